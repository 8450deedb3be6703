"""Continuation in preload at a fixed speed, and its agreement with continuation in speed."""

from __future__ import annotations

from functools import cache

import numpy as np

from periodic import Accuracy, Branch, Label
from reports.studies.paper.common.discs import HEAVY, LOST, OIL_A
from reports.studies.paper.common.scenes import system
from reports.studies.paper.common.tracing import at_speed, traced
from symbolic.scenes.axes import RPM

SPEEDS = (200.0, 360.0)
"""Speeds of the paper's Figs. 12a and 12b, rev/min."""

RANGE = (100.0, 2500.0)
"""Preloads, N."""

COMMON = {810.0: OIL_A, 2100.0: HEAVY}
"""Preloads at which a scene of its own is continued in speed."""


@cache
def branch(speed: float) -> Branch:
    """Return the orbits of oil A at a speed in rev/min from 2500 N down to 100 N, at accuracy fine."""
    at, values = tuple(COMMON), {"speed": speed * RPM}
    return traced(
        system(OIL_A), "preload", RANGE, start=RANGE[1], at=at, values=values, accuracy=Accuracy.FINE
    )


def disagreement(speed: float, preload: float) -> float:
    """Return the relative difference of x peak to peak between the two continuations at a common point."""
    (here,) = [p for p in branch(speed).labelled(Label.USER) if p.parameter == preload]
    ends = (speed - 5, speed + 5)
    in_speed = traced(system(COMMON[preload]), "speed", ends, at=(speed,), accuracy=Accuracy.FINE)
    (there,) = at_speed(in_speed, speed)
    return abs(here.peak_to_peak("x") / there.peak_to_peak("x") - 1)


def trend(speed: float) -> tuple[float, float, int]:
    """Return the range of preload (N) over which the orbits joined to 2500 N are stable and keep contact.

    It ends at a fold or period doubling, that point included. With it goes the sign of d x / d Q there, 0
    where x peak to peak both rises and falls.
    """
    preload, swing = [], []
    for point in branch(speed):
        if point.minimum["load"] <= LOST * point.parameter:
            break
        preload.append(point.parameter)
        swing.append(point.peak_to_peak("x"))
        if not point.stable:
            break
    changes = np.diff(swing)[np.diff(preload) < 0]
    sign = -1 if (changes > 0).all() else 1 if (changes < 0).all() else 0
    return preload[-1], preload[0], sign
