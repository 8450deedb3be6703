"""Borders of regions in the plane of two parameters: curves of folds, doublings, tori, peaks, levels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from periodic.checks import named
from periodic.results.branch import INTRINSIC, Branch
from periodic.results.plots.curve import draw_curve
from periodic.results.plots.frame import dressed, fresh
from periodic.results.plots.marks import mark
from periodic.results.plots.units import Shown, Units, quantities

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BORDERS = {
    "FoldCondition": "LP",
    "DoublingCondition": "PD",
    "TorusCondition": "NS",
    "HopfCondition": "HB",
    "GrazingCondition": "GR",
    "Peak": "peak",
    "Level": "level",
}


def plot_regions(
    curves: Branch | Sequence[Branch],
    axes: Axes | None = None,
    *,
    units: Units | None = None,
    labels: Sequence[str] | None = None,
) -> Axes:
    """Plot curves in two parameters: of folds, doublings, tori, grazings, peaks, levels.

    Parameters
    ----------
    curves : Branch or list of Branch
        Curves that `trace` follows with `determined=`: each has its parameter across, the one that its
        condition determines up. All must have the same two.
    axes : matplotlib.axes.Axes, optional
        Where to plot, perhaps a map's; by default in a figure of its own.
    units : dict, optional
        Units by names of the two parameters, as for `plot`.
    labels : list of str, optional
        Names in the legend; by default what the curves are of: "LP".

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For branches in one parameter, and curves in different parameters.
    """
    chosen = [curves] if isinstance(curves, Branch) else list(curves)
    if not chosen:
        raise ValueError("curves is empty; it must have a branch that is traced with determined=")
    planes = {(curve.parameter, other_of(curve)) for curve in chosen}
    if len(planes) != 1:
        raise ValueError(f"curves are in the planes of {sorted(planes)}; they must share one plane")
    (across, up) = planes.pop()
    shown = Shown(quantities(chosen[0].layout), units)
    horizontal = shown.unit(across, np.concatenate([curve.values for curve in chosen]))
    vertical = shown.unit(up, np.concatenate([curve.column(up) for curve in chosen]))
    axes = fresh(axes)
    names = labels or [BORDERS.get(kind_of(curve), kind_of(curve)) for curve in chosen]
    for curve, name in zip(chosen, names, strict=True):
        x, y = curve.values / horizontal.size, curve.column(up) / vertical.size
        draw_curve(axes, x, y, np.ones(max(len(x) - 1, 0), dtype=bool), labels=(name, ""))
        mark(axes, [(p.label.value, p.event, *at) for p, *at in zip(curve, x, y, strict=True)])
    return dressed(axes, horizontal.label(across), vertical.label(up))


def other_of(curve: Branch) -> str:
    """Return the parameter that a curve's condition determines."""
    if not isinstance(curve, Branch):
        raise ValueError(f"curves has {curve!r}; it must be made of branches, as periodic.trace returns them")
    found = second_of(curve)
    if found is None:
        raise ValueError(
            f"a curve over {curve.parameter} has no second parameter; it must be traced with determined=, "
            f"such as determined={{'F': FoldCondition()}}"
        )
    return found


def second_of(branch: Branch) -> str | None:
    """Return the parameter that a curve's condition determines; None of a branch in one parameter."""
    known = {q.name for q in branch.layout.parameters}
    found = [
        name
        for name, condition in _determined(branch).items()
        if name in known and condition.get("is") not in INTRINSIC
    ]
    return found[-1] if found else None


def kind_of(curve: Branch) -> str:
    """Return the name of the condition that makes a curve."""
    return str(_determined(curve)[other_of(curve)].get("is", "curve"))


def _determined(curve: Branch) -> dict[str, dict[str, object]]:
    return dict(named("determined", curve.made.get("determined", {}), "conditions"))
