"""A Campbell diagram: natural frequencies of a rotor over its speed, and where its orders meet them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from periodic.orbit.scheme import Array
from periodic.results.plots.frame import dressed, fresh
from periodic.results.plots.units import Shown, Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NO_DAMPING = 1e-9
"""Damping ratios smaller than this are taken for none."""


class Diagram(Protocol):
    """Natural frequencies over speed: `symbolic.campbell` returns one."""

    @property
    def speeds(self) -> Array:
        """Speeds in rad/s, shape (N,)."""

    @property
    def frequencies(self) -> Array:
        """Frequencies in rad/s, shape (N, k)."""

    @property
    def damping(self) -> Array:
        """Damping ratios, shape (N, k)."""

    def critical(self, order: float = 1.0) -> Array:
        """Speeds (rad/s) at which a frequency is `order` times the speed."""


def plot_campbell(
    diagram: Diagram,
    axes: Axes | None = None,
    *,
    orders: Sequence[float] = (1.0,),
    units: Units | None = None,
) -> Axes:
    """Plot natural frequencies over speed, with lines of the orders and the critical speeds on them.

    Parameters
    ----------
    diagram : Campbell
        What `symbolic.campbell` returns.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    orders : list of float
        Multiples of the speed that excite: 1 for unbalance.
    units : dict, optional
        Units of "speed" and "frequency", by default rev/min and Hz.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. Crosses mark where a mode is unstable.

    Raises
    ------
    ValueError
        For what is no diagram.
    """
    if not hasattr(diagram, "critical"):
        raise ValueError(f"diagram is {diagram!r}; it must be what symbolic.campbell returns")
    usual = {"speed": "rev/min", "frequency": "Hz"}
    shown = Shown(dict.fromkeys(usual, "rad/s"), {**usual, **(units or {})})
    across, up = shown.unit("speed"), shown.unit("frequency")
    axes, speeds = fresh(axes), diagram.speeds / across.size
    for k, column in enumerate(diagram.frequencies.T):
        unstable = diagram.damping[:, k] < -NO_DAMPING
        axes.plot(speeds, column / up.size, color="C0", linewidth=1.6, label="natural frequencies")
        if unstable.any():
            axes.plot(speeds[unstable], column[unstable] / up.size, "x", color="C1", label="unstable")
    top = float(np.nanmax(diagram.frequencies)) / up.size
    for order in orders:
        line = order * diagram.speeds / up.size
        inside = line <= top
        axes.plot(speeds[inside], line[inside], color="black", linewidth=0.8, linestyle="--", label="orders")
        if inside.any():
            axes.annotate(f"{order:g}x", (speeds[inside][-1], line[inside][-1]), ha="right", va="bottom")
        critical = diagram.critical(order)
        axes.plot(
            critical / across.size, order * critical / up.size, "o", color="black", label="critical speeds"
        )
    axes.set_xlim(speeds[0], speeds[-1])
    return dressed(axes, across.label("speed"), up.label("frequency"))
