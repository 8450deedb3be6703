"""Section of the report: whether the dial keeps its word."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from periodic.orbit.scheme import Array
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.trade.dialled import PROBLEMS, Compared, Problem, compared, references
from reports.studies.trade.methods.names import power

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)

WASTE = 30.0
"""By how much a branch may be better than asked for."""

ROUNDING = 1e-12
"""True errors below this are no errors of the method."""

RATIOS = (1 / 3, 10.0)
"""Between these the ratio of error estimate and true error is to lie."""


def compute(tell: Tell) -> Found:
    """Trace every problem at every tolerance."""
    rows = []
    for problem in PROBLEMS:
        tell(problem.name)
        rows += branches(problem, TOLERANCES)
    figures = {"dial": drawn(rows), "estimates": estimates(rows)}
    return Found(numbers=summed(rows), rows=[row.kept() for row in rows], figures=figures)


def branches(problem: Problem, tolerances: Sequence[float]) -> list[Compared]:
    """Return the errors of a problem's branches at tolerances well above its reference's."""
    tight, reference = references(problem)
    return [compared(problem, tol, reference) for tol in tolerances if tol >= 10 * tight]


def ratios(rows: Sequence[Compared]) -> Array:
    """Return error estimate over true error of every orbit whose error is above rounding."""
    return np.array([e / t for row in rows for e, t in row.orbits if t > ROUNDING])


def summed(rows: Sequence[Compared]) -> dict[str, float]:
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


def context(kept: Kept) -> Mapping[str, Any]:
    """Return what the template is given."""
    rows = [Compared(**row) for row in kept.rows]
    at = {(row.problem, row.tol): row for row in rows}
    names = list(dict.fromkeys(row.problem for row in rows))
    return {
        "tolerances": TOLERANCES,
        "cells": {name: [at.get((name, tol)) for tol in TOLERANCES] for name in names},
        "failed": [row for row in rows if row.failure],
        "power": power,
    }


def drawn(rows: Sequence[Compared]) -> Figure:
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


def estimates(rows: Sequence[Compared]) -> Figure:
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


SECTION = Section(title="Whether the dial keeps its word", compute=compute, context=context)
