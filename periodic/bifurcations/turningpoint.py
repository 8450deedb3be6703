"""Turning points of a branch by their kinds: folds, and other special points where the parameter reverses.

A branch of doubled orbits reverses where it meets the orbits that it came from, at their PD, and one of
lopsided orbits where it leaves a symmetric branch: from there these are branch points (BP).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.bifurcations.branchpoint import branching
from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.label import Label
from periodic.bifurcations.withinstep import RejectedError, WithinStep
from periodic.correction.identity import from_itself
from periodic.correction.solution import Solution

MERGED = 0.05
"""Largest distance of the orbit at a pitchfork from its shifted copies, as a part of that at the step's
ends."""

BESIDE_FOLD = 1e-3
"""Distance from a fold, as a part of the step, at which the multipliers on either side are compared, and
beyond which another special point is not the fold itself."""


@dataclass(frozen=True)
class Found:
    """A special point at `distance` from the step's base; `name` is the user's name of an event or limit.

    within: how far from there it may lie in the parameter, besides the orbit's error.
    """

    label: Label
    distance: float
    solution: Solution
    name: str = ""
    within: float = 0.0

    @property
    def shrunk(self) -> bool:
        """Whether a branch of orbits ends at an equilibrium there."""
        return self.label is Label.HOPF and not self.solution.orbit.equilibrium


def named(within: WithinStep, fold: Found, new: Solution, ds: float) -> Found:
    """Return a fold of the branch with the label that it has among special points.

    BP where its orbit has a smaller period than those at the step's ends: it equals its copy one or more
    excitation periods later, and the branch beyond consists of such copies of the same orbits. HB where an
    autonomous orbit has shrunk to an equilibrium: the branch beyond consists of the same orbits half a period
    later. BP also where a multiplier touches 1 without passing it: the branch leaves another there, which
    goes on. On a curve in two parameters it is at most a cusp. Raises RejectedError where a multiplier passes
    1 and comes back within the step: a fold and a branch point.
    """
    base, problem = within.base, within.solver.problem
    if codim2.picked(problem) is not None:
        return replace(fold, label=codim2.fold_on_curve(fold.solution, base, new))
    if shrinks(fold.solution, base, new):
        return replace(fold, label=Label.HOPF)
    apart = [from_itself(solution) for solution in (fold.solution, base, new)]
    if apart[0] < MERGED * max(apart[1:]) < np.inf:
        return replace(fold, label=Label.BRANCH)
    decides = new.discretisation.stability
    tests = (*codim2.TESTS[decides], *codim2.BESIDE_FOLDS[decides])
    labels = [test.label for test in tests if test.touches(fold.solution, base, new)]
    if labels and codim2.BESIDE_FOLDS[decides] and problem.trivial < 2 and _passes(within, fold, ds):
        raise RejectedError("the branch turns beside a branch point")
    return replace(fold, label=labels[0]) if labels else fold


def _passes(within: WithinStep, fold: Found, ds: float) -> bool:
    """Whether a multiplier passes 1 at a fold, by the orbits just before and just after it."""
    before, after = (branching(within.at(fold.distance + side * BESIDE_FOLD * ds)) for side in (-1, 1))
    return before * after < 0


def shrinks(fold: Solution, *ends: Solution) -> bool:
    """Whether autonomous orbits shrink to an equilibrium at a fold of their branch."""
    return fold.problem.autonomous and fold.orbit.span() < MERGED * min(end.orbit.span() for end in ends)


def is_one(point: Found, fold: Found, ds: float) -> bool:
    """Whether a special point is the fold of the branch, which has its label already."""
    return point.label is fold.label and abs(point.distance - fold.distance) < BESIDE_FOLD * ds


def at_once(before: Solution, after: Solution) -> list[Label]:
    """Return the special points that coincide with a grazing, by the orbits just before and beyond it.

    There multipliers jump, or change too fast to be followed, and only the numbers of unstable ones before
    and beyond say what has crossed: one through 1 where the branch turns, one through 1 or -1 where their
    number changes from even to odd (Feigin; di Bernardo et al., Piecewise-smooth Dynamical Systems, 3.1),
    pairs otherwise.
    """
    if codim2.picked(before.problem) is not None:
        return []
    folded = before.tangent.parameter * after.tangent.parameter < 0
    decides = before.discretisation.stability
    every = codim2.TESTS[decides] + (() if folded else codim2.BESIDE_FOLDS[decides])
    tests = [test for test in every if test.label is not Label.TORUS]
    changed = [test for test in tests if test.value(before) * test.value(after) < 0]
    sure = [test for test in changed if test.genuine(before) or test.genuine(after)]
    rest = abs(unstable(after) - unstable(before)) - folded - len(sure)
    alone = [test for test in changed if test not in sure][: max(rest, 0) % 2]
    labels = [test.label for test in (*sure, *alone)]
    return [Label.FOLD] * folded + labels + [Label.TORUS] * (max(rest, 0) // 2)


def unstable(solution: Solution) -> int:
    """Return how many multipliers lie outside the unit circle."""
    return int((np.abs(solution.spectrum.nontrivial) > 1).sum())
