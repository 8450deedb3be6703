"""Plots of branches: stable parts solid, unstable dashed, special points labelled as the field does."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from periodic.bifurcations.label import Label
from periodic.results.branch import Branch
from periodic.results.point import Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(
    branch: Branch,
    output: str | None = None,
    axes: Axes | None = None,
    measure: Callable[[Point], float] | None = None,
) -> Axes:
    """Plot the peak to peak of an output, of equilibria the output itself, against the parameter.

    Parameters
    ----------
    branch : Branch
        The branch, perhaps without points.
    output : str, optional
        Name of the output; by default the first.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own.
    measure : callable, optional
        Any function of a point, in the place of the peak to peak.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For a name that is no output; it says which there are.
    """
    import matplotlib.pyplot as plt

    outputs = [q.name for q in branch.layout.outputs]
    name = output or outputs[0]
    if name not in outputs:
        raise ValueError(f"output is {name!r}; it must be one of {', '.join(outputs)}")
    units = {q.name: q.unit for q in (*branch.layout.outputs, *branch.layout.parameters)}
    still = any(point.equilibrium for point in branch)
    shown = name if still else f"{name} peak to peak"
    measured = measure or (lambda point: point.maximum[name] if still else point.peak_to_peak(name))
    axes = axes or plt.subplots(figsize=(7.0, 4.5), layout="constrained")[1]
    values, heights = branch.values, np.array([measured(p) for p in branch.points])
    for piece, stable in runs(branch):
        axes.plot(values[piece], heights[piece], "-" if stable else "--", color="C0", linewidth=1.5)
    for point in branch.special_points:
        if point.label not in (Label.END, Label.USER):
            at = (point.parameter, measured(point))
            axes.plot(*at, "o", color="C3", markersize=5)
            axes.annotate(point.label.value, at, xytext=(6, 6), textcoords="offset points")
    axes.set_xlabel(_with_unit(branch.parameter, units))
    axes.set_ylabel(_with_unit(shown, {shown: units[name]}))
    return axes


def runs(branch: Branch) -> list[tuple[slice, bool]]:
    """Cut a branch into stretches of one stability; neighbours share their end point."""
    stable = branch.stable_between
    cuts = [0, *(np.flatnonzero(np.diff(stable)) + 1), len(stable)]
    return [
        (slice(begin, end + 1), bool(stable[begin]))
        for begin, end in zip(cuts[:-1], cuts[1:], strict=True)
        if end > begin
    ]


def _with_unit(name: str, units: dict[str, str]) -> str:
    return f"{name} ({units[name]})" if units.get(name) else name
