"""A jump of the state at an event node, linearised."""

from __future__ import annotations

from dataclasses import dataclass

from periodic.orbit.scheme import Array


@dataclass(frozen=True)
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
    saltation : ndarray, shape (n, n+q)
        dx+ = S (dx-, dp) at fixed tau, the event moving with the state and the free parameters p.
    """

    index: int
    interval: int
    before: Array
    after: Array
    by_state: Array
    by_outer: Array
    saltation: Array
