"""How cost grows with the number of degrees of freedom, for each method and beside time integration."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import symbolic as sym
from periodic import Branch, Collocation, Discretisation, HarmonicBalance, Label, trace
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.structures.beams import cantilever, cubic

RANGE = (2.0, 8.0)
"""Of Omega, rad/s: the first resonance."""

CONDENSED, FULL, BALANCE, MARCHED = "condensed", "all states", "harmonic balance", "time integration"

METHODS: Mapping[str, tuple[Discretisation, bool, tuple[int, ...]]] = {
    CONDENSED: (Collocation(), True, (2, 10, 50, 200, 1000)),
    FULL: (Collocation(), False, (1, 2)),
    BALANCE: (HarmonicBalance(), True, (2, 10, 50)),
}
"""The discretisation, whether the structure is condensed, and the numbers of elements."""

ELEMENTS_MARCHED = (1, 2)
SETTLE = 100
"""Periods that are integrated to steady motion at one frequency: 1 % of damping leaves exp(-2 pi)."""

AUTO = (50, 37.6, 341)
"""States, seconds and points of AUTO-07p's Fortran executable on a chain of 25 oscillators, as recorded."""


def processor(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return what `work` returns and the processor's seconds."""
    begin = time.process_time()
    return work(), time.process_time() - begin


def row(method: str, elements: int) -> dict[str, Any]:
    """Return the points, the time for each of them, and the folds of a branch."""
    discretisation, condense, _ = METHODS[method]
    system, made = processor(lambda: cantilever(elements, cubic, condense=condense))
    found, took = processor(lambda: branch(system, discretisation))
    return {
        "method": method,
        "freedoms": 2 * elements,
        "unknown": len(system.states),
        "points": len(found),
        "ms": 1e3 * took / len(found),
        "made": made,
        "folds": [point.parameter for point in found.labelled(Label.FOLD)],
        "stop": str(found.stop),
    }


def branch(system: sym.CompiledSystem, method: Discretisation) -> Branch:
    """Return the branch through the first resonance."""
    return trace(system, "Omega", RANGE, start=RANGE[0], method=method)


def march(elements: int) -> dict[str, Any]:
    """Return the time for one frequency by time integration from rest."""
    system = cantilever(elements, cubic, condense=False)
    _, took = processor(lambda: sym.simulate(system, {"Omega": 3.0}, settle=SETTLE, periods=1))
    return {"method": MARCHED, "freedoms": 2 * elements, "unknown": len(system.states), "ms": 1e3 * took}


def compute(tell: Tell) -> Found:
    """Trace the branch with each method at each size, and march to one of its points."""
    rows = []
    for method, (_, _, sizes) in METHODS.items():
        for elements in sizes:
            tell(f"{method}, {2 * elements} degrees of freedom")
            rows.append(row(method, elements))
    for elements in ELEMENTS_MARCHED:
        tell(f"{MARCHED}, {2 * elements} degrees of freedom")
        rows.append(march(elements))
    figure, axes = panels(1, 1, height=3.2)
    looks = {CONDENSED: (TRUSTED, "o-"), FULL: (PAPER, "s-"), BALANCE: (SECOND, "^-"), MARCHED: ("k", "v:")}
    for method, (color, look) in looks.items():
        mine = [r for r in rows if r["method"] == method]
        freedoms, cost = [r["freedoms"] for r in mine], [r["ms"] for r in mine]
        axes.loglog(freedoms, cost, look, color=color, label=method, markersize=4)
    axes.loglog(AUTO[0] / 2, 1e3 * AUTO[1] / AUTO[2], "*", color="k", label="AUTO-07p, a chain (recorded)")
    axes.set(xlabel="degrees of freedom", ylabel="ms a point (processor)")
    axes.legend(frameon=False)
    first = next(r for r in rows if r["method"] == CONDENSED and r["freedoms"] == 100)
    numbers = {f"fold {k} of 100 degrees of freedom": value for k, value in enumerate(first["folds"])}
    return Found(numbers=numbers, rows=rows, figures={"size": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the ratios that the text tells, and the record of AUTO."""
    cost = {(r["method"], r["freedoms"]): r["ms"] for r in kept.rows}
    return {
        "auto": AUTO,
        "auto_ms": 1e3 * AUTO[1] / AUTO[2],
        "settle": SETTLE,
        "growth": cost[CONDENSED, 2000] / cost[CONDENSED, 20],
        "full": cost[FULL, 4] / cost[CONDENSED, 2000],
    }


SIZE = Section(title="Cost over size", compute=compute, context=context)
