"""Where a slope vanishes within a step: polynomials by hand, and peaks of functions in closed form."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import testfunction
from periodic.bifurcations.label import Label
from periodic.tracing.steps import peaklocation
from periodic.tracing.steps.peaklocation import _corner, _peak, _vertex

Values = Callable[[float], tuple[float, float]]
"""A function and its derivative at a place."""


class Step:
    """A step along which a peak to peak is a function of the distance."""

    def __init__(self, values: Values, length: float) -> None:
        self._values = values
        self.base = SimpleNamespace(orbit=None, tangent=None)
        self.solver = SimpleNamespace(constraint=lambda *at: SimpleNamespace(rate=lambda tangent: 1.0))
        self.known = {end: self._solved(end) for end in (0.0, length)}

    def _solved(self, place: float) -> SimpleNamespace:
        value, slope = self._values(place)
        found = SimpleNamespace(peak_to_peak=np.array([value]), peak_to_peak_slope=np.array([slope]))
        return SimpleNamespace(tangent=None, found=found)

    def at(self, place: float) -> SimpleNamespace:
        """The orbit at a distance, solved for once."""
        if place not in self.known:
            self.known[place] = self._solved(place)
        return self.known[place]


@pytest.fixture
def located(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[list[float], int]]:
    """Return the places of peaks, and how many orbits were solved for."""
    monkeypatch.setattr(peaklocation, "measured", lambda solution: solution.found)
    monkeypatch.setattr(peaklocation, "refined_place", lambda solver, place, *others: place)
    test = testfunction.TestFunction(label=Label.PEAK, value=lambda solution: 0.0, precision=1e-7)

    def places(values: Values, length: float, corners: bool = True) -> tuple[list[float], int]:
        step: Any = Step(values, length)
        return [*_peak(step, 0, test, length, corners)], len(step.known) - 2

    return places


def test_peak_of_a_parabola_takes_one_orbit(located: Any) -> None:
    """Assert its place to rounding: the prediction from its own orbit is the same."""
    (place,), orbits = located(lambda s: (3 - 2 * (s - 0.3) ** 2, -4 * (s - 0.3)), 0.7)
    assert place == pytest.approx(0.3, rel=1e-13) and orbits == 1


@pytest.mark.parametrize("length", [0.2, 1.0, 3.0])
def test_peak_of_a_resonance(length: float, located: Any) -> None:
    """Assert the place of the peak of 1/(1 + (s - 0.1)^2), to 1e-7 of the step, in few orbits."""

    def values(s: float) -> tuple[float, float]:
        height = 1 / (1 + (s - 0.1) ** 2)
        return height, -2 * (s - 0.1) * height**2

    (place,), orbits = located(values, length)
    assert place == pytest.approx(0.1, abs=1e-7 * length) and orbits <= 5


def test_peak_that_polynomials_do_not_predict(located: Any) -> None:
    """Assert the place where the slope falls within 1e-3 of the step, by its end tangents."""

    def values(s: float) -> tuple[float, float]:
        return -float(np.logaddexp((s - 0.61) / 1e-3, -(s - 0.61) / 1e-3)), -1e3 * np.tanh((s - 0.61) / 1e-3)

    (place,), orbits = located(values, 1.0)
    assert place == pytest.approx(0.61, abs=1e-7) and orbits < 40


@pytest.mark.parametrize("bend", [0.0, 0.3, -2.0])
def test_corner_is_a_peak(bend: float, located: Any) -> None:
    """Assert the place where the slope jumps, in fewer orbits than 1e-7 has bits."""

    def values(s: float) -> tuple[float, float]:
        return -abs(s - 0.37) + bend * (s - 0.37) ** 3, -np.sign(s - 0.37) + 3 * bend * (s - 0.37) ** 2

    (place,), orbits = located(values, 0.6)
    assert place == pytest.approx(0.37, abs=1e-7) and orbits <= 15
    assert located(values, 0.6, corners=False)[0] == []


@pytest.mark.parametrize(("slopes", "expected"), [([1.0, -3.0], 2.75), ([1e-3, -3.0], 2.5)])
def test_tangents_meet(slopes: list[float], expected: float) -> None:
    """Assert the place by hand; midway where it is within a hundredth of an end."""
    places, values = np.array([2.0, 3.0]), np.array([0.0, 0.0])
    assert _corner(places, values, np.array(slopes), 0) == pytest.approx(expected, rel=1e-12)


def test_no_change_of_sign(located: Any) -> None:
    """Assert that nothing is solved for."""
    assert located(lambda s: (s, 1.0), 1.0) == ([], 0)


def test_vertex_of_a_quintic() -> None:
    """Assert its root from three places, and that a nearer place is left out."""
    polynomial = np.polynomial.Polynomial([1.0, 0.5, -0.3, 0.2, -0.4, 0.05])
    places = np.array([0.0, 1.0, 1.02, 2.0])
    root = next(r.real for r in polynomial.deriv().roots() if abs(r.imag) < 1e-12 and 0 < r.real < 1)
    values, slopes = polynomial(places), polynomial.deriv()(places)
    assert _vertex(places, values, slopes, 0) == pytest.approx(root, rel=1e-12)
    values[2] = slopes[2] = np.nan
    assert _vertex(places, values, slopes, 0) == pytest.approx(root, rel=1e-12)


def test_vertex_between_later_places() -> None:
    """Assert it in units of the interval, wherever that lies."""
    places = np.array([-3.0, 5.0, 9.0])
    values, slopes = -((places - 6.5) ** 2), -2 * (places - 6.5)
    assert _vertex(places, values, slopes, 1) == pytest.approx(6.5, rel=1e-12)


def test_three_roots_leave_the_chord() -> None:
    """Assert that of a polynomial that vanishes three times the chord of the slopes is taken."""
    slope = np.polynomial.Polynomial.fromroots([0.2, 0.5, 0.8, 3.0])
    places = np.array([0.0, 1.0, 2.0])
    values, slopes = slope.integ()(places), slope(places)
    assert slopes[:2] == pytest.approx([0.24, -0.16], rel=1e-12)
    assert _vertex(places, values, slopes, 0) == pytest.approx(0.6, rel=1e-12)


def test_slopes_alone_tell_where_values_differ_by_rounding() -> None:
    """Assert the chord's zero where values, which differ by 1e-9 of themselves, are off by as much."""
    places, slopes = np.array([0.0, 1.0, 2.0]), np.array([1e-9, -3e-9, -1.0])
    off = np.array([1.0, 1.0 + 3e-9, 1.0])
    assert _vertex(places, 3 * off, slopes, 0) == pytest.approx(0.25, rel=1e-12)
    assert _vertex(places, off, slopes, 0) != pytest.approx(0.25, rel=1e-2)


@pytest.mark.parametrize(("slopes", "expected"), [([0.0, -1.0], 2.0), ([1.0, 0.0], 3.0)])
def test_slope_that_is_zero_at_an_end(slopes: list[float], expected: float) -> None:
    """Assert that end."""
    assert _vertex(np.array([2.0, 3.0]), np.zeros(2), np.array(slopes), 0) == expected
