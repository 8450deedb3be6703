"""Figures of the aims: how the cost of an iteration grows, and the other tools."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from reports.bench.suite import COUNTS, NTST, Numbers
from reports.pages.figures import TRUSTED, panels


def growth(n: Mapping[str, Numbers]) -> Figure:
    """Return the time of a Newton iteration over ntst (disc) and over n (chains)."""
    figure, (left, right) = panels(1, 2, width=8.0, height=3.2)
    times = [n["disc iteration"][f"ntst {count} ms"] for count in NTST]
    left.loglog(NTST, times, "o-", color=TRUSTED, label="disc, n = 3 and one unknown")
    left.loglog(NTST, [times[-1] * count / NTST[-1] for count in NTST], ":", color="gray", label="~ ntst")
    left.plot([100], [0.7], "x", color="black", label="aim")
    states = [2 * count for count in COUNTS]
    times = [n["chain iteration"][f"{count} oscillators ms"] for count in COUNTS]
    right.loglog(states, times, "o-", color=TRUSTED, label="chain, ntst 20")
    right.loglog(states, [times[-1] * (k / states[-1]) ** 3 for k in states], ":", color="gray", label="~ n³")
    right.plot([100], [60.0], "x", color="black", label="aim")
    right.set_ylim(bottom=min(times) / 3)
    left.set_xlabel("mesh intervals ntst")
    right.set_xlabel("states n")
    left.set_ylabel("one Newton iteration (ms)")
    for ax in (left, right):
        ax.legend()
    left.set_xticks(NTST, [str(count) for count in NTST])
    left.xaxis.set_minor_formatter(NullFormatter())
    return figure


def peers(found: Mapping[str, Numbers]) -> Figure:
    """Return the error of the folds over the time of the branch, tool by tool."""
    figure, axes = panels(1, 1, width=8.0, height=3.6)
    for name, numbers in found.items():
        if "fold error" in numbers:
            ours = name.startswith("Duffing")
            label = name.replace("Duffing A branch", "orbitrace")
            marker = "o" if ours else "s^vD*P"[len(axes.lines) % 6]
            colour = {"color": TRUSTED} if ours else {}
            axes.loglog(numbers["s"], numbers["fold error"], marker, markersize=7, label=label, **colour)
    axes.set_xlabel("processor time of the branch (s)")
    axes.set_ylabel("relative error of the folds")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure
