"""An orbit of closed form in time, in its phase plane and as a spectrum."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from support.numpy_systems import Quantity
from support.surfaces import Surfaces, along

from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.results.plots import orbitplots
from periodic.results.plots.orbitplots import moving, spectrum

OMEGA = 2.0


@pytest.fixture
def axes() -> Axes:
    """Axes of a figure of their own."""
    figure = Figure()
    FigureCanvasAgg(figure)
    return figure.subplots()


def orbit(*nodes: tuple[EventNode, float]) -> Orbit:
    """x = 2 + 3 cos tau + 0.5 sin 3 tau in mm, x' its rate, and y in mm, at 2 rad/s."""

    def states(tau: Any) -> Any:
        x = 2 + 3 * np.cos(tau) + 0.5 * np.sin(3 * tau)
        return np.column_stack([x, -3 * np.sin(tau) + 1.5 * np.cos(3 * tau), np.sin(tau), np.cos(tau)])

    system: Any = Surfaces([], [[1.0, 0.0, 0.0, 0.0]])
    names = ("x", "x'", "y", "y'")
    system.states = tuple(Quantity(name, "m", 1e-3) for name in names)
    found = along(states, nodes, intervals=60)
    return replace(
        found, parameter=np.array([OMEGA]), layout=replace(layout_of(system), frequency=("Omega",))
    )


@pytest.mark.parametrize("harmonics", [1, 3, 5])
def test_amplitudes_of_harmonics(harmonics: int) -> None:
    """Assert 3 and 0.5 mm of the first and the third, at multiples of the excitation's frequency."""
    orders, amplitudes = spectrum(orbit(), "x", harmonics)
    assert orders.tolist() == list(range(1, harmonics + 1))
    assert amplitudes == pytest.approx([3e-3, 0, 0.5e-3, 0, 0][:harmonics], abs=1e-8)


@pytest.mark.parametrize("harmonics", [0, -1, 2.0, "3", None])
def test_numbers_of_harmonics_that_are_none(harmonics: Any) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError, match="^harmonics is .*; it must be a whole number of at least 1$"):
        spectrum(orbit(), "x", harmonics)


def test_spectrum_as_drawn(axes: Axes) -> None:
    """Assert heights in mm on a logarithmic scale, those that are none a billionth of the largest."""
    orbitplots.plot_spectrum(orbit(), axes=axes, harmonics=4)
    (dots,) = axes.get_lines()
    assert np.asarray(dots.get_xdata()).tolist() == [1, 2, 3, 4]
    heights = np.asarray(dots.get_ydata())
    assert heights[[0, 2]] == pytest.approx([3.0, 0.5], rel=1e-4)
    assert axes.get_yscale() == "log" and axes.get_ylim()[0] == pytest.approx(3e-9, rel=1e-4)
    assert axes.get_ylabel() == "amplitude of x (mm)" and heights.min() >= 3e-9 * 0.999


def test_signals_over_time(axes: Axes) -> None:
    """Assert displacements in mm over a period of pi s, lines where the equations bend."""
    given = orbit((EventNode(0, 1), 1.0), (EventNode(0, -1), 4.0))
    orbitplots.plot_orbit(given, axes=axes)
    x, y, *events = axes.get_lines()
    times = np.asarray(x.get_xdata())
    assert len(times) == orbitplots.SAMPLES + 1 and times[[0, -1]] == pytest.approx([0.0, np.pi])
    exact = 2 + 3 * np.cos(2 * times) + 0.5 * np.sin(6 * times)
    assert np.asarray(x.get_ydata()) == pytest.approx(exact, abs=1e-3)
    assert np.asarray(y.get_ydata()) == pytest.approx(np.sin(2 * times), abs=1e-3)
    assert [float(np.asarray(line.get_xdata())[0]) for line in events] == pytest.approx([0.5, 2.0])
    assert axes.get_xlim() == pytest.approx((0.0, np.pi))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (s)", "x, y (mm)")
    assert [line.get_linewidth() for line in (x, y)] == [1.8, 1.8]


def test_units_over_time(axes: Axes) -> None:
    """Assert those that are asked for, of both signals and of time, and the sentence where they differ."""
    orbitplots.plot_orbit(orbit(), ["y", "x"], axes, units={"x": "um", "y": "um", "time": ("T", np.pi)})
    y, _ = axes.get_lines()
    assert np.abs(np.asarray(y.get_ydata())).max() == pytest.approx(1000, rel=1e-3)
    assert axes.get_xlim() == pytest.approx((0.0, 1.0)) and axes.get_xlabel() == "time (T)"
    with pytest.raises(ValueError, match=r"^names has x \(um\) and y \(mm\); signals in one picture must"):
        orbitplots.plot_orbit(orbit(), ["x", "y"], axes, units={"x": "um"})
    with pytest.raises(ValueError, match=r"^names has x \(mm\) and x' \("):
        orbitplots.plot_orbit(orbit(), ["x", "x'"], axes)


def test_phase_plane(axes: Axes) -> None:
    """Assert displacement and velocity in SI, a dot where the period begins, and signals of choice."""
    orbitplots.plot_phase(orbit(), axes=axes)
    line, dot = axes.get_lines()
    assert len(np.asarray(line.get_xdata())) == orbitplots.SAMPLES + 1
    assert np.asarray(dot.get_xdata()) == pytest.approx([5.0], abs=1e-3)
    assert np.asarray(dot.get_ydata()) == pytest.approx([3.0], abs=1e-2)
    assert np.asarray(line.get_xdata())[[0, -1]] == pytest.approx([5.0, 5.0], abs=1e-3)
    assert (line.get_linewidth(), dot.get_marker(), dot.get_color()) == (1.8, "o", line.get_color())
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (mm)", "x' (mm/s)")
    orbitplots.plot_phase(orbit(), "y", "x", axes)
    assert np.asarray(axes.get_lines()[-1].get_xdata()) == pytest.approx([0.0], abs=1e-3)
    assert np.asarray(axes.get_lines()[-1].get_ydata()) == pytest.approx([5.0], abs=1e-3)


def test_what_has_no_motion_to_show() -> None:
    """Assert the sentences for equilibria, orbits without names and what is no orbit."""
    assert moving(orbit()).omega == OMEGA
    wrong: Any = "x"
    for given, said in (
        (wrong, "orbit is 'x'; it must be an Orbit or a Point of a branch$"),
        (replace(orbit(), equilibrium=True), "orbit is an equilibrium; it has no motion to show$"),
    ):
        with pytest.raises(ValueError, match=f"^{said}"):
            moving(given)
    with pytest.raises(ValueError, match="^orbit has no names; it must have been traced, or sampled for a"):
        orbitplots.shown_of(replace(orbit(), layout=None), None)
