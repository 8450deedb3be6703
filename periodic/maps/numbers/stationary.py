"""Where a functional is stationary along a branch, next to a point that exceeds its neighbours."""

from __future__ import annotations

from dataclasses import replace

from periodic.conditions.functionals import Functional
from periodic.conditions.levels import Peak
from periodic.correction.problem import Problem
from periodic.maps.task import Task
from periodic.results.branch import Branch
from periodic.tracing.steps.stationarytest import stationary_test
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.trace import continuation
from periodic.tracing.watch import Watch

NAME = "stationary"
"""Name of the test function whose zero is the point."""

STEPS_AGAIN = 12
"""Largest number of steps in which the branch is followed again to its next points."""


def stationary(task: Task, branch: Branch, k: int, functional: Functional) -> tuple[float, float] | None:
    """Return value and parameter where a functional is stationary near point k, or None.

    By Newton on the condition itself; where the functional or the orbit has no derivative for it, or Newton
    leads elsewhere, along the branch from the point before.
    """
    found = _by_condition(task, branch, k, functional)
    return found if found is not None else _along(task, branch, k, functional)


def _by_condition(task: Task, branch: Branch, k: int, functional: Functional) -> tuple[float, float] | None:
    """Hold another parameter and let the condition determine the branch's own."""
    orbit, held = branch[k].orbit, _another(task)
    if held is None or not hasattr(functional, "linearise"):
        return None
    value = orbit.parameters[held]
    determined = {**task.problem.determined, task.parameter: Peak(functional)}
    problem = Problem(task.system, held, (value, value + (abs(value) or 1.0)), determined)
    try:
        run = continuation(problem, orbit, tol=task.tol, method=task.method)
        point = next(run, None)
    except ValueError:  # orbits of this method have no such condition
        return None
    if point is None:
        return None
    place = point.orbit.parameters[task.parameter]
    return (float(functional(task.system, point.orbit)), place) if _between(branch, k, place) else None


def _another(task: Task) -> str | None:
    """A parameter that is neither continued in nor determined."""
    taken = (task.parameter, *task.problem.determined)
    return next((p.name for p in task.system.parameters if p.name not in taken), None)


def _between(branch: Branch, k: int, place: float) -> bool:
    """Whether a place lies between the neighbours of point k, or as far beyond: the branch may have a fold
    there.
    """
    near = branch.values[k - 1 : k + 2]
    low, high = near.min(), near.max()
    return bool(low - (high - low) <= place <= high + (high - low))


def _along(task: Task, branch: Branch, k: int, functional: Functional) -> tuple[float, float] | None:
    """Follow the branch from the point before to the one behind, the derivative as a test function."""
    way = 1 if branch[k - 1].slope > 0 else -1
    test = stationary_test(functional, NAME)
    control = replace(task.control or ArclengthControl(), max_points=STEPS_AGAIN)
    run = continuation(
        task.problem,
        branch[k - 1].orbit,
        sign=way,
        tol=task.tol,
        method=task.method,
        control=control,
        watch=Watch(special=(test,)),
    )
    for point in run:
        if point.event == NAME:
            return float(functional(task.system, point.orbit)), point.parameter
    return None
