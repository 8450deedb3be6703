"""Pictures of basins."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array
from periodic.phasespace.motion import Motion
from periodic.results.plots.frame import dressed, fresh

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = ("#bcd7ee", "#f6cfa6", "#c9e3bd", "#e3c6e6", "#f3b9b5", "#d8d3c0", "#bfe4e2", "#e8e09c")
"""Of the basins, in their order, then again."""


class Elsewhere(IntEnum):
    """Labels of starts that are in no basin.

    DIVERGED: they grow beyond all bounds. OPEN: their end is not known. BEHIND: they are behind a wall.
    """

    DIVERGED = -1
    OPEN = -2
    BEHIND = -3


FEW = 50
"""Places of a motion up to which they are drawn large."""

PLAIN = {
    Elsewhere.DIVERGED: ("#555555", "grows beyond all bounds"),
    Elsewhere.OPEN: ("#999999", "not known"),
    Elsewhere.BEHIND: ("#ffffff", "behind a wall"),
}
"""Of what is no basin, and its name."""

POINTS = 2000
"""Points of an attractor that are drawn at the most."""


def drawn(
    labels: NDArray[np.int_],
    motions: Sequence[Motion],
    places: Sequence[Array],
    plane: Sequence[tuple[str, tuple[float, float]]],
    axes: Axes | None,
) -> Axes:
    """Draw basins on their plane.

    labels: (rows, columns). places: of each motion (K, 2). plane: the axes' names, with their ranges.
    """
    from matplotlib.colors import to_rgb

    axes, image = fresh(axes, (6.5, 5.0)), np.ones((*labels.shape, 3))
    for k, (motion, states) in enumerate(zip(motions, places, strict=True)):
        if not (labels == k).any():
            continue
        colour = COLOURS[k % len(COLOURS)]
        image[labels == k] = to_rgb(colour)
        small = len(states) > FEW
        sign, inside, size = (".", "black", 1.5) if small else ("o", colour, 7)
        name = f"{k + 1}: {motion.name}, {100 * motion.share:.1f} %"
        points = states[:POINTS].T
        axes.plot(*points, sign, color=inside, markersize=size, markeredgecolor="black", label=name)
    for k, (colour, name) in PLAIN.items():
        if (labels == k).any():
            image[labels == k] = to_rgb(colour)
            axes.plot([], [], "s", color=colour, markeredgecolor="black", label=name)
    (across, (left, right)), (up, (low, high)) = plane
    extent = (left, right, low, high)
    axes.imshow(image, origin="lower", extent=extent, aspect="auto", interpolation="nearest")
    axes.set_xlim(left, right)
    dressed(axes, across, up)
    axes.grid(False)
    return axes
