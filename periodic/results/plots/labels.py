"""The names of special points in a picture: each beside its point, where it covers nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.text import Annotation, Text
from matplotlib.transforms import Bbox

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DISTANCES = (5.0, 9.0, 14.0, 22.0, 32.0, 45.0, 60.0)
"""How far a text is from its point (pt): the nearest place that is free is taken."""

DIRECTIONS = np.pi / 180 * np.array([60, 120, -60, -120, 30, 150, -30, -150, 90, -90, 0, 180])
LEADER = 12.0
"""From this distance on a thin line leads to the point (pt)."""

SPACING = 3.0
"""Distance between the points that stand for a curve (pixels)."""


def placed(axes: Axes) -> Labels:
    """Return the labels of axes, made if there are none yet."""
    for child in axes.get_children():
        if isinstance(child, Labels):
            return child
    labels = Labels(axes)
    axes.add_artist(labels)
    return labels


class Labels(Artist):
    """Texts beside points. They find their places whenever the picture is drawn, at its size and limits.

    A text whose point is out of sight, and one for which no place is free, is not drawn.
    """

    def __init__(self, within: Axes) -> None:
        super().__init__()
        self._within = within
        self.set_zorder(2.9)  # after the curves, before the texts
        self.set_in_layout(False)
        self._texts: list[Annotation] = []

    def add(self, text: str, at: tuple[float, float]) -> None:
        """Add a text beside a point, in the coordinates of the data."""
        leader = {"arrowstyle": "-", "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 3.0, "alpha": 0.6}
        annotation = self._within.annotate(
            text,
            at,
            xytext=(0, 0),
            textcoords="offset points",
            fontsize="small",
            horizontalalignment="center",
            verticalalignment="center",
            arrowprops=leader,
            parse_math=False,
        )
        annotation.set_in_layout(False)
        self._texts.append(annotation)

    def draw(self, renderer: Any) -> None:
        """Give every text its place; the axes draw them after this."""
        axes = self._within
        point = renderer.points_to_pixels(1.0)
        at = axes.transData.transform(np.array([t.xy for t in self._texts], dtype=float).reshape(-1, 2))
        curves = _pixels(axes)
        taken = [Bbox.from_bounds(x - 4 * point, y - 4 * point, 8 * point, 8 * point) for x, y in at]
        legend = axes.get_legend()
        if legend is not None:
            taken.append(legend.get_window_extent(renderer))
        done: list[tuple[str, np.ndarray]] = []
        for text, where in zip(self._texts, at, strict=True):
            near = {other for other, there in done if np.hypot(*(where - there)) < 4 * point}
            hidden = text.get_text() in near or not axes.bbox.contains(*where)
            free = None if hidden else _free(text, where, taken, curves, renderer)
            text.set_visible(free is not None)
            if free is not None:
                offset, box = free
                text.xyann = tuple(offset / point)
                if text.arrow_patch is not None:
                    text.arrow_patch.set_visible(_gap(box, where) > LEADER * point)
                taken.append(box)
                done.append((text.get_text(), where))
        self.stale = False


def _free(
    text: Annotation, where: np.ndarray, taken: list[Bbox], curves: np.ndarray, renderer: Any
) -> tuple[np.ndarray, Bbox] | None:
    """Return the nearest free place of a text: its offset from the point, in pixels, and its box."""
    assert text.axes is not None
    point, frame = renderer.points_to_pixels(1.0), text.axes.bbox
    extent = Text.get_window_extent(text, renderer)
    half = np.array([extent.width, extent.height]) / 2
    for distance in DISTANCES:
        for angle in DIRECTIONS:
            way = np.array([np.cos(angle), np.sin(angle)])
            offset = distance * point * way + half * np.clip(1.5 * way, -1, 1)
            low, high = where + offset - half - point, where + offset + half + point
            inside = (low > frame.min).all() and (high < frame.max).all()
            if not inside or ((curves > low) & (curves < high)).all(axis=1).any():
                continue
            box = Bbox([low, high])
            if not any(box.overlaps(other) for other in taken):
                return offset, box
    return None


def _gap(box: Bbox, where: np.ndarray) -> float:
    """Distance of a point from a box."""
    return float(np.hypot(*np.maximum(np.maximum(box.min - where, where - box.max), 0.0)))


def _pixels(axes: Axes) -> np.ndarray:
    """Points along all curves of axes, a few pixels apart, shape (points, 2)."""
    found = [np.empty((0, 2))]
    for line in axes.get_lines():
        drawn = line.get_transform().transform(np.asarray(line.get_xydata(), dtype=float))
        drawn = drawn[np.isfinite(drawn).all(axis=1)]
        if len(drawn) > 1 and line.get_linestyle() != "None":
            length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(drawn, axis=0).T))])
            every = np.linspace(0, length[-1], min(int(length[-1] / SPACING) + 2, 20000))
            drawn = np.column_stack([np.interp(every, length, column) for column in drawn.T])
        found.append(drawn)
    return np.vstack(found)
