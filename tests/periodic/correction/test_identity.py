"""How far two orbits are apart."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along

import periodic as per
import symbolic as sym
from periodic.correction import identity
from periodic.correction.identity import Shared, _impacts, _interpolated, distance
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import Kind
from periodic.system.events import Surface


def apart(scale: float) -> float:
    """Distance over the peak to peak of two motions with impacts, their coordinate measured in such units."""
    q = sym.coordinate("q", scale=scale)
    parts = [sym.Mass(q, 1.0), sym.Spring(q, 1.0), sym.Damper(q, 0.1), sym.RigidStop(q, 1.0, 0.8)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(q, 0.5, 1.1)]))
    one = per.ArclengthControl(max_points=1)
    a, b = (per.trace(system, "Omega", (w, 1.2), control=one)[0].orbit for w in (1.1, 1.101))
    shift = float(np.abs(a.phases - b.phases).max())
    assert 1e-4 < shift < 1e-2
    same = replace(b, parameter=a.parameter)
    return distance(per.Problem(system, "Omega", (1.1, 1.2)), a, same) / a.span()


@pytest.mark.parametrize("scale", [1e3, 1e-3])
def test_impacts_that_are_later_count_as_the_motion_does(scale: float) -> None:
    """Assert that what an impact's phase adds does not depend on the unit of the states."""
    assert apart(scale) == pytest.approx(apart(1.0), rel=1e-2)


def given(
    phases: tuple[float, ...] = (), late: float = 0.0, height: float = 1.0, switches: Any = ()
) -> Orbit:
    """x = height cos(tau - late), with impacts of some switches at phases."""
    events = [EventNode(k, -1) for k in switches or (0,) * len(phases)]
    nodes = list(zip(events, phases, strict=True))
    return along(lambda tau: height * np.cos(tau - late)[:, None], nodes, intervals=40)


def problem(units: float | tuple[float, ...] = 2.0, free: tuple[int, ...] = (0,)) -> Any:
    """One of two walls, in units of its parameters."""
    walls = [Surface(Kind.IMPACT, "wall", 0), Surface(Kind.IMPACT, "other wall", 1)]
    own = np.array(units) if isinstance(units, tuple) else units
    return SimpleNamespace(system=Surfaces(walls, [[1.0]] * 2), free=free, units=lambda orbit: own)


def test_distance_is_a_mean_over_the_period() -> None:
    """Assert that of two heights, of a shift, and none of an orbit from itself, whatever its mesh."""
    a = given()
    assert distance(problem(), a, a) == 0.0
    assert distance(problem(), a, given(height=1.25)) == pytest.approx(0.25 * np.sqrt(0.5), rel=1e-6)
    assert distance(problem(), a, given(late=0.5), later=0.5) == pytest.approx(0.0, abs=1e-6)
    assert distance(problem(), a, given(late=0.5), later=-0.5) == pytest.approx(
        2 * np.sin(0.5) / np.sqrt(2), rel=1e-5
    )
    other = along(lambda tau: np.cos(tau)[:, None], intervals=24)
    assert distance(problem(), a, other) == pytest.approx(0.0, abs=1e-5)


def test_parameters_count_in_their_units() -> None:
    """Assert the first of them where there is one unit, and all where each has its own."""
    a = replace(given(), parameter=np.array([1.0, 1.0, 1.0]))
    b = replace(a, parameter=np.array([1.6, 9.0, 1.3]))
    assert distance(problem(2.0, (0, 2)), a, b) == pytest.approx(0.3)
    assert distance(problem((2.0, 0.5), (0, 2)), a, b) == pytest.approx(np.hypot(0.3, 0.6))


@pytest.mark.parametrize(("shift", "shared"), [(0.04, True), (-0.04, True), (0.06, False)])
def test_impacts_are_shared_that_are_near(shift: float, shared: bool) -> None:
    """Assert which of the other orbit it is, where, and how much later."""
    a, b = given((1.0, 4.0)), given((1.0 + shift, 4.0))
    found = list(_impacts(problem(), a, b, 0.0))
    assert len(found) == (2 if shared else 1)
    assert (found[-1].starts, found[-1].other, found[-1].phase) == ([20], 20, 4.0)
    assert found[-1].shift == pytest.approx(0.0)
    if shared:
        assert (found[0].starts, found[0].other, found[0].phase) == ([0, 40], 0, 1.0)
        assert found[0].shift == pytest.approx(shift)


@pytest.mark.parametrize(
    ("phases", "switches", "other", "count"),
    [
        ((1.0, 1.06), (), (1.025, 4.0), 1),
        ((1.0, 1.06), (), (1.035, 4.0), 1),
        ((1.0, 1.06), (0, 1), (1.035, 4.0), 1),
        ((1.0, 4.0), (0, 1), (1.0, 4.0), 1),
        ((1.0, 2 * np.pi + 0.96), (), (0.985, 4.0), 1),
    ],
)
def test_impacts_that_follow_each_other(phases: Any, switches: Any, other: Any, count: int) -> None:
    """Assert that each is compared with what is nearer to it than to its neighbour at the same wall."""
    found = list(_impacts(problem(), given(phases, switches=switches), given(other), 0.0))
    assert len(found) == count


def test_shift_between_impacts() -> None:
    """Assert that of each impact, in between as much as there is of the way, round the period too."""
    shared = [Shared([0], 0, 1.0, 0.1), Shared([1], 1, 3.0, 0.3)]
    tau = np.array([1.0, 2.0, 3.0, 3.0 + (2 * np.pi - 2) / 2])
    assert _interpolated(tau, given(), shared) == pytest.approx([0.1, 0.2, 0.3, 0.2])
    assert _interpolated(tau, given(), []).tolist() == [0.0] * 4


def test_shift_of_an_impact_counts_as_the_motion() -> None:
    """Assert its part of the amplitude, beside what is left between orbits of one shape."""
    a, b = given((1.0, 4.0)), given((1.02, 4.0), late=0.0)
    apart = distance(problem(), a, b)
    assert apart >= 0.02 * a.span() / 2 and apart < 0.04
    later = given((1.02, 4.02), late=0.02)
    assert distance(problem(), a, later) == pytest.approx(np.sqrt(2) * 0.02 * a.span() / 2, rel=1e-3)


@pytest.mark.parametrize(
    ("apart", "errors", "span", "alike"),
    [
        (0.03, (0.0, 0.0), 1.0, False),
        (0.02, (1e-3, 0.0), 1.0, True),
        (0.02, (0.0, 1e-3), 1.0, False),
        (0.04, (1e-3, 0.0), 1.0, False),
        (0.06, (0.1, 0.0), 1.0, False),
        (0.06, (0.1, 0.0), 2.0, True),
        (2e-5, (0.0, 0.0), 1.0, True),
        (1e-9, (0.0, 0.0), 0.0, False),
    ],
)
def test_one_orbit_within_its_error(
    apart: float, errors: tuple[float, float], span: float, alike: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert 30 times the larger of its error and the tolerance, in peaks to peak, a twentieth at most."""
    a, b = (
        SimpleNamespace(error=SimpleNamespace(worst=error), orbit=SimpleNamespace(span=lambda: span))
        for error in errors
    )
    asked: list[float] = []
    monkeypatch.setattr(identity, "distance", lambda problem, one, other, later: asked.append(later) or apart)
    solver: Any = SimpleNamespace(problem=None, tolerance=SimpleNamespace(orbit=1e-6))
    assert identity.same(solver, a, b, 2) is alike  # type: ignore[arg-type]
    assert asked == [pytest.approx(4 * np.pi)]


@pytest.mark.parametrize(
    ("periods", "at", "way", "closed"),
    [(1, 0, 1.0, True), (1, 0, -1.0, False), (3, 2, 1.0, True), (3, 2, -1.0, False), (3, 3, 1.0, False)],
)
def test_branch_that_comes_back_to_its_start(
    periods: int, at: int, way: float, closed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it is the start shifted by whole periods, met in the direction in which it was left."""
    asked: list[float] = []

    def alike(solver: Any, a: Any, b: Any, later: float) -> bool:
        asked.append(later)
        return later == at

    monkeypatch.setattr(identity, "same", alike)
    restricted: list[float] = []
    tangent = SimpleNamespace(
        restricted=lambda orbit, onto, later: restricted.append(later) or "onward",
        dot=lambda other, orbit, units: way if other == "onward" else 0.0,
    )
    start: Any = SimpleNamespace(orbit=SimpleNamespace(periods=periods), tangent=tangent)
    solver: Any = SimpleNamespace(problem=SimpleNamespace(autonomous=False, units=lambda orbit: None))
    assert identity.closes(solver, start, start) is closed
    assert asked == list(range(min(at + 1, periods)))
    assert restricted == ([pytest.approx(2 * np.pi * at)] if at < periods else [])


@pytest.mark.parametrize(("periods", "again", "found"), [(1, 0, False), (4, 2, True), (4, 4, False)])
def test_orbit_that_repeats_itself(
    periods: int, again: int, found: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert it of one that comes back after fewer periods than it has."""
    monkeypatch.setattr(identity, "same", lambda solver, a, b, later: later == again)
    own: Any = SimpleNamespace(orbit=SimpleNamespace(periods=periods))
    assert identity.repeats(None, own) is found  # type: ignore[arg-type]


@pytest.mark.parametrize(("periods", "least"), [(1, np.inf), (2, 9.0), (4, 1.0)])
def test_distance_of_an_orbit_from_itself(
    periods: int, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the least one, shifted by one period to all but one."""
    apart = {1: 9.0, 2: 1.0, 3: 4.0}
    monkeypatch.setattr(identity, "distance", lambda problem, a, b, later: apart[round(later / 2 / np.pi)])
    own: Any = SimpleNamespace(orbit=SimpleNamespace(periods=periods), problem=None)
    assert identity.from_itself(own) == least


def test_shift_of_the_least_distance() -> None:
    """Assert that of a wave against the same one later, to 8 digits, in turns."""
    a, b = given(), given(late=1.2345)
    free: Any = problem()
    assert identity._ahead(free, a, b) == pytest.approx(1.2345 / (2 * np.pi), abs=1e-7)
