"""Section of the report: an undamped oscillator forced ever nearer its resonance."""

from __future__ import annotations

from functools import partial

import periodic as per
import symbolic as sym
from reports.studies.extremes.multipliers import exact
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case

APPROACHED = (0.1, 1e-2, 1e-3)
DISTANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
START = 0.7


def system(scale: float | None) -> sym.CompiledSystem:
    """Return x'' + x = cos(Omega t), x in units of `scale`."""
    x = sym.coordinate("x", scale=scale)
    return sym.compile(sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 1.0))


def approached(distance: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch from Omega = START up to the distance from 1."""
    return per.trace(compiled, "Omega", (START, 1 - distance), start=START, control=control)


def started(distance: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch that begins at the distance from 1 and goes on to twice that."""
    near = 1 - distance
    return per.trace(compiled, "Omega", (1 - 2 * distance, near), start=near, control=control)


def cases() -> list[Case]:
    """Return branches that begin near resonance, with x scaled or not, and one that runs towards it."""
    ways = (
        ("approached from 0.7", approached, APPROACHED, lambda d: None),
        ("begun there", started, DISTANCES, lambda d: None),
        ("begun there, x scaled", started, DISTANCES, lambda d: 0.5 / d),
    )
    return [
        Case(
            value=distance,
            way=way,
            at_end=trace is approached,
            system=partial(system, scale(distance)),
            trace=partial(trace, distance),
            confirm=partial(exact, 0.0, 1.0),
        )
        for way, trace, distances, scale in ways
        for distance in distances
    ]


STUDY = Study(
    key="nearresonance",
    title="Undamped forcing near resonance",
    quantity="1 - Ω",
    cases=cases,
    quick=(1e-2,),
)
