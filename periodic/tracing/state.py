"""Where a continuation stands after its last completed step."""

from __future__ import annotations

from dataclasses import dataclass, field

from periodic.bifurcations.testfunction import Course
from periodic.correction.solution import Solution


@dataclass(frozen=True)
class State:
    """Where a run stands: its last solution, the first, the next step's size, and what it has counted.

    kept: how many of its points belong to steps that were completed. least: the least step, which is
    shorter near grazing, where a fold may lie very close.
    """

    begun: Solution
    last: Solution
    sign: int
    ds: float
    steps: int
    since_remesh: int
    left: bool
    met: dict[str, int]
    kept: int
    least: float
    course: Course = field(default_factory=Course)
