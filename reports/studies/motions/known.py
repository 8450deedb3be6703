"""Systems whose motions are known: how many, and by their numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell

SORT = per.phasespace.Sort


def thomas() -> sym.CompiledSystem:
    """Thomas' cyclic equations, b = 0.1665."""
    sine = sym.functions.sin
    return sym.compile(
        sym.Equations(
            lambda s, p: {
                "x": sine(s.y) - p.b * s.x,
                "y": sine(s.z) - p.b * s.y,
                "z": sine(s.x) - p.b * s.z,
            },
            {"x": 1.0, "y": 0.5, "z": 0.1},
            {"b": 0.1665},
        )
    )


def kinked() -> sym.CompiledSystem:
    """Lorenz's equations with a kink, a = 5."""
    return sym.compile(
        sym.Equations(
            lambda s, p: {
                "x": s.y - s.x,
                "y": -s.x * s.z + 0.1 * sym.functions.fabs(s.z),
                "z": s.x * s.y - p.a,
            },
            {"x": 1.0, "y": 1.0, "z": 1.0},
            {"a": 5.0},
        )
    )


def lorenz() -> sym.CompiledSystem:
    """Lorenz's equations, 10, 28, 8/3."""
    return sym.compile(
        sym.Equations(
            lambda s, p: {"x": 10 * (s.y - s.x), "y": s.x * (28 - s.z) - s.y, "z": s.x * s.y - 8 / 3 * s.z},
            {"x": 1.0, "y": 1.0, "z": 20.0},
        )
    )


def oscillator(*, k: float, c: float, force: float) -> sym.CompiledSystem:
    """x'' + c x' + k x + x^3 = force cos(t)."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Damper(x, c), sym.Spring(x, k), sym.CubicSpring(x, 1.0)]
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, force, 1.0)]))


def known(tell: Tell) -> Found:
    """Compute each."""
    rows: list[dict[str, Any]] = []

    def row(what: str, value: float, told: float) -> None:
        rows.append({"what": what, "found": float(value), "known": told})

    tell("Lorenz")
    chaos = per.lyapunov(lorenz(), periods=20_000)
    for k, value in enumerate((0.9056, 0.0, -14.5723)):
        row(f"Lorenz, Lyapunov exponent {k + 1}", chaos.values[k], value)
    row("Lorenz, standard error of the first", chaos.errors[0], math.nan)
    tell("kinked Lorenz")
    found = per.motions(kinked(), box=dict.fromkeys("xyz", (-4, 4)), starts=128)
    cycle = next(motion for motion in found.stable if motion.sort == SORT.PERIODIC)
    assert cycle.point is not None and cycle.orbit is not None
    row(
        "Lorenz with a kink, period of the cycle", 2 * math.pi / cycle.orbit.parameters["omega"], 4.6542037389
    )
    row("Lorenz with a kink, its multiplier", cycle.point.nontrivial[0].real, -0.87709132)
    row("Lorenz with a kink, its multiplier", cycle.point.nontrivial[1].real, -0.01085576)
    row("Lorenz with a kink, chaotic attractors", sum(m.sort == SORT.CHAOTIC for m in found.stable), 1)
    tell("Thomas")
    found = per.motions(thomas(), box=dict.fromkeys("xyz", (-4, 4)), starts=192)
    cycles = [motion for motion in found.stable if motion.sort == SORT.PERIODIC]
    row("Thomas, limit cycles", len(cycles), 3)
    near = [m for m in found.unstable if m.sort == SORT.EQUILIBRIUM]
    inner = [m for m in near if np.ptp(m.sections[0]) < 1e-6]
    row("Thomas, unstable equilibria with x = y = z", len(inner), 3)
    tell("Ueda")
    found = per.motions(oscillator(k=0.0, c=0.05, force=7.5), box={"x": (-4, 4), "x'": (-6, 6)}, starts=64)
    row("Ueda, attractors", len(found.stable), 1)
    row("Ueda, Lyapunov exponent", found.stable[0].exponent, 0.1)
    tell("three branches")
    x = sym.coordinate("x")
    damped = sym.compile(
        sym.Mass(x, 1.0)
        + sym.Spring(x, 1.0)
        + sym.CubicSpring(x, 1.0)
        + sym.HarmonicForce(x, 0.01, 1.05)
        + sym.Equations(lambda s, p: {"x": -0.1 * s.x**2 * s.x_dot}, {}, coordinates=[x])
    )
    found = per.motions(damped, box={"x": (-1, 1), "x'": (-1, 1)}, periods=2)
    row("nonlinear damping at 1.05, stable motions", len(found.stable), 2)
    row("nonlinear damping at 1.05, unstable motions", len(found.unstable), 1)
    return Found(numbers={"rows": len(rows)}, rows=rows)


def _context(kept: Kept) -> Mapping[str, Any]:
    table = [
        [row["what"], f"{row['found']:.10g}", "" if math.isnan(row["known"]) else f"{row['known']:.10g}"]
        for row in kept.rows
    ]
    return {"table": table}


KNOWN = Section(title="Systems that are known", compute=known, context=_context)
