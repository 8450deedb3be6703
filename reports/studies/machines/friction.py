"""Friction dampers and stops: where dry friction damps best."""

from __future__ import annotations

import numpy as np

from periodic import Branch, Peak, PeakToPeak, trace
from reports.studies.machines.figures import Curve
from reports.studies.machines.machine import Machine


def over_limit(machine: Machine, found: Branch) -> Curve:
    """Return the height of the resonance over the friction force."""
    top = found[int(np.argmax(found.peak_to_peak("x")))]
    peaks = trace(
        machine.system, "F_f", (0.005, 0.079), guess=top.orbit, determined={"Omega": Peak(PeakToPeak("x"))}
    )
    force = np.array([p.parameter for p in peaks])
    return Curve(force, peaks.peak_to_peak("x"), ("friction force", "x peak to peak at resonance"))


SMOOTH = Machine(
    key="friction-damper",
    title="Friction damper",
    parameter="Omega",
    axis="frequency Ω",
    range=(0.5, 1.6),
    marched=(0.7, 0.9, 1.0, 1.1, 1.4),
    words="A body on a spring, damped by 1 % and by dry friction to the ground, smoothed about rest "
    "(tanh): the height of the resonance falls with the friction force until the body hardly moves.",
    two=over_limit,
)

SLIDER = Machine(
    key="jenkins-damper",
    title="Jenkins damper",
    parameter="Omega",
    axis="frequency Ω",
    range=(0.5, 1.6),
    marched=(0.7, 1.0, 1.1, 1.2, 1.5),
    words="The friction acts through a spring: small motion sticks, and the damper is a spring; larger "
    "motion slips twice a cycle, from where each slip begins to where it ends.",
)

STOP = Machine(
    key="stop",
    title="Oscillator with an elastic stop",
    parameter="Omega",
    axis="frequency Ω",
    range=(0.7, 1.8),
    marched=(0.75, 0.9, 1.0, 1.2, 1.5),
    words="A stop twenty times as stiff as the spring: the resonance stiffens where the body strikes it.",
)
