"""Orbits beside grazing: what the parameter's last digits are to multipliers there, and on another mesh."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support.drawn.contact import drawn

import periodic as per
from periodic.correction import error
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.refinement.adaptation import carried
from periodic.tracing.continuation import Continuation
from periodic.tracing.steps.taken import Step

BRIEF = 2e-3
"""Contacts that last so long (rad) at the most are looked at."""


@cache
def beside() -> list[tuple[Solver, Solution]]:
    """The ends of steps beside two grazings of jumps 177: a contact of stiffness 6500 comes and goes."""
    found, completed = [], Continuation._completed
    case = drawn("jumps", 177)
    with pytest.MonkeyPatch.context() as patch:

        def noted(run: Continuation, step: Step) -> None:
            found.append((run.solver, step.end))
            completed(run, step)

        patch.setattr(Continuation, "_completed", noted)
        branch = per.trace(case.system, "Omega", (0.5812, 0.5816), start=0.5816)
    assert branch.unaccounted == ()
    brief = [(solver, end) for solver, end in found if len(end.orbit.phases) > 1 and shortest(end) < BRIEF]
    assert len(brief) > 8
    return brief


def shortest(solution: Solution) -> float:
    """The length of its shortest contact."""
    return float(solution.orbit.mesh.segment_lengths(solution.orbit.phases).min())


def test_contacts_are_as_long_on_another_mesh() -> None:
    """Assert that an orbit stays where it is on its branch, of which brief contacts alone tell there."""
    for solver, solution in beside():
        finer = carried(solver, solution, solution.orbit.mesh.bisected(), solution.orbit.phases)
        assert finer.ok
        assert shortest(finer) == pytest.approx(shortest(solution), rel=1e-8)


@pytest.mark.parametrize("digits", [1e-15, 1e-14, 1e-13, 1e-12])
def test_rounding_of_the_parameter_adds_to_errors(digits: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that no error of the orbit hides it: both may have either sign."""
    monkeypatch.setattr(error, "LAST_DIGITS", 0.0)
    without = [by_orbit(solution) for _, solution in beside()]
    monkeypatch.setattr(error, "LAST_DIGITS", digits)
    rounded = [by_orbit(solution) for _, solution in beside()]
    assert (np.array(rounded) > 0.99 * np.array(without)).all()


def by_orbit(solution: Solution) -> float:
    """What the orbit's own error makes of its multipliers."""
    asked = solution.problem, solution.correction, solution.tangent, solution.spectrum
    return solution.discretisation.error(*asked).by_orbit
