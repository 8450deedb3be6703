"""The curve of a branch in a figure: smooth between its points, solid where stable and dashed where not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from periodic.system.precision import SMALLEST

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PER_SEGMENT = 8
"""Straight pieces that are drawn between two computed points."""


def draw_curve(
    axes: Axes,
    across: np.ndarray,
    up: np.ndarray,
    stable: np.ndarray,
    *,
    color: str | None = None,
    labels: tuple[str, str] = ("stable", "unstable"),
    linewidth: float = 1.8,
) -> str | None:
    """Draw a curve through points, one line for each run of equal stability, and return its colour.

    `stable` tells each segment's kind; an empty label leaves its lines out of the legend. Without a colour it
    is the next one of the axes.
    """
    if len(across) < 2:
        return color
    from matplotlib.colors import to_hex

    across, up = smooth(across, up)
    named: set[bool] = set()
    for piece, kind in runs(stable):
        part = slice(PER_SEGMENT * piece.start, PER_SEGMENT * (piece.stop - 1) + 1)
        label = labels[not kind] if kind not in named else ""
        (line,) = axes.plot(
            across[part],
            up[part],
            "-" if kind else "--",
            color=color,
            linewidth=linewidth,
            label=label or None,
        )
        named.add(kind)
        color = color or to_hex(line.get_color())
    return color


def runs(stable: np.ndarray) -> list[tuple[slice, bool]]:
    """Cut a branch into runs of equal stability, as slices of points; neighbours share their end point."""
    cuts = [0, *(np.flatnonzero(np.diff(stable)) + 1), len(stable)]
    return [
        (slice(begin, end + 1), bool(stable[begin]))
        for begin, end in zip(cuts[:-1], cuts[1:], strict=True)
        if end > begin
    ]


def smooth(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a curve through the points, each segment in PER_SEGMENT parts.

    Monotone cubics in the chord length: they reverse in the parameter at the computed folds alone.
    """
    from scipy.interpolate import PchipInterpolator

    spans = [max(float(np.ptp(values)), SMALLEST) for values in (x, y)]
    chords = np.hypot(np.diff(x) / spans[0], np.diff(y) / spans[1])
    length = np.concatenate([[0.0], np.cumsum(np.maximum(chords, 1e-9))])
    parts = np.arange(len(x) - 1)[:, None] + np.arange(PER_SEGMENT) / PER_SEGMENT
    where = np.interp(np.append(parts, len(x) - 1), np.arange(len(x)), length)
    points = np.column_stack([x, y])
    curve = PchipInterpolator(length, points)(where)
    curve[::PER_SEGMENT] = points
    return curve[:, 0], curve[:, 1]
