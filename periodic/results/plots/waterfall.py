"""The spectra along a branch, one above the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from periodic.results.branch import Branch
from periodic.results.plots.frame import dressed, fresh, plain
from periodic.results.plots.orbitplots import shown_of, spectrum
from periodic.results.plots.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROWS = 40
HEIGHT = 8.0
"""Height of the largest line, in distances between rows."""


def plot_waterfall(
    branch: Branch,
    name: str | None = None,
    axes: Axes | None = None,
    *,
    harmonics: int = 4,
    units: Units | None = None,
) -> Axes:
    """Plot the spectra of a branch's orbits over frequency, each above its value of the parameter.

    The height of a line is in proportion to its amplitude; the largest is named in the legend.

    Parameters
    ----------
    branch : Branch
        The branch; of its points those nearest to 40 evenly spaced values of its parameter, on each sheet.
    name : str, optional
        A state, its velocity x', or an unknown; by default the first state.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    harmonics : int
        Up to which multiple of the excitation's frequency.
    units : dict, optional
        Units by names, as for `plot`; frequencies are in Hz.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For a branch without an orbit that moves, and a name that its orbits have not.
    """
    points = [point for point in branch if not point.equilibrium]
    if not points:
        raise ValueError("branch has no orbit that moves; a waterfall needs some")
    shown = shown_of(points[0].orbit, units)
    signal = name or points[0].orbit.names[0]
    values = np.array([point.parameter for point in points])
    across = shown.unit(branch.parameter, values)
    step = float(np.ptp(values)) / ROWS / across.size or 1.0
    rows = _rows(values, float(np.ptp(values)) / ROWS)
    found = [(points[k], *spectrum(points[k].orbit, signal, harmonics)) for k in rows]
    largest = max(float(amplitudes.max(initial=0.0)) for _, _, amplitudes in found) or 1.0
    unit, axes = shown.unit(signal, largest), fresh(axes, (7.0, 5.0))
    named: set[bool] = set()
    for point, orders, amplitudes in found:
        base = point.parameter / across.size
        frequencies = orders * point.orbit.omega / (2 * np.pi)
        color, stable = ("C0" if point.stable else "C1"), point.stable
        axes.plot([0, frequencies[-1]], [base, base], color=color, linewidth=0.4, alpha=0.5)
        tips = base + HEIGHT * step * amplitudes / largest
        drawn = axes.vlines(frequencies, base, tips, color=color, linewidth=1.4)
        drawn.set_label("" if stable in named else "stable" if stable else "unstable")
        named.add(stable)
    axes.plot([], [], " ", label=plain(f"longest line: {largest / unit.size:.3g} {unit.text}".rstrip()))
    axes.set_xlim(left=0)
    return dressed(axes, f"frequency of {signal} (Hz)", across.label(branch.parameter))


def _rows(values: np.ndarray, step: float) -> list[int]:
    """Indices of points that are a step apart along the branch, both ends included."""
    chosen = [0]
    for k, value in enumerate(values):
        if abs(value - values[chosen[-1]]) >= step:
            chosen.append(k)
    return chosen if chosen[-1] == len(values) - 1 else [*chosen, len(values) - 1]
