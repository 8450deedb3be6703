"""Work-precision diagrams: error over processor time, a curve for each family of a method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from reports.studies.pages.figures import panels
from reports.studies.trade.methods.measure import Measured
from reports.studies.trade.methods.names import (
    ANCHORED,
    BALANCE,
    CVODES,
    DIAL,
    EVEN,
    RK4,
    SCHEMES,
    SHOOTING,
    SWEEP,
    UNTIED,
    Mesh,
    named,
)
from reports.studies.trade.words import families, shown

COLOURS = {
    RK4: "tab:red",
    CVODES: "tab:orange",
    SWEEP: "tab:orange",
    SHOOTING: "tab:purple",
    BALANCE: "tab:green",
    DIAL: "tab:pink",
    EVEN: "black",
    "Gauss 5, even": "tab:gray",
    UNTIED: "tab:cyan",
    ANCHORED: "tab:blue",
}
MARKERS = "osv^D*P<>"
SHADES = ("#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#d2b000")
MS = 1e3
TIME, ERROR = "processor time (ms)", "error of the orbit, part of its size"


def diagram(rows: Sequence[Measured]) -> Figure:
    """Return the methods side by side."""
    figure, axes = panels(1, 1, width=8.0, height=4.5)
    _curves(axes, shown(rows), COLOURS)
    axes.set_xlabel(TIME)
    axes.set_ylabel(ERROR)
    return figure


def meshes(rows: Sequence[Measured]) -> Figure:
    """Return collocation by scheme: Radau above Gauss, a column for each kind of mesh, a colour for ncol."""
    own = families(rows)
    kinds = [mesh for mesh in Mesh if any(named(scheme, mesh) in own for scheme in SCHEMES)]
    figure, axes = panels(2, len(kinds), 3.2 * len(kinds) + 0.8, 3.0, sharex=True, sharey=True, squeeze=False)
    for index, scheme in enumerate(SCHEMES):
        for column, mesh in enumerate(kinds):
            ax, count = axes[index // 6][column], index % 6
            style: dict[str, Any] = {
                "color": SHADES[count],
                "marker": MARKERS[count],
                "label": f"ncol {scheme.ncol}",
            }
            _curve(ax, own.get(named(scheme, mesh), []), **style)
            ax.tick_params(labelsize=7)
            ax.set_title(f"{named(scheme, mesh).split()[0]}, {mesh.value} mesh", fontsize=9)
    for ax in axes[1]:
        ax.set_xlabel(TIME)
    for ax in axes[:, 0]:
        ax.set_ylabel(ERROR)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="outside right center", fontsize=8)
    return figure


def branches(rows: Sequence[Measured]) -> Figure:
    """Return the error of the folds over the time of the whole branch."""
    figure, axes = panels(1, 1, width=7.0, height=4.0)
    _curves(axes, rows, COLOURS, unit=1.0)
    axes.set_xlabel("processor time of the branch (s)")
    axes.set_ylabel("relative error of the folds")
    return figure


def _curves(axes: Any, rows: Sequence[Measured], colours: dict[str, str], unit: float = MS) -> None:
    found = [r for r in rows if r.error is not None]
    for index, (family, own) in enumerate(families(found).items()):
        style: dict[str, Any] = {"color": colours[family]} if family in colours else {}
        _curve(axes, own, unit, marker=MARKERS[index % len(MARKERS)], label=family.replace("`", ""), **style)
    # Beside the axes: no corner is free of curves.
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _curve(axes: Any, rows: Sequence[Measured], unit: float = MS, **style: Any) -> None:
    points = [(unit * (r.seconds or 0.0), r.error) for r in rows if r.error is not None]
    time, error = zip(*points, strict=True) if points else ((), ())
    axes.loglog(time, error, markersize=4, linewidth=1, **style)
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
