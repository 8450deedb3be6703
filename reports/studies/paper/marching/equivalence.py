"""Is the paper's third-order equation the system of three states? Eigenvalues, motions and orbits of both."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from periodic import ArclengthControl, Branch, Label
from reports.studies.paper.common.discs import OIL_A
from reports.studies.paper.common.scenes import system
from reports.studies.paper.common.tracing import branch, traced
from reports.studies.paper.marching.histories import stepped, trusted
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM

THIRD, THREE = "third-order-810N", OIL_A
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
    paper, ours = stepped(THREE, duration, step=step), trusted(THREE, 0.5).during(0, duration)
    return float(np.abs(CubicSpline(paper.time, paper.x)(ours.time) - ours.x).max())


def orbit_difference(output: str) -> float:
    """Return the largest relative difference of an output's p-p between the branches of the two forms."""
    at = SPEEDS[1:]
    branches = [branch(name, 500.0, min(at), at=at) for name in (THIRD, THREE)]
    swings = [[p.peak_to_peak(output) for p in found.labelled(Label.USER)] for found in branches]
    one, other = (np.array(values) for values in swings)
    return float(np.abs(one / other - 1).max())


def reached(name: str, most: int = TRACED) -> Branch:
    """Trace a scene from 320 towards 265 rev/min with at most `most` points."""
    return traced(system(name), "speed", (265, 320), start=320, step=ArclengthControl(max_points=most))
