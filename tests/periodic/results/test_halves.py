"""Branches of two halves that begin at one point, by hand."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from periodic.orbit.layout import Layout
from periodic.results import halves
from periodic.results.halves import joined, reversed_run
from periodic.results.stop import Reason, Stop


@dataclass(frozen=True)
class Point:
    """A point with a parameter and a slope."""

    parameter: float
    slope: float = 1.0
    minimum_slope: dict[str, float] = field(default_factory=dict)
    maximum_slope: dict[str, float] = field(default_factory=dict)


LAYOUT = Layout((), (), (), ())
ENDS = [Stop(Reason.BOUND, "lower"), Stop(Reason.BOUND, "upper")]


@pytest.fixture(autouse=True)
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a branch be what it is made of."""

    def made(*given: Any, **named: Any) -> SimpleNamespace:
        parts = dict(zip(("parameter", "layout", "points", "stop"), given, strict=False))
        return SimpleNamespace(**parts, **named)

    monkeypatch.setattr(halves, "Branch", made)


def half(stop: Stop, *parameters: float, checkpoint: Any = None) -> Any:
    """A half of some points."""
    return SimpleNamespace(points=[Point(p) for p in parameters], stop=stop, checkpoint=checkpoint)


def branch(*given: Any) -> Any:
    """What halves make."""
    return joined("p", LAYOUT, given, {"a": 1})


def test_points_backwards() -> None:
    """Assert the opposite order and slopes."""
    points: Any = [Point(1.0, 2.0), Point(3.0, -4.0)]
    found: Any = reversed_run(points)
    assert found == [Point(3.0, 4.0), Point(1.0, -2.0)]


def test_two_halves() -> None:
    """Assert the first backwards without its start, then the second; ends and checkpoints of both."""
    found = branch(half(ENDS[0], 5.0, 4.0, 3.0, checkpoint="a"), half(ENDS[1], 5.0, 6.0, checkpoint="b"))
    assert [p.parameter for p in found.points] == [3.0, 4.0, 5.0, 6.0]
    assert [p.slope for p in found.points] == [-1.0, -1.0, 1.0, 1.0]
    assert (found.stop, found.stop_backwards, found.backwards) == (ENDS[1], ENDS[0], 2)
    assert found.checkpoints == ("a", "b") and found.made == {"a": 1} and found.parameter == "p"


def test_starts_that_are_there_twice() -> None:
    """Assert that the first two points of a half are left out where they are the start, and no later ones."""
    found = branch(half(ENDS[0], 5.0, 5.0, 4.0, 5.0), half(ENDS[1], 5.0, 6.0))
    assert [p.parameter for p in found.points] == [5.0, 4.0, 5.0, 6.0] and found.backwards == 2


def test_one_half_or_none() -> None:
    """Assert its points and end, the start alone of a second half that is empty, and what has not begun."""
    one = branch(half(ENDS[1], 5.0, 6.0))
    assert [p.parameter for p in one.points] == [5.0, 6.0] and one.checkpoints == ()
    assert (one.stop, one.stop_backwards, one.backwards) == (ENDS[1], None, 0)
    begun = branch(half(ENDS[0], 5.0, 4.0), half(ENDS[1]))
    assert [p.parameter for p in begun.points] == [4.0, 5.0] and begun.backwards == 1
    failed = branch(half(ENDS[0]), half(ENDS[1], 5.0, 6.0))
    assert [p.parameter for p in failed.points] == [5.0, 6.0] and failed.stop_backwards is None
    none = branch()
    assert none.points == () and str(none.stop) == "interrupted: after 0 points"
