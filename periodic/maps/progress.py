"""How far a map is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """Progress of a map, reported after each chunk; as text it is one line.

    Parameters
    ----------
    done : int
        Cells computed, those of earlier calls included.
    total : int
        Cells that there are.
    failed : int
        Of those done, cells without numbers.
    elapsed : float
        Time since this call began, in s.
    left : float
        Time left at the rate so far, in s; infinite before the first cell of this call is done.
    """

    done: int
    total: int
    failed: int
    elapsed: float
    left: float

    def __str__(self) -> str:
        failed = f", {self.failed} failed" if self.failed else ""
        left = "" if self.done == self.total or self.left == float("inf") else f", {_time(self.left)} left"
        return f"{self.done} of {self.total} cells{failed}, {_time(self.elapsed)}{left}"


def _time(seconds: float) -> str:
    """A time as people read it."""
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
