"""A branch that was traced both ways from its start, put together from its two halves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from periodic.orbit.layout import Layout
from periodic.results.branch import Branch
from periodic.results.checkpoint import Checkpoint
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop


@dataclass(frozen=True)
class Half:
    """One run from the start on.

    Parameters
    ----------
    points : sequence of Point
        Its points, the start first.
    stop : Stop
        Why it ended.
    checkpoint : Checkpoint, optional
        Where it stands; none where it has not begun.
    """

    points: Sequence[Point]
    stop: Stop
    checkpoint: Checkpoint | None


def joined(parameter: str, layout: Layout, halves: Sequence[Half], made: dict[str, Any]) -> Branch:
    """Return the branch of two halves that begin at the same point, of one, or of none yet.

    Parameters
    ----------
    parameter : str
        Name of the parameter continued in.
    layout : Layout
        Names, units and scales.
    halves : sequence of Half
        None, one or two; the first of two is reversed.
    made : dict
        What they were made with, by value.

    Returns
    -------
    Branch
        The branch.
    """
    if not halves:
        return Branch(parameter, layout, (), Stop.after(Reason.INTERRUPTED, 0), made=made)
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
    return reversed_run([p for i, p in enumerate(half) if i > 1 or p.parameter != start])


def reversed_run(points: Sequence[Point]) -> list[Point]:
    """Return points in the opposite order.

    Parameters
    ----------
    points : sequence of Point
        The points of a half.

    Returns
    -------
    list of Point
        With the opposite slopes.
    """
    return [_turned(point) for point in reversed(points)]


def _turned(point: Point) -> Point:
    """A point of a branch that goes the other way."""
    least, most = point.minimum_slope, point.maximum_slope
    return replace(point, slope=-point.slope, minimum_slope=_opposite(least), maximum_slope=_opposite(most))


def _opposite(slopes: dict[str, float]) -> dict[str, float]:
    return {output: -slope for output, slope in slopes.items()}
