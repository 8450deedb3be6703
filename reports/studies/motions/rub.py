"""A rotor under its weight that rubs on a stiff ring: orbits, tori, lockings and chaos over its speed."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import periodic as per
import symbolic as sym
from reports.studies.pages.content import Found, Kept, Section, Tell

BOX = {"x": (-1.2, 1.2), "y": (-1.2, 1.2), "x'": (-1.0, 1.0), "y'": (-1.0, 1.0)}

SPEEDS, COUNT, STARTS = (0.8, 2.0), 25, 32
"""Speeds over the critical one, values at which all motions are looked for, and starts at each."""

TORUS, FAMILY = 1.5, (1.33, 1.51)
"""Where a torus is settled on, and where it is traced."""


COUNTS = ("unstable", "diverged")
"""Columns of numbers."""


def rotor() -> sym.CompiledSystem:
    """The rotor: lengths over the clearance, its weight a quarter of the shaft's stiffness times it."""
    x, y, speed = sym.coordinate("x"), sym.coordinate("y"), sym.parameter("speed", 1.0)
    model = sym.Mass(x, 1.0) + sym.Mass(y, 1.0) + sym.ConstantForce(y, -0.25)
    for q in (x, y):
        model = model + sym.Damper(q, 0.17) + sym.Spring(q, 1.0)
    return sym.compile(model + sym.Unbalance(x, y, 1.0, 0.35, speed) + sym.Rub(x, y, 30.0, 1.05, 0.1))


def rub(tell: Tell) -> Found:
    """Compute the atlas over the speed, and a family of tori."""
    system = rotor()
    tell("atlas")
    begun = time.perf_counter()
    atlas = per.atlas(system, "speed", SPEEDS, box=BOX, count=COUNT, starts=STARTS, places=4, periods=4)
    seconds = time.perf_counter() - begun
    rows: list[dict[str, Any]] = [
        {
            "speed": float(speed),
            "stable": [[motion.name, motion.share, motion.tells] for motion in found.stable if motion.starts],
            "unstable": len(found.unstable),
            "diverged": found.diverged,
            "undecided": found.undecided,
        }
        for speed, found in zip(atlas.values, atlas.motions, strict=True)
    ]
    tell("tori")
    torus = per.settled_torus(system, {"speed": TORUS}, start={"x": 0.9})
    begun = time.perf_counter()
    family = per.trace(system, "speed", FAMILY, guess=torus)
    numbers = {
        "atlas_s": seconds,
        "branches": len(atlas.sheets),
        "rotation": torus.rotation_number,
        "breaks": len(torus.breaks),
        "family": len(family),
        "family_s": time.perf_counter() - begun,
        "first": float(family.rotation_numbers[0]),
        "last": float(family.rotation_numbers[-1]),
    }
    return Found(numbers=numbers, rows=rows, figures={"rub": atlas.plot()})


def _context(kept: Kept) -> Mapping[str, Any]:
    table = [
        [f"{row['speed']:.2f}", "; ".join(_told(*each) for each in row["stable"]), *map(row.get, COUNTS)]
        for row in kept.rows
    ]
    return {"table": table, "starts": STARTS, "torus": TORUS, "family": FAMILY}


def _told(name: str, share: float, tells: str) -> str:
    """A stable motion in a cell."""
    what = name.removeprefix("stable, ")
    known = tells if "number" in tells or "exponent" in tells or "simulations" in tells else ""
    return " ".join(filter(None, [f"{100 * share:.0f} % {what}", f"({known})" if known else ""]))


RUB = Section(title="A rub, from orbits to tori, lockings and chaos", compute=rub, context=_context)
