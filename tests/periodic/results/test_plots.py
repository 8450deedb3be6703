"""Pictures with matplotlib: units, legends and labels that cover nothing, and every kind of picture."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox
from support.kept import kept
from support.traces import disc, duffing

import periodic as per
import symbolic as sym
from periodic.results.plots.units import prefixed


@pytest.fixture
def axes() -> Axes:
    """Axes of a figure of their own."""
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    return figure.subplots()


@kept
def gears() -> per.Branch:
    """The gear pair: four folds and seven grazing points, some close together."""
    return per.trace(sym.scene("gear-pair"), "Omega", (0.4, 1.2), start=1.2)


def boxes(axes: Axes) -> list[Bbox]:
    """The texts that are drawn within the axes, as pixels."""
    renderer = FigureCanvasAgg(axes.figure.get_figure(root=True)).get_renderer()
    return [Text.get_window_extent(text, renderer) for text in axes.texts if text.get_visible()]


def curve(axes: Axes) -> np.ndarray:
    """Points along all lines, half a pixel apart."""
    found = []
    for line in axes.get_lines():
        at = axes.transData.transform(np.asarray(line.get_xydata(), dtype=float))
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(at, axis=0).T))])
        every = np.linspace(0, length[-1], int(2 * length[-1]) + 2)
        found.append(np.column_stack([np.interp(every, length, column) for column in at.T]))
    return np.vstack(found)


@pytest.mark.parametrize("size", [(7.0, 4.5), (4.0, 3.0)])
def test_texts_collide_with_nothing(axes: Axes, size: tuple[float, float]) -> None:
    """Assert that labels cover no curve, mark, label, legend or frame, and which are drawn."""
    figure = axes.figure
    assert isinstance(figure, Figure)
    figure.set_size_inches(*size)
    per.plot(gears(), axes=axes)
    figure.canvas.draw()
    drawn, line, legend = boxes(axes), curve(axes), axes.get_legend()
    assert legend is not None
    assert [t.get_text() for t in axes.texts] == [p.label for p in gears().special_points if p.label != "EP"]
    assert len(drawn) >= 9
    frame = legend.get_window_extent()
    inside = ((line > frame.min) & (line < frame.max)).all(axis=1)
    assert not inside.any()
    for k, box in enumerate(drawn):
        assert not ((line > box.min) & (line < box.max)).all(axis=1).any()
        assert not any(box.overlaps(other) for other in [*drawn[:k], frame])
        assert (box.min > axes.bbox.min).all() and (box.max < axes.bbox.max).all()


def test_legend_names_what_is_drawn(axes: Axes) -> None:
    """Assert entries for both stabilities and each kind of mark, once, of two branches too."""
    per.plot(gears(), axes=axes, label="gears")
    per.plot(duffing(at=(1.8,)), axes=axes, label="Duffing")
    legend = axes.get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names == [
        "gears",
        "unstable",
        "GR grazing",
        "PK peak or trough",
        "LP fold",
        "Duffing",
        "asked for",
    ]


def test_units(axes: Axes) -> None:
    """Assert units by their names, a pair, the prefix of what is small, and what is refused."""
    branch = disc(rpm=(290.0, 270.0), accuracy=per.Accuracy.DRAFT)
    per.plot(branch, axes=axes, units={"speed": "rev/min"})
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("speed (rev/min)", "x peak to peak (µm)")
    line = max(axes.get_lines(), key=lambda drawn: len(drawn.get_xdata()))
    x, y = np.asarray(line.get_xydata()).T
    assert [x.min(), x.max()] == pytest.approx([270.0, 290.0], rel=1e-12)
    assert y[0] == pytest.approx(1e6 * branch[0].peak_to_peak("x"), rel=1e-12)
    per.plot(branch, axes=axes, units={"x": ("thou", 25.4e-6)})
    assert axes.get_ylabel() == "x peak to peak (thou)"
    with pytest.raises(
        ValueError, match="^units has 'mm' for speed, which is in rad/s; it must be rev/min, "
    ):
        per.plot(branch, axes=axes, units={"speed": "mm"})
    with pytest.raises(ValueError, match="^units has 'sped'; its names must be among time, x, "):
        per.plot(branch, axes=axes, units={"sped": "Hz"})
    with pytest.raises(ValueError, match="^the SI value of thou is 0; it must be a positive number$"):
        per.plot(branch, axes=axes, units={"x": ("thou", 0)})


@pytest.mark.parametrize(
    ("value", "unit"), [(2e-7, "nm"), (3e-6, "µm"), (0.02, "mm"), (0.2, "m"), (2e3, "km"), (0.0, "m")]
)
def test_prefix(value: float, unit: str) -> None:
    """Assert the prefix of a length."""
    found = prefixed("m", [0.0, -value])
    assert found.text == unit
    assert 0.1 <= value / found.size < 1e3 or value == 0.0


def test_column_in_the_place_of_a_peak_to_peak(axes: Axes) -> None:
    """Assert a column by its name, with its unit."""
    branch = duffing()
    per.plot(branch, axes=axes, measure="x max")
    assert axes.get_ylabel() == "x max (m)"
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.get_lines()])
    assert np.isin(branch.column("x max"), drawn).all()


def test_orbit(axes: Axes) -> None:
    """Assert a signal over its period, with a line where the gears come into contact."""
    point = gears()[len(gears()) // 2]
    assert per.plots.orbit(point, axes=axes) is axes
    x, y = np.asarray(axes.get_lines()[0].get_xydata()).T
    assert len(x) == 1025
    assert x[-1] == pytest.approx(point.orbit.period) and y[0] == pytest.approx(y[-1], rel=1e-9)
    assert np.ptp(y) == pytest.approx(point.peak_to_peak("x"), rel=1e-4)
    places = [float(np.ravel(line.get_xdata())[0]) for line in axes.get_lines()[1:]]
    assert places == pytest.approx(np.unique(point.orbit.phases % (2 * np.pi)) / point.orbit.omega)


def test_signals_in_different_units(axes: Axes) -> None:
    """Assert one sentence."""
    with pytest.raises(ValueError, match=r"^names has x \(m\) and x' \(m/s\); signals in one picture must"):
        per.plots.orbit(duffing()[3], ["x", "x'"], axes=axes)


def test_phase_plane_is_in_SI(axes: Axes) -> None:
    """Assert dx/dt, not dx/dtau: the slope of x over time, and one dot for the period's beginning."""
    point = duffing()[5]
    per.plots.phase(point.orbit, axes=axes)
    line, dot = axes.get_lines()
    x, v = np.asarray(line.get_xydata()).T
    step = point.orbit.period / (len(x) - 1)
    assert v[1:-1] == pytest.approx((x[2:] - x[:-2]) / (2 * step), abs=1e-4 * np.abs(v).max())
    assert len(x) == 1025 and (x[-1], v[-1]) == pytest.approx((x[0], v[0]))
    assert axes.get_ylabel() == "x' (m/s)" and np.asarray(dot.get_xydata()).tolist() == [[x[0], v[0]]]


def test_spectrum(axes: Axes) -> None:
    """Assert amplitudes that give the motion's mean square (Parseval)."""
    orbit = duffing()[5].orbit
    per.plots.spectrum(orbit, axes=axes)
    orders, heights = np.asarray(axes.get_lines()[0].get_xydata()).T
    assert orders.tolist() == list(range(1, 21))
    x = orbit["x"](np.arange(4096) / 4096 * orbit.period)
    assert np.sum(heights**2) / 2 == pytest.approx(np.var(x), rel=1e-9)
    assert all(tick == round(tick) for tick in axes.get_xticks())


def test_what_cannot_be_drawn_is_refused(axes: Axes) -> None:
    """Assert one sentence for counts of harmonics, diagrams, curves and axes that are none."""
    with pytest.raises(ValueError, match="^harmonics is -3; it must be a whole number of at least 1$"):
        per.plots.spectrum(duffing()[5], axes=axes, harmonics=-3)
    with pytest.raises(ValueError, match="^harmonics is 0; it must be a whole number of at least 1$"):
        per.plots.waterfall(duffing(), axes=axes, harmonics=0)
    with pytest.raises(ValueError, match="^diagram is Branch.*; it must be what symbolic.campbell returns$"):
        per.plots.campbell(duffing(), axes)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="^curves is empty; it must have a branch that is traced with"):
        per.plots.regions([], axes)
    with pytest.raises(ValueError, match="^axes is a Figure; it must be one Axes of matplotlib$"):
        per.plot(duffing(), axes=axes.figure)  # type: ignore[arg-type]


def test_multipliers(axes: Axes) -> None:
    """Assert marks at the multipliers, in the colour of their stability, and large ones at the rim."""
    point = min(duffing(), key=lambda p: -np.abs(p.multipliers).max())
    per.plots.multipliers(point, axes)
    drawn = np.vstack([np.asarray(c.get_offsets()) for c in axes.collections])
    expected = sorted((m.real, m.imag) for m in point.multipliers if abs(m) <= 1.6)
    assert [pair for pair in expected if not np.isclose(drawn, pair).all(axis=1).any()] == []
    per.plots.multipliers(duffing(), axes)
    with pytest.raises(ValueError, match="^points is 3; it must be a Point, or a Branch that has points$"):
        per.plots.multipliers(3, axes)  # type: ignore[arg-type]


def test_waterfall(axes: Axes) -> None:
    """Assert frequencies in Hz above each value of the parameter."""
    branch = duffing()
    per.plots.waterfall(branch, axes=axes)
    rows = [c for c in axes.collections if isinstance(c, LineCollection)]
    assert 20 < len(rows) <= len(branch)
    for row in rows:
        (x, base), (_, tip) = row.get_segments()[0]
        assert x == pytest.approx(base / (2 * np.pi)) and tip > base
    assert axes.get_xlabel() == "frequency of x (Hz)"


def test_regions(axes: Axes) -> None:
    """Assert the curve of a fold in two parameters with its cusp; branches in one are refused."""
    system = sym.scene("duffing")
    fold = per.trace(system, "Omega", (0.8, 2.5), start=0.8).labelled("LP")[0]
    border = per.trace(system, "Omega", (0.9, 3.0), guess=fold.orbit, determined={"F": per.FoldCondition()})
    per.plots.regions(border, axes)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Omega (rad/s)", "F (N)")
    assert [text.get_text() for text in axes.texts] == ["CP"]
    with pytest.raises(
        ValueError, match="^a curve over Omega has no second parameter; it must be traced with"
    ):
        per.plots.regions(duffing(), axes)
    over_force = per.trace(
        system, "F", (0.5, 0.51), guess=fold.orbit, determined={"Omega": per.FoldCondition()}
    )
    with pytest.raises(
        ValueError, match=r"^curves are in the planes of \[\('F', 'Omega'\), \('Omega', 'F'\)\]"
    ):
        per.plots.regions([border, over_force], axes)
    with pytest.raises(ValueError, match="^curves is empty; it must have a branch"):
        per.plots.regions([], axes)


def test_campbell(axes: Axes) -> None:
    """Assert critical speeds where the first order meets the frequencies, in rev/min and Hz."""
    shaft = sym.shaft(length=1.0, diameter=0.05, elements=6, discs=[sym.ShaftDisc(3, 30.0, 0.3, 0.18)])
    stiff = np.asarray(shaft.K.todense() if hasattr(shaft.K, "todense") else shaft.K).copy()
    for k in (0, 1, -4, -3):
        stiff[k, k] += 1e7
    diagram = sym.campbell(sym.Matrices(shaft.M, shaft.C, stiff, G=shaft.G), np.linspace(1, 1000, 40), 4)
    per.plots.campbell(diagram, axes)
    marks = [line for line in axes.get_lines() if line.get_label() == "critical speeds"]
    x, y = np.asarray(marks[0].get_xydata()).T
    assert x == pytest.approx(diagram.critical() * 30 / np.pi) and y == pytest.approx(x / 60)
    assert axes.get_xlabel() == "speed (rev/min)" and len(x) >= 2


@pytest.mark.parametrize("draw", [per.plots.orbit, per.plots.phase, per.plots.spectrum])
def test_what_does_not_move_is_refused(draw: Callable[..., Axes], axes: Axes) -> None:
    """Assert one sentence for equilibria and for what is no orbit."""
    system = sym.compile(
        sym.Equations(lambda x, p: {"x": p.a - x.x}, states={"x": 0.0}, parameters={"a": 1.0})
    )
    still = per.trace(system, "a", (0.5, 1.5), start=1.0, method=per.Equilibrium())[0]
    with pytest.raises(ValueError, match="^orbit is an equilibrium; it has no motion to show$"):
        draw(still, axes=axes)
    with pytest.raises(ValueError, match="^orbit is 3; it must be an Orbit or a Point of a branch$"):
        draw(3, axes=axes)
    per.plots.multipliers(still, axes)
    assert axes.get_xlabel() == "real part (1/s)"


def test_rolling_bearing_tells_time() -> None:
    """Assert the passage of balls in s: the period is that of the cage over the number of balls."""
    bearing = sym.scene("ball-bearing")
    speed = 800.0
    branch = per.trace(
        bearing, "speed", (700.0, speed), start=speed, watch=per.Watch(stop={"UZ": 1}), at=[790.0]
    )
    orbit = branch[0].orbit
    cage = speed * 40.1 / (40.1 + 63.9)
    assert orbit.period == pytest.approx(2 * np.pi / (8 * cage), rel=1e-12)


def test_orders_and_critical_speeds_of_a_diagram(axes: Axes) -> None:
    """Assert each line up to the highest frequency, its name at its end, and marks where it is crossed."""
    diagram: Any = SimpleNamespace(
        speeds=np.array([10.0, 20.0, 30.0, 40.0]),
        frequencies=np.array([[30.0, 60.0]] * 4),
        damping=np.array([[0.1, 0.1], [0.1, 0.1], [0.1, -0.1], [0.1, -0.1]]),
        critical=lambda order: np.array([30.0, 60.0]) / order,
    )
    per.plots.campbell(diagram, axes, orders=(1.0, 2.0), units={"speed": "rad/s", "frequency": "rad/s"})
    named = {text.get_text(): text.get_position() for text in axes.texts}
    assert named == {"1x": (40.0, 40.0), "2x": (30.0, 60.0)}
    lines = axes.get_lines()
    drawn = [
        (line.get_linestyle(), line.get_marker(), np.asarray(line.get_xydata()).tolist()) for line in lines
    ]
    assert [at for style, _, at in drawn if style == "--"] == [
        [[10.0, 10.0], [20.0, 20.0], [30.0, 30.0], [40.0, 40.0]],
        [[10.0, 20.0], [20.0, 40.0], [30.0, 60.0]],
    ]
    assert [at for _, mark, at in drawn if mark == "o"] == [
        [[30.0, 30.0], [60.0, 60.0]],
        [[15.0, 30.0], [30.0, 60.0]],
    ]
    assert [at for _, mark, at in drawn if mark == "x"] == [[[30.0, 60.0], [40.0, 60.0]]]
    assert axes.get_xlim() == (10.0, 40.0)
