"""Stable stretches of a branch: where they are, and what happens at their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from periodic.results.branch import Branch
from periodic.results.plots.marks import KINDS
from periodic.results.point import Point
from periodic.results.stop import Reason

LETTERS = "abcdefghijklmnopqrstuvwxyz"
"""Names of stable stretches."""

PLAIN = ("EP", "UZ", "")
"""Labels of points at which nothing happens."""


@dataclass(frozen=True)
class End:
    """Where a stable stretch ends: the parameter (SI), and the label of the special point there, if any."""

    value: float
    label: str

    def __str__(self) -> str:
        if self.label in PLAIN:
            return f"{self.value:.9g}"
        name = KINDS.get(self.label, ("", ""))[1]
        return f"{self.label} {name} at {self.value:.9g}".replace("  ", " ")


def stretches(branch: Branch) -> list[int]:
    """Return for each point of a branch the number of the stable stretch that it is on, -1 where unstable.

    The last stretch of a closed branch is its first where both are stable at the start.
    """
    found, last, before = list[int](), -1, False
    for point in branch:
        last, before = last + (point.stable and not before), point.stable
        found.append(last if point.stable else -1)
    if _joined(branch) and last > 0:
        found = [0 if k == last else k for k in found]
    return found


def ends(branch: Branch) -> list[tuple[End, End]]:
    """Return both ends of each stable stretch, that at the lower value of the parameter first."""
    numbers, points = stretches(branch), list(branch)
    closed = _joined(branch)
    found = []
    for number in range(max(numbers, default=-1) + 1):
        own = [i for i, k in enumerate(numbers) if k == number]
        first, last = own[0], own[-1]
        if closed and number == 0:
            outside = [i for i, k in enumerate(numbers) if k != 0]
            first, last = (outside[-1] + 1, outside[0] - 1) if outside else (first, last)
        both = _end(points, first, first - 1), _end(points, last, last + 1)
        found.append((min(both, key=_value), max(both, key=_value)))
    return found


def _joined(branch: Branch) -> bool:
    """Whether a branch is closed, and stable where it begins."""
    return (
        bool(len(branch)) and branch.stop.reason == Reason.CLOSED and branch[0].stable and branch[-1].stable
    )


def _end(points: Sequence[Point], own: int, beside: int) -> End:
    """The end of a stretch at its last point, or at the special point beside it."""
    k = beside if 0 <= beside < len(points) and str(points[beside].label) not in PLAIN else own
    return End(points[k].parameter, str(points[k].label))


def _value(end: End) -> float:
    return end.value
