"""Curves between points, from values and slopes, against curves in closed form."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import periodic as per
from periodic.results.betweenpoints import cubics, curve, lengths, slopes_of, smooth


def circle(count: int) -> tuple[np.ndarray, ...]:
    """Points on half a circle of radius 2 about (1, 3) with their slopes in arclength: it turns back in x."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, count)
    return (
        1 + 2 * np.cos(angle),
        3 + 2 * np.sin(angle),
        -np.sin(angle),
        np.cos(angle),
    )


def test_lengths_of_a_circle() -> None:
    """Assert the arc 2 d of intervals of d rad: the trapezoidal rule gives 2 tan(d/2) 2 where it is exact."""
    x, y, dx, dy = circle(9)
    assert lengths(x, y, dx, dy) == pytest.approx(np.full(8, 4 * np.tan(np.pi / 16)), rel=1e-12)


def test_circle_to_fourth_order() -> None:
    """Assert that the curve is off the circle by h^4/64: the length's h^4/48 less the cubic's own h^4/192."""
    errors = []
    for count in (9, 17):
        x, y = curve(*circle(count))
        assert len(x) == 8 * (count - 1) + 1
        assert x[::8] == pytest.approx(circle(count)[0])
        assert y[::8] == pytest.approx(circle(count)[1])
        errors.append(np.abs(np.hypot(x - 1, y - 3) - 2).max())
    assert errors == pytest.approx([(np.pi / 8) ** 4 / 64, (np.pi / 16) ** 4 / 64], rel=0.02)


def test_cubic_and_parabola_are_exact() -> None:
    """Assert a cubic from both slopes, a parabola from either, and a straight line from none."""
    theta = np.array([0.0, 0.25, 0.5, 0.75])
    places = 1 + 2 * theta
    values, slope, length = np.array([1.0, 27.0]), np.array([3.0, 27.0]), np.array([2.0])
    assert cubics(values, slope, length, theta)[0] == pytest.approx(places**3, rel=1e-14)
    values, slope = np.array([1.0, 9.0]), np.array([2.0, 6.0])
    for known in (0, 1):
        one = np.where(np.arange(2) == known, slope, np.nan)
        assert cubics(values, one, length, theta)[0] == pytest.approx(places**2, rel=1e-14)
    nothing = np.full(2, np.nan)
    assert cubics(values, nothing, length, theta)[0] == pytest.approx([1.0, 3.0, 5.0, 7.0], rel=1e-14)


def test_slopes_that_tell_no_length_leave_a_straight_line() -> None:
    """Assert it where slopes are unknown, 0, or lead the other way."""
    x, y = np.array([0.0, 1.0]), np.array([0.0, 2.0])
    for slope in (np.nan, 0.0, -1.0):
        same = np.full(2, slope)
        assert np.isnan(lengths(x, y, same, same)).all()
        across, up = curve(x, y, same, same, each=4)
        assert across == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0], rel=1e-14)
        assert up == pytest.approx(2 * across, rel=1e-14)


def test_one_point_and_none() -> None:
    """Assert that there is nothing between them."""
    for count in (0, 1):
        one = np.arange(count, dtype=float)
        assert curve(one, one, one, one)[0].tolist() == one.tolist()


def test_slope_is_unknown_at_a_corner_alone() -> None:
    """Assert it where the slope at a peak is more than a thousandth of its neighbours', and at grazings."""

    def point(slope: float, event: str = "", label: str = "") -> Any:
        of = {"maximum": {"x": 1.0}, "minimum_slope": {"x": 0.0}, "maximum_slope": {"x": slope}}
        return SimpleNamespace(slope=2.0, label=per.Label(label), event=event, **of)

    smooth, corner, peak = 0.9e-3, 1.1e-3, "peak of x"
    points = [point(0.5), point(corner, peak, "PK"), point(1.0), point(smooth, peak, "PK"), point(1.0)]
    points += [point(0.9, "peak of y", "PK"), point(0.8), point(1.0, "", "GR")]
    found = slopes_of(points, "x p-p")
    assert found is not None
    unknown = np.isnan(found)
    assert unknown[0].tolist() == [k == 7 for k in range(8)]
    assert unknown[1].tolist() == [k in (1, 7) for k in range(8)]


def test_points_without_slopes() -> None:
    """Assert as many values as asked for, monotone between points, through all of them."""
    x, y = smooth(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 0.0]), each=3)
    assert (len(x), x[::3].tolist(), y[::3].tolist()) == (7, [0.0, 1.0, 2.0], [0.0, 1.0, 0.0])
    assert (np.diff(x) > 0).all()
    assert y.max() == 1.0
