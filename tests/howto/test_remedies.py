"""What to do when a trace stops: remedies of that page, each on a model that needs it."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import periodic as per
import symbolic as sym

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "when-a-trace-stops.md"

F = sym.functions
FEW = per.ArclengthControl(max_points=200, max_newton=3000)


def system(force: Callable[[Any, Any, Any], Any], start: float = 0.0, **values: float) -> sym.CompiledSystem:
    """x'' = a force of x, v, parameters and the wave."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": force(x, p, wave)}

    parameters = {"Omega": 1.0} | values
    return sym.compile(sym.Equations(rates, {"x": start, "v": 0.0}, parameters, frequency="Omega"))


def test_remedies_that_are_code_can_be_written() -> None:
    """Assert that each setting on the page is accepted as it stands there."""
    text = PAGE.read_text("utf-8")
    settings = re.findall(r"`(?:control|method|watch)=(per\.[^`]*\))`", text)
    assert len(settings) >= 5
    made = [eval(setting, {"per": per}) for setting in settings]
    assert {type(each) for each in made} == {
        per.ArclengthControl,
        per.Collocation,
        per.Equilibrium,
        per.Watch,
    }


@pytest.mark.parametrize(("start", "said"), [(0.0, "the equations were not finite"), (1.0, "")])
def test_rest_that_is_not_at_zero(start: float, said: str) -> None:
    """Assert that a mass repelled by 1/x has an orbit from a start where its rest is, and none from 0."""
    repelled = system(lambda x, p, w: 1 / x.x - x.x - 0.1 * x.v + 0.1 * w.cos, start)
    branch = per.trace(repelled, "Omega", (0.5, 2.0), start=0.5)
    assert branch.stop.reason is (per.Reason.NO_START if said else per.Reason.BOUND)
    assert branch.stop.detail.startswith(said)


@pytest.mark.parametrize(("stiffness", "said"), [(0.0, "; nothing holds x; "), (0.01, "")])
def test_free_body_is_tied_down(stiffness: float, said: str) -> None:
    """Assert that a damped mass alone has no isolated orbit, and that a soft spring gives it one."""
    free = system(lambda x, p, w: -0.1 * x.v + 0.3 * w.cos - stiffness * x.x)
    branch = per.trace(free, "Omega", (0.5, 1.5), start=0.5)
    assert branch.stop.reason is (per.Reason.NO_START if said else per.Reason.BOUND)
    assert said in branch.stop.detail


@pytest.mark.parametrize(("floor", "finite"), [(0.0, False), (1e-3, True)])
def test_logarithm_that_leaves_its_range(floor: float, finite: bool) -> None:
    """Assert that log(1 - x) ends the branch as the amplitude grows to 1, and does not with a floor."""
    force = system(
        lambda x, p, w: (
            -x.x - 0.1 * x.v + p.F * w.cos + 0.2 * F.log(F.fmax(1 - x.x, floor) if floor else 1 - x.x)
        ),
        Omega=0.9,
        F=0.05,
    )
    branch = per.trace(force, "F", (0.05, 1.0), start=0.05, control=FEW)
    assert branch.stop.reason is (per.Reason.BOUND if finite else per.Reason.SMALL_STEP)
    if not finite:
        assert branch.stop.detail.startswith("the equations were not finite near the iterate")
        assert branch[-1].maximum["x"] == pytest.approx(1.0, abs=1e-2)


def test_growth_ends_at_a_bound_of_ones_own() -> None:
    """Assert that a parametric oscillator ends at the peak to peak of the page, and without it far beyond."""
    driven = system(lambda x, p, w: -0.1 * x.v - (1 + 0.8 * w.cos) * x.x + 1e-4 * w.cos)
    asked = re.search(r"`watch=(per\.Watch\([^`]*\))`", PAGE.read_text("utf-8"))
    assert asked is not None
    watch = eval(asked[1], {"per": per})
    near = per.trace(driven, "Omega", (0.4, 3.0), start=0.5, watch=watch)
    assert near.stop.reason is per.Reason.ASKED
    assert near[-1].peak_to_peak("x") == pytest.approx(1e-3, rel=1e-9)
    far = per.trace(driven, "Omega", (0.4, 3.0), start=0.5)
    assert far.stop.reason is per.Reason.UNBOUNDED and far[-1].peak_to_peak("x") > 1e3


def test_friction_that_holds_is_written_as_such() -> None:
    """Assert the reason where sign(v) holds all along, and the branch of `CoulombFriction` with its place."""
    own = system(lambda x, p, w: -x.x - 0.1 * x.v - 0.5 * F.sign(x.v) + 0.3 * w.cos)
    for start in (0.5, 1.5):
        branch = per.trace(own, "Omega", (0.5, 1.5), start=start)
        assert branch.stop.reason is per.Reason.NO_START
        assert "holds all along, at a place that is not determined" in branch.stop.detail
    q = sym.coordinate("q")
    model = sym.Mass(q, 1.0) + sym.Spring(q, 1.0) + sym.Damper(q, 0.1) + sym.HarmonicForce(q, 0.3)
    rubbed = sym.compile(model + sym.CoulombFriction(q, 0.5))
    assert "place of q" in [parameter.name for parameter in rubbed.parameters]
    held = per.trace(rubbed, "Omega", (0.5, 1.5), start=0.5)
    assert held.stop.reason is per.Reason.BOUND and max(p.orbit.span() for p in held) < 1e-9


def test_harmonics_that_do_not_represent_a_contact() -> None:
    """Assert that harmonic balance says so of a hard stop, and that collocation resolves it."""
    stop = system(lambda x, p, w: -x.x - 0.1 * x.v + 0.5 * w.cos - 1e3 * F.fmax(x.x - 1, 0.0))
    ways: list[tuple[Any, per.Reason]] = [
        (per.HarmonicBalance(), per.Reason.INACCURATE),
        (per.Collocation(), per.Reason.BOUND),
    ]
    for method, reason in ways:
        branch = per.trace(stop, "Omega", (0.5, 0.9), start=0.9, method=method, control=FEW)
        assert branch.stop.reason is reason


def test_more_intervals_or_less_accuracy() -> None:
    """Assert that a steep orbit that 60 intervals do not resolve is traced with more, or less accurately."""
    steep = system(lambda x, p, w: -x.x - 5 * (x.x**2 - 1) * x.v + p.A * w.cos, A=10.0)
    few = per.Collocation(ntst=16, ntst_max=60)
    for method, tol, reason in (
        (few, 1e-8, per.Reason.INACCURATE),
        (per.Collocation(ntst_max=4000), 1e-8, per.Reason.BOUND),
        (few, 1e-3, per.Reason.BOUND),
    ):
        branch = per.trace(steep, "Omega", (0.8, 1.0), start=1.0, method=method, tol=tol, control=FEW)
        assert branch.stop.reason is reason, (method, tol, branch.stop)


def test_bounds_on_the_work_are_raised() -> None:
    """Assert that a branch cut short goes on with `guess=branch`, to the points of one that was not."""
    bent = system(lambda x, p, w: -0.1 * x.v - x.x - x.x**3 + 0.3 * w.cos)
    short = per.trace(bent, "Omega", (0.5, 2.0), start=0.5, control=per.ArclengthControl(max_points=9))
    assert short.stop.reason is per.Reason.MAX_POINTS
    whole = per.trace(bent, "Omega", (0.5, 2.0), start=0.5)
    resumed = per.trace(bent, "Omega", (0.5, 2.0), guess=short)
    assert resumed.stop.reason is per.Reason.BOUND
    assert resumed.values == pytest.approx(whole.values, rel=1e-12)
