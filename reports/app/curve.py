"""The curve of a branch in a figure: smooth between its points, solid where stable and dashed where not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PER_SEGMENT = 8
"""Parts that the curve is drawn in between two computed points."""


def draw_curve(
    axes: Axes,
    across: np.ndarray,
    up: np.ndarray,
    stable: np.ndarray,
    *,
    color: str,
    labels: tuple[str, str] = ("stable", "unstable"),
    linewidth: float = 1.8,
) -> None:
    """Draw a curve through points as two lines, each broken where the other goes on.

    `stable` tells each segment's kind; an empty label leaves its line out of the legend.
    """
    if len(across) < 2:
        return
    chosen = np.repeat(stable, PER_SEGMENT)
    across, up = smooth(across, up)
    for part, style, label in ((chosen, "-", labels[0]), (~chosen, "--", labels[1])):
        if part.any():
            x, y = _pieces(across, part), _pieces(up, part)
            axes.plot(x, y, style, color=color, linewidth=linewidth, label=label or None)


def smooth(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a curve through the points, each segment in PER_SEGMENT parts.

    Monotone cubics of the chord length: they turn in speed at the computed folds and nowhere else.
    """
    from scipy.interpolate import PchipInterpolator

    spans = [max(float(np.ptp(values)), np.finfo(float).tiny) for values in (x, y)]
    chords = np.hypot(np.diff(x) / spans[0], np.diff(y) / spans[1])
    length = np.concatenate([[0.0], np.cumsum(np.maximum(chords, 1e-9))])
    parts = np.arange(len(x) - 1)[:, None] + np.arange(PER_SEGMENT) / PER_SEGMENT
    where = np.interp(np.append(parts, len(x) - 1), np.arange(len(x)), length)
    curve = PchipInterpolator(length, np.column_stack([x, y]))(where)
    return curve[:, 0], curve[:, 1]


def _pieces(values: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the ends of the chosen segments, a gap before each that does not go on from the last."""
    line: list[float] = []
    for k in np.flatnonzero(chosen):
        begins = not (k and chosen[k - 1])
        line += [np.nan, values[k], values[k + 1]] if begins else [values[k + 1]]
    return np.array(line)
