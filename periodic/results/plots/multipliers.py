"""Floquet multipliers beside the unit circle, eigenvalues of equilibria beside the imaginary axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.results.branch import Branch
from periodic.results.plots.frame import dressed, fresh
from periodic.results.point import Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RIM = 1.6
"""Multipliers beyond this modulus are shown here, each with its value beside it."""


def plot_multipliers(points: Point | Branch, axes: Axes | None = None) -> Axes:
    """Plot multipliers of a point, or how those of a branch move, beside the unit circle.

    Parameters
    ----------
    points : Point or Branch
        One point, or all of a branch: the same marks, the later the darker. Of equilibria the eigenvalues
        (1/s).
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For what is neither, and a branch without points.
    """
    chosen = [points] if isinstance(points, Point) else points
    if not isinstance(chosen, list | Branch) or not len(chosen):
        raise ValueError(f"points is {points!r}; it must be a Point, or a Branch that has points")
    axes = fresh(axes, (4.8, 4.8))
    still = any(point.equilibrium for point in chosen)
    values = np.concatenate([point.multipliers for point in chosen])
    ages = np.repeat(np.linspace(0.25, 1.0, len(chosen)), [len(point.multipliers) for point in chosen])
    ages = ages if len(chosen) > 1 else np.ones(len(values))
    bad = values.real >= 0 if still else np.abs(values) > 1
    shown = values if still else values * np.minimum(1.0, RIM / np.maximum(np.abs(values), 1e-300))
    for kind, color, name in ((~bad, "C0", "stable"), (bad, "C1", "unstable")):
        if kind.any():
            looks: dict[str, Any] = {"alpha": ages[kind], "color": color, "label": name}
            axes.scatter(shown[kind].real, shown[kind].imag, s=36, zorder=3, **looks)
    if still:
        axes.axvline(0.0, color="black", linewidth=0.8)
        return dressed(axes, "real part (1/s)", "imaginary part (1/s)")
    _circle(axes)
    beyond = values[np.abs(values) > RIM] if len(chosen) == 1 else values[[np.abs(values).argmax()]]
    for value in beyond[np.abs(beyond) > RIM]:
        at = RIM * value / abs(value)
        style: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "fontsize": "small"}
        axes.annotate(f"|µ| = {abs(value):.4g}", (at.real, at.imag), xytext=(0, 7), **style)
    return dressed(axes, "real part", "imaginary part")


def _circle(axes: Axes) -> None:
    """Draw the unit circle."""
    turn = np.linspace(0, 2 * np.pi, 361)
    axes.plot(np.cos(turn), np.sin(turn), color="black", linewidth=0.8)
    axes.set_aspect("equal", adjustable="box")
