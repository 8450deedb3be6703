"""Bounds and roots of guards between phases: of functions that are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from symbolic.arrays import Array
from symbolic.integration import follower
from symbolic.integration.enclosures import RESOLVED, SAFE, Passed, _fourth, crossing, lowest, root
from symbolic.integration.follower import LONGEST, Followed, Passage, Seen

PHASE = np.array([0.0, 0.3, 0.5, 1.1, 1.2])


def column(function: Any) -> Array:
    """Values of a function at the phases, as those of one guard."""
    return np.asarray(function(PHASE), dtype=float)[:, None]


def polynomial(*coefficients: float) -> tuple[Any, Any]:
    """A polynomial and its derivative, the highest power first."""
    own = np.poly1d(coefficients)
    return own, own.deriv()


def test_fourth_derivative_is_read_from_neighbouring_cubics() -> None:
    """Assert s''''/24 = 2 of 2 t^4 + t^3 - t on every interval, and 0 of a cubic, to rounding."""
    s, rate = polynomial(2.0, 1.0, 0.0, -1.0, 3.0)
    assert _fourth(column(s), column(rate), PHASE) == pytest.approx(np.full((4, 1), 2.0), rel=1e-9)
    s, rate = polynomial(-1.5, 2.0, -1.0, 3.0)
    assert np.abs(_fourth(column(s), column(rate), PHASE)).max() < 1e-10
    assert _fourth(column(s)[:2], column(rate)[:2], PHASE[:2]).tolist() == [[np.inf]]


def test_larger_estimate_of_both_sides_counts() -> None:
    """Assert on each interval the larger of those at its ends, where the fourth derivative changes."""
    s, rate = polynomial(1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    each = _fourth(column(s), column(rate), PHASE).ravel()
    at = [_fourth(column(s)[k : k + 3], column(rate)[k : k + 3], PHASE[k : k + 3])[0, 0] for k in range(3)]
    assert each == pytest.approx([at[0], max(at[:2]), max(at[1:]), at[2]], rel=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_lowest_encloses_a_function(sign: float) -> None:
    """Assert a bound below all values of sin 2t, no lower than its own fourth derivatives explain."""
    values, rates = column(lambda t: sign * np.sin(2 * t)), column(lambda t: sign * 2 * np.cos(2 * t))
    bound = lowest(values, rates, PHASE).ravel()
    for k, (begin, end) in enumerate(zip(PHASE, PHASE[1:], strict=False)):
        least = (sign * np.sin(2 * np.linspace(begin, end, 200))).min()
        assert least - 0.35 < bound[k] <= least + 1e-12


def test_bernstein_coefficients_of_a_quartic() -> None:
    """Assert the five of t^4 on [0, 1] with the error taken fourfold: 0, 0, -1/2, 0, 1."""
    phase = np.array([0.0, 1.0, 2.0])
    values, rates = phase[:, None] ** 4, 4 * phase[:, None] ** 3
    assert SAFE == 4.0
    # of the cubic through both ends: 0, 0, (0 - 1/3)/2, ..., less 4/6
    assert lowest(values, rates, phase)[0, 0] == pytest.approx(-1 / 6 - 4 / 6)


def along(phase: float, function: Any, slope: Any) -> Passed:
    """A motion y = tau and a function of it."""
    return Passed(phase, np.array([phase]), float(function(phase)), float(slope(phase)))


@pytest.mark.parametrize("near", [1e-4, 1e-9])
@pytest.mark.parametrize("power", [1, 3])
def test_root_is_enclosed(near: float, power: int) -> None:
    """Assert phases on either side of (0.7 - tau)^n = 0, both as near to 0 as asked for, with y and rate."""
    asked: list[float] = []

    def value(tau: float) -> float:
        return (0.7 - tau) ** power + 0.1 * (0.7 - tau)

    def slope(tau: float) -> float:
        return -power * (0.7 - tau) ** (power - 1) - 0.1

    def guard(tau: float, y: Array) -> Passed:
        asked.append(tau)
        return Passed(tau, y, value(tau), slope(tau))

    ends = [along(tau, value, slope) for tau in (0.2, 1.5)]
    found = root(lambda tau, y, later: y + later - tau, guard, *ends, near)
    assert found.before <= 0.7 <= found.after and found.before < found.after
    assert 0 <= value(found.before) <= near and 0 < -value(found.after) <= near
    assert found.y_before == pytest.approx([found.before]) and found.y_after == pytest.approx([found.after])
    assert found.rate == pytest.approx(slope(0.7), abs=1e-2) and len(asked) < 20


def test_root_of_a_jump_is_resolved() -> None:
    """Assert that a guard that jumps is enclosed by phases next to each other."""

    def guard(tau: float, y: Array) -> Passed:
        return Passed(tau, y, 1.0 if tau < 0.7 else -1.0, 0.0)

    low, high = Passed(0.5, np.zeros(1), 1.0, 0.0), Passed(1.0, np.zeros(1), -1.0, 0.0)
    found = root(lambda tau, y, later: y, guard, low, high, 1e-12)
    assert found.before < 0.7 <= found.after and found.after - found.before <= 1e-13


@pytest.mark.parametrize(("begin", "place"), [(0.0, 0.25), (0.5, 0.75)])
def test_first_crossing_of_a_cubic(begin: float, place: float) -> None:
    """Assert the first root of (t - 1/4)(t - 3/4)(t - 2) in an interval, which need not be its only one."""
    s, rate = polynomial(*np.poly([0.25, 0.75, 2.0]))
    assert crossing(along(begin, s, rate), along(1.0, s, rate)) == pytest.approx(place, abs=1e-12)
    assert crossing(along(0.3, s, rate), along(0.6, s, rate)) == 0.3
    assert crossing(along(0.25, s, rate), along(0.25 + RESOLVED, s, rate)) == 0.25


@pytest.mark.parametrize(("value", "rate"), [(-np.inf, 0.0), (-1.0, np.inf), (-1.0, np.nan)])
def test_no_cubic_through_what_is_not_finite(value: float, rate: float) -> None:
    """Assert the first phase, so that the interval is halved."""
    ends = Passed(0.25, np.zeros(1), 1.0, 0.0), Passed(1.0, np.zeros(1), value, rate)
    assert crossing(*ends) == 0.25


def test_phases_are_filled_in() -> None:
    """Assert even parts no longer than the longest, the given ones kept as they are."""
    given = np.array([0.0, LONGEST / 2, 3.1 * LONGEST, 3.1 * LONGEST, 5 * LONGEST])
    every, places = follower._filled(given)
    assert every[places] == pytest.approx(given, abs=1e-15)
    assert np.diff(every).max() <= LONGEST * (1 + 1e-12)
    assert places.tolist() == [0, 1, 4, 5, 7]
    assert np.diff(every[1:5]) == pytest.approx(np.full(3, 2.6 * LONGEST / 3))


@pytest.mark.parametrize(("number", "power"), [(0, 0), (1, 1), (2, 2), (3, 2), (4, 4), (7, 4), (100, 64)])
def test_power_of_2_up_to_a_number(number: int, power: int) -> None:
    """Assert the largest one."""
    assert follower._power_of_2(number) == power


def test_guards_less_their_levels() -> None:
    """Assert phase, y, value and rate of each guard."""
    seen = Seen(
        np.array([1.0, 2.0]),
        np.eye(2),
        np.array([[1.0, 2.0], [3.0, 4.0]]),
        np.array([[5.0, 6.0], [7.0, 8.0]]),
    )
    first, second = (seen.at(1, k, np.array([0.5, -0.5])) for k in (0, 1))
    assert (first.phase, first.value, first.rate) == (2.0, 2.5, 7.0)
    assert (second.phase, second.value, second.rate) == (2.0, 4.5, 8.0)
    assert first.y.tolist() == [0.0, 1.0]


def test_impacts_are_shown_twice() -> None:
    """Assert both values of each impact between the given phases, and nothing of other passages."""
    from symbolic.integration.enclosures import Root

    def passage(at: float, mapped: bool) -> Passage:
        own = Root(at, at + 1e-12, np.array([at]), np.array([at]), -1.0)
        return Passage(own, np.array([-at]), None, mapped)  # type: ignore[arg-type]

    values = np.array([[0.0], [10.0], [20.0]])
    passages = [passage(0.5, True), passage(0.7, False), passage(1.0, True)]
    found = Followed(values, passages, (), None)  # type: ignore[arg-type]
    phase, each = found.with_impacts(np.array([0.0, 1.0, 2.0]))
    assert phase.tolist() == [0.0, 0.5, 0.5, 1.0, 1.0, 1.0, 2.0]
    assert each.ravel().tolist() == [0.0, 0.5, -0.5, 1.0, -1.0, 10.0, 20.0]
