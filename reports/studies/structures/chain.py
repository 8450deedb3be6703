"""A chain of oscillators of which one is nonlinear: condensed, with all states, and by AUTO-07p."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import symbolic as sym
from periodic import Branch, Collocation, Label, trace
from reports.benchmarks.others import Case, MissingError, traced
from reports.benchmarks.work import CHAIN
from reports.studies.pages.content import Found, Kept, Section, Tell
from reports.studies.structures.size import processor

RANGE = (0.5, 1.6)
"""Of Omega, rad/s, traced downwards."""

COUNTS = (5, 10, 25, 50)
"""Oscillators."""

NTST = 20
"""AUTO's intervals."""

CONDENSED, WHOLE, AUTO = "condensed", "all states", "AUTO-07p"

WAYS = {CONDENSED: True, WHOLE: False}


def chain(count: int) -> sym.CompiledSystem:
    """Return the chain of `reports.benchmarks.work` with the cubic spring of its first oscillator alone."""
    places = [sym.coordinate(f"x{k + 1}") for k in range(count)]
    model = sym.CubicSpring(places[0], CHAIN["k3"]) + sym.HarmonicForce(places[0], CHAIN["F"], RANGE[1])
    for k, place in enumerate(places):
        model = model + sym.Mass(place, CHAIN["m"]) + sym.Spring(place, CHAIN["k"])
        model = model + sym.Damper(place, CHAIN["c"])
        model = model + sym.Coupling(places[k - 1], place, CHAIN["link"]) if k else model
    return sym.compile(model)


def branch(system: sym.CompiledSystem, way: str) -> Branch:
    """Return the branch, condensed or not."""
    method = Collocation(condense=WAYS[way])
    return trace(system, "Omega", RANGE, start=RANGE[1], method=method)


def own(count: int, way: str) -> dict[str, Any]:
    """Return points, seconds and folds of this program."""
    system = chain(count)
    found, took = processor(lambda: branch(system, way))
    return {"s": took, "points": len(found), "folds": [p.parameter for p in found.labelled(Label.FOLD)]}


def auto(count: int) -> dict[str, Any]:
    """Return what AUTO says of the branch, or why it says nothing."""
    try:
        found = traced(Case("AUTO", "executable", ("local", str(count), str(NTST))))
    except MissingError as missing:
        return {"why": str(missing)}
    return {"s": found.seconds, "points": found.points, "folds": list(found.folds)}


def compute(tell: Tell) -> Found:
    """Trace the branch of each chain in each way."""
    rows: list[dict[str, Any]] = []
    for count in COUNTS:
        for way in (*WAYS, AUTO):
            if way == AUTO and count > 25:
                continue
            tell(f"{way}, {count} oscillators")
            found = auto(count) if way == AUTO else own(count, way)
            rows.append({"way": way, "states": 2 * count} | found)
    first = next(row for row in rows if row["way"] == CONDENSED and row["states"] == 2 * COUNTS[1])
    numbers = {f"fold {k} of {COUNTS[1]} oscillators": value for k, value in enumerate(first["folds"])}
    return Found(numbers=numbers, rows=rows)


def context(kept: Kept) -> Mapping[str, Any]:
    """Return how many times as long all states and AUTO take as the condensed branch."""
    seconds = {(row["way"], row["states"]): row["s"] for row in kept.rows if "s" in row}
    return {
        "ntst": NTST,
        "times": {key: value / seconds[CONDENSED, key[1]] for key, value in seconds.items()},
    }


ONE_OF_MANY = Section(title="One nonlinear oscillator of many", compute=compute, context=context)
