"""How cost grows with the number of degrees of freedom, for each method and beside time integration."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import symbolic as sym
from periodic import Branch, Collocation, HarmonicBalance, Label, trace
from periodic.extend import Discretisation
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.pages.figures import PAPER, SECOND, TRUSTED, panels
from reports.studies.structures.beams import cantilever, cubic, with_tip
from reports.studies.structures.plane import SLENDER, plane_beam

RANGE = (2.0, 8.0)
"""Of Omega, rad/s: the first resonance."""

CONDENSED, FULL, BALANCE, MARCHED = "condensed", "all states", "harmonic balance", "time integration"
PLANE, REDUCED = "plane stress, condensed", "plane stress, reduced and condensed"

MODES = 20
"""Modes with the tip held that are kept by Craig and Bampton's reduction."""

BAND = (2.0, 210.0)
"""Of the reduction's error, rad/s: three harmonics of the first three modes."""


@dataclass(frozen=True)
class Method:
    """A discretisation, what it is given, and sizes: elements of a beam, rows of them in plane stress."""

    discretisation: Discretisation
    system: Callable[[int], sym.CompiledSystem]
    sizes: tuple[int, ...]


def of_all_states(elements: int) -> sym.CompiledSystem:
    """Return the beam with all of its states."""
    return cantilever(elements, cubic, condense=False)


def of_beam(elements: int) -> sym.CompiledSystem:
    """Return the beam, condensed."""
    return cantilever(elements, cubic)


def of_plane(rows: int) -> sym.CompiledSystem:
    """Return the cantilever in plane stress."""
    return with_tip(plane_beam(rows), cubic)


def of_reduced(rows: int) -> sym.CompiledSystem:
    """Return the same by Craig and Bampton."""
    return with_tip(sym.craig_bampton(plane_beam(rows), ["tip"], MODES).matrices, cubic)


METHODS: Mapping[str, Method] = {
    CONDENSED: Method(Collocation(), of_beam, (2, 10, 50, 200, 1000)),
    PLANE: Method(Collocation(), of_plane, (4, 20)),
    REDUCED: Method(Collocation(), of_reduced, (20,)),
    FULL: Method(Collocation(), of_all_states, (1, 2)),
    BALANCE: Method(HarmonicBalance(), of_beam, (2, 10, 50)),
}


def freedoms(method: str, size: int) -> int:
    """Return the degrees of freedom of the structure."""
    return 2 * SLENDER * size * (size + 1) if method in (PLANE, REDUCED) else 2 * size


ELEMENTS_MARCHED = (1, 2)
SETTLE = 100
"""Periods that are integrated to steady motion at one frequency: 1 % of damping leaves exp(-2 pi)."""


def processor(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return what `work` returns and the processor's seconds."""
    begin = time.process_time()
    return work(), time.process_time() - begin


def row(name: str, size: int) -> dict[str, Any]:
    """Return the points, the time for each of them, and the folds of a branch."""
    method = METHODS[name]
    system, made = processor(lambda: method.system(size))
    found, took = processor(lambda: branch(system, method.discretisation))
    return {
        "method": name,
        "freedoms": freedoms(name, size),
        "unknown": len(system.states),
        "points": len(found),
        "ms": 1e3 * took / len(found),
        "made": made,
        "memory": memory(lambda: method.system(size)),
        "folds": [point.parameter for point in found.labelled(Label.FOLD)],
        "stop": str(found.stop),
    }


def memory(work: Callable[[], Any]) -> float:
    """Return the most that arrays take meanwhile, MB."""
    tracemalloc.start()
    work()
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return most / 1e6


def reduction_error(rows: int) -> float:
    """Return the error of the reduced cantilever's flexibility over the band, damped by about 1 %."""
    bare = plane_beam(rows)
    damped = sym.Matrices(bare.M, 1e-3 * bare.K, bare.K, at=bare.at)
    return sym.craig_bampton(damped, ["tip"], MODES).error(*BAND)


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
    for name, given in METHODS.items():
        for size in given.sizes:
            tell(f"{name}, {freedoms(name, size)} degrees of freedom")
            rows.append(row(name, size))
    for elements in ELEMENTS_MARCHED:
        tell(f"{MARCHED}, {2 * elements} degrees of freedom")
        rows.append(march(elements))
    figure, axes = panels(1, 1, height=3.2)
    looks = {
        CONDENSED: (TRUSTED, "o-"),
        PLANE: (TRUSTED, "s--"),
        FULL: (PAPER, "s-"),
        BALANCE: (SECOND, "^-"),
        MARCHED: ("k", "v:"),
    }
    for method, (color, look) in looks.items():
        mine = [r for r in rows if r["method"] == method]
        at, cost = [r["freedoms"] for r in mine], [r["ms"] for r in mine]
        axes.loglog(at, cost, look, color=color, label=method, markersize=4)
    axes.set(xlabel="degrees of freedom", ylabel="ms a point (processor)")
    axes.legend(frameon=False)
    first = next(r for r in rows if r["method"] == CONDENSED and r["freedoms"] == 100)
    numbers = {f"fold {k} of 100 degrees of freedom": value for k, value in enumerate(first["folds"])}
    tell("the reduction's error")
    numbers["error of the reduction"] = reduction_error(METHODS[REDUCED].sizes[-1])
    return Found(numbers=numbers, rows=rows, figures={"size": figure})


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the ratios that the text tells."""
    cost = {(r["method"], r["freedoms"]): r["ms"] for r in kept.rows}
    folds = {r["freedoms"]: r["folds"] for r in kept.rows if r["method"] == CONDENSED}
    full, reduced = (next(r for r in reversed(kept.rows) if r["method"] == name) for name in (PLANE, REDUCED))
    both = zip(full["folds"], reduced["folds"], strict=True)
    return {
        "settle": SETTLE,
        "band": BAND,
        "kept_modes": MODES,
        "error": kept.numbers["error of the reduction"],
        "off": max(abs(a / b - 1) for a, b in both),
        "rounded": max(abs(a / b - 1) for a, b in zip(folds[2000], folds[400], strict=True)),
        "largest": full,
        "growth": cost[CONDENSED, 2000] / cost[CONDENSED, 20],
        "full": cost[FULL, 4] / cost[CONDENSED, 2000],
    }


SIZE = Section(title="Cost over size", compute=compute, context=context)
