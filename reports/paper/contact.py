"""When contact counts as lost, and the speed from which a disc loses it in every cycle."""

from __future__ import annotations

import periodic
from reports.paper.scenes import system
from reports.view import RPM

LOST = 1e-3
"""Contact counts as lost where the load falls below this part of the preload."""


def lost_from(name: str) -> float:
    """Return the speed (rev/min) below which the upper sheet loses contact in every cycle.

    Raises ArithmeticError for a branch that keeps contact.
    """
    found = periodic.trace(
        system(name),
        "speed",
        (100 * RPM, 500 * RPM),
        start=500 * RPM,
        events={"contact lost": periodic.Level(periodic.Minimum("load"), LOST * preload_of(name))},
        stop={"contact lost": 1},
    )
    if not found.labelled("contact lost"):
        raise ArithmeticError(f"scene {name} does not lose contact from 500 rev/min on")
    return found.labelled("contact lost")[0].parameter / RPM


def preload_of(name: str) -> float:
    """Return the preload of a built-in disc in N."""
    return next(p.value for p in system(name).parameters if p.name == "preload")
