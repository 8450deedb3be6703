"""Test functions along a branch, and of codimension two along curves of its special points in two parameters.

On a curve of folds, doublings or tori one multiplier (or a pair's product) is held at 1 or -1; test functions
leave it out. With d_i = mu_i - 1 (or + 1) a second multiplier comes to 1 (or -1) where the sum of the
products of all d_i but one vanishes. The sum is smooth where two multipliers coincide.
"""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.branchpoint import BRANCHING, branching
from periodic.bifurcations.codimension2.contours import CONTOUR
from periodic.bifurcations.codimension2.equilibria import HOPFS, RESTING_FOLDS
from periodic.bifurcations.codimension2.generalisedflips import GENERALISED
from periodic.bifurcations.doubling import DOUBLING, doubling, product_test
from periodic.bifurcations.fold import FOLD
from periodic.bifurcations.label import Label
from periodic.bifurcations.stationary import BRANCHING as CROSSING
from periodic.bifurcations.stationary import HOPF
from periodic.bifurcations.testfunction import TestFunction
from periodic.bifurcations.torus import TORUS, complex_pair, nearest_pair, noise, torus_of
from periodic.conditions.twoparameter.augmented import (
    DoublingCondition,
    FoldCondition,
    HopfCondition,
    TorusCondition,
)
from periodic.correction.condition import Condition
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.linear.unknowns import mean_weights
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Complex, Stability

TESTS = {Stability.MULTIPLIERS: (DOUBLING, TORUS), Stability.EIGENVALUES: (HOPF, CROSSING)}
"""Test functions of the special points of a branch, turns (LP) apart, by what decides stability."""

BESIDE_FOLDS = {Stability.MULTIPLIERS: (BRANCHING,), Stability.EIGENVALUES: ()}
"""Those that are looked for only where the branch does not turn."""

REVERSED = 0.05
"""At a cusp both parameters turn: the second one's rate is at most this part of that at the step's ends."""


def second_at(solution: Solution, at: float) -> float:
    """Sum of the products of all d_i = (mu_i - at) / (1 + |mu_i|) but one; 0 where it is 0 within its error.

    The trivial multiplier is left out. Two that coincide are known to the square root of the multipliers'
    error only, their sum to the error itself.
    """
    factors, value = _second(solution, at)
    both_out = np.poly(-np.abs(factors))[-3:-2].sum()  # products of all but two
    return value if abs(value) > noise(solution) * both_out else 0.0


def _second(solution: Solution, at: float) -> tuple[Complex, float]:
    """The factors d_i, and the sum whatever its error."""
    found = solution.spectrum.nontrivial
    factors = (found - at) / (1 + np.abs(found))
    return factors, float(np.poly(factors)[-2].real)


def _cosine(solution: Solution) -> float:
    """Half the sum of the pair whose product is 1: the cosine of its angle while it is complex."""
    found = solution.spectrum.nontrivial
    return float(found[nearest_pair(found)].sum().real) / 2


def _beside(solution: Solution) -> Complex:
    """The multipliers without the one that is held at 1 or -1."""
    found = solution.spectrum.nontrivial
    return np.delete(found, np.abs(np.abs(found) - 1).argmin())


def _product_beside(solution: Solution, at: int) -> float:
    """`product_test` of the multipliers without the pair whose product is held at 1."""
    found = solution.spectrum.nontrivial
    return product_test(np.delete(found, nearest_pair(found)), at)


def _torus_beside(solution: Solution) -> float:
    return torus_of(_beside(solution), noise(solution))


def _sharp_beside(solution: Solution) -> float:
    return torus_of(_beside(solution), 0.0)


def _resonance(label: Label, at: float) -> TestFunction:
    """Where two multipliers are 1, or -1, on a curve that holds one there."""
    return TestFunction(
        label=label,
        value=lambda solution: second_at(solution, at),
        sharp=lambda solution: _second(solution, at)[1],
    )


def _torus_too(label: Label) -> TestFunction:
    """Where a pair passes the circle on a curve that holds another multiplier at 1 or -1."""
    return TestFunction(label=label, value=_torus_beside, sharp=_sharp_beside, genuine=_complex_beside)


def _complex_beside(solution: Solution) -> bool:
    return complex_pair(_beside(solution))


FOLDS = (
    _resonance(Label.RESONANCE_1, 1.0),
    TestFunction(label=Label.FOLD_DOUBLING, value=doubling),
    _torus_too(Label.FOLD_TORUS),
)
DOUBLINGS = (
    _resonance(Label.RESONANCE_2, -1.0),
    TestFunction(label=Label.FOLD_DOUBLING, value=branching),
    _torus_too(Label.DOUBLING_TORUS),
    GENERALISED,
)
TORI = (
    TestFunction(label=Label.RESONANCE_1, value=lambda solution: _cosine(solution) - 1.0),
    TestFunction(label=Label.RESONANCE_2, value=lambda solution: _cosine(solution) + 1.0),
    TestFunction(label=Label.RESONANCE_3, value=lambda solution: _cosine(solution) + 0.5),
    TestFunction(label=Label.RESONANCE_4, value=_cosine),
    TestFunction(label=Label.FOLD_TORUS, value=lambda solution: _product_beside(solution, 1)),
    TestFunction(label=Label.DOUBLING_TORUS, value=lambda solution: _product_beside(solution, -1)),
)
CURVES: dict[type, tuple[TestFunction, ...]] = {
    FoldCondition: FOLDS,
    DoublingCondition: DOUBLINGS,
    TorusCondition: TORI,
}
OF_EQUILIBRIA: dict[type, tuple[TestFunction, ...]] = {FoldCondition: RESTING_FOLDS, HopfCondition: HOPFS}
CRITICAL = {*CURVES, *OF_EQUILIBRIA}
"""Conditions that hold a multiplier on the unit circle, or an eigenvalue on the imaginary axis."""

HELD: dict[type, float] = {FoldCondition: 1.0, DoublingCondition: -1.0}


def picked(problem: Problem) -> Condition | None:
    """Return the condition that picks the orbits of a curve, if there is one."""
    chosen = [c for c in problem.conditions if not c.intrinsic]
    return next((c for c in chosen if type(c) in CRITICAL), chosen[0] if chosen else None)


def marginal(problem: Problem) -> bool:
    """Whether a multiplier is held on the unit circle."""
    return type(picked(problem)) in CRITICAL


def along(solution: Solution) -> tuple[TestFunction, ...]:
    """Return all tests for special points on the branch or curve of a solution."""
    return (FOLD, *sought(solution, folded=False))


def sought(solution: Solution, folded: bool) -> tuple[TestFunction, ...]:
    """Return the tests for special points in a step to a solution; `folded` if the parameter turns in it.

    On a curve of orbits at a level, or of peaks, they are those of the branches that it crosses.
    """
    condition, decides = picked(solution.problem), solution.discretisation.stability
    if condition is None:
        return TESTS[decides] + (() if folded else BESIDE_FOLDS[decides])
    known = CURVES if decides is Stability.MULTIPLIERS else OF_EQUILIBRIA
    return known.get(type(condition), CONTOUR[decides])


def alignment(base: Solution, new: Solution) -> float:
    """Cosine between the critical motions of two orbits on one mesh: eigenvectors carried over the period.

    The two sides of a narrow tongue have nearly the same orbits, but critical motions across each other. 1
    on a curve that holds no simple multiplier.
    """
    condition = picked(base.problem)
    if type(condition) not in HELD or base.discretisation.stability is Stability.EIGENVALUES:
        return 1.0
    held = HELD[type(condition)]
    a, b = (_critical(solution, held) for solution in (base, new))
    square = np.einsum("j,sjn,tjn->st", mean_weights(base.orbit), (a, b), (a, b))
    return float(abs(square[0, 1]) / np.sqrt(square[0, 0] * square[1, 1]))


def _critical(solution: Solution, held: float) -> Array:
    """The perturbation (N+1, n) that is multiplied by `held` over the period."""
    monodromy = solution.spectrum.monodromy
    vector = np.linalg.svd(monodromy - held * np.eye(len(monodromy)))[2][-1]
    return solution.spectrum.fundamental @ vector


def fold_on_curve(found: Solution, base: Solution, new: Solution) -> Label:
    """Return what a fold in the parameter is on a curve: a cusp where its other parameter turns too."""
    problem = found.problem
    if not isinstance(picked(problem), FoldCondition):
        return Label.NONE
    own = next(k for k, c in enumerate(problem.conditions) if not c.intrinsic)
    rates = [float(s.tangent.others[own]) for s in (found, base, new)]
    reverses = rates[1] * rates[2] < 0 and abs(rates[0]) < REVERSED * max(map(abs, rates[1:]))
    return Label.CUSP if reverses else Label.NONE
