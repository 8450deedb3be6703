"""What is watched along a branch besides its stability: columns, events, limits, and when to stop."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from periodic.conditions import Level
from periodic.events import Test
from periodic.functionals import Functional, Value, apart
from periodic.label import Label
from periodic.orbit import Orbit
from periodic.system import System, index_of

if TYPE_CHECKING:
    from periodic.solve import Solved, Task


@dataclass(frozen=True)
class Watch:
    """columns: functionals by the names of their columns. events: levels of functionals by name; where one
    is passed the branch gets a point (UZ). limits: ranges of parameters (SI) that end the branch. stop: after
    how many points of a label or event it ends.
    """

    columns: Mapping[str, Functional] = field(default_factory=dict)
    events: Mapping[str, Level] = field(default_factory=dict)
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    stop: Mapping[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        known = [*(label.value for label in Label if label.value), *self.events]
        for name, count in self.stop.items():
            if name not in known:
                raise ValueError(f"stop has {name!r}; it must name a label or an event: {', '.join(known)}")
            if isinstance(count, bool) or not (isinstance(count, int) and count >= 1):
                raise ValueError(f"stop of {name} is {count!r}; it must be a whole number of at least 1")
        for name, event in self.events.items():
            if not isinstance(event, Level):
                raise ValueError(f"event {name} is {event!r}; it must be a Level(functional, value)")
        for name, ends in self.limits.items():
            low, high = ends
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise ValueError(f"limits of {name} are {ends}; they must be two rising finite numbers")

    def tests(self) -> tuple[Test, ...]:
        """Return the test functions of events and limits."""
        events = [_passing(event.functional, event.value, Label.USER, n) for n, event in self.events.items()]
        limits = [
            _passing(Value(name), value + side * slack(value), Label.END, f"{word} limit of {name}")
            for name, ends in self.limits.items()
            for side, word, value in zip((-1, 1), ("lower", "upper"), ends, strict=True)
        ]
        return (*events, *limits)

    def measured(self, system: System, orbit: Orbit) -> dict[str, float]:
        """Return the columns of an orbit."""
        return {name: float(functional(system, orbit)) for name, functional in self.columns.items()}

    def checked(self, system: System, orbit: Orbit) -> None:
        """Raise ValueError if an orbit to start from lies outside the limits."""
        for name, (low, high) in self.limits.items():
            value = float(orbit.parameter[index_of(system, name)])
            if not low - slack(low) <= value <= high + slack(high):
                raise ValueError(f"{name} is {value} at the start; its limits are {low} to {high}")


def slack(limit: float) -> float:
    """How far beyond a limit a parameter may lie: by rounding."""
    return 1e-12 * abs(limit)


def _passing(functional: Functional, level: float, label: Label, name: str) -> Test:
    def value(task: Task, solved: Solved) -> float:
        return apart(functional, functional(task.system, solved.orbit), level)

    return Test(label, value, 1e-10, name=name)
