"""Tori beside integration over very long times, and their families."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any, cast

from matplotlib.figure import Figure

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell


def two_forces() -> sym.CompiledSystem:
    """T1: a cubic oscillator with two forces of frequencies 1 to sqrt(2)."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        left, omega = 1 - x.c**2 - x.s**2, math.sqrt(2) * p.eta
        return {
            "x": x.v,
            "v": 0.25 * wave.sin + 0.25 * x.s - 0.1 * x.v - x.x - 1.5 * x.x**3,
            "c": left * x.c - omega * x.s,
            "s": left * x.s + omega * x.c,
        }

    states = {"x": 0.0, "v": 0.0, "c": 1.0, "s": 0.0}
    return sym.compile(sym.Equations(rates, states, {"eta": 1.9}, frequency="eta"))


def coupled() -> sym.CompiledSystem:
    """T2: two van der Pol oscillators, coupled."""

    def rates(x: Any, p: Any) -> dict[str, Any]:
        return {
            "x": x.u,
            "u": -p.e * (x.x**2 - 1) * x.u - x.x + 0.1 * (x.y - x.x),
            "y": x.v,
            "v": -p.e * (x.y**2 - 1) * x.v - 2.1 * x.y + 0.1 * (x.x - x.y),
        }

    return sym.compile(sym.Equations(rates, {"x": 1.0, "u": 0.0, "y": 0.5, "v": 0.0}, {"e": 0.5}))


def forced() -> sym.CompiledSystem:
    """T4: van der Pol's oscillator, forced."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": 0.4 * wave.cos - 0.3 * (x.x**2 - 1) * x.v - x.x}

    return sym.compile(sym.Equations(rates, {"x": 0.0, "v": 0.0}, {"eta": 1.4}, frequency="eta"))


def rubbing() -> sym.CompiledSystem:
    """A rotor in a stiff ring with friction, which it touches now and then."""
    x, y, speed = sym.coordinate("x"), sym.coordinate("y"), sym.parameter("speed", 0.8)
    model: sym.Model | sym.Part = sym.Mass(x, 1.0) + sym.Mass(y, 1.0)
    for q in (x, y):
        model = model + sym.Damper(q, 0.1) + sym.Spring(q, 1.0)
    return sym.compile(model + sym.Unbalance(x, y, 1.0, 1.0, speed) + sym.Rub(x, y, 25.0, 1.05, 0.1))


def tori(tell: Tell) -> Found:
    """Compute the tori and their families."""
    rows: list[dict[str, Any]] = []

    def row(what: str, value: float, told: float) -> None:
        rows.append({"what": what, "found": float(value), "known": told})

    def average(system: Any, torus: per.Torus, name: str, power: int) -> float:
        return per.tori.average(system, torus, lambda s: s[name] ** power)

    tell("T1")
    t1 = two_forces()
    one = per.settled_torus(t1)
    row("T1 at 1.9, mean of x^2", average(t1, one, "x", 2), 0.00542667682441)
    row("T1 at 1.9, mean of x^4", average(t1, one, "x", 4), 5.63111720483e-5)
    row("T1 at 1.9, mean of x'^2", average(t1, one, "v", 2), 0.0225188513595)
    tell("T2")
    t2 = coupled()
    two = per.settled_torus(t2, start={"x": 1.0, "y": 0.5})
    first, beside = two.frequencies
    row("T2 at 0.5, a frequency", first, 1.47363265105)
    row("T2 at 0.5, the other", first - beside, 1.0315375291)
    row("T2 at 0.5, mean of x1^2", average(t2, two, "x", 2), 1.99803323659)
    row("T2 at 0.5, mean of x2^2", average(t2, two, "y", 2), 1.99380063634)
    tell("T3")
    rotor = sym.scene("jeffcott-internal-damping")
    three = per.settled_torus(rotor, {"n": 2.0})
    row("T3 at 2.0, rotation number", 1 - three.rotation_number, 0.50120598859)
    tell("T4")
    t4 = forced()
    four = per.settled_torus(t4)
    row("T4 at 1.4, free frequency", 1.4 * (1 - four.rotation_number), 0.9965355256)
    row("T4 at 1.4, mean of x^2", average(t4, four, "x", 2), 1.9463176)
    tell("rub")
    rub = rubbing()
    five = per.settled_torus(rub, start={"x": 0.5})
    row("rub at 0.8, rotation number", five.rotation_number, 0.2952063144343)
    fast = per.settled_torus(rub, {"speed": 1.0}, start={"x": 0.5})
    row("rub at 1.0, rotation number", fast.rotation_number, 0.6441887029537)
    seconds = {}
    for name, system, torus, parameter, bounds in (
        ("T1", t1, one, "eta", (0.8, 2.0)),
        ("T2", t2, two, "e", (0.1, 1.25)),
        ("T3", rotor, three, "n", (1.6, 2.4)),
        ("T4", t4, four, "eta", (1.0, 1.45)),
        ("rub", rub, five, "speed", (0.725, 1.1)),
    ):
        tell(f"{name}, its family")
        begun = time.perf_counter()
        family = per.trace(system, parameter, bounds, guess=torus)
        seconds[name] = time.perf_counter() - begun
        if name == "T3":
            row("T3, its birth", float(family.stops[0].rpartition(" ")[2]), 1.7147671116)
        rows.append(
            {
                "what": f"{name}, tori over {parameter} from {bounds[0]:g} to {bounds[1]:g}",
                "found": float(len(family)),
                "known": math.nan,
                "folds": len(family.labelled("LP")),
                "others": [point.label for point in family if point.label in ("BP", "PD", "NS")],
                "stops": list(family.stops),
                "seconds": seconds[name],
            }
        )
    figure = cast(Figure, per.trace(t1, "eta", (0.8, 2.0), guess=one).plot().figure)
    worst = max(
        abs(r["found"] / r["known"] - 1)
        for r in rows
        if not math.isnan(r["known"]) and "birth" not in r["what"]
    )
    numbers = {"worst_ratio": worst, "most_s": max(seconds.values())}
    return Found(numbers=numbers, rows=rows, figures={"folds": figure})


def _context(kept: Kept) -> Mapping[str, Any]:
    known = [row for row in kept.rows if not math.isnan(row["known"])]
    families = [row for row in kept.rows if math.isnan(row["known"])]
    return {
        "table": [
            [r["what"], f"{r['found']:.12g}", f"{r['known']:.12g}", f"{abs(r['found'] / r['known'] - 1):.0e}"]
            for r in known
        ],
        "families": [
            [
                r["what"],
                int(r["found"]),
                r["folds"],
                " ".join(r["others"]),
                "; ".join(r["stops"]),
                f"{r['seconds']:.1f}",
            ]
            for r in families
        ],
    }


TORI = Section(title="Tori", compute=tori, context=_context)
