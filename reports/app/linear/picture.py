"""The picture of a linear study: peak to peak and phase of x over the range of the excitation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..drawing import BLUE, INK, ORANGE, figure, legend, write
from ..linear.study import Study
from ..linear.text import degrees, units
from ..view import view_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(path: Path, found: Study) -> None:
    """Write the picture of a study as a PNG file."""
    from matplotlib.ticker import MultipleLocator

    drawn = figure(6.0)
    upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    view, answer = view_of(found.scene), found.response
    name, unit, scale = units(found.system)[0]
    across = answer.values / view.unit
    upper.semilogy(across, answer.peak_to_peak(name) / scale, color=BLUE, linewidth=1.8)
    lower.plot(across, degrees(found, name), color=BLUE, linewidth=1.8)
    _mark(upper, found, scale)
    source = "wave" if found.scene.kind == "disc" else "force"
    letters = "µm" if unit == "um" else unit
    upper.set_ylabel(f"{name} peak to peak, linear ({letters})")
    lower.set(xlabel=view.axes[0], ylabel=f"phase of {name} to the {source} (°)")
    lower.yaxis.set_major_locator(MultipleLocator(90))
    for axes in (upper, lower):
        axes.grid(alpha=0.25)
        axes.margins(x=0.02)
        if found.resonance is not None:
            axes.axvline(found.resonance / view.unit, color=INK, linewidth=0.8, linestyle=":")
    legend(upper)
    write(path, drawn, upper, found.scene.title)


def _mark(axes: Axes, found: Study, scale: float) -> None:
    """Mark the peak and what was asked for."""
    view = view_of(found.scene)
    if found.peak is not None:
        where, height = view.shown(found.peak[0]), found.peak[1] / scale
        name = f"peak at {where:.6g} {view.unit_name}"
        axes.plot([where], [height], "o", color=INK, markersize=5, label=name)
    if found.at != (found.resonance,):
        swings = found.there.peak_to_peak(found.system.outputs[0].name) / scale
        across = [value / view.unit for value in found.at]
        look: dict[str, Any] = {"color": ORANGE, "markersize": 7, "markerfacecolor": "none"}
        axes.plot(across, swings, "s", label="values of the table", **look)
