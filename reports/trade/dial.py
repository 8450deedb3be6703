"""Section of the report: whether the dial keeps its word."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from periodic.scheme import Array
from reports.pages.report import table
from reports.pages.section import Section, Tell
from reports.trade.dialled import PROBLEMS, Kept, Problem, compared, references
from reports.trade.words import power

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)

WASTE = 30.0
"""By how much a branch may be better than asked for."""

ROUNDING = 1e-12
"""True errors below this are no errors of the method."""

RATIOS = (1 / 3, 10.0)
"""Between these the ratio of error estimate and true error is to lie."""


def section(tell: Tell) -> Section:
    """Trace every problem at every tolerance."""
    rows = []
    for problem in PROBLEMS:
        tell(problem.name)
        rows += branches(problem, TOLERANCES)
    numbers = summed(rows)
    figures = {"dial": drawn(rows), "estimates": estimates(rows)}
    return Section(
        title="Whether the dial keeps its word",
        text=told(rows, numbers),
        numbers=numbers,
        rows=rows,
        figures=figures,
    )


def branches(problem: Problem, tolerances: Sequence[float]) -> list[Kept]:
    """Return the errors of a problem's branches at tolerances well above its reference's."""
    tight, reference = references(problem)
    return [compared(problem, tol, reference) for tol in tolerances if tol >= 10 * tight]


def ratios(rows: Sequence[Kept]) -> Array:
    """Return error estimate over true error of every orbit whose error is above rounding."""
    return np.array([e / t for row in rows for e, t in row.orbits if t > ROUNDING])


def summed(rows: Sequence[Kept]) -> dict[str, float]:
    """Return the key numbers."""
    good = [row for row in rows if not row.failure]
    parts = np.array([row.worst / row.tol for row in good])
    found = ratios(good)
    return {
        "branches": len(rows),
        "branches that differ": len(rows) - len(good),
        "kept": float((parts <= 1).mean()),
        "kept and not wasteful": float(((parts <= 1) & (parts * WASTE >= 1)).mean()),
        "worst in tolerances": float(parts.max()),
        "median in tolerances": float(np.median(parts)),
        "orbits": len(found),
        "estimates within": float(((found >= RATIOS[0]) & (found <= RATIOS[1])).mean()),
        "least estimate over error": float(found.min()),
        "median estimate over error": float(np.median(found)),
        "largest estimate over error": float(found.max()),
    }


def told(rows: Sequence[Kept], n: Mapping[str, float]) -> str:
    """Return the section's text."""
    names = list(dict.fromkeys(row.problem for row in rows))
    at = {(row.problem, row.tol): row for row in rows}
    body = [(name, *(_cell(at.get((name, tol))) for tol in TOLERANCES)) for name in names]
    failed = [f"{row.problem} at {power(row.tol)}: {row.failure}" for row in rows if row.failure]
    return f"""
`tol=` (in Python) and `--accuracy` (draft 1e-4, standard 1e-6, fine 1e-9) bound three relative errors of
every branch: those of peaks to peak, of the places of folds (LP) and of multipliers (relative to the largest
where that exceeds 1). Here {len(names)} branches are traced at tolerances from 1e-2 to 1e-10 and held against
the same branch at 1e-11, or at 1e-10 where rounding ends it there: then down to 1e-9. A cell is the largest
of the three errors anywhere on the branch, in tolerances: 1 or less is a word kept, less than 1/30 is work
wasted.

{table(("branch", *(power(tol) for tol in TOLERANCES)), body)}

Of {n["branches"] - n["branches that differ"]:.0f} branches compared {100 * n["kept"]:.0f} % keep their word;
the worst error is {n["worst in tolerances"]:.1f} tolerances, the median {n["median in tolerances"]:.2f};
{100 * n["kept and not wasteful"]:.0f} % lie between 1/30 and 1. Where a branch is better than it need be it
has few intervals, and those are cheap: what costs then are the calls and not the numbers.{_differing(failed)}

![Largest error of each branch against the tolerance asked for; the band is 1/30 to 1 of it](dial.png)

The error estimate of an orbit (`error.orbit`) is that of its motion, the largest over all states and phases.
Over {n["orbits"]:.0f} forced orbits it is {n["least estimate over error"]:.2g} to
{n["largest estimate over error"]:.2g} times the true error, the median {n["median estimate over error"]:.2g};
{100 * n["estimates within"]:.0f} % lie between 1/3 and 10.

![Error estimate against true error of each orbit; dashed: a third and ten times it](estimates.png)
"""


def _differing(failed: Sequence[str]) -> str:
    return f" Not compared, since the special points differ: {'; '.join(failed)}." if failed else ""


def _cell(row: Kept | None) -> str:
    if row is None:
        return ""
    if row.failure:
        return "differs"
    part = row.worst / row.tol
    return f"**{part:.2g}**" if part > 1 else f"{part:.2g}"


def drawn(rows: Sequence[Kept]) -> Figure:
    """Return the errors of all branches against their tolerances."""
    figure = Figure(figsize=(8.0, 5.2), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log", xlabel="tolerance", ylabel="largest error")
    ends = np.array([min(TOLERANCES), max(TOLERANCES)])
    axes.fill_between(ends, ends / WASTE, ends, color="0.9", label="1/30 to 1 tolerance")
    for k, name in enumerate(dict.fromkeys(row.problem for row in rows)):
        own = [row for row in rows if row.problem == name and not row.failure and row.worst > 0]
        marker = "osD^v<>PX*hp8"[k % 13]
        axes.plot([r.tol for r in own], [r.worst for r in own], marker, markersize=5, label=name)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def estimates(rows: Sequence[Kept]) -> Figure:
    """Return error estimates against true errors."""
    figure = Figure(figsize=(8.0, 5.2), layout="constrained")
    axes = figure.add_subplot(xscale="log", yscale="log", xlabel="true error", ylabel="error estimate")
    ends = np.array([1e-12, 1e-1])
    axes.plot(ends, ends, "k-", linewidth=1)
    for factor in RATIOS:
        axes.plot(ends, factor * ends, "k--", linewidth=1)
    for k, name in enumerate(dict.fromkeys(row.problem for row in rows if row.orbits)):
        pairs = [pair for row in rows if row.problem == name for pair in row.orbits]
        own = np.array([pair for pair in pairs if pair[1] > ROUNDING])
        axes.plot(own[:, 1], own[:, 0], "osD^v<>PX*hp8"[k % 13], markersize=4, label=name)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
