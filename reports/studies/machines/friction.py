"""Friction dampers and stops: where dry friction damps best."""

from __future__ import annotations

import math

import numpy as np

from periodic import Branch, GrazingCondition, Label, Peak, PeakToPeak, trace
from reports.studies.machines.figures import Curve
from reports.studies.machines.machine import Known, Machine, place

HZ = 2 * math.pi


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


def grazing(machine: Machine, found: Branch) -> Curve:
    """Return where the orbit grazes the wall, over frequency and force."""
    point = next(p for p in found.special_points if p.label is Label.GRAZING)
    border = trace(
        machine.system,
        "Omega",
        (0.5, 2.0),
        guess=point.orbit,
        determined={"A": GrazingCondition("impact at x = gap")},
    )
    frequency = np.array([p.parameter for p in border])
    return Curve(frequency, border.column("A"), ("frequency Ω", "force A at which it grazes"))


IMPACT = Machine(
    key="impact-oscillator",
    title="Oscillator that strikes a rigid wall",
    parameter="A",
    axis="force A",
    range=(1.0, 0.01),
    marched=(0.9, 0.6, 0.3, 0.05),
    words="COCO's problem hspo: a linear oscillator with an impact of restitution 0.8 in each period, "
    "followed from large forces down to grazing, where the impact has no speed left, and on without impacts. "
    "The orbit grazes at A = c Ω d = 0.1, and over the frequency at d |k - Ω² + i c Ω|; the fold just below "
    "is known in closed form.",
    known=(
        Known(name="fold (closed form), A", value=0.0999707536, ours=place(Label.FOLD, 0)),
        Known(name="grazing, A = c Ω d", value=0.1, ours=place(Label.GRAZING, 0)),
    ),
    two=grazing,
)

BEAM = Machine(
    key="beam-stop",
    title="Beam that strikes a stop",
    parameter="Omega",
    axis="frequency (Hz)",
    range=(16.0, 26.0),
    unit=HZ,
    size=1e-3,
    output="tip",
    swing="tip peak to peak (mm)",
    words="A clamped steel beam of ten elements, condensed exactly to its tip, with a stop there six times "
    "as stiff as the tip: the resonance stiffens from where the tip touches (GR) to the fold, and parts "
    "again beside the second one.",
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
