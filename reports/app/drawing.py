"""What the pictures of all commands share: size, colours, title."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, INK = "#1f5fa8", "#d1661b", "#2b8a57", "#222222"

DPI = 150


def figure(height: float) -> Figure:
    """Return an empty figure 8 inches wide, with a canvas of its own."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    empty = Figure(figsize=(8.0, height), layout="constrained")
    FigureCanvasAgg(empty)
    return empty


def legend(axes: Axes) -> None:
    """Name what is drawn, if any of it has a name: below the axes, where no curve is."""
    handles, names = axes.get_legend_handles_labels()
    if names:
        drawn = axes.get_figure(root=True)
        assert drawn is not None
        drawn.legend(handles, names, frameon=False, loc="outside lower center", ncols=min(len(names), 3))


def write(path: Path, drawn: Figure, axes: Axes, title: str) -> None:
    """Write a figure as a PNG file, its axes under a title in any script; no text in it is a formula."""
    named = [label for each in drawn.axes for label in (each.xaxis.label, each.yaxis.label)]
    for text in (*named, *(text for box in drawn.legends for text in box.get_texts())):
        text.set_parse_math(False)
    axes.set_title(title, fontsize="medium", parse_math=False)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)
        drawn.savefig(path, format="png", dpi=DPI)
