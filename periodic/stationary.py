"""Test functions of equilibria, with the eigenvalues lambda of d(dx)/dt = J dx:

LP  d parameter / d arclength     HB  prod over pairs (lambda_i + lambda_j), of a complex pair only
BP  det [R_u; tangent], u = (x, z, p): it changes sign where two branches cross, and not at an LP
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from periodic.equilibrium import crossing, rows_at
from periodic.events import Test
from periodic.label import Label
from periodic.scheme import Array
from periodic.solve import Solved, Task

Complex = NDArray[np.complex128]

CONSERVED = 1e-12
"""Sums of two eigenvalues this small, in parts of the largest one, are 0: energy is conserved."""

LIGHT = 0.1
"""Damping ratio below which a pair may cross the imaginary axis and come back within a step."""

UPRIGHT = 1e-5
"""A branch of smaller slope, in ranges of the parameter, turns."""


def eigenvalues(solved: Solved) -> Complex:
    """Return the eigenvalues of an equilibrium, in 1/s, shape (n,)."""
    return np.linalg.eigvals(solved.correction.monodromy).astype(np.complex128)


def hopf(task: Task, solved: Solved) -> float:
    """prod over i < j of (lambda_i + lambda_j) / (|lambda_i| + |lambda_j|); 0 where energy is conserved."""
    found = eigenvalues(solved)
    first, second = np.triu_indices(len(found), 1)
    sums = found[first] + found[second]
    if (np.abs(sums) <= CONSERVED * np.abs(found).max()).any():
        return 0.0
    return float(np.prod(sums / (np.abs(found[first]) + np.abs(found[second]))).real)


def _complex(task: Task, solved: Solved) -> bool:
    """Whether the pair whose sum is nearest 0 is complex: else it is a neutral saddle."""
    found = eigenvalues(solved)
    first, second = np.triu_indices(len(found), 1)
    nearest = np.abs(found[first] + found[second]).argmin()
    return bool(found[first[nearest]].imag != 0)


def _crosses_twice(base: Solved, new: Solved) -> bool:
    """Whether a pair may cross the axis and come back: lightly damped, or moved by more than its distance."""
    before, after = (found[found.imag > 0] for found in map(eigenvalues, (base, new)))
    for a in before if len(after) else ():
        b = after[np.abs(after - a).argmin()]
        real = min(abs(a.real), abs(b.real))
        if real < max(LIGHT * abs(a), abs(a - b)):
            return True
    return False


def _matrix(task: Task, solved: Solved) -> tuple[Array, Array]:
    """R_u and the tangent of length 1, u = (x, z, p), p in ranges of the parameter."""
    orbit, tangent, ranges = solved.orbit, solved.tangent, task.metric.scale
    rows = rows_at(task.system, orbit, task.free).balanced(ranges)
    outer = np.append(tangent.parameter, tangent.others) / ranges
    along = np.concatenate([tangent.nodes[0], tangent.algebraic[0, 0], outer])
    return rows, along / np.linalg.norm(along)


def branching(task: Task, solved: Solved) -> float:
    """det [R_u; tangent]."""
    return float(np.linalg.det(np.vstack(_matrix(task, solved))))


def _on_its_way(task: Task, solved: Solved) -> bool:
    """Whether the branch goes on past another there: where it turns as well, the turn is the branch point."""
    return abs(solved.tangent.parameter) > UPRIGHT * task.metric.scale


def crosses(task: Task, turn: Solved, base: Solved, new: Solved) -> bool:
    """Whether two branches cross where one of them turns."""
    return branching(task, base) * branching(task, new) < 0 and crossing(_matrix(task, turn)[0])


def _touches_twice(base: Solved, new: Solved) -> bool:
    """Whether a real eigenvalue moved by more than half its distance from 0."""
    before, after = (found[found.imag == 0].real for found in map(eigenvalues, (base, new)))
    for a in before if len(after) else ():
        b = after[np.abs(after - a).argmin()]
        if min(abs(a), abs(b)) < 2 * abs(a - b):
            return True
    return False


PASSAGES = (
    Test(Label.HOPF, hopf, 1e-12, _complex, _crosses_twice),
    Test(Label.BRANCH, branching, 1e-10, _on_its_way, _touches_twice, crosses),
)
