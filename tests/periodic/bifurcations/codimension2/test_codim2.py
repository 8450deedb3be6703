"""Special points on curves of folds: a Duffing oscillator beside a linear part with known multipliers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.traces import DUFFING_A, duffing_system

import periodic as per
import symbolic as sym
from periodic.bifurcations.codimension2.codim2 import alignment

CRITICAL = 0.3
"""F at which the linear part's multipliers pass the unit circle."""

Rates = Callable[[Any, Any], Mapping[str, Any]]


def beside(rates: Rates, states: tuple[str, ...]) -> sym.CompiledSystem:
    """x'' + .1 x' + x + x^3 = F cos(Omega t) and, decoupled, a part whose damping depends on F."""

    def all_rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = p.F * wave.cos - 0.1 * x.v - x.x - x.x**3
        return {"x": x.v, "v": force, **rates(x, p)}

    names = dict.fromkeys(("x", "v", *states), 0.0)
    parameters = {"F": 0.5, "Omega": 1.0}
    return sym.compile(sym.Equations(all_rates, names, parameters, frequency="Omega"))


def first_order(x: Any, p: Any) -> dict[str, Any]:
    """y' = -(F - CRITICAL) y: its multiplier passes 1."""
    return {"y": -(p.F - CRITICAL) * x.y}


def oscillator(x: Any, p: Any) -> dict[str, Any]:
    """y'' + (F - CRITICAL) y' + 2 y = 0: a complex pair passes the unit circle."""
    return {"y": x.w, "w": -(p.F - CRITICAL) * x.w - 2 * x.y}


def saddle(x: Any, p: Any) -> dict[str, Any]:
    """y'' + (F - CRITICAL) y' - y/10 = 0: two real multipliers have the product 1 there."""
    return {"y": x.w, "w": -(p.F - CRITICAL) * x.w + 0.1 * x.y}


def fold_curve(
    system: per.extend.System, tol: float = 1e-8, start: float = 1.2, ds_max: float = 0.2
) -> per.Branch:
    """The curve of the first fold from a start in Omega, over Omega and F, between F = 0.2 and 0.5."""
    branch = per.trace(system, "Omega", (1.2, 3.0), start=start, watch=per.Watch(stop={"LP": 1}), tol=tol)
    assert branch[-1].label is per.Label.FOLD
    return per.trace(
        system,
        "Omega",
        (1.2, 3.0),
        guess=branch[-1].orbit,
        determined={"F": per.FoldCondition()},
        watch=per.Watch(limits={"F": (0.2, 0.5)}),
        tol=tol,
        control=per.ArclengthControl(ds_max=ds_max),
    )


@pytest.mark.parametrize(
    ("rates", "states", "labels"),
    [(first_order, ("y",), ["R1"]), (oscillator, ("y", "w"), ["LPNS"]), (saddle, ("y", "w"), [])],
)
def test_what_a_fold_curve_passes(rates: Rates, states: tuple[str, ...], labels: list[str]) -> None:
    """Assert R1 for a second multiplier 1, LPNS for a complex pair, and nothing for a neutral saddle."""
    curve = fold_curve(beside(rates, states))
    assert np.ptp(curve.column("F")) > 0.25
    found = [p for p in curve.special_points if p.label is not per.Label.END]
    assert [p.label.value for p in found] == labels
    for point in found:
        assert point.orbit.parameter[0] == pytest.approx(CRITICAL, rel=1e-8)


@pytest.mark.parametrize("tol", [1e-6, 1e-9])
def test_conserved_products_are_no_resonance(tol: float) -> None:
    """Assert that folds without damping, where both multipliers are 1 throughout, have no R1."""
    curve = fold_curve(duffing_system(0.0, 1.0, 0.5), tol, start=3.0, ds_max=0.02)
    assert len(curve) >= 10
    assert np.sort(curve.column("F"))[[0, -1]] == pytest.approx([0.2, 0.5], rel=1e-9)
    assert {p.label for p in curve.special_points} == {per.Label.END}


def test_limit_at_the_start_ends_the_branch() -> None:
    """Assert that a curve that begins at its limit ends there, and goes on on the other side."""
    curve = fold_curve(duffing_system(*DUFFING_A))
    ends = curve.column("F")[[0, -1]]
    assert np.sort(ends) == pytest.approx([0.2, 0.5], rel=1e-9)
    assert {curve.stop.detail, curve.stop_backwards.detail if curve.stop_backwards else ""} == {
        "lower limit of F",
        "upper limit of F",
    }


def test_cut_of_an_angle_is_no_event() -> None:
    """Assert that every event of a phase lag is at its level: none where the angle jumps by 2 pi."""
    lag = per.PhaseLag("x", 3)
    branch = per.trace(
        duffing_system(*DUFFING_A),
        "Omega",
        (0.3, 3.0),
        control=per.ArclengthControl(ds_max=0.05),
        watch=per.Watch(columns={"lag": lag}, events={"lag": per.Level(lag, 0.5)}),
    )
    lags = branch.column("lag")
    assert np.abs(np.diff(lags)).max() > 6  # there is such a jump
    for point in branch.labelled(per.Label.USER):
        assert point.columns["lag"] == pytest.approx(0.5, abs=1e-6)


def test_critical_motions_of_folds_are_those_that_come_back() -> None:
    """Assert the cosine between motions with the multiplier 1, whatever the others are."""
    t = np.linspace(0, 2 * np.pi, 101)
    orbit = per.sampled(t, np.stack([np.cos(t), -np.sin(t)], axis=1))

    def solution(angle: float) -> Any:
        vectors = np.array([[np.cos(angle), 0.0], [np.sin(angle), 1.0]])
        monodromy = vectors @ np.diag([1.0, 0.5]) @ np.linalg.inv(vectors)
        spectrum = SimpleNamespace(
            monodromy=monodromy, fundamental=np.array([np.eye(2)] * (orbit.mesh.ntst + 1))
        )
        problem = SimpleNamespace(conditions=(per.FoldCondition(),))
        return SimpleNamespace(
            orbit=orbit, spectrum=spectrum, problem=problem, discretisation=per.Collocation()
        )

    assert alignment(solution(0.2), solution(1.1)) == pytest.approx(np.cos(0.9), rel=1e-12)
