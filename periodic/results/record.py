"""The numbers of a branch that one continuation leaves, without methods to read them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from periodic.orbit.layout import Layout
from periodic.results.atvalue import Onwards
from periodic.results.checkpoint import Checkpoint
from periodic.results.point import Point
from periodic.results.stop import Stop


@dataclass(frozen=True, eq=False, repr=False)
class Record:
    """The fields of a branch: see `periodic.results.branch.Branch`."""

    parameter: str
    layout: Layout
    points: tuple[Point, ...]
    stop: Stop
    stop_backwards: Stop | None = None
    newton_iterations: int = 0
    elapsed: float = 0.0
    versions: dict[str, str] = field(default_factory=dict)
    checkpoints: tuple[Checkpoint, ...] = ()
    backwards: int = 0
    made: dict[str, Any] = field(default_factory=dict)
    onwards: Onwards | None = None
