"""A branch: stable parts solid, unstable dashed, special points labelled as the field does."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from periodic.checks import one_of
from periodic.results import frames
from periodic.results.branch import Branch
from periodic.results.peaks import PEAK_OF
from periodic.results.plots.curve import draw_curve
from periodic.results.plots.frame import dressed, fresh
from periodic.results.plots.marks import mark
from periodic.results.plots.units import Shown, Unit, Units, prefixed, quantities
from periodic.results.point import Point

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(
    branch: Branch,
    output: str | None = None,
    axes: Axes | None = None,
    measure: Callable[[Point], float] | str | None = None,
    *,
    units: Units | None = None,
    label: str = "",
) -> Axes:
    """Plot the peak to peak of an output, of equilibria the output itself, against the parameter.

    Parameters
    ----------
    branch : Branch
        The branch, perhaps without points.
    output : str, optional
        Name of the output; by default the first.
    axes : matplotlib.axes.Axes, optional
        Where to plot; by default in a figure of its own. Several branches may share them.
    measure : callable or str, optional
        What is plotted in place of the peak to peak: a function of a point, or a column of `Branch.to_pandas`
        as "x max".
    units : dict, optional
        Units by names of parameter and outputs, ``{"speed": "rev/min", "x": "mm"}``; a unit that is not known
        is given with its SI value, ``("tooth/s", 0.2)``. By default SI, with a prefix where that is shorter.
    label : str
        Name of the branch in the legend; by default "stable".

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        For a name that is no output, and units that do not fit; it says which there are.
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch is {branch!r}; it must be a Branch, as periodic.trace returns it")
    outputs = [q.name for q in branch.layout.outputs]
    name = one_of("output", output or outputs[0], outputs)
    shown = Shown(quantities(branch.layout), units)
    heights, said, unit = _measured(branch, name, measure, shown)
    across = shown.unit(branch.parameter, branch.values)
    x, y = branch.values / across.size, heights / unit.size
    axes = fresh(axes)
    curve = _curve(branch, name, measure)
    between = (x, y) if curve is None else (curve[0] / across.size, curve[1] / unit.size)
    draw_curve(axes, *between, branch.stable_between, labels=(label or "stable", "unstable"))
    others = {PEAK_OF + output for output in outputs if output != name}
    told = [
        (p.label.value, p.event, *at) for p, *at in zip(branch, x, y, strict=True) if p.event not in others
    ]
    mark(axes, told)
    return dressed(axes, across.label(branch.parameter), unit.label(said))


def _curve(
    branch: Branch, name: str, measure: Callable[[Point], float] | str | None
) -> tuple[np.ndarray, np.ndarray] | None:
    """The curve of what is plotted (SI); none where it is a function of a point."""
    if measure is not None and not isinstance(measure, str):
        return None
    still = any(point.equilibrium for point in branch)
    return branch.curve(measure or (name if still else f"{name} p-p"))


def _measured(
    branch: Branch, name: str, measure: Callable[[Point], float] | str | None, shown: Shown
) -> tuple[np.ndarray, str, Unit]:
    """Return what is plotted of each point (SI), its name and its unit."""
    if isinstance(measure, str):
        heights = branch.column(measure)
        return heights, measure, prefixed(frames.units(branch)[measure], heights)
    if measure is not None:
        said = getattr(measure, "__name__", type(measure).__name__)
        return np.array([measure(p) for p in branch]), said.replace("<lambda>", "measure"), Unit("")
    still = any(point.equilibrium for point in branch)
    heights = np.array([p.maximum[name] if still else p.peak_to_peak(name) for p in branch])
    return heights, name if still else f"{name} peak to peak", shown.unit(name, heights)
