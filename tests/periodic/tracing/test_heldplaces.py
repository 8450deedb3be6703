"""A joint that is held all along and reaches one of its limits: the orbit at which it reaches both."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.orbit.orbit import Orbit
from periodic.system import SurfaceLike
from periodic.tracing import heldplaces
from periodic.tracing.continuation import Continuation

BEGIN, BOUNDS = 0.7, (0.6, 1.0)
"""Below the resonance: the slider is held where the branch begins, and its limits come nearer."""

BOTH = (-1.0, 1.0)
"""Parts of the room of the slider by which its place is moved."""


@pytest.fixture(scope="module")
def system() -> sym.CompiledSystem:
    """A mass on a spring that stiffens, and on a slider."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 0.5) + sym.CubicSpring(x, 0.5) + sym.Damper(x, 0.1)
    return sym.compile(model + sym.Jenkins(x, 0.5, 0.2, creep=None) + sym.HarmonicForce(x, 0.15))


@pytest.fixture(scope="module")
def begun(system: sym.CompiledSystem) -> tuple[Continuation, SurfaceLike]:
    """A run that has taken a step, the slider midway between its limits; the slider."""
    run = per.continuation(per.Problem(system, "Omega", BOUNDS), BEGIN, sign=1)
    points = iter(run)
    next(points)
    (surface,) = heldplaces._held(system, next(points).orbit)
    return run, surface


def moved(run: Continuation, surface: SurfaceLike, part: float) -> Orbit:
    """The orbit there as a guess of one whose slider is held farther off the middle."""
    assert run.state is not None and surface.place is not None
    orbit = run.state.last.orbit
    (pull,) = heldplaces._pulls(run.solver.problem.system, orbit, [surface])
    parameter = orbit.parameter.copy()
    parameter[surface.place[0]] += part * 0.4 * -pull.up  # half the distance of its limits is 0.4
    return replace(orbit, parameter=parameter)


@pytest.mark.parametrize("part", BOTH)
def test_limits_are_followed_to_where_both_are_reached(part: float, system: Any, begun: Any) -> None:
    """Assert the corner from either limit: where the slider midway begins to slip, to 7 digits."""
    run, surface = begun
    branch = per.trace(system, "Omega", BOUNDS, start=BEGIN, guess=run.state.last.orbit)
    slips = next(point for point in branch.points if point.label is per.Label.GRAZING)
    found = heldplaces._along_limit(run.solver, moved(run, surface, part), surface, 1, run._follow)
    assert found is not None and heldplaces._at_both(system, found, [surface])
    assert run.solver.problem.value(found) == pytest.approx(slips.parameter, rel=1e-7)
    assert heldplaces._off_centre(system, found, [surface]) == pytest.approx([0.0], abs=1e-6)


def test_way_that_leads_to_no_corner(begun: Any) -> None:
    """Assert that downwards, where the limits part, the bound is reached, and that the other way is found."""
    run, surface = begun
    system, guess = run.solver.problem.system, moved(run, surface, 1.0)
    found = heldplaces._along_limit(run.solver, guess, surface, -1, run._follow)
    assert found is not None and not heldplaces._at_both(system, found, [surface])
    assert run.solver.problem.value(found) == BOUNDS[0]
    base = replace(run.state.last, correction=replace(run.state.last.correction, orbit=guess))
    (corner,) = heldplaces._corners(run.solver, base, [surface], -1.0, run._follow)
    assert corner.ok and heldplaces._at_both(system, corner.orbit, [surface])
    assert np.sign(corner.tangent.parameter) == -1.0


def test_nothing_is_sought_beyond_a_corner(begun: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an orbit at both limits is returned as it is: slips begin from there."""
    run, surface = begun
    base = run.state.last
    monkeypatch.setattr(heldplaces, "at_limit", lambda *_: [surface])
    monkeypatch.setattr(heldplaces, "amid", lambda solver, found, *_: found)
    monkeypatch.setattr(heldplaces, "_at_both", lambda *_: True)
    monkeypatch.setattr(heldplaces, "_corners", lambda *_: pytest.fail("it was sought"))
    assert heldplaces.off_limits(run.solver, base, 1.0, heldplaces._fixed, run._follow, 0.2) is base


@pytest.mark.parametrize("far", [False, True])
def test_far_corners_are_left(far: bool, begun: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a corner as far off as the longest step is taken, and that else the place is followed."""
    run, surface = begun
    base, corner, followed = run.state.last, object(), object()
    monkeypatch.setattr(heldplaces, "at_limit", lambda *_: [surface])
    monkeypatch.setattr(heldplaces, "amid", lambda solver, found, *_: found)
    monkeypatch.setattr(heldplaces, "_at_both", lambda *_: False)
    monkeypatch.setattr(heldplaces, "_corners", lambda *_: iter([corner]))
    monkeypatch.setattr(heldplaces, "_apart", lambda *_: 0.21 if far else 0.2)
    monkeypatch.setattr(heldplaces, "_followed", lambda *_: followed)
    found = heldplaces.off_limits(run.solver, base, 1.0, heldplaces._fixed, run._follow, 0.2)
    assert found is (followed if far else corner)  # type: ignore[comparison-overlap]
