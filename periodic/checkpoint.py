"""Where a run stands after its last step: what it takes to go on from there as if nothing had happened."""

from __future__ import annotations

from dataclasses import dataclass

from periodic.closure import Direction
from periodic.scheme import Array


@dataclass(frozen=True)
class Checkpoint:
    """State of a run whose last point is an orbit of its branch.

    sign: the way it set out. tangent, fundamental (N+1, n, n): of its last orbit, just as the run had them.
    ds: the next step. steps: how many it has taken; since_remesh: since the mesh was made anew. left: whether
    it has left its start. met: how many points of each name it has had. done: whether it ended of itself.
    """

    sign: int
    tangent: Direction
    fundamental: Array
    ds: float
    steps: int
    since_remesh: int
    left: bool
    met: dict[str, int]
    done: bool
