"""What a branch is made with, as data that are compared by value."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from support.traces import DUFFING_A, duffing_system

import periodic as per
from periodic.orbit.orbit import Orbit
from periodic.results.described import described, differences
from periodic.system import System


def functional(factor: float, name: str = "x") -> Callable[[System, Orbit], float]:
    """A functional with a number from around it."""

    def swing(system: System, orbit: Orbit) -> float:
        return factor * per.PeakToPeak(name)(system, orbit)

    return swing


@dataclass(frozen=True)
class Own:
    """A user's own functional."""

    size: float = 1.0

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return a number."""
        return self.size


class Plain:
    """One that is no dataclass, and knows itself."""

    def __init__(self, size: float) -> None:
        self.size, self.me = size, self


VALUES: list[tuple[Any, Any]] = [
    (per.Level(per.PeakToPeak("x"), 3.0), per.Level(per.PeakToPeak("x"), 1.0)),
    (per.Level(per.PeakToPeak("x"), 3.0), per.Level(per.Maximum("x"), 3.0)),
    (per.Amplitude("x"), per.Amplitude("x", 2.0)),
    (per.Tolerance(), per.Tolerance.of(per.Accuracy.FINE)),
    (per.Collocation(), per.HarmonicBalance()),
    (per.HarmonicBalance(), per.HarmonicBalance(harmonics=9)),
    (per.PhaseCondition(), per.Conservative()),
    (functional(1.0), functional(2.0)),
    (lambda s, o: 1.0, lambda s, o: 2.0),
    (functools.partial(functional, 1.0), functools.partial(functional, 2.0)),
    (Own(1.0), Own(2.0)),
    (Own(1.0).__call__, Own(2.0).__call__),
    (Plain(1.0), Plain(2.0)),
    (np.arange(4.0), np.arange(1.0, 5.0)),
    (np.arange(400.0), np.arange(1.0, 401.0)),
    (per.Accuracy.FINE, per.Accuracy.DRAFT),
    ({"LP": 1}, {"LP": 2}),
    ({"c": (0.0, 1.0)}, {"c": (0.0, 2.0)}),
    ({1, 2}, {1, 3}),
    (math.nan, 1.0),
    (1.0, True + 1),
]


@pytest.mark.parametrize("which", range(len(VALUES)))
def test_descriptions_differ_as_values_do(which: int) -> None:
    """Assert that a description survives a file, equals itself, and differs from that of another value."""
    one, other = ({"it": described(value)} for value in VALUES[which])
    assert differences(one, json.loads(json.dumps(one))) == []
    (told,) = differences(one, other)
    assert told.startswith("it ") and "; now they are " in told and "\n" not in told


def test_equal_values_that_are_other_objects() -> None:
    """Assert that what was made again in the same way has the same description."""
    assert described(functional(2.0)) == described(functional(2.0))
    assert described(Own(2)) == described(Own(2.0))
    assert described(per.Level(per.Value("c"), 3)) == described(per.Level(per.Value("c"), np.float64(3.0)))
    assert described((1, 2)) == described([1.0, 2.0])


def test_sentences() -> None:
    """Assert that field, place, before and now are told, and what may differ is passed over."""
    before = {"events": described({"three": per.Level(per.PeakToPeak("x"), 3)}), "at": [1.7]}
    now = {"events": described({"three": per.Level(per.PeakToPeak("x"), 1)}), "at": []}
    assert differences(before, now) == [
        "events three.value = 3; now they are three.value = 1",
        "at (1.7); now they are ()",
    ]
    assert differences(before, now, ["events.three.value", "at"]) == []
    (told,) = differences(before, {**before, "events": described({"three": per.Value("c")})})
    assert told.startswith("events three = Level(functional=PeakToPeak(output=x), value=3); now they are ")
    assert told.endswith("three = Value(parameter=c)")


CHANGES: dict[str, Any] = {
    "events": {"here": per.Level(per.PeakToPeak("x"), 1.0)},
    "columns": {"size": per.Amplitude("x", 3.0)},
    "limits": {"F": (0.0, 2.0)},
    "stop": {"LP": 3},
}


@pytest.mark.parametrize("name", list(CHANGES))
def test_a_branch_is_not_taken_up_with_another_problem(name: str) -> None:
    """Assert that events, columns, limits and stops of the same names but other values are refused."""
    options: dict[str, Any] = {
        "events": {"here": per.Level(per.PeakToPeak("x"), 3.0)},
        "columns": {"size": per.Amplitude("x")},
        "limits": {"F": (0.0, 1.0)},
        "stop": {"LP": 2},
    }
    few = per.ArclengthControl(max_points=5)
    problem = (duffing_system(*DUFFING_A), "Omega", (0.3, 3.0))
    part = per.trace(*problem, watch=per.Watch(**options), control=few)
    with pytest.raises(per.ResumeError, match=f"^guess is a branch made with {name} .*; now they are [^;]*$"):
        per.trace(*problem, watch=per.Watch(**{**options, name: CHANGES[name]}), control=few, guess=part)
    again = per.trace(*problem, watch=per.Watch(**options), guess=part)
    assert len(again) > len(part)
