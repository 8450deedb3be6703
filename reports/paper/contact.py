"""When contact counts as lost, and the speed from which a disc loses it in every cycle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

import periodic
from periodic import Point
from reports.paper.scenes import branch, system
from reports.view import RPM

LOST = 1e-3
"""Contact counts as lost where the load falls below this part of the preload."""


def lost_from(name: str) -> float:
    """Return the speed (rev/min) below which the upper sheet loses contact in every cycle.

    It is interpolated in the logarithm of the least load, on a closer trace of the step that passes it.
    Raises ArithmeticError for a branch that keeps contact.
    """
    ends = [point.parameter / RPM for point in _passing(name, branch(name))]
    before, after = _passing(name, branch(name, *ends))
    threshold = np.log(LOST * preload_of(name))
    loads = [np.log(point.minimum["load"]) for point in (after, before)]
    return float(np.interp(threshold, loads, [after.parameter / RPM, before.parameter / RPM]))


def _passing(name: str, found: periodic.Branch) -> tuple[Point, Point]:
    """Return the first neighbours of a branch between which contact is lost."""
    for before, after in pairwise(found):
        if after.minimum["load"] < LOST * preload_of(name) <= before.minimum["load"]:
            return before, after
    raise ArithmeticError(f"scene {name} does not lose contact from {found[0].parameter / RPM:g} rev/min on")


def preload_of(name: str) -> float:
    """Return the preload of a built-in disc in N."""
    return next(p.value for p in system(name).parameters if p.name == "preload")
