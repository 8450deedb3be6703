"""What a picture shows: values asked for, time integration by the parameter's name, a legend beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from support.traces import duffing

import periodic as per
import symbolic as sym
from reports.app import drawing
from reports.app.trace import picture
from symbolic.scenes.reading import load


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """The figures that are written."""
    kept: list[Figure] = []
    original = drawing.write

    def write(path: Path, figure: Figure, *others: object) -> None:
        kept.append(figure)
        original(path, figure, *others)  # type: ignore[arg-type]

    monkeypatch.setattr(picture, "write", write)
    return kept


@pytest.fixture
def drawn(tmp_path: Path, kept: list[Figure]) -> Figure:
    """The figure of a branch with two values asked for and what time integration settles to."""
    branch = duffing(at=(0.8, 1.7))
    picture.draw(tmp_path / "branch.png", load("duffing"), branch, ([(1.0, 0.9)], [(1.0, 0.9), (0.9, 0.8)]))
    return kept[0]


def test_values_asked_for_are_drawn(drawn: Figure) -> None:
    """Assert a mark at each point of --at, on every sheet."""
    (line,) = [line for line in drawn.axes[0].lines if line.get_label() == "values asked for"]
    assert np.asarray(line.get_xdata()).tolist() == [0.8, 1.7, 1.7, 1.7]


def test_time_integration_is_named_by_the_parameter(drawn: Figure) -> None:
    """Assert that an axis in rad/s is not said to be a speed."""
    names = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert {"time integration, frequency rising", "time integration, frequency falling"} < set(names)


def test_legend_covers_nothing(drawn: Figure) -> None:
    """Assert that the legend lies outside the axes."""
    assert not drawn.legends[0].get_window_extent().overlaps(drawn.axes[0].get_window_extent())


def test_names_of_special_points_cover_nothing(tmp_path: Path, kept: list[Figure]) -> None:
    """Assert that texts are apart and within the axes where ten special points are close together."""
    scene = load("gear-pair")
    branch = per.trace(sym.scene("gear-pair"), "Omega", (0.4, 1.2), start=1.2)
    picture.draw(tmp_path / "branch.png", scene, branch)
    kept[0].canvas.draw()
    axes = kept[0].axes[0]
    boxes = [Text.get_window_extent(text) for text in axes.texts if text.get_visible()]
    assert len(boxes) >= 9
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k])
        assert (box.min > axes.bbox.min).all() and (box.max < axes.bbox.max).all()
