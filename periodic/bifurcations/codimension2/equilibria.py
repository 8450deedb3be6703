"""Special points on curves of folds and of Hopf points of equilibria in two parameters.

BT  a second eigenvalue is 0       ZH  a pair is on the imaginary axis beside a real one that is 0
GH  the first Lyapunov coefficient is 0 (Bautin): between supercritical and subcritical Hopf points
"""

from __future__ import annotations

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.stationary import balance
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.solution import Solution
from periodic.equilibrium.equilibrium import Equilibrium
from periodic.equilibrium.normalform import first_lyapunov
from periodic.stability.multipliers import Complex


def _scaled(solution: Solution) -> Complex:
    """The eigenvalues over the largest one."""
    found = solution.spectrum.multipliers
    return np.asarray(found / np.abs(found).max())


def _second(solution: Solution) -> float:
    """Sum of the products of all eigenvalues but one, up to its sign.

    One eigenvalue is 0 on a curve of folds, so this is the product of the others.
    """
    return float(np.poly(_scaled(solution))[-2].real)


def _beside(solution: Solution) -> Complex:
    """The eigenvalues without the one that is 0."""
    found = _scaled(solution)
    return np.delete(found, np.abs(found).argmin())


def _complex_beside(solution: Solution) -> bool:
    found = _beside(solution)
    return bool(found[_held(found)[0]].imag != 0)


def _held(found: Complex) -> list[int]:
    """Indices of the two eigenvalues whose sum is 0."""
    first, second = np.triu_indices(len(found), 1)
    k = np.abs(found[first] + found[second]).argmin()
    return [int(first[k]), int(second[k])]


def _square(solution: Solution) -> float:
    """Square of the pair's frequency: negative where the pair has become real."""
    found = _scaled(solution)
    return float(np.prod(found[_held(found)]).real)


def _lyapunov(solution: Solution) -> float:
    """The first Lyapunov coefficient; 0 where no pair is complex any more."""
    method = solution.discretisation
    assert isinstance(method, Equilibrium)
    if _square(solution) <= 0:
        return 0.0
    return first_lyapunov(solution.problem.system, solution.orbit, method.frequency)


def _others(solution: Solution) -> float:
    """The product of the eigenvalues beside the pair."""
    found = _scaled(solution)
    return float(np.prod(np.delete(found, _held(found))).real)


RESTING_FOLDS = (
    TestFunction(label=Label.BOGDANOV_TAKENS, value=_second),
    TestFunction(
        label=Label.ZERO_HOPF, value=lambda solution: balance(_beside(solution)), genuine=_complex_beside
    ),
)
HOPFS = (
    TestFunction(label=Label.BAUTIN, value=_lyapunov),
    TestFunction(label=Label.ZERO_HOPF, value=_others),
    TestFunction(label=Label.BOGDANOV_TAKENS, value=_square),
)
