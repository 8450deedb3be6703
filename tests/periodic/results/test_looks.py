"""How pictures look: lines, marks, texts, legends and sizes of each, and what they are computed from."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

import periodic as per
import symbolic as sym
from periodic.results.plots import frame, marks
from periodic.results.plots.curve import PER_SEGMENT, draw_curve, runs, smooth
from periodic.results.plots.waterfall import _rows

BLUE, ORANGE = "#1f77b4", "#ff7f0e"
X = sym.coordinate("x")


@cache
def branch() -> per.Branch:
    """A linear oscillator, with a value that is asked for."""
    system = sym.compile(
        sym.Mass(X, 1.0) + sym.Damper(X, 0.2) + sym.Spring(X, 1.0) + sym.HarmonicForce(X, 1.0)
    )
    return per.trace(system, "Omega", (0.5, 0.6), at=(0.55,), tol=1e-4)


@pytest.fixture
def axes() -> Axes:
    """Axes of a figure of their own."""
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    return figure.subplots()


def lines(axes: Axes) -> list[tuple[Any, ...]]:
    """Style, width, mark and its size, colour and opacity of each line, in order, each once."""
    each = axes.get_lines()
    looks = [(q.get_linestyle(), q.get_linewidth(), q.get_marker(), q.get_markersize()) for q in each]
    colors = [(to_hex(q.get_color()), q.get_alpha()) for q in each]
    both = [(*look, *color) for look, color in zip(looks, colors, strict=True)]
    return list(dict.fromkeys(both))


DRAWN: dict[str, tuple[Callable[[], Axes], tuple[float, float], list[tuple[Any, ...]], list[float]]] = {
    "branch": (
        lambda: per.plot(branch()),
        (7.0, 4.5),
        [("-", 1.8, "None", 6.0, BLUE, None), ("None", 1.5, "o", 5.0, "#000000", None)],
        [],
    ),
    "orbit": (lambda: per.plots.orbit(branch()[0]), (7.0, 4.5), [("-", 1.8, "None", 6.0, BLUE, None)], []),
    "phase": (
        lambda: per.plots.phase(branch()[0]),
        (5.5, 4.5),
        [("-", 1.8, "None", 6.0, BLUE, None), ("None", 1.5, "o", 6.0, BLUE, None)],
        [],
    ),
    "spectrum": (
        lambda: per.plots.spectrum(branch()[0]),
        (7.0, 4.5),
        [("None", 1.5, "o", 4.0, BLUE, None)],
        [2.5],
    ),
    "waterfall": (
        lambda: per.plots.waterfall(branch()),
        (7.0, 5.0),
        [("-", 0.4, "None", 6.0, BLUE, 0.5), ("None", 1.5, "None", 6.0, BLUE, None)],
        [1.4],
    ),
    "multipliers": (
        lambda: per.plots.multipliers(branch()[0]),
        (4.8, 4.8),
        [("-", 0.8, "None", 6.0, "#000000", None)],
        [1.0],
    ),
}


@pytest.mark.parametrize("name", DRAWN)
def test_lines_and_size_of_a_picture(name: str) -> None:
    """Assert each kind of line that is drawn, the widths of collections, the size, and the grid."""
    draw, size, expected, widths = DRAWN[name]
    try:
        axes = draw()
        assert axes.figure.get_figure(root=True).get_size_inches().tolist() == list(size)  # type: ignore[union-attr]
        assert lines(axes) == expected
        assert sorted({width for c in axes.collections for width in np.ravel(c.get_linewidth())}) == widths
        assert axes.get_axisbelow() is True and axes.get_xgridlines()[0].get_alpha() == 0.25
    finally:
        plt.close("all")


def test_branch_that_loses_its_stability(axes: Axes) -> None:
    """Assert one line for each run, solid where stable, dashed where not, of one colour, named once."""
    x, y = np.arange(5.0), np.array([0.0, 1.0, 0.0, 1.0, 0.0])
    color = draw_curve(axes, x, y, np.array([True, True, False, True]))
    drawn = axes.get_lines()
    assert [line.get_linestyle() for line in drawn] == ["-", "--", "-"]
    assert {to_hex(line.get_color()) for line in drawn} == {color}
    assert [str(line.get_label()) for line in drawn][:2] == ["stable", "unstable"]
    assert str(drawn[2].get_label()).startswith("_")
    ends = [(line.get_xdata()[0], line.get_xdata()[-1]) for line in drawn]
    assert ends == [(0.0, 2.0), (2.0, 3.0), (3.0, 4.0)]
    assert [len(line.get_xdata()) for line in drawn] == [2 * PER_SEGMENT + 1] + [PER_SEGMENT + 1] * 2
    assert draw_curve(axes, x[:1], y[:1], np.zeros(0, bool), color="red") == "red"
    assert len(axes.get_lines()) == 3


@pytest.mark.parametrize(
    ("stable", "found"),
    [
        ([True, True], [(0, 3, True)]),
        ([True, False], [(0, 2, True), (1, 3, False)]),
        ([False, False, True], [(0, 3, False), (2, 4, True)]),
        ([], []),
    ],
)
def test_runs_of_equal_stability(stable: list[bool], found: list[tuple[int, int, bool]]) -> None:
    """Assert slices of points that share their ends."""
    each = runs(np.array(stable, dtype=bool))
    assert [(piece.start, piece.stop, kind) for piece, kind in each] == found


def test_curve_between_points() -> None:
    """Assert that it passes through them, is straight between points in line, and turns at a fold alone."""
    x, y = np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 6.0])
    across, up = smooth(x, y)
    assert len(across) == 2 * PER_SEGMENT + 1
    assert up == pytest.approx(2 * across) and across[[0, PER_SEGMENT, -1]].tolist() == [0.0, 1.0, 3.0]
    assert np.diff(across)[:PER_SEGMENT] == pytest.approx(1 / PER_SEGMENT)
    fold, _ = smooth(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 2.0]))
    assert fold.max() == 1.0 and (np.diff(fold)[:PER_SEGMENT] > 0).all()
    assert (np.diff(fold)[PER_SEGMENT:] < 0).all()
    point, _ = smooth(np.array([2.0, 2.0]), np.array([3.0, 3.0]))
    assert point == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("values", "step", "rows"),
    [
        ([0.0, 0.4, 1.0, 1.5, 2.0], 1.0, [0, 2, 4]),
        ([0.0, 0.4, 1.0, 1.5, 1.9], 1.0, [0, 2, 4]),
        ([0.0, 1.0, 0.0], 1.0, [0, 1, 2]),
        ([2.0, 1.5, 1.0], 0.5, [0, 1, 2]),
        ([1.0], 0.5, [0]),
    ],
)
def test_rows_of_a_waterfall(values: list[float], step: float, rows: list[int]) -> None:
    """Assert points a step apart along the branch, both ends included."""
    assert _rows(np.array(values), step) == rows


def test_heights_of_a_waterfall(axes: Axes) -> None:
    """Assert that the largest line is eight rows high, the others in proportion, from their parameter on."""
    per.plots.waterfall(branch(), axes=axes, harmonics=2, units={"Omega": "rad/s"})
    first = [np.array(c.get_segments()) for c in axes.collections]
    heights = np.array([s[0, 1, 1] - s[0, 0, 1] for s in first])
    assert heights.max() == pytest.approx(8 * 0.1 / 40)
    peaks = np.array([branch()[k].peak_to_peak("x") for k in _rows(branch().values, 0.1 / 40)])
    assert heights / heights.max() == pytest.approx(peaks / peaks.max(), rel=1e-3)
    for segments, point in zip(first, [branch()[k] for k in _rows(branch().values, 0.1 / 40)], strict=True):
        assert segments[:, 0, 0] == pytest.approx(np.array([1, 2]) * point.parameter / (2 * np.pi))
        assert segments[0, 0, 1] == pytest.approx(point.parameter)
    assert axes.get_xlim()[0] == 0.0


def of(*multipliers: complex, equilibrium: bool = False) -> Any:
    """A point of a branch with multipliers."""
    point = object.__new__(per.Point)
    orbit = SimpleNamespace(equilibrium=equilibrium)
    spectrum = SimpleNamespace(multipliers=np.array(multipliers, dtype=complex))
    object.__setattr__(point, "orbit", orbit)
    object.__setattr__(point, "multipliers", spectrum.multipliers)
    return point


def test_multipliers_beyond_the_rim(axes: Axes) -> None:
    """Assert that one beyond 1.6 is drawn there with its modulus, one up to it at its place."""
    per.plots.multipliers(of(0.5, 1.0, 1.5j, -3.2, 0.0), axes)
    drawn = {str(c.get_label()): np.asarray(c.get_offsets()).tolist() for c in axes.collections}
    assert drawn["stable"] == [[0.5, 0.0], [1.0, 0.0], [0.0, 0.0]]
    assert drawn["unstable"] == [[0.0, 1.5], [pytest.approx(-1.6), pytest.approx(0.0)]]
    (text,) = axes.texts
    assert text.get_text() == "|µ| = 3.2" and text.xy == pytest.approx((-1.6, 0.0))  # type: ignore[attr-defined]
    assert (text.get_ha(), text.get_position()) == ("center", (0, 7))
    assert [c.get_sizes().tolist() for c in axes.collections] == [[36.0]] * 2  # type: ignore[attr-defined]
    assert [to_hex(c.get_facecolor()[0]) for c in axes.collections] == [BLUE, ORANGE]  # type: ignore[index]


def test_multipliers_that_move(axes: Axes) -> None:
    """Assert that later marks are darker, from a quarter on, and that the farthest of all is named."""
    per.plots.multipliers([of(0.5), of(2.0), of(4.0)], axes)  # type: ignore[arg-type]
    opacity = {str(c.get_label()): np.ravel(c.get_alpha()).tolist() for c in axes.collections}
    assert opacity == {"stable": [0.25], "unstable": [0.625, 1.0]}
    assert [text.get_text() for text in axes.texts] == ["|µ| = 4"]


def test_eigenvalues_beside_the_imaginary_axis(axes: Axes) -> None:
    """Assert that those of equilibria are at their places, unstable from 0 on."""
    per.plots.multipliers(of(-3.0 + 2.0j, 0.0, 5.0, equilibrium=True), axes)
    drawn = {str(c.get_label()): np.asarray(c.get_offsets()).tolist() for c in axes.collections}
    assert drawn == {"stable": [[-3.0, 2.0]], "unstable": [[0.0, 0.0], [5.0, 0.0]]}
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("real part (1/s)", "imaginary part (1/s)")
    assert [np.ravel(line.get_xdata()).tolist() for line in axes.get_lines()] == [[0.0, 0.0]]
    assert not axes.texts


@pytest.mark.parametrize(
    ("label", "event", "name", "text"),
    [(k, "", f"{k} {meaning}", k) for k, (_, meaning) in marks.KINDS.items()]
    + [
        ("UZ", "", "asked for", None),
        ("UZ", "loud", "loud", "loud"),
        ("", "loud", "loud", "loud"),
        ("EP", "limit", "EP limit", "limit"),
        ("", "", None, None),
        ("EP", "", None, None),
        ("XX", "mine", "XX mine", "XX"),
        ("UZ", "a$b", r"a\$b", "a$b"),
    ],
)
def test_mark_of_a_special_point(
    axes: Axes, label: str, event: str, name: str | None, text: str | None
) -> None:
    """Assert what the legend says of it, its sign, and its text; a second one is not named again."""
    axes.plot([0.0, 1.0], [0.0, 1.0])
    marks.mark(axes, [(label, event, 0.5, 0.5), (label, event, 0.6, 0.6)])
    found = axes.get_lines()[1:]
    assert [t.get_text() for t in axes.texts] == ([] if text is None else [text] * 2)
    if name is None:
        assert not found
        return
    first, second = found
    assert first.get_label() == name and str(second.get_label()) in ("", "_child2")
    ring = label in ("", "UZ")
    assert first.get_marker() == ("o" if ring else marks.KINDS.get(label, ("P", ""))[0])
    assert (first.get_markerfacecolor() == "none") is ring
    assert (first.get_markersize(), first.get_zorder()) == (5.0, 3)


def test_signs_of_kinds_tell_them_apart() -> None:
    """Assert that kinds that are met on one branch have signs of their own."""
    simple = ["LP", "PD", "NS", "BP", "HB", "GR", "MX"]
    assert len({marks.KINDS[label][0] for label in simple}) == len(simple)


@pytest.mark.parametrize("names", [1, 2, 5, 9])
def test_legend_above_the_curves(axes: Axes, names: int) -> None:
    """Assert columns of 105 pt in 85 % of the width, and rows of 14 pt and 4 more left free above."""
    for k in range(names):
        axes.plot([0.0, 1.0], [0.0, 1.0], label=f"curve {k}")
    width, height = (0.85 * 72 / axes.figure.dpi * side for side in (axes.bbox.width, axes.bbox.height))
    frame.dressed(axes, "across", "up")
    legend = axes.get_legend()
    assert legend is not None
    columns = int(min(names, width // 105))
    assert legend._ncols == columns and legend.get_frame_on() is False
    free = (14 * -(-names // columns) + 4) / height
    assert axes.get_ylim() == pytest.approx((-0.05, 1 + 1.05 * free / (1 - free)))
    assert (legend.borderaxespad, legend.handlelength, legend.columnspacing) == (0.2, 1.6, 1.2)
    frame.dressed(axes, "across", "up", least=names + 1)


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        ((1.0, 3.0), (0.9, 3.0 + 1.05 * 2 / 3)),
        ((2.0, 2.0), (1.9, 2.0 + 1.05 * 2 / 3)),
        ((0.0, 0.0), (-0.05, 1.05 / 3)),
    ],
)
def test_headroom(axes: Axes, values: tuple[float, float], limits: tuple[float, float]) -> None:
    """Assert a quarter of the height left free above, 5 % below; at most half is."""
    axes.plot([0.0, 1.0], values)
    frame.headroom(axes, 0.25)
    span = 2.0 if values != (0.0, 0.0) else 1.0
    assert axes.get_ylim() == pytest.approx((values[0] - 0.05 * span, values[1] + 1.05 * span / 3))
    assert axes.get_ylim() == pytest.approx(limits)
    frame.headroom(axes, 0.9)
    assert axes.get_ylim()[1] == pytest.approx(values[1] + 1.05 * span)
