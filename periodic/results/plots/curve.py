"""The curve of a branch in a figure: smooth between its points, solid where stable and dashed where not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from periodic.results.betweenpoints import PER_SEGMENT, smooth

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    """Draw a curve, one line for each run of equal stability, and return its colour.

    It is given by points, or with PER_SEGMENT values from each to the next, as `Branch.curve` returns it.
    `stable` tells each segment's kind; an empty label leaves its lines out of the legend. Without a colour it
    is the next one of the axes.
    """
    if len(across) < 2:
        return color
    from matplotlib.colors import to_hex

    if len(across) == len(stable) + 1:
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
