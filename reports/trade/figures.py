"""Work-precision diagrams: error over processor time, a curve for each family of a method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from reports.pages.figures import panels
from reports.trade.cases import ANCHORED, BALANCE, CVODES, RK4, SHOOTING, UNTIED
from reports.trade.measure import Measured

COLOURS = {
    RK4: "tab:red",
    CVODES: "tab:orange",
    SHOOTING: "tab:purple",
    UNTIED: "tab:cyan",
    ANCHORED: "tab:blue",
    BALANCE: "tab:green",
    "Radau 4, even": "black",
    "Gauss 4, even": "tab:gray",
}
MARKERS = "osv^D*P"
SHADES = ("#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#d2b000")


def diagram(rows: Sequence[Measured]) -> Figure:
    """Return the methods side by side, and beside them collocation on even meshes, Radau and Gauss."""
    figure, axes = panels(1, 3, width=11.0, height=4.0, sharey=True)
    main = [r for r in rows if not r.family.endswith("even")]
    chosen = [r for r in rows if r.family in ("Radau 4, even", "Gauss 4, even")]
    _curves(axes[0], [*main, *chosen], COLOURS)
    for ax, kind in zip(axes[1:], ("Radau", "Gauss"), strict=True):
        shown = [r for r in rows if r.family.startswith(kind) and r.family.endswith("even")]
        _curves(ax, shown, {f: SHADES[i % len(SHADES)] for i, f in enumerate(_families(shown))})
    for ax, title in zip(axes, ("methods", "Radau on even meshes", "Gauss on even meshes"), strict=True):
        ax.set_title(title, fontsize=9)
        ax.set_xlabel("processor time (s)")
    axes[0].set_ylabel("error of the orbit, part of its size")
    return figure


def branches(rows: Sequence[Measured]) -> Figure:
    """Return the error of the folds over the time of the whole branch."""
    figure, axes = panels(1, 1, width=5.5, height=4.0)
    _curves(axes, rows, {})
    axes.set_xlabel("processor time of the branch (s)")
    axes.set_ylabel("relative error of the folds")
    return figure


def _curves(axes: Any, rows: Sequence[Measured], colours: dict[str, str]) -> None:
    for index, family in enumerate(_families(rows)):
        points = [(r.seconds, r.error) for r in rows if r.family == family and r.error is not None]
        if points:
            time, error = zip(*points, strict=True)
            style = {"color": colours[family]} if family in colours else {}
            marker = MARKERS[index % len(MARKERS)]
            axes.loglog(time, error, marker=marker, markersize=4, linewidth=1, label=family, **style)
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=7)


def _families(rows: Sequence[Measured]) -> list[str]:
    return list(dict.fromkeys(r.family for r in rows))
