"""Branches that go back over themselves: beyond a change the orbits are those before it, in reverse.

Where an event that lasts no time begins and ends at one parameter, orbits beyond it may be orbits without it.
A branch never leads back over its own orbits, not even where it turns: the orbits of both sides of a fold, or
of a grazing that turns it, part as it goes on. (Passing through an orbit of fewer periods it comes back with
the same orbits taken a period later, which are others at the same phase.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from periodic.correction.error import AT_WORST
from periodic.correction.identity import distance
from periodic.correction.newton import in_order
from periodic.correction.predictor import tangent
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop
from periodic.system.precision import CONVERGED


def retraced(solver: Solver, points: Sequence[Point], new: Solution) -> Stop | None:
    """Return that a branch has gone back over itself since it last turned, if it has.

    It is looked at once for each turn of orbits with events: as the parameter comes past that of the point
    before the turn.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    points : sequence of Point
        The branch so far, the last one of the orbit `new`.
    new : Solution
        Its last orbit.

    Returns
    -------
    Stop or None
        None where it goes on to other orbits.
    """
    before = _passed(points) if new.orbit.mesh.events else None
    if before is None or solver.problem.free != (solver.problem.index,) or solver.problem.autonomous:
        return None
    guess = solver.problem.restrict(before.orbit)
    ahead = tangent(solver.problem, new, (before.parameter - new.value) / new.tangent.parameter)
    if not _near(solver.problem, new, ahead, guess):
        return None
    parameter = guess.parameter.copy()
    parameter[solver.problem.index] = new.value
    back = solver.at_parameter(replace(guess, parameter=parameter), -float(np.sign(new.tangent.parameter)))
    if not back.ok or not np.isfinite(back.error.motion):
        return None
    allowed = AT_WORST * (back.error.orbit + new.error.orbit) * max(new.orbit.span(), LEAST_SPAN)
    if distance(solver.problem, new.orbit, back.orbit) > allowed or not _one(solver, new, back):
        return None
    if not _leads_to(solver, new, ahead, before):
        return None
    turn = _turn(points)
    assert turn is not None
    return Stop(Reason.RETRACED, f"beyond {points[turn].parameter:.10g} the orbits are those before it")


def _near(problem: Problem, new: Solution, ahead: Orbit, orbit: Orbit) -> bool:
    """Whether an orbit may be the one ahead: the tangent leads nearer to it than it is long.

    Those on another sheet lie farther off, so that they need not be solved for at the same parameter.
    """
    return not in_order(ahead) or distance(problem, ahead, orbit) <= distance(problem, ahead, new.orbit)


def _one(solver: Solver, new: Solution, back: Solution) -> bool:
    """Whether two orbits that agree within their errors are one: on one mesh Newton leads both to the same.

    Sheets that lie nearer to each other than their errors, as at a low accuracy, are two there too.
    """
    if new.orbit.mesh.events != back.orbit.mesh.events:
        return False
    newton = solver.tolerance.newton
    close = replace(newton, tolerance=min(CONVERGED, newton.tolerance), close=0.0)
    sign = float(np.sign(new.tangent.parameter))
    guesses = [next(solver.transfers(new.orbit, back.orbit.mesh, new.orbit.phases), None), back.orbit]
    each = [solver.at_parameter(guess, sign, close) for guess in guesses if guess is not None]
    allowed = np.sqrt(CONVERGED) * max(new.orbit.span(), LEAST_SPAN)
    ok = len(each) == 2 and all(found.ok for found in each)
    return ok and distance(solver.problem, each[0].orbit, each[1].orbit) <= allowed


def _leads_to(solver: Solver, new: Solution, ahead: Orbit, before: Point) -> bool:
    """Whether the branch as it goes on has, where a point before the turn lies, the orbit of that point.

    With its word there may be none at the new parameter on that side of the turn: then Newton has led from it
    to the other side. Here there is one on either side.
    """
    guess = ahead if in_order(ahead) else new.orbit
    parameter = guess.parameter.copy()
    parameter[solver.problem.index] = before.parameter
    sign = float(np.sign(new.tangent.parameter))
    found = solver.at_parameter(replace(guess, parameter=parameter), sign)
    if not found.ok:
        return False
    known = solver.problem.restrict(before.orbit)
    allowed = AT_WORST * (before.error.orbit + found.error.orbit) * max(known.span(), LEAST_SPAN)
    return distance(solver.problem, known, found.orbit) <= allowed


def _turn(points: Sequence[Point]) -> int | None:
    """The last point at which the parameter turns; None where it goes one way all along."""
    values = [point.parameter for point in points]
    way = float(np.sign(values[-1] - values[-2])) if len(values) > 1 else 0.0
    back = (k for k in range(len(values) - 2, 0, -1) if way * (values[k] - values[k - 1]) < 0)
    return next(back, None) if way else None


def _passed(points: Sequence[Point]) -> Point | None:
    """The point before the last turn whose parameter the last step has passed for the first time, if any.

    It is farther from the turn than their errors: there the orbits of both sides differ by more than these.
    """
    turn = _turn(points)
    if turn is None:
        return None
    at, far = points[turn], (p for p in reversed(points[:turn]))
    before = next((p for p in far if abs(p.parameter - at.parameter) > _blur(p, at)), None)
    if before is None:
        return None
    left = [abs(p.parameter - at.parameter) for p in points[-2:]]
    return before if left[0] < abs(before.parameter - at.parameter) <= left[1] else None


def _blur(one: Point, other: Point) -> float:
    """Distance in the parameter at which orbits of two branches differ by far more than their errors."""
    return AT_WORST**2 * (one.error.motion + other.error.motion) * abs(one.parameter)
