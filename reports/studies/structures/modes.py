"""Three nonlinear tips over the first three modes of beams of growing size: points, cost, memory, truth."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import symbolic as sym
from periodic import ArclengthControl, Branch, trace
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.structures.beams import beam, cubic
from reports.studies.structures.plane import plane_beam

RANGE = (2.0, 70.0)
"""Of Omega, rad/s: the beam's first three modes lie at 3.5, 22 and 62."""

FEW = 2
"""Elements of the beam that is integrated in time."""

SETTLE = 200
"""Periods that are integrated to steady motion."""

SOME = 4
"""Points of the branch whose memory is measured."""


def stop(tip: Any) -> sym.Part:
    """A stop, a hundred times as stiff as the beam's tip."""
    return sym.OneSidedSpring(tip, 300.0, 0.03)


def friction(tip: Any) -> sym.Part:
    """Dry friction, smooth over a velocity of 0.05."""
    return sym.TanhFriction(tip, 0.02, 0.05)


@dataclass(frozen=True, kw_only=True)
class Case:
    """What sits at the tip of which beam, force, damping, tolerance, sizes, Omega where it is checked."""

    part: Callable[[Any], sym.Part]
    force: float
    damping: float
    tolerance: float
    elements: tuple[int, ...]
    at: float
    bare: Callable[[int], sym.Matrices] = beam

    def system(self, elements: int, *, condense: bool = True) -> sym.CompiledSystem:
        """Return the compiled beam."""
        structure = sym.Structure(self.bare(elements), damping=self.damping)
        tip = structure["tip"]
        model = structure + self.part(tip) + sym.HarmonicForce(tip, self.force, 3.0)
        return sym.compile(model, condense=condense)

    def branch(self, system: sym.CompiledSystem, most: int = 5000) -> Branch:
        """Return the branch over three modes, or so many points of it."""
        control = ArclengthControl(max_points=most)
        return trace(system, "Omega", RANGE, start=RANGE[0], tol=self.tolerance, control=control)


CUBIC = Case(part=cubic, force=0.1, damping=0.01, tolerance=1e-6, elements=(10, 50, 200, 1000), at=3.0)

CASES: Mapping[str, Case] = {
    "cubic spring": CUBIC,
    "cubic spring, plane stress": replace(CUBIC, elements=(20,), bare=plane_beam),
    "stop": Case(part=stop, force=0.01, damping=0.05, tolerance=1e-5, elements=(10, 50, 200, 1000), at=3.5),
    "friction": Case(
        part=friction, force=0.1, damping=0.01, tolerance=1e-6, elements=(10, 50, 200, 1000), at=4.0
    ),
}


def row(name: str, elements: int) -> dict[str, Any]:
    """Return points, time and memory of a branch, and its special points."""
    case = CASES[name]
    system = case.system(elements)
    part = system.linear
    assert part is not None
    begin = time.process_time()
    found = case.branch(system)
    took = time.process_time() - begin
    tracemalloc.start()
    case.branch(system, SOME)
    memory = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    special = [p for p in found.special_points if p.label.value not in ("EP", "UZ")]
    return {
        "name": name,
        "freedoms": part.size // 2,
        "points": len(found),
        "ms": 1e3 * took / len(found),
        "memory": memory / 1e6,
        "special": [(p.label.value, p.parameter) for p in special],
        "stop": str(found.stop),
    }


def apart(name: str) -> float:
    """Return how far the tip's motion is from time integration to steady motion, over its peak to peak."""
    case = CASES[name]
    bounds = min(RANGE[0], case.at), case.at + 0.1
    system = case.system(FEW)
    found = trace(system, "Omega", bounds, start=bounds[0], at=case.at, tol=case.tolerance)
    point = next(p for p in found.labelled("UZ") if p.stable)
    whole = case.system(FEW, condense=False)
    marched = sym.simulate(whole, {"Omega": case.at}, settle=SETTLE, periods=1)
    moved = np.asarray(marched["tip"]) - point.orbit["tip"](np.asarray(marched.time))
    return float(np.abs(moved).max()) / point.peak_to_peak("tip")


def compute(tell: Tell) -> Found:
    """Trace every branch, and integrate each tip once."""
    rows, numbers = [], {}
    for name, case in CASES.items():
        for elements in case.elements:
            tell(f"{name}, size {elements}")
            rows.append(row(name, elements))
        if case.bare is beam:
            tell(f"{name}, time integration")
            numbers[f"{name}: from time integration"] = apart(name)
    return Found(numbers=numbers, rows=rows)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return the special points as text, and the differences from time integration."""
    told = [", ".join(f"{label} {place:.7g}" for label, place in row["special"]) for row in kept.rows]
    return {"told": told, "few": 2 * FEW, "cases": CASES, "apart": kept.numbers}


MODES = Section(title="Three tips over three modes", compute=compute, context=context)
