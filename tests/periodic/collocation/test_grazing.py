"""A mass and a stop from soft to all but rigid: branches through grazing, judged in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from reference.piecewise import Piecewise
from support.kept import kept
from support.stops import errors, exactly, stopped
from support.stops import judged as exactly_judged

import periodic as per
import symbolic as sym
from periodic.events.rewrites import rewrite
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

UP, DOWN = (0.65, 0.8), (0.8, 0.65)
STIFFNESSES = [5.0, 1e2, 1e4]
each_way = pytest.mark.parametrize("way", [UP, DOWN], ids=["up", "down"])


@kept
def branch(stiffness: float, way: tuple[float, float], tol: float = 1e-6) -> per.Branch:
    """The branch through grazing."""
    return per.trace(stopped(stiffness), "Omega", way, tol=tol)


@each_way
@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_every_orbit_and_multiplier_is_right(stiffness: float, way: tuple[float, float]) -> None:
    """Assert that the branch passes grazing, and what it claims of every point on the way."""
    judged(branch(stiffness, way), exactly(stiffness))


def test_all_but_rigid_stop() -> None:
    """Assert the same of a stop a million times as stiff as the spring, to just past grazing."""
    judged(branch(1e6, (0.65, 0.71075)), exactly(1e6))


def judged(found: per.Branch, exact: Piecewise) -> None:
    """Assert that a branch comes to its bound, and that its points are as accurate as it says."""
    assert found.stop.reason is per.Reason.BOUND
    grazings = {point.parameter for point in found.labelled(per.Label.GRAZING)}
    for point in found:
        if point.parameter not in grazings:  # there multipliers have two values
            gap, apart = errors(exact, point)
            assert gap < 3 * max(point.error.orbit, 1e-11)
            assert apart < max(1e-6, 3 * point.error.multiplier)
            assert point.error.worst < 1e-6


@each_way
@pytest.mark.parametrize("tol", [1e-3, 1e-9])
def test_any_tolerance_passes(tol: float, way: tuple[float, float]) -> None:
    """Assert the same of a rough and of a fine branch."""
    found, exact = branch(50.0, way, tol), exactly(50.0)
    assert found.stop.reason is per.Reason.BOUND
    grazings = {point.parameter for point in found.labelled(per.Label.GRAZING)}
    for point in found:
        if point.parameter not in grazings:  # there multipliers have two values
            found_there = exactly_judged(exact, point)  # 1e-10 beside grazing doubles do not tell it
            assert found_there.orbit < tol
            assert found_there.multiplier < max(tol, 3 * point.error.multiplier)


@each_way
def test_grazing_is_a_point_of_the_branch(way: tuple[float, float]) -> None:
    """Assert where it is, by the free response, and that the motion just reaches the stop."""
    (point,) = branch(1e2, way).labelled(per.Label.GRAZING)
    amplitude = 0.5 / abs(1 - point.parameter**2 + 0.1j * point.parameter)
    assert amplitude == pytest.approx(1.0, abs=1e-8)
    assert point.maximum["q"] == pytest.approx(1.0, abs=1e-8)
    damped = np.exp(-0.05 * 2 * np.pi / point.parameter)
    assert np.abs(point.multipliers) == pytest.approx([damped, damped], abs=1e-7)


@pytest.mark.parametrize("way", [(0.5, 2.0), (2.0, 0.5)], ids=["up", "down"])
def test_two_stops_are_grazed_at_once(way: tuple[float, float]) -> None:
    """Assert that a mass between equal stops meets and leaves both at once, where the free motion does."""
    q = sym.coordinate("q")
    model = sym.Mass(q, 1.0) + sym.Damper(q, 0.5) + sym.Spring(q, 1.0) + sym.HarmonicForce(q, 0.7)
    found = per.trace(sym.compile(model + sym.Backlash(q, 5.0, 1.0)), "Omega", way)
    assert found.stop.reason is per.Reason.BOUND
    grazings = sorted(point.parameter for point in found.labelled(per.Label.GRAZING))
    free = sorted(np.sqrt(np.roots([1.0, 0.5**2 - 2.0, 1.0 - 0.7**2])))
    assert grazings == pytest.approx(free, abs=1e-8)
    beyond = [point for point in found if point.maximum["q"] > 1 + 1e-8]
    assert beyond
    for point in beyond:
        assert len(point.orbit.mesh.events) == 4
        assert point.maximum["q"] == pytest.approx(-point.minimum["q"], abs=1e-6)


def test_meshes_stay_small() -> None:
    """Assert that no point takes more than 200 intervals, however stiff the stop."""
    traced = [branch(k, way) for k in STIFFNESSES for way in (UP, DOWN)]
    assert max(point.orbit.mesh.ntst for found in traced for point in found) <= 200


def test_excursion_between_collocation_points_is_seen() -> None:
    """Assert that a switch that passes its level between two collocation points only is found."""
    system = stopped(1e2)
    orbit = at_rest(system, uniform(per.Scheme(per.Family.GAUSS, 4), 5), system.nominal)
    width, points = orbit.grid.width[0], orbit.mesh.scheme.points
    middle = orbit.grid.left[2] + width / 2
    bump = 1.0 + 1e-4 - (orbit.stage_phases - middle) ** 2
    ends = 1.0 + 1e-4 - (orbit.mesh.nodes(orbit.phases) - middle) ** 2
    assert (bump < 1).all() and points[1] < 0.5 < points[2]
    orbit.stages[:, :, 0], orbit.nodes[:, 0] = bump, ends
    (found,) = SwitchPolynomials(system, orbit).unmarked(0, -1)
    assert (found.interval, found.theta) == (2, pytest.approx(0.5, abs=1e-9))
    assert found.value == pytest.approx(1e-4, abs=1e-12)
    begin, end = (phase for _, phase in SwitchPolynomials(system, orbit).crossings(0))
    assert end - begin == pytest.approx(0.02, abs=1e-9)


def test_excursions_that_end_take_their_intervals_with_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the mesh beyond grazing is wanted with MIN_INTERVALS fewer for each excursion gone."""
    lost, spread = [], rewrite.spread

    def noted(orbit: Orbit, wanted: Array, events: tuple[EventNode, ...], *rest: Any) -> Mesh:
        gone = (len(orbit.mesh.events) - len(events)) // 2
        lost.append((orbit.mesh.ntst - float(wanted @ orbit.grid.width), gone))
        return spread(orbit, wanted, events, *rest)

    monkeypatch.setattr(rewrite, "spread", noted)
    per.trace(stopped(1e3), "Omega", (0.6, 0.8), start=0.8)
    assert lost and all(gone > 0 for _, gone in lost)
    assert [less for less, _ in lost] == pytest.approx([rewrite.MIN_INTERVALS * gone for _, gone in lost])
