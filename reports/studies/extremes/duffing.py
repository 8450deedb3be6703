"""Section of the report: the Duffing oscillator under forces up to 1e4."""

from __future__ import annotations

from functools import partial

import periodic as per
import symbolic as sym
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

FORCES = (1e-6, 1e-3, 0.5, 10.0, 1e2, 1e3, 1e4)
ENDS = (0.5, 20.0)
"""Range of Omega, in units of the larger of 1 and cbrt(F), about the frequency of so large a motion."""


def system(force: float) -> sym.CompiledSystem:
    """Return x'' + 0.1 x' + x + x^3 = F cos(Omega t), the scene `duffing`."""
    return build(load("duffing", [("force", repr(force))]))


def swept(force: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch over frequency, from high ones down."""
    unit = max(1.0, force ** (1 / 3))
    low, high = (unit * end for end in ENDS)
    return per.trace(compiled, "Omega", (low, high), start=high, control=control)


def raised(force: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch over the force from 0.5 on, at Omega = 1."""
    return per.trace(compiled, "F", (0.5, force), start=0.5, values={"Omega": 1.0}, control=control)


def cases() -> list[Case]:
    """Return sweeps in frequency, then sweeps in force."""
    over = [
        Case(value=f, system=partial(system, f), trace=partial(swept, f), way="over Ω", points=400)
        for f in FORCES
    ]
    up = [
        Case(
            value=f,
            system=partial(system, 0.5),
            trace=partial(raised, f),
            way="up from 0.5, at Ω = 1",
            at_end=True,
            points=800,
        )
        for f in FORCES
        if 0.5 < f <= 1e3
    ]
    return [*over, *up]


STUDY = Study(
    key="duffing",
    title="Duffing: large forces",
    quantity="F",
    cases=cases,
    quick=(1e-3,),
)
