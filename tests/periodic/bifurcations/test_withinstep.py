"""A second change of sign within a step."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import location, testfunction
from periodic.bifurcations.label import Label
from periodic.bifurcations.withinstep import (
    LEAST_SHARE,
    RejectedError,
    WithinStep,
    _lowest,
    _through,
    second_change,
)


class Line:
    """Stands for a step whose solutions are their distances."""

    root = WithinStep.root

    def __init__(self, *given: object) -> None:
        self.given = given

    def at(self, distance: float) -> Any:
        """A solution that tells its distance."""
        return SimpleNamespace(place=distance, once=lambda function: function(self.at(distance)))


def named(value: Callable[[Any], float]) -> testfunction.TestFunction:
    """A test function of that value."""
    return testfunction.TestFunction(label=Label.USER, value=value, precision=1e-12)


@pytest.mark.parametrize("zero", [-0.01, 0.03, 0.3])
def test_special_point_is_found_again(zero: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the zero of a test function within half a step of where it was on a coarser mesh."""
    monkeypatch.setattr(location, "WithinStep", Line)
    test = named(lambda at: at.place - zero)
    assert location._again(Line(), Line().at(0.0), 1.0, test).place == pytest.approx(zero, abs=1e-11)  # type: ignore[arg-type, attr-defined]


def test_special_point_that_is_lost_is_not_looked_for_afar(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the step is rejected where the test function has no zero within half a step."""
    monkeypatch.setattr(location, "WithinStep", Line)
    test = named(lambda at: at.place - 0.8)
    with pytest.raises(RejectedError, match="not found again"):
        location._again(Line(), Line().at(0.0), 1.0, test)  # type: ignore[arg-type]


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_what_is_expected_at_an_end_is_known(end: float) -> None:
    """Assert that a pair of multipliers that passes just at an end of a step is not looked for there."""
    assert second_change(lambda place: 1.0 + place, {0.0: 1.0, 1.0: 2.0}, end) is None


@pytest.mark.parametrize("place", [0.2, 0.5, 0.9])
def test_dip_below_zero_is_found(place: float) -> None:
    """Assert that a parabola's dip is found from wherever it is expected."""

    def value(at: float) -> float:
        return (at - 0.4) ** 2 - 0.01

    found = second_change(value, {0.0: value(0.0), 1.0: value(1.0)}, place)
    assert found is not None and value(found) < 0


def test_parabola_through_three_points() -> None:
    """Assert the values at points that are not evenly spaced, to rounding."""
    at, values = [0.5, 1.0, 2.5], [3.0, -1.0, 0.25]
    assert _through(at, values)(np.array(at)) == pytest.approx(values, rel=1e-14)


def test_least_value_at_an_end_is_refined_towards_its_neighbour() -> None:
    """Assert the next trial midway between the least value and its neighbour, where it lies at an end."""
    falling = {place: 1.0 - place for place in (0.0, 0.1, 0.2, 0.6, 1.0)}
    assert _lowest(falling) == (pytest.approx(0.8), pytest.approx(0.2))
    rising = {place: 1.0 + place for place in (0.0, 0.1, 0.2, 0.6, 1.0)}
    assert _lowest(rising) == (pytest.approx(0.05), pytest.approx(1.05))


@pytest.mark.parametrize("at", [(0.0, 0.3, 0.6, 1.0), (0.0, 0.2, 0.3, 0.35, 1.0), (0.0, 0.5, 1.0)])
@pytest.mark.parametrize("vertex", [0.05, 0.29, 0.4, 0.62, 0.9])
def test_trial_for_a_minimum_of_a_parabola(at: tuple[float, ...], vertex: float) -> None:
    """Assert the vertex, whichever three of the points it is read from, but for the least share of a gap.

    Where an end is the least of the points it is halfway to the next one, with the parabola's value there.
    """

    def value(x: float) -> float:
        return (x - vertex) ** 2 + 1.0

    place, expected = _lowest({x: value(x) for x in at})
    assert expected == pytest.approx(value(place), rel=1e-9)
    least = min(range(len(at)), key=lambda k: value(at[k]))
    if 0 < least < len(at) - 1:
        gap = (at[least + 1] if vertex > at[least] else at[least - 1]) - at[least]
        share = max((vertex - at[least]) / gap, LEAST_SHARE)
        assert place == pytest.approx(at[least] + share * gap)
    else:
        assert place == pytest.approx((at[0] + at[1]) / 2 if least == 0 else (at[-1] + at[-2]) / 2)


def test_trial_beside_an_end_is_read_from_the_three_points_there() -> None:
    """Assert the parabola through the last three points where the last is the least, the first three else."""
    cubic = {x: x**3 for x in (0.0, 0.4, 0.7, 1.0)}
    place, expected = _lowest({1.0 - x: y for x, y in cubic.items()})
    last = _through([0.3, 0.6, 1.0], [0.7**3, 0.4**3, 0.0])
    assert place == pytest.approx(0.8) and expected == pytest.approx(last(0.8))
    place, expected = _lowest(cubic)
    assert place == pytest.approx(0.2) and expected == pytest.approx(
        _through([0.0, 0.4, 0.7], [0, 0.4**3, 0.7**3])(0.2)
    )


@pytest.mark.parametrize("least", [0.001, 0.04, 0.3])
def test_search_for_a_minimum_does_not_depend_on_the_unit(least: float) -> None:
    """Assert the same trials for a function and for its multiples, however small or large."""

    def trials(unit: float) -> list[float]:
        at: list[float] = []

        def value(place: float) -> float:
            at.append(place)
            return unit * (least + (place - 0.37) ** 2 + 0.8 * (place - 0.37) ** 4)

        ends = {0.0: value(0.0), 0.1: value(0.1), 1.0: value(1.0)}
        assert second_change(value, ends, 0.8) is None
        return at

    once = trials(1.0)
    assert len(once) > 4
    for unit in (1e-9, 1e-3, 1e3, 1e9):
        assert trials(unit) == pytest.approx(once, rel=1e-6)
