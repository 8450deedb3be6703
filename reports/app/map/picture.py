"""The picture of a map: the peak over one or two parameters, and where branches have folds."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..drawing import BLUE, INK, ORANGE, figure, legend, write

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.patheffects import AbstractPathEffect


def draw(path: Path, title: str, data: xr.Dataset, keys: Mapping[str, str]) -> None:
    """Write the picture of a map over one or two parameters as a PNG file."""
    drawn = figure(5.0)
    fixed = [name for name in keys if name in data.dims and data.sizes[name] == 1][: len(keys) - 1]
    axes, names = drawn.add_subplot(), [name for name in keys if name not in fixed]
    labels = [f"{keys[name]} ({data[name].attrs['units'] or '-'})" for name in names]
    for name in fixed:  # a field of one column has no width
        labels[0] += f", {keys[name]} = {data[name].item():.6g} {data[name].attrs['units']}".rstrip()
    data = data.squeeze(fixed).sortby([name for name in names if name in data.dims])
    if len(names) == 1:
        _line(axes, data, names[0])
        axes.set(xlabel=labels[0], ylabel=_named(data, "peak"))
        axes.grid(alpha=0.25)
    else:
        shown = _field(axes, data, names)
        drawn.colorbar(shown, ax=axes, label=_named(data, "peak"))
        axes.set(xlabel=labels[0], ylabel=labels[1])
    legend(axes)
    write(path, drawn, axes, title)


def drawable(keys: Mapping[str, str], data: xr.Dataset) -> bool:
    """Return whether a map has a picture: of two parameters at most, and something to show."""
    return len(keys) <= 2 and "peak" in data and bool(np.isfinite(data["peak"]).any())


def _named(data: xr.Dataset, name: str) -> str:
    unit = data[name].attrs["units"]
    return f"{name}, peak to peak ({unit})" if unit else f"{name}, peak to peak"


def _line(axes: Axes, data: xr.Dataset, name: str) -> None:
    """Draw the peak, and the highest stable orbit, over one parameter."""
    x = data[name].values
    order = np.argsort(x)
    axes.plot(x[order], data["peak"].values[order], ".-", color=BLUE, label="peak")
    axes.plot(x[order], data["stable peak"].values[order], "--", color=ORANGE, label="highest stable")


def _field(axes: Axes, data: xr.Dataset, names: list[str]) -> ScalarMappable:
    """Draw the peak as a field over two parameters, with a line where branches begin to have folds."""
    x, y = (data[name].values for name in names)
    folds = np.isfinite(data["folds"].values).any(axis=-1) if data["folds"].ndim > data["peak"].ndim else None
    if data["peak"].dims == ("cell",):
        axes.plot(x, y, ".", color=INK, markersize=1.5)
        done = np.isfinite(data["peak"].values)  # a cell that failed has no colour
        x, y, peak = x[done], y[done], data["peak"].values[done]
        return axes.tripcolor(x, y, peak, shading="gouraud") if len(x) > 2 else axes.scatter(x, y, c=peak)
    if folds is not None and min(folds.shape) > 1 and folds.any() and not folds.all():
        axes.contour(x, y, folds.T, levels=[0.5], colors=INK, linewidths=1.2).set(path_effects=_ticked())
        axes.plot([], [], color=INK, linewidth=1.2, label="folds on the ticked side", path_effects=_ticked())
    return axes.pcolormesh(x, y, data["peak"].values.T, shading="nearest")


def _ticked() -> list[AbstractPathEffect]:
    """A line that is seen on dark and on light, with ticks on the side of what is higher."""
    from matplotlib.patheffects import Normal, TickedStroke, withStroke

    tick, light = partial(TickedStroke, spacing=12.0, length=0.5, angle=90.0), "white"
    wide = withStroke(linewidth=2.8, foreground=light)
    return [tick(linewidth=2.8, foreground=light), wide, tick(), Normal()]
