"""A jump of the state or of its rates at an event node, linearised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from periodic.orbit.scheme import Array


class Carried(Protocol):
    """What an orbit's jumps make of perturbations: computed for all of them when it is first asked for."""

    @property
    def matrices(self) -> Array:
        """Their saltation matrices, shape (jumps, n, n+q). Raises numpy.linalg.LinAlgError without rates."""


@dataclass(frozen=True, eq=False)
class Jump:
    """x+ = r(x-, y) where interval `interval` ends, and what it makes of perturbations at fixed tau.

    Parameters
    ----------
    index : int
        The event node.
    interval : int
        The interval whose right end is x-; the next mesh point is x+.
    before, after : ndarray, shape (n,)
        x- and r(x-).
    by_state : ndarray, shape (n, n)
        r_x.
    by_outer : ndarray, shape (n, q)
        r_y: in the phases of the event nodes, then the free parameters.
    carried : Carried
        The saltation matrices of all jumps of the orbit; Newton's iteration does without.
    place : int
        Which of them is its own.
    """

    index: int
    interval: int
    before: Array
    after: Array
    by_state: Array
    by_outer: Array
    carried: Carried
    place: int

    @property
    def saltation(self) -> Array:
        """S (n, n+q): dx+ = S (dx-, dp) at fixed tau, the event moving with the state and parameters p."""
        return self.carried.matrices[self.place]
