"""BP: branch points (pitchforks, transcritical), where a multiplier is 1 and the branch does not turn."""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.doubling import dips, known, nearest, product_test
from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.bifurcations.torus import noise
from periodic.correction.solution import Solution
from periodic.stability.winding import confined, pair_crossings

TOUCHED = 0.01
"""Largest prod (1 - mu) where a multiplier touches 1, as a part of that at the step's ends."""


def branching(solution: Solution) -> float:
    """prod (1 - mu) / (1 + |mu|); 0 where it is not known."""
    spectrum = solution.spectrum
    return product_test(spectrum.nontrivial, 1) if spectrum.known else 0.0


def touches(fold: Solution, base: Solution, new: Solution) -> bool:
    """Whether a multiplier comes to 1 at a fold between two orbits and goes back, as far as can be told."""
    values = [branching(end) for end in (base, new)]
    if fold.problem.trivial > 1:  # no other multiplier passes 1 at a fold
        return abs(branching(fold)) < TOUCHED * min(map(abs, values))
    if values[0] * values[1] < 0:
        return False
    return all(np.abs(end.spectrum.nontrivial - 1).min(initial=np.inf) > noise(end) for end in (base, new))


def branches_twice(base: Solution, new: Solution) -> bool:
    """Whether a pair of multipliers turns past +1 between two orbits."""
    return bool(pair_crossings(base.spectrum, new.spectrum, 1))


BRANCHING = TestFunction(
    label=Label.BRANCH,
    value=branching,
    genuine=known,
    twice=branches_twice,
    dips=lambda base, new: dips(base, new, 1),
    confined=lambda base, new: confined(base.spectrum, new.spectrum),
    local=lambda solution: nearest(solution.spectrum.nontrivial, 1),
    touches=touches,
    singular=True,
)
