"""Branches that go back over themselves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.bifurcations.label import Label
from periodic.correction.solution import Between, Solution
from periodic.correction.solver import Solver
from periodic.orbit.orbit import Orbit
from periodic.results.point import Point, describe
from periodic.tracing.continuation import Continuation
from periodic.tracing.ends.retraced import retraced


@pytest.fixture(scope="module")
def sticking() -> Continuation:
    """A branch of a mass on dry friction, which sticks and slips, traced to its bound."""
    x = sym.coordinate("x", unit="m")
    parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.CoulombFriction(x, 0.3)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 1.0)]))
    run = per.continuation(per.Problem(system, "Omega", (0.3, 0.6)), tol=1e-6)
    for _ in run:
        pass
    assert len(run.collected) > 5 and run.stop is not None and run.stop.reason is per.Reason.BOUND
    return run


def _back(run: Continuation) -> tuple[list[Point], Solution]:
    """The points of a branch that turns at its end and goes back over itself, and its last orbit."""
    points, problem = list(run.collected), run.solver.problem
    before, end = (point.parameter for point in points[-2:])
    for part in (0.5, 1.5):
        near = points[-1 if part < 1 else -2]
        parameter = near.orbit.parameter.copy()
        parameter[problem.index] = end - part * (end - before)
        guess = replace(problem.restrict(near.orbit), parameter=parameter)
        last = run.solver.at_parameter(guess, -1.0)
        assert last.ok
        points.append(describe(last, Label.NONE, "", {}))
    return points, last


def test_orbits_in_reverse_are_told(sticking: Continuation) -> None:
    """Assert that it is told once, with where it turned, as the point before the turn is passed."""
    points, last = _back(sticking)
    stop = retraced(sticking.solver, points, last)
    assert stop is not None and stop.reason is per.Reason.RETRACED and stop.reason.numerical
    assert f"{sticking.collected[-1].parameter:.10g}" in str(stop)
    short = sticking.solver.at_parameter(sticking.solver.problem.restrict(points[-2].orbit), -1.0)
    assert retraced(sticking.solver, points[:-1], short) is None  # not yet past it


def test_other_orbits_are_another_sheet(sticking: Continuation) -> None:
    """Assert that a branch that turns to orbits a little off is not said to go back over itself."""
    points, last = _back(sticking)
    nodes = last.orbit.nodes * (1 + 1e-5)
    moved = replace(last.correction, orbit=replace(last.orbit, nodes=nodes))
    off = Between(last.problem, last.discretisation, moved, last.tangent, beside=last)
    assert last.error.orbit < 1e-6
    assert retraced(sticking.solver, points, off) is None


def test_another_sheet_is_not_solved_for(sticking: Continuation, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an orbit farther off than the tangent there is long is told apart without Newton."""
    points, last = _back(sticking)
    before, solved = points[-4], list[float]()
    length = np.abs(last.orbit.nodes - before.orbit.nodes).max()
    at_parameter = Solver.at_parameter

    def counted(solver: Solver, guess: Orbit, sign: float, *settings: Any) -> Solution:
        solved.append(sign)
        return at_parameter(solver, guess, sign, *settings)

    monkeypatch.setattr(Solver, "at_parameter", counted)
    for far, some in ((0.1, True), (10.0, False)):
        solved.clear()
        points[-4] = replace(before, orbit=replace(before.orbit, nodes=before.orbit.nodes + far * length))
        retraced(sticking.solver, points, last)
        assert bool(solved) is some


def test_newton_may_lead_to_the_other_side(sticking: Continuation) -> None:
    """Assert that nothing is told where Newton leads from a point before the turn to another side of a fold.

    The orbit at that point is then another than the branch as it goes on has there.
    """
    points, last = _back(sticking)
    before = points[-4]
    assert retraced(sticking.solver, points, last) is not None
    points[-4] = replace(before, orbit=replace(before.orbit, nodes=before.orbit.nodes * (1 + 1e-5)))
    assert points[-4].error.orbit < 1e-6
    assert retraced(sticking.solver, points, last) is None


def test_one_way_is_no_turn(sticking: Continuation) -> None:
    """Assert that nothing is told of a branch on which the parameter goes one way."""
    points = sticking.collected
    values = np.diff([point.parameter for point in points])
    assert (values > 0).all() and sticking.state is not None
    assert retraced(sticking.solver, points, sticking.state.last) is None
