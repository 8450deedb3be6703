"""Where a run stands after its last step: what it takes to go on from there as if nothing had happened."""

from __future__ import annotations

from dataclasses import dataclass, field

from periodic.bifurcations.testfunction import Course
from periodic.linear.unknowns import Increment
from periodic.orbit.scheme import Array


@dataclass(frozen=True)
class Checkpoint:
    """State of a run whose last point is an orbit of its branch.

    Parameters
    ----------
    sign : int
        Direction in which it set out, 1 or -1 times the parameter.
    tangent : Increment
        That of its last orbit, bit for bit.
    fundamental : ndarray, shape (N+1, n, n)
        Fundamental matrices of its last orbit at the mesh points.
    ds : float
        Length of the next step.
    steps, since_remesh : int
        How many steps it has taken, and since the mesh was made anew.
    left : bool
        Whether it has left its start.
    met : dict
        How many points of each label or event it has had.
    done : bool
        Whether it ended of itself.
    course : Course
        Of the test functions in its last step.
    """

    sign: int
    tangent: Increment
    fundamental: Array
    ds: float
    steps: int
    since_remesh: int
    left: bool
    met: dict[str, int]
    done: bool
    course: Course = field(default_factory=Course)
