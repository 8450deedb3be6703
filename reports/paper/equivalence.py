"""Is the paper's third-order equation the system of three states? Eigenvalues, motions and orbits of both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

import periodic
from periodic import Accuracy, StepSettings
from reports.paper.histories import stepped, trusted
from reports.paper.scenes import branch, system
from reports.view import RPM
from symbolic.linear import modes

THIRD, THREE = "third-order-810N", "vitrea79-810N"
SPEEDS = (200.0, 290.0, 360.0, 500.0)
TRACED = 400
"""Points after which the trace of the third-order form into the loss of contact is given up."""


def eigenvalue_difference(rpm: float) -> float:
    """Return the largest relative difference of the eigenvalues at rest between the two forms."""
    found = [modes(system(name), {"speed": rpm * RPM}).eigenvalues for name in (THIRD, THREE)]
    one, other = (values[np.lexsort((values.imag, values.real))] for values in found)
    return float(np.abs(one / other - 1).max())


def motion_difference(step: float, duration: float = 0.02) -> float:
    """Return the largest distance of x at 360 rev/min between the two forms from the paper's start, in m.

    The third-order form is stepped by Runge-Kutta, the three-state form integrated by CVODES.
    """
    paper, ours = stepped(THREE, duration, step=step), trusted(THREE, 0.5)
    part = ours.during(0, duration)
    return float(np.abs(CubicSpline(paper.time, paper.x)(part.time) - part.x).max())


def orbit_difference(output: str) -> float:
    """Return the largest relative difference of an output's p-p between the branches of the two forms."""
    at = SPEEDS[1:]
    branches = [branch(name, 500.0, min(at), at=at) for name in (THIRD, THREE)]
    swings = [[p.peak_to_peak(output) for p in found.labelled(periodic.Label.USER)] for found in branches]
    one, other = (np.array(values) for values in swings)
    return float(np.abs(one / other - 1).max())


@dataclass(frozen=True, kw_only=True)
class Reached:
    """How far a trace downwards in speed came: rev/min, points used and why it ended."""

    rpm: float
    points: int
    why: str


def reached(name: str, most: int = TRACED) -> Reached:
    """Trace a scene from 320 to 265 rev/min with at most `most` points."""
    found = periodic.trace(
        system(name),
        "speed",
        (265 * RPM, 320 * RPM),
        start=320 * RPM,
        settings=Accuracy.STANDARD.settings(StepSettings(max_points=most)),
    )
    return Reached(rpm=found[-1].parameter / RPM, points=len(found), why=found.stop.reason.value)
