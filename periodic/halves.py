"""A branch that was traced both ways from its start, put together from its two halves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from periodic.branch import Branch, Layout
from periodic.checkpoint import Checkpoint
from periodic.point import Point
from periodic.stop import Reason, Stop


@dataclass(frozen=True)
class Half:
    """The points of one run from the start on, why it ended, and where it stands."""

    points: Sequence[Point]
    stop: Stop
    checkpoint: Checkpoint | None


def joined(parameter: str, layout: Layout, halves: Sequence[Half], made: dict[str, str]) -> Branch:
    """Return the branch of two halves that begin at the same point, of one, or of none yet.

    The first of two is turned round; `made` is what they were made with.
    """
    if not halves:
        return Branch(parameter, layout, (), Stop(Reason.INTERRUPTED, "after 0 points"), made=made)
    two = len(halves) == 2 and len(halves[0].points) > 0
    last, first = halves[-1], _reversed(halves[0].points) if two else []
    return Branch(
        parameter=parameter,
        layout=layout,
        points=(*first, *(last.points or halves[0].points[:1])),
        stop=last.stop,
        stop_backwards=halves[0].stop if two else None,
        checkpoints=tuple(half.checkpoint for half in halves if half.checkpoint is not None),
        backwards=len(first),
        made=made,
    )


def _reversed(half: Sequence[Point]) -> list[Point]:
    """A half backwards as the first part of a branch, without its start."""
    start = half[0].parameter
    return turned([p for i, p in enumerate(half) if i > 1 or p.parameter != start])


def turned(points: Sequence[Point]) -> list[Point]:
    """Return points in the opposite order."""
    return [replace(point, slope=-point.slope) for point in reversed(points)]
