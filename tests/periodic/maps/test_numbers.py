"""Numbers of branches against closed forms and against the branch's own points."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator

import periodic as per
import symbolic as sym
from periodic.maps.numbers.extremes import _inside

ZETA = 0.05
SWING = per.PeakToPeak("x")
AT = math.sqrt(1 - 2 * ZETA**2)
PEAK = 1 / (ZETA * math.sqrt(1 - ZETA**2))
"""x'' + 2 zeta x' + x = cos Omega t: the largest peak to peak and where it is."""


@cache
def duffing() -> sym.CompiledSystem:
    """The oscillator of the scene."""
    return sym.scene("duffing")


def numbers_of(task: per.maps.Task, **values: float) -> dict[str, Any]:
    """The numbers of one cell at the given or nominal parameters."""
    branch = task.traced(values)
    return {name: number(task, branch) for name, number in task.numbers.items()}


def linear() -> sym.CompiledSystem:
    """The linear oscillator, with derivatives of its outputs."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 1.0) + sym.Damper(x, 2 * ZETA) + sym.Spring(x, 1.0)
    return sym.compile(parts + sym.HarmonicForce(x, 1.0))


@pytest.mark.parametrize(
    ("kind", "method"),
    [
        (linear, per.Collocation()),
        (LinearOscillator, per.Collocation()),
        (linear, per.HarmonicBalance()),
    ],
)
def test_peak_is_exact_between_points(kind: Any, method: Any) -> None:
    """Assert place (1e-7) and height (1e-7) of a linear resonance, with and without exact derivatives."""
    task = per.maps.Task(
        kind(),
        "Omega",
        (0.5, 1.6),
        numbers={"peak": per.maps.Highest(SWING)},
        method=method,
        tol=1e-8,
        watch=per.Watch(peaks={}),
    )
    peak = numbers_of(task)["peak"]
    assert peak[""] == pytest.approx(PEAK, rel=1e-9)
    assert peak["at"] == pytest.approx(AT, rel=1e-9)
    samples = task.traced({}).peak_to_peak("x").max()
    assert abs(samples / PEAK - 1) > 1e-6  # no point of the branch lies there


def test_extreme_at_an_end() -> None:
    """Assert that a number that only rises or falls is the one at the end of the branch."""
    numbers = {"most": per.maps.Highest(SWING), "least": per.maps.Lowest(SWING)}
    found = numbers_of(per.maps.Task(linear(), "Omega", (0.3, 0.7), numbers=numbers))
    for name, omega in (("most", 0.7), ("least", 0.3)):
        exact = 2 / math.hypot(1 - omega**2, 2 * ZETA * omega)
        assert found[name]["at"] == omega and found[name][""] == pytest.approx(exact, rel=1e-6)


def test_folds_sheets_and_stable_ranges() -> None:
    """Assert folds, three orbits between them and two stable ranges of Duffing's oscillator."""
    numbers = {
        "folds": per.maps.Places("LP"),
        "heights": per.maps.Places("LP", SWING),
        "stable": per.maps.StableRanges(),
        "sheets": per.maps.Sheets(SWING, 1.8),
        "lone": per.maps.Sheets(SWING, 2.5),
        "none": per.maps.Places("PD"),
    }
    found = numbers_of(per.maps.Task(duffing(), "Omega", (0.3, 3.0), numbers=numbers))
    upper, lower = found["folds"]
    assert [upper, lower] == pytest.approx([2.2119353, 1.4386701], rel=1e-6)
    assert found["stable"] == {"from": [0.3, lower], "to": [upper, 3.0]}
    high, middle, low = found["sheets"][""]
    assert high > middle > low and found["sheets"]["stable"] == [1.0, 0.0, 1.0]
    assert len(found["lone"][""]) == 1 and found["none"] == [] and len(found["heights"]) == 2
    assert found["heights"][0] > high > low


def test_stable_extreme_is_the_fold() -> None:
    """Assert that the highest stable response of the lower sheet's side is exactly at a fold."""
    numbers = {
        "high": per.maps.Highest(SWING, stable=True),
        "low": per.maps.Highest(per.Minimum("x"), stable=True),
    }
    task = per.maps.Task(
        duffing(), "Omega", (0.3, 3.0), start=3.0, numbers=numbers, watch=per.Watch(stop={"LP": 1})
    )
    found = numbers_of(task)
    fold = task.traced({}).labelled("LP")[0]
    assert found["high"] == {"": pytest.approx(fold.peak_to_peak("x")), "at": fold.parameter}


def test_no_stable_orbit_is_nan() -> None:
    """Assert that an extreme among no orbits is no number."""
    task = per.maps.Task(
        LinearOscillator(zeta=-0.05),
        "Omega",
        (0.5, 0.8),
        numbers={"peak": per.maps.Highest(SWING, stable=True)},
    )
    assert all(np.isnan(value) for value in numbers_of(task)["peak"].values())


def test_units() -> None:
    """Assert the units of each number's parts."""
    task = per.maps.Task(duffing(), "Omega", (0.3, 3.0), numbers={"peak": per.maps.Highest(SWING)})
    assert per.maps.Highest(SWING).units(task) == {"": "m", "at": "rad/s"}
    assert per.maps.Places("LP").units(task) == {"": "rad/s"}
    assert per.maps.Places("LP", SWING).units(task) == {"": "m"}
    assert per.maps.Sheets(SWING, 1.0).units(task) == {"": "m", "stable": ""}


def asked(numbers: Any) -> per.maps.Task:
    """A task that reads some numbers."""
    return per.maps.Task(linear(), "Omega", (1, 2), numbers=numbers)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: per.maps.Highest("x"), "functional is 'x'; it must be one of an orbit"),
        (lambda: per.maps.Lowest(per.PeakToPeak), "functional is <class"),
        (lambda: per.maps.Places(3), "label is 3; it must be one of EP, LP"),
        (lambda: per.maps.Sheets(SWING, "1"), "at is '1'; it must be a number"),
        (lambda: per.maps.Task(linear(), "Omega", (1, 2), numbers={}), "numbers is empty; it must name"),
        (
            lambda: per.maps.Task(linear(), "Omega", (1, 2), numbers={"a": 3}),
            "number a is 3; it must be a function",
        ),
        (
            lambda: per.maps.Task(linear(), "Omega", (1, 2), numbers={"s": per.maps.Sheets(SWING, 9.0)}),
            "at is 9.0; it must lie within the bounds",
        ),
        (
            lambda: per.maps.Task(
                linear(),
                "Omega",
                (1, 2),
                numbers={"p": per.maps.Highest(SWING)},
                watch=per.Watch(journal="j"),
            ),
            "watch has a journal or progress",
        ),
        (
            lambda: asked({"p": SWING}),
            "number p is PeakToPeak(output='x'), of an orbit; it must be of a branch",
        ),
        (lambda: asked({"p": per.maps.Highest(per.PeakToPeak("y"))}), "output is 'y'; it must be one of x"),
        (lambda: asked({"p": per.maps.Places("XX")}), "label is 'XX'; it must be one of EP, LP"),
        (
            lambda: asked({"x/y": per.maps.Places("LP")}),
            "numbers has 'x/y'; names must not be empty and have no /",
        ),
        (lambda: asked({" ": per.maps.Places("LP")}), "numbers has ' '; names must not"),
        (
            lambda: asked({"p": per.maps.Highest(SWING), "p at": per.maps.Places("LP")}),
            "numbers gives 'p at' twice; it must be the name of one",
        ),
    ],
)
def test_refusals(make: Any, said: str) -> None:
    """Assert the sentence for what cannot be read, before anything is traced."""
    with pytest.raises(ValueError, match="^" + re.escape(said)):
        make()


def test_extreme_value_beside_a_point_that_does_not_count() -> None:
    """Assert that a stationary value is looked for only between points that count on both sides."""
    values = np.array([1.0, 2.0, 3.0, 2.5, -np.inf, 2.0])
    assert _inside(values, 2)
    assert not _inside(values, 3) and not _inside(values, 0) and not _inside(values, 5)
