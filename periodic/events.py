"""Test functions: what vanishes at a special point of a branch.

With the Floquet multipliers mu (an autonomous orbit's trivial one left out), each factor divided by its size
so that none overflows:

    LP  d parameter / d arclength        PD  prod (mu + 1)
    BP  prod (mu - 1), not at an LP      NS  prod over pairs (mu_i mu_j - 1), of a complex pair only
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from periodic import rotation
from periodic.label import Label
from periodic.spectrum import CONSERVED, ROUNDING, without_unit

if TYPE_CHECKING:
    from periodic.solve import Solved, Task

Complex = NDArray[np.complex128]

LOST = 0.1
"""Distance of the multiplier that is 1 from it, above which the multipliers of a long orbit are rounding."""

NEGATIVE = 1e-3
"""Real multipliers nearer to 0 than this are too far from -1."""


UPRIGHT = 1e-10
"""Slopes smaller than this, in ranges of the parameter, are rounding."""

TOUCHED = 0.01
"""What a touch leaves of prod (mu - 1), as a part of that at the step's ends."""


@dataclass(frozen=True)
class Test:
    """A function of an orbit that changes sign at special points of one kind.

    precision: of its place along the branch, in steps. genuine: whether the zero found is of that kind.
    twice: whether it may change sign twice between two orbits at which it has the same. touches: whether a
    turn of the branch (between a base and a new orbit) is of that kind. name: the user's.
    """

    label: Label
    value: Callable[[Task, Solved], float]
    precision: float
    genuine: Callable[[Task, Solved], bool] = lambda task, solved: True
    twice: Callable[[Solved, Solved], bool] = lambda base, new: False
    touches: Callable[[Task, Solved, Solved, Solved], bool] = lambda task, turn, base, new: False
    name: str = ""


def multipliers(task: Task, solved: Solved) -> Complex:
    """Return the multipliers of an orbit, without those that are 1 whatever the parameters."""
    found = np.linalg.eigvals(solved.correction.monodromy).astype(np.complex128)
    return without_unit(found, task.unit)


def known(task: Task, solved: Solved) -> bool:
    """Whether rounding has left the multiplier that is 1, and so the others that are not huge."""
    found = np.linalg.eigvals(solved.correction.monodromy)
    return not task.autonomous or bool(np.abs(found - 1).min() <= LOST)


def slope(task: Task, solved: Solved) -> float:
    """d parameter / d arclength; 0 where the branch is upright."""
    found = solved.tangent.parameter
    return found if abs(found) > UPRIGHT * task.metric.scale else 0.0


def doubling(task: Task, solved: Solved) -> float:
    """prod (mu + 1) / (1 + |mu|); 0 where it is not known."""
    return passing(multipliers(task, solved), -1) if known(task, solved) else 0.0


def branching(task: Task, solved: Solved) -> float:
    """prod (mu - 1) / (1 + |mu|); 0 where it is not known."""
    return passing(multipliers(task, solved), 1) if known(task, solved) else 0.0


def passing(found: Complex, at: int) -> float:
    """prod (mu - at) / (1 + |mu|) of given multipliers."""
    return float(np.prod((found - at) / (1 + np.abs(found))).real)


def touches(task: Task, turn: Solved, base: Solved, new: Solved) -> bool:
    """Whether a multiplier comes to 1 at a turn between two orbits and goes back, as far as can be told."""
    values = [branching(task, end) for end in (base, new)]
    if task.unit > 1:  # no other multiplier passes 1 at a turn
        return abs(branching(task, turn)) < TOUCHED * min(map(abs, values))
    if values[0] * values[1] < 0:
        return False
    ends = [(np.abs(multipliers(task, end) - 1).min(initial=np.inf), noise(end)) for end in (base, new)]
    return all(distance > noise for distance, noise in ends)


def noise(solved: Solved) -> float:
    """What multipliers cannot be told apart by."""
    return CONSERVED * solved.error.multiplier + ROUNDING


def torus(task: Task, solved: Solved) -> float:
    """prod over i < j of (mu_i mu_j - 1) / (1 + |mu_i mu_j|); 0 where one is 1 within its error or lost."""
    return torus_of(multipliers(task, solved), noise(solved)) if known(task, solved) else 0.0


def torus_of(found: Complex, noise: float) -> float:
    """The torus test of given multipliers, their products known to within `noise`."""
    products = _products(found)
    if (np.abs(products - 1) < noise).any():
        return 0.0
    return float(np.prod((products - 1) / (1 + np.abs(products))).real)


def _products(found: Complex) -> Complex:
    first, second = np.triu_indices(len(found), 1)
    return found[first] * found[second]


def _complex(task: Task, solved: Solved) -> bool:
    """Whether the pair whose product is nearest 1 is complex: else it is a neutral saddle."""
    return known(task, solved) and complex_pair(multipliers(task, solved))


def complex_pair(found: Complex) -> bool:
    """The same of given multipliers."""
    first, second = np.triu_indices(len(found), 1)
    nearest = np.abs(found[first] * found[second] - 1).argmin()
    return bool(found[first[nearest]].imag != 0)


def doubles_twice(base: Solved, new: Solved) -> bool:
    """Whether the orbits may double between two orbits and be single again at the second.

    A pair of multipliers turns past -1, or is real and negative at one end, on its way out or back.
    """
    ends = [np.linalg.eigvals(end.correction.monodromy) for end in (base, new)]
    negative = [int(((mu.imag == 0) & (mu.real < -NEGATIVE)).sum()) for mu in ends]
    return max(negative) > 1 or rotation.passes(base.correction, new.correction, -1)


def branches_twice(base: Solved, new: Solved) -> bool:
    """Whether a pair of multipliers turns past +1 between two orbits."""
    return rotation.passes(base.correction, new.correction, 1)


TURN = Test(Label.FOLD, slope, 1e-10)
"""Its parameter is second order in its place; those of the others are first order."""

PASSAGES = (
    Test(Label.DOUBLING, doubling, 1e-10, known, doubles_twice),
    Test(Label.TORUS, torus, 1e-10, _complex),
)

BRANCHING = Test(Label.BRANCH, branching, 1e-10, known, branches_twice, touches)
