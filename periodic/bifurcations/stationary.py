"""Test functions of equilibria, with the eigenvalues lambda of d(dx)/dt = J dx:

LP  d parameter / d arclength     HB  prod over pairs (lambda_i + lambda_j), of a complex pair only
BP  det [R_u; tangent], u = (x, z, p): it changes sign where two branches cross, and not at an LP
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from periodic.bifurcations.fold import VERTICAL
from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.solution import Solution
from periodic.equilibrium.linearise import crossing, flat, rows_at
from periodic.orbit.scheme import Array

Complex = NDArray[np.complex128]

NO_DAMPING = 1e-12
"""Sums of two eigenvalues this small, in parts of the largest one, are 0: energy is conserved."""

LIGHTLY_DAMPED = 0.1
"""Damping ratio below which a pair may cross the imaginary axis and come back within a step."""


def hopf(solution: Solution) -> float:
    """Return the test function of HB."""
    return balance(solution.spectrum.multipliers)


def balance(found: Complex) -> float:
    """prod over i < j of (lambda_i + lambda_j) / (|lambda_i| + |lambda_j|); 0 where energy is conserved."""
    first, second = np.triu_indices(len(found), 1)
    sums = found[first] + found[second]
    if (np.abs(sums) <= NO_DAMPING * np.abs(found).max(initial=0.0)).any():
        return 0.0
    return float(np.prod(sums / (np.abs(found[first]) + np.abs(found[second]))).real)


def _complex(solution: Solution) -> bool:
    """Whether the pair whose sum is nearest 0 is complex: else it is a neutral saddle."""
    found = solution.spectrum.multipliers
    first, second = np.triu_indices(len(found), 1)
    nearest = np.abs(found[first] + found[second]).argmin()
    return bool(found[first[nearest]].imag != 0)


def _crosses_twice(base: Solution, new: Solution) -> bool:
    """Whether a pair may cross the axis and come back: lightly damped, or moved by more than its distance."""
    before, after = (found[found.imag > 0] for found in (base.spectrum.multipliers, new.spectrum.multipliers))
    for a in before if len(after) else ():
        b = after[np.abs(after - a).argmin()]
        real = min(abs(a.real), abs(b.real))
        if real < max(LIGHTLY_DAMPED * abs(a), abs(a - b)):
            return True
    return False


def _growth(solution: Solution) -> float:
    """Real part of the complex pair nearest the axis, with the sign of the test; without one the test."""
    found, value = solution.spectrum.multipliers, hopf(solution)
    parts = np.abs(found[found.imag > 0].real)
    return float(np.sign(value) * parts.min()) if len(parts) else value


def product(solution: Solution) -> float:
    """The product of the eigenvalues over the largest one: it changes sign where a real one passes 0."""
    found = solution.spectrum.multipliers
    return float(np.prod(found / np.abs(found).max()).real)


def _matrix(solution: Solution) -> tuple[Array, Array]:
    """R_u above the rows of the side conditions, and the unit tangent, u = (x, z, p), p in ranges."""
    problem, orbit, tangent = solution.problem, solution.orbit, solution.tangent
    rows = rows_at(problem.system, orbit, problem.free).balanced(problem.scale)
    outer = tangent.parameters / problem.scale
    along = np.concatenate([tangent.nodes[0], tangent.algebraic[0, 0], outer])
    units = np.append(np.ones(len(along) - len(outer)), np.full(len(outer), problem.scale))
    closing = [c.linearise(problem.system, orbit, problem.free) for c in problem.side_conditions(orbit)]
    held = [units * flat(orbit, row) for row in closing]
    matrix = np.vstack([rows, *(row / np.linalg.norm(row) for row in held)])
    return matrix, along / np.linalg.norm(along)


def branching(solution: Solution) -> float:
    """det [R_u; tangent]."""
    return float(np.linalg.det(np.vstack(_matrix(solution))))


def _on_its_way(solution: Solution) -> bool:
    """Whether the branch does not turn there: where it does, its fold is labelled as the branch point."""
    return abs(solution.tangent.parameter) > VERTICAL * solution.problem.scale


def crosses(fold: Solution, base: Solution, new: Solution) -> bool:
    """Whether two branches cross where one of them turns."""
    return branching(base) * branching(new) < 0 and is_crossed(fold)


def is_crossed(solution: Solution) -> bool:
    """Whether two branches cross at a solution."""
    return crossing(_matrix(solution)[0])


def _touches_twice(base: Solution, new: Solution) -> bool:
    """Whether a real eigenvalue moved by more than half its distance from 0."""
    before, after = (
        found[found.imag == 0].real for found in (base.spectrum.multipliers, new.spectrum.multipliers)
    )
    for a in before if len(after) else ():
        b = after[np.abs(after - a).argmin()]
        if min(abs(a), abs(b)) < 2 * abs(a - b):
            return True
    return False


HOPF = TestFunction(
    label=Label.HOPF,
    value=hopf,
    precision=1e-12,
    genuine=_complex,
    twice=_crosses_twice,
    local=_growth,
)
BRANCHING = TestFunction(
    label=Label.BRANCH,
    value=branching,
    genuine=_on_its_way,
    twice=_touches_twice,
    touches=crosses,
    singular=True,
)
