"""Branch points met by curves of orbits at a level, of peaks, and of equilibria at a level."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

import periodic as per
import symbolic as sym

CRITICAL = 0.3
"""F at which the orbits with y = 0 lose their stability."""

PEAK = per.PeakToPeak("x")


@cache
def lopsided() -> sym.CompiledSystem:
    """x'' + .1 x' + x^3 = F cos(Omega t), whose symmetric orbits become lopsided at branch points."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - 0.1 * x.v - x.x**3}

    return sym.compile(
        sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"F": 0.5, "Omega": 1.0}, frequency="Omega")
    )


@cache
def beside() -> sym.CompiledSystem:
    """A Duffing oscillator and y' = (F - CRITICAL) y - y^3, with branch points at F = CRITICAL."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = p.F * wave.cos - 0.1 * x.v - x.x - x.x**3
        return {"x": x.v, "v": force, "y": (p.F - CRITICAL) * x.y - x.y**3}

    states = dict.fromkeys(("x", "v", "y"), 0.0)
    return sym.compile(sym.Equations(rates, states, {"F": 0.25, "Omega": 2.0}, frequency="Omega"))


def special(branch: per.Branch) -> list[str]:
    """Labels but for the ends."""
    return [p.label.value for p in branch.special_points if p.label is not per.Label.END]


@cache
def level_curve() -> tuple[per.Level, per.Branch]:
    """Symmetric orbits of the height that they have at F = .5, Omega = .63."""
    system = lopsided()
    (start,) = per.trace(system, "Omega", (0.6, 3.0), start=3.0, at=0.63).labelled("UZ")
    level = per.Level(PEAK, PEAK(system, start.orbit))
    watch = per.Watch(limits={"Omega": (0.55, 0.7)})
    held = {"Omega": level}
    return level, per.trace(system, "F", (0.4, 0.8), guess=start.orbit, determined=held, watch=watch)


def test_branch_point_on_a_level_curve() -> None:
    """Assert a BP where the branch in Omega at its force has one, to 1e-9, and no fold."""
    level, curve = level_curve()
    assert special(curve) == ["BP"] and not curve.unaccounted
    (point,) = curve.labelled("BP")
    Omega, force = point.orbit.parameters["Omega"], point.parameter
    given: Any = {"start": Omega + 0.02, "values": {"F": force}}
    branch = per.trace(lopsided(), "Omega", (Omega - 0.01, Omega + 0.02), guess=curve[0].orbit, **given)
    (crossed,) = branch.labelled("BP")
    assert crossed.parameter == pytest.approx(Omega, rel=1e-9)
    assert point.peak_to_peak("x") == pytest.approx(level.value, rel=1e-9)


def test_curve_that_leaves_there() -> None:
    """Assert that lopsided orbits of that height are reached, on whose curve the point is a BP as well."""
    level, curve = level_curve()
    (point,) = curve.labelled("BP")
    held = {"Omega": level}
    guess = per.branched(lopsided(), point.orbit, "F", determined=held)
    leaving = per.trace(lopsided(), "F", (0.5, 0.6), guess=guess, determined=held)
    assert special(leaving) == ["BP"] and not leaving.unaccounted
    (back,) = leaving.labelled("BP")
    assert back.parameter == pytest.approx(point.parameter, rel=1e-6)  # on another mesh
    for end in (leaving[0], leaving[-1]):
        assert abs(end.maximum["x"] + end.minimum["x"]) > 0.01
        assert end.peak_to_peak("x") == pytest.approx(level.value, rel=1e-9)


@pytest.mark.parametrize("method", [per.Collocation(), per.Shooting(), per.HarmonicBalance()])
def test_branch_point_by_any_method(method: per.extend.Discretisation) -> None:
    """Assert the BP of a level curve at F = CRITICAL, to 1e-9."""
    system = beside()
    (start,) = per.trace(system, "F", (0.1, 0.25)).labelled("EP")[-1:]
    held = {"Omega": per.Level(PEAK, PEAK(system, start.orbit))}
    curve = per.trace(system, "F", (0.1, 0.5), guess=start.orbit, determined=held, method=method)
    assert special(curve) == ["BP"]
    assert curve.labelled("BP")[0].parameter == pytest.approx(CRITICAL, rel=1e-9)


def test_branch_point_on_a_curve_of_peaks() -> None:
    """Assert the BP of the curve of resonance peaks at F = CRITICAL, to 1e-9."""
    system, height = beside(), per.PeakToPeak("x")
    branch = per.trace(system, "Omega", (0.8, 2.5), start=2.5)
    peak = max(branch, key=lambda point: point.peak_to_peak("x"))
    held = {"Omega": per.Peak(height)}
    curve = per.trace(system, "F", (0.1, 0.5), guess=peak.orbit, determined=held)
    assert special(curve) == ["BP"] and not curve.unaccounted
    assert curve.labelled("BP")[0].parameter == pytest.approx(CRITICAL, rel=1e-9)


def test_equilibria_at_a_level() -> None:
    """Assert the BP and the LPs of curves of equilibria at a level, in closed form."""

    def pitchfork(x: Any, p: Any) -> dict[str, Any]:
        return {"x": x.x * (p.mu - x.x**2), "y": p.a + p.mu - x.x**2 - x.y}

    def cusp(x: Any, p: Any) -> dict[str, Any]:
        return {"x": p.a + p.mu * x.x - x.x**3, "y": x.x**2 + p.mu - x.y}

    names, level = dict.fromkeys("xy", 0.0), {"a": per.Level(per.mean("y"), 0.5)}
    system = sym.compile(sym.Equations(pitchfork, names, {"mu": -1.0, "a": 1.5}))
    straight = per.trace(system, "mu", (-1, 1), guess={"y": 0.5}, determined=level, method=per.Equilibrium())
    assert special(straight) == ["BP"] and straight.labelled("BP")[0].parameter == pytest.approx(0, abs=1e-9)
    guess = per.branched(system, straight.labelled("BP")[0].orbit, "mu", determined=level)
    bent = per.trace(system, "mu", (-1, 1), guess=guess, determined=level, method=per.Equilibrium())
    assert special(bent) == ["BP"]
    assert [bent[0].maximum["x"], bent[-1].maximum["x"]] == [pytest.approx(x, rel=1e-9) for x in (-1, 1)]
    system = sym.compile(sym.Equations(cusp, names, {"mu": 0.25, "a": -0.125}))
    curve = per.trace(
        system, "mu", (-1, 1), guess={"x": 1.2, "y": 0.5}, determined=level, method=per.Equilibrium()
    )
    assert special(curve) == ["LP", "LP"]  # 3 x^2 = mu = .5 - x^2
    places = sorted(point.maximum["x"] for point in curve.labelled("LP"))
    assert places == [pytest.approx(sign * 0.125**0.5, rel=1e-9) for sign in (-1, 1)]
