"""Section of the report: contact lost by ever less, down to 1e-9 of the deflection."""

from __future__ import annotations

import math
from functools import partial

import periodic as per
import symbolic as sym
from reports.studies.extremes.confirm import Checked, check
from reports.studies.extremes.study import Study
from reports.studies.extremes.survey import Case

PRELOAD, STIFFNESS, MASS, RATIO = 810.0, 1e8, 10.2, 0.02
FREQUENCY = 1.3
"""Of the waviness, in units of the contact's natural frequency."""

MARGINS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-3, -1e-1)
"""Least deflection at the end of the branch, as a part of the static one; below 0 contact is lost."""


def grazing() -> float:
    """Return the waviness (m) at which the linear motion just loses contact."""
    inertia, damping = FREQUENCY**2, 2j * RATIO * FREQUENCY
    moved = 1 / (1 - inertia + damping)
    return PRELOAD / STIFFNESS / abs(1 - moved)


def system(exponent: float) -> sym.CompiledSystem:
    """Return a wavy body of mass m on a contact, W = Q (delta/delta0)^n while delta > 0, else 0.

    delta0 = Q/K whatever n; n = 1 is a stiffness that is lost with contact.
    """
    x = sym.coordinate("x")
    pair = sym.ContactPair(x)
    deflection = PRELOAD / STIFFNESS
    omega = FREQUENCY * math.sqrt(STIFFNESS / MASS)
    return sym.compile(
        sym.Mass(x, MASS)
        + sym.Preload(pair, PRELOAD)
        + sym.Hertz(pair, PRELOAD / deflection**exponent, exponent)
        + sym.Waviness(pair, 0.5 * grazing(), 1.0, omega)
        + sym.ContactDamping(pair, RATIO)
    )


def traced(margin: float, compiled: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch over the waviness, from half of that which grazes."""
    edge = grazing()
    return per.trace(compiled, "amplitude", (0.5 * edge, (1 - margin) * edge), control=control)


def last(compiled: sym.CompiledSystem, branch: per.Branch) -> Checked:
    """Confirm the orbit at the margin."""
    return check(compiled, branch[-1], branch.parameter, ())


def cases() -> list[Case]:
    """Return branches that end at each margin."""
    return [
        Case(
            value=margin,
            system=partial(system, 1.0),
            trace=partial(traced, margin),
            confirm=last,
            at_end=True,
        )
        for margin in MARGINS
    ]


STUDY = Study(
    key="grazing",
    title="Grazing",
    quantity="margin",
    unit="of the static deflection",
    cases=cases,
    quick=(1e-5, -1e-5),
)
