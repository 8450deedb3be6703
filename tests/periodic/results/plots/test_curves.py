"""Curves, marks and texts of pictures, by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from periodic.results.plots import curve, frame, labels
from periodic.results.plots.curve import draw_curve, runs, smooth
from periodic.results.plots.marks import mark


@pytest.fixture
def axes() -> Axes:
    """Axes of 600 by 400 pixels from 0 to 6 and 0 to 4, at 72 dots an inch: a pixel is a point."""
    figure = Figure(figsize=(600 / 72, 400 / 72), dpi=72)
    FigureCanvasAgg(figure)
    axes: Axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0, 6)
    axes.set_ylim(0, 4)
    return axes


@pytest.mark.parametrize(
    ("stable", "expected"),
    [
        ([True], [(0, 2, True)]),
        ([True, True, False, False, True], [(0, 3, True), (2, 5, False), (4, 6, True)]),
        ([False, True], [(0, 2, False), (1, 3, True)]),
        ([], []),
    ],
)
def test_runs_of_equal_stability(stable: list[bool], expected: list[tuple[int, int, bool]]) -> None:
    """Assert slices of points, of which neighbours share one."""
    found = runs(np.array(stable, dtype=bool))
    assert [(part.start, part.stop, kind) for part, kind in found] == expected


def test_smooth_curves_pass_through_their_points() -> None:
    """Assert eight pieces a segment, straight on a line, and no turn but at a point."""
    x, y = np.array([0.0, 1.0, 3.0]), np.array([2.0, 4.0, 8.0])
    across, up = smooth(x, y)
    assert len(across) == 2 * curve.PER_SEGMENT + 1
    assert across[::8].tolist() == x.tolist() and up[::8].tolist() == y.tolist()
    assert up == pytest.approx(2 + 2 * across) and (np.diff(across) > 0).all()
    assert across[4] == pytest.approx(0.5) and across[12] == pytest.approx(2.0)
    turning, _ = smooth(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 2.0]))
    assert turning.max() == 1.0 and turning.argmax() == 8
    same, _ = smooth(np.array([1.0, 1.0]), np.array([2.0, 2.0]))
    assert same.tolist() == [1.0] * 9


def test_lines_of_a_curve(axes: Axes) -> None:
    """Assert solid and dashed lines of one colour, of which the first of a kind has a name."""
    x = np.arange(5.0)
    colour = draw_curve(axes, x, x, np.array([True, False, False, True]))
    found = axes.get_lines()
    assert [line.get_linestyle() for line in found] == ["-", "--", "-"]
    assert [str(line.get_label()) for line in found][:2] == ["stable", "unstable"]
    assert str(found[2].get_label()).startswith("_") and {line.get_color() for line in found[1:]} == {colour}
    assert [np.asarray(line.get_xdata())[[0, -1]].tolist() for line in found] == [[0, 1], [1, 3], [3, 4]]
    assert {line.get_linewidth() for line in found} == {1.8}
    draw_curve(axes, x, x, np.ones(4, dtype=bool), color="#123456", labels=("a", ""), linewidth=0.5)
    last = axes.get_lines()[-1]
    assert (last.get_color(), last.get_label(), last.get_linewidth()) == ("#123456", "a", 0.5)
    assert draw_curve(axes, x[:1], x[:1], np.ones(0, dtype=bool), color="red") == "red"
    assert len(axes.get_lines()) == 4


def test_points_along_curves(axes: Axes) -> None:
    """Assert them three pixels apart on lines, and markers as they are; nothing that is not finite."""
    assert labels._pixels(axes).shape == (0, 2)
    axes.plot([1.0, 1.0, np.nan], [1.0, 2.0, 3.0])
    found = labels._pixels(axes)
    assert found[:, 0] == pytest.approx(100.0) and found[[0, -1], 1] == pytest.approx([100.0, 200.0])
    assert len(found) == int(100 / labels.SPACING) + 2
    axes.plot([2.0, 3.0], [1.0, 1.0], linestyle="None", marker="o")
    axes.plot([5.0], [3.0])
    more = labels._pixels(axes)[len(found) :]
    assert more == pytest.approx(np.array([[200.0, 100.0], [300.0, 100.0], [500.0, 300.0]]))


def test_distance_from_a_box() -> None:
    """Assert it beside, above and at a corner, and 0 inside."""
    box = Bbox([[10.0, 20.0], [30.0, 40.0]])
    given = ([13.0, 25.0], [7.0, 30.0], [35.0, 30.0], [20.0, 48.0], [7.0, 16.0], [33.0, 44.0])
    assert [labels._gap(box, np.array(at)) for at in given] == [0.0, 3.0, 5.0, 8.0, 5.0, 5.0]


def drawn(axes: Axes) -> None:
    """Draw axes, so that texts are in their places."""
    axes.set_axis_off()
    canvas: Any = axes.figure.canvas
    canvas.draw()


def test_places_of_texts(axes: Axes) -> None:
    """Assert that one is shown of two alike at one point, none out of sight, and both of others."""
    texts = labels.placed(axes)
    assert labels.placed(axes) is texts
    for text, at in (
        ("LP", (3.0, 2.0)),
        ("LP", (3.03, 2.0)),
        ("LP", (3.05, 2.0)),
        ("PD", (3.0, 2.0)),
        ("NS", (7.0, 2.0)),
        ("NS", (1.0, -1.0)),
    ):
        texts.add(text, at)
    drawn(axes)
    assert [text.get_visible() for text in texts._texts] == [True, False, True, True, False, False]
    boxes = [Text.get_window_extent(t) for t in texts._texts if t.get_visible()]
    first = texts._texts[0]
    at, away = np.array([300.0, 200.0]), np.array(first.xyann)
    assert away[0] > 0 and away[1] > 0 and np.hypot(*away) < 30
    assert not first.arrow_patch.get_visible()
    for k, one in enumerate(boxes):
        assert not any(one.overlaps(other) for other in boxes[k + 1 :]) and not one.contains(*at)


def test_texts_go_out_of_the_way_of_curves(axes: Axes) -> None:
    """Assert a leader to a text that is far from its point, and none where there is no place at all."""
    texts = labels.placed(axes)
    texts.add("LP", (3.0, 2.0))
    for y in np.linspace(1.7, 2.3, 25):
        axes.plot([2.5, 3.5], [y, y])
    drawn(axes)
    (text,) = texts._texts
    assert text.get_visible() and text.arrow_patch.get_visible()
    box = Text.get_window_extent(text)
    assert labels._gap(box, np.array([300.0, 200.0])) > labels.LEADER
    pixels = labels._pixels(axes)
    assert not ((pixels > box.min) & (pixels < box.max)).all(axis=1).any()
    for y in np.linspace(0.0, 4.0, 160):
        axes.plot([0.0, 6.0], [y, y])
    drawn(axes)
    assert not text.get_visible()


def test_texts_stay_within_the_axes(axes: Axes) -> None:
    """Assert it in every corner."""
    texts = labels.placed(axes)
    for x in (0.03, 5.97):
        for y in (0.03, 3.97):
            texts.add("a long text", (x, y))
    drawn(axes)
    for text in texts._texts:
        box = Text.get_window_extent(text)
        assert text.get_visible()
        assert box.x0 > 0 and box.y0 > 0 and box.x1 < 600 and box.y1 < 400


def test_marks_of_special_points(axes: Axes) -> None:
    """Assert signs, names once each, rings where a value was asked for, and texts; none of ends."""
    points = [
        ("LP", "", 1.0, 1.0),
        ("LP", "", 2.0, 1.0),
        ("UZ", "", 3.0, 1.0),
        ("", "peak", 4.0, 1.0),
        ("EP", "", 5.0, 1.0),
        ("EP", "begin", 5.0, 2.0),
        ("", "", 5.5, 1.0),
        ("CP", "mine", 1.0, 2.0),
    ]
    mark(axes, points)
    lines = axes.get_lines()
    assert [float(np.asarray(line.get_xdata())[0]) for line in lines] == [1.0, 2.0, 3.0, 4.0, 5.0, 1.0]
    assert [line.get_marker() for line in lines[2:4]] == ["o", "o"]
    assert [line.get_markerfacecolor() == "none" for line in lines] == [
        False,
        False,
        True,
        True,
        False,
        False,
    ]
    named = [str(line.get_label()) for line in lines]
    assert named[0].startswith("LP ") and named[1] == "" and named[2:4] == ["asked for", "peak"]
    assert named[5] == "CP cusp"
    assert [t.get_text() for t in labels.placed(axes)._texts] == ["LP", "LP", "peak", "begin", "CP"]


@pytest.mark.parametrize(
    ("heights", "free", "limits"),
    [([1.0, 3.0], 0.2, (0.9, 3.525)), ([2.0, 2.0], 0.5, (1.9, 4.1)), ([0.0, 0.0], 0.5, (-0.05, 1.05))],
)
def test_room_above_curves(
    axes: Axes, heights: list[float], free: float, limits: tuple[float, float]
) -> None:
    """Assert a twentieth of the height below, and a part of the axes above; of one height its own size."""
    axes.plot([0.0, 1.0], heights)
    frame.headroom(axes, free)
    assert axes.get_ylim() == pytest.approx(limits)
    frame.headroom(axes, 0.9)
    half = (heights[1] - heights[0]) or abs(heights[1]) or 1.0
    assert axes.get_ylim()[1] == pytest.approx(heights[1] + 1.05 * half)


def test_no_room_above_logarithmic_curves(axes: Axes) -> None:
    """Assert that their limits stay."""
    axes.plot([0.0, 1.0], [1.0, 3.0])
    axes.set_yscale("log")
    axes.set_ylim(0.5, 5.0)
    frame.headroom(axes, 0.2)
    assert axes.get_ylim() == (0.5, 5.0)


@pytest.mark.parametrize(
    ("names", "least", "shown"), [(0, 1, False), (1, 1, True), (1, 2, False), (2, 2, True)]
)
def test_legends(axes: Axes, names: int, least: int, shown: bool) -> None:
    """Assert one from so many names on, and what the axes say, dollars and all."""
    axes.plot([0.0, 1.0], [0.0, 1.0], label="_hidden")
    for k in range(names):
        axes.plot([0.0, 1.0], [0.0, 1.0], label=f"n{k}")
        axes.plot([0.0, 1.0], [0.0, 1.0], label=f"n{k}")
    assert frame.dressed(axes, "a $x$", "b", least=least) is axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("a $x$", "b")
    legend = axes.get_legend()
    assert (legend is not None) is shown
    if legend is not None:
        assert [text.get_text() for text in legend.get_texts()] == [f"n{k}" for k in range(names)]
    assert frame.plain("a$b") == r"a\$b"


def test_axes_that_are_none(axes: Axes) -> None:
    """Assert the sentence, and that axes are taken as they are."""
    assert frame.fresh(axes) is axes
    wrong: Any = [axes]
    with pytest.raises(ValueError, match="^axes is a list; it must be one Axes of matplotlib$"):
        frame.fresh(wrong)
