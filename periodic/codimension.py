"""What is looked for along a branch, and along curves of its special points in a second parameter.

On a curve of folds, doublings or tori one multiplier (or a pair's product) stays where it is; test functions
leave it out. With d_i = mu_i - 1 (or + 1) the second multiplier gets there where the sum of the products of
all d_i but one vanishes, which is smooth where two multipliers coincide.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from periodic import events
from periodic.closure import Metric
from periodic.curves import DoublingCondition, FoldCondition, TorusCondition
from periodic.events import Test
from periodic.label import Label
from periodic.scheme import Array

Complex = NDArray[np.complex128]

if TYPE_CHECKING:
    from periodic.closure import Condition
    from periodic.solve import Solved, Task

PRECISION = 1e-10

REVERSED = 0.05
"""At a cusp both parameters turn: the second one's rate is this part of that at the step's ends at most."""


def second_at(task: Task, solved: Solved, at: float) -> float:
    """Sum of the products of all (mu_i - at) / (1 + |mu_i|) but one, the trivial multiplier left out."""
    found = events.multipliers(task, solved)
    if np.sort(np.abs(found - at))[1:2].min(initial=np.inf) < events.noise(solved):
        return 0.0
    factors = np.poly((found - at) / (1 + np.abs(found)))
    return float(factors[-2].real)


def _cosine(task: Task, solved: Solved) -> float:
    """Half the sum of the pair whose product is 1: the cosine of its angle while it is complex."""
    found = events.multipliers(task, solved)
    return float(found[_pair(found)].sum().real) / 2


def _pair(found: Complex) -> list[int]:
    """Indices of the two multipliers whose product is nearest 1."""
    first, second = np.triu_indices(len(found), 1)
    nearest = np.abs(found[first] * found[second] - 1).argmin()
    return [int(first[nearest]), int(second[nearest])]


def _beside(task: Task, solved: Solved) -> Complex:
    """The multipliers without the one that is held at 1 or -1."""
    found = events.multipliers(task, solved)
    return np.delete(found, np.abs(np.abs(found) - 1).argmin())


def _passing_beside(task: Task, solved: Solved, at: int) -> float:
    """Whether one passes 1 or -1 of the multipliers without the pair whose product is held at 1."""
    found = events.multipliers(task, solved)
    return events.passing(np.delete(found, _pair(found)), at)


def _torus_beside(task: Task, solved: Solved) -> float:
    return events.torus_of(_beside(task, solved), events.noise(solved))


def _complex_beside(task: Task, solved: Solved) -> bool:
    return events.complex_pair(_beside(task, solved))


FOLDS = (
    Test(Label.RESONANCE_1, lambda task, solved: second_at(task, solved, 1.0), PRECISION),
    Test(Label.FOLD_DOUBLING, events.doubling, PRECISION),
    Test(Label.FOLD_TORUS, _torus_beside, PRECISION, _complex_beside),
)
DOUBLINGS = (
    Test(Label.RESONANCE_2, lambda task, solved: second_at(task, solved, -1.0), PRECISION),
    Test(Label.FOLD_DOUBLING, events.branching, PRECISION),
    Test(Label.DOUBLING_TORUS, _torus_beside, PRECISION, _complex_beside),
)
TORI = (
    Test(Label.RESONANCE_1, lambda task, solved: _cosine(task, solved) - 1.0, PRECISION),
    Test(Label.RESONANCE_2, lambda task, solved: _cosine(task, solved) + 1.0, PRECISION),
    Test(Label.RESONANCE_3, lambda task, solved: _cosine(task, solved) + 0.5, PRECISION),
    Test(Label.RESONANCE_4, _cosine, PRECISION),
    Test(Label.FOLD_TORUS, lambda task, solved: _passing_beside(task, solved, 1), PRECISION),
    Test(Label.DOUBLING_TORUS, lambda task, solved: _passing_beside(task, solved, -1), PRECISION),
)
CURVES = {FoldCondition: FOLDS, DoublingCondition: DOUBLINGS, TorusCondition: TORI}
HELD = {FoldCondition: 1.0, DoublingCondition: -1.0}


def picked(task: Task) -> Condition | None:
    """Return the condition that picks the orbits of a curve, if there is one."""
    chosen = [c for c in task.conditions if not c.intrinsic]
    return next((c for c in chosen if type(c) in CURVES), chosen[0] if chosen else None)


def marginal(task: Task) -> bool:
    """Whether a multiplier is held on the unit circle."""
    return type(picked(task)) in CURVES


def sought(task: Task, turned: bool) -> tuple[Test, ...]:
    """Return the tests for special points within a step; `turned` if the parameter turns in it.

    On a curve of orbits at a level, or of peaks, the folds of the branches that it crosses are where a
    multiplier is 1.
    """
    condition, method = picked(task), task.method
    if condition is None:
        return method.passages + (() if turned else method.branching)
    if type(condition) in CURVES:
        return CURVES[type(condition)]
    return (*method.passages, Test(Label.FOLD, events.branching, PRECISION))


def alignment(task: Task, base: Solved, new: Solved) -> float:
    """Cosine between the critical motions of two orbits on one mesh: eigenvectors carried over the period.

    The two sides of a narrow tongue have nearly the same orbits, but critical motions across each other. 1
    on a curve that holds no simple multiplier.
    """
    held = HELD.get(type(picked(task)))
    if held is None:
        return 1.0
    weights = Metric.weights(base.orbit)
    a, b = (_critical(solved, held) for solved in (base, new))
    square = np.einsum("j,sjn,tjn->st", weights, (a, b), (a, b))
    return float(abs(square[0, 1]) / np.sqrt(square[0, 0] * square[1, 1]))


def _critical(solved: Solved, held: float) -> Array:
    """The disturbance (N+1, n) that comes back `held` times itself."""
    monodromy = solved.correction.monodromy
    vector = np.linalg.svd(monodromy - held * np.eye(len(monodromy)))[2][-1]
    return solved.correction.fundamental @ vector


def turn(task: Task, found: Solved, base: Solved, new: Solved) -> Label:
    """Return what a turn of the parameter is on a curve: a cusp where its other parameter turns too."""
    if not isinstance(picked(task), FoldCondition):
        return Label.NONE
    own = next(k for k, c in enumerate(task.conditions) if not c.intrinsic)
    rates = [float(s.tangent.others[own]) for s in (found, base, new)]
    reverses = rates[1] * rates[2] < 0 and abs(rates[0]) < REVERSED * max(map(abs, rates[1:]))
    return Label.CUSP if reverses else Label.NONE
