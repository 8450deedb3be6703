"""Figures of the aims: how the cost of an iteration grows, and the other tools."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from reports.benchmarks.work import COUNTS, NTST
from reports.studies.pages.figures import TRUSTED, panels

Numbers = dict[str, float]
"""Results by name; a name ends with its unit."""

TOOLS = ("Duffing A branch", "AUTO-07p itself, ntst", "AUTO-07p by bifpy", "xpplab", "pyHarm", "bice")
"""How the names of the benchmarks begin."""

BESIDE = (4, -10)
"""Names of settings stand so high beside their points (pt), of one tool and of the next."""


def growth(n: Mapping[str, Numbers]) -> Figure:
    """Return the time of a Newton iteration over ntst (disc) and over n (chains)."""
    figure, (left, right) = panels(1, 2, width=8.0, height=3.4)
    times = [n["disc iteration"][f"ntst {count} ms"] for count in NTST]
    _growing(left, NTST, times, 1, "disc at 360 rev/min", (100, 0.7))
    left.set_xlabel("mesh intervals ntst")
    left.set_ylabel("one Newton iteration (ms)")
    left.set_xticks(NTST, [str(count) for count in NTST])
    times = [n["chain iteration"][f"{count} oscillators ms"] for count in COUNTS]
    _growing(right, [2 * count for count in COUNTS], times, 3, "chains, ntst 20", (100, 60.0))
    right.set_xlabel("states n")
    return figure


def _growing(
    axes: Any,
    sizes: Sequence[int],
    times: Sequence[float],
    power: int,
    label: str,
    aim: tuple[float, float],
) -> None:
    """Draw times over sizes, a power that ends where they do, and an aim."""
    axes.loglog(sizes, times, "o-", color=TRUSTED, label=label)
    slope = [times[-1] * (size / sizes[-1]) ** power for size in sizes]
    axes.loglog(sizes, slope, ":", color="gray", label=f"power {power}")
    axes.plot(*aim, "x", color="black", markersize=8, label="aim")
    axes.set_ylim(bottom=min(times) / 3)
    for axis in (axes.xaxis, axes.yaxis):
        _ticks(axis)
    axes.legend(loc="lower right")


def _ticks(axis: Any) -> None:
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def peers(found: Mapping[str, Numbers]) -> Figure:
    """Return the error of the folds over the time of the branch, a curve for each tool."""
    figure, axes = panels(1, 1, width=7.0, height=3.8)
    for number, (tool, marker) in enumerate(zip(TOOLS, "osvDx^", strict=True)):
        own = {k: n for k, n in found.items() if k.startswith(tool) and "fold error" in n}
        time, error = [n["s"] for n in own.values()], [n["fold error"] for n in own.values()]
        label = tool.replace(TOOLS[0], "orbitrace").removesuffix(", ntst")
        axes.loglog(time, error, marker + "-", label=label)
        for place, name in zip(zip(time, error, strict=True), own, strict=True):
            setting = name.rpartition(", ")[2]
            beside = (5, BESIDE[number % 2])
            axes.annotate(setting, place, xytext=beside, textcoords="offset points", fontsize=7)
    axes.set_xlabel("processor time of the branch (s)")
    axes.set_ylabel("relative error of the folds")
    axes.margins(0.12)
    _ticks(axes.xaxis)
    axes.legend()
    return figure
