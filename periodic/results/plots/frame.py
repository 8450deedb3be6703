"""What all pictures share: axes, grid and a legend that covers no curve."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROW, COLUMN = 14.0, 105.0
"""Height of a row of the legend and width of a column (pt)."""

KEPT = 0.85
"""What is left of the axes when their texts have their room."""


def fresh(axes: Axes | None, size: tuple[float, float] = (7.0, 4.5)) -> Axes:
    """Return the axes given, or new ones in a figure of their own. Raises ValueError for what are no axes."""
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes

    if axes is None:
        return plt.subplots(figsize=size, layout="constrained")[1]
    if not isinstance(axes, Axes):
        raise ValueError(f"axes is a {type(axes).__name__}; it must be one Axes of matplotlib")
    return axes


def dressed(axes: Axes, across: str, up: str, *, least: int = 1) -> Axes:
    """Name the axes, draw a grid, and above the curves a legend, if as many as `least` have names."""
    axes.set_xlabel(across, parse_math=False)
    axes.set_ylabel(up, parse_math=False)
    axes.grid(alpha=0.25)
    axes.set_axisbelow(True)
    named = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    if len(named) >= least:
        points = KEPT * 72 / axes.figure.dpi
        width, height = points * axes.bbox.width, points * axes.bbox.height
        columns = int(min(len(named), max(width // COLUMN, 1)))
        headroom(axes, (ROW * -(-len(named) // columns) + 4) / height)
        axes.legend(
            named.values(),
            named.keys(),
            loc="upper left",
            ncols=columns,
            fontsize="small",
            frameon=False,
            borderaxespad=0.2,
            handlelength=1.6,
            columnspacing=1.2,
        )
    return axes


def plain(name: str) -> str:
    """Return a name as the legend of a picture takes it: what stands between dollars is no formula."""
    return name.replace("$", r"\$")


def headroom(axes: Axes, free: float) -> None:
    """Leave the top of linear axes, as a part of their height, to the legend."""
    low, high = map(float, axes.dataLim.intervaly)
    if axes.get_yscale() == "linear" and np.isfinite([low, high]).all():
        span, free = (high - low) or abs(high) or 1.0, min(free, 0.5)
        axes.set_ylim(low - 0.05 * span, high + 1.05 * span * free / (1 - free))
