"""Rotors: internal damping, rub, oil whirl, squeeze film."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

import symbolic as sym
from periodic import Branch, FoldCondition, Label, trace
from reports.studies.machines.figures import Curve
from reports.studies.machines.machine import Known, Machine, place, rpm

VISCOSITY, RADIUS, LENGTH, CLEARANCE, MASS = 0.02, 25e-3, 25e-3, 1e-4, 20.0
"""Of the scene journal-bearing, SI."""

WEIGHT = 196.2


def coefficients(e: float) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness over W/c and damping over W/(c Omega) of a short cavitated bearing at eccentricity e.

    Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, Cambridge 2010, section 5.5.
    """
    p, s = math.pi**2, math.sqrt(1 - e**2)
    h = (p * (1 - e**2) + 16 * e**2) ** -1.5
    across = math.pi * (p * (1 - e**2) ** 2 - 16 * e**4) / (e * s)
    back = -math.pi * (p * (1 - e**2) * (1 + 2 * e**2) + 32 * e**2 * (1 + e**2)) / (e * s)
    along = 4 * (p * (1 + 2 * e**2) + 32 * e**2 * (1 + e**2) / (1 - e**2))
    cross = -8 * (p * (1 + 2 * e**2) - 16 * e**2)
    side = 2 * math.pi * s * (p * (1 + 2 * e**2) - 16 * e**2) / e
    front = 2 * math.pi * (p * (1 - e**2) ** 2 + 48 * e**2) / (e * s)
    stiffness = np.array([[4 * (p * (2 - e**2) + 16 * e**2), across], [back, along]])
    return h * stiffness, h * np.array([[side, cross], [cross, front]])


def whirl_onset() -> float:
    """Return the speed (rad/s) from which a rigid rotor whirls, by Routh's criterion in closed form."""

    def load(e: float) -> float:
        return math.hypot(2 * e**2 / (1 - e**2) ** 2, math.pi * e / (2 * (1 - e**2) ** 1.5))

    def excess(e: float) -> float:
        a, b = coefficients(e)
        speed = WEIGHT / (VISCOSITY * RADIUS * LENGTH**3 / (2 * CLEARANCE**2) * load(e))
        k = a[0, 0] * b[1, 1] + a[1, 1] * b[0, 0] - a[0, 1] * b[1, 0] - a[1, 0] * b[0, 1]
        k /= np.trace(b)
        ratio = ((a[0, 0] - k) * (a[1, 1] - k) - a[0, 1] * a[1, 0]) / np.linalg.det(b)
        return float(MASS * CLEARANCE / WEIGHT * ratio * speed**2 - k)

    e = brentq(excess, 0.02, 0.7, xtol=1e-14)
    return WEIGHT / (VISCOSITY * RADIUS * LENGTH**3 / (2 * CLEARANCE**2) * load(e))


def onset(found: Branch) -> float:
    """Return the NS (rev/min) under a vanishing unbalance, near that of a branch."""
    near = found.labelled(Label.TORUS)[0].parameter
    faint = trace(
        sym.scene("journal-bearing"), "speed", (0.9 * near, 1.1 * near), start=0.9 * near, values={"e": 1e-9}
    )
    return faint.labelled(Label.TORUS)[0].parameter / rpm(1.0)


def over_stiffness(machine: Machine, found: Branch) -> Curve:
    """Return the fold at which the rub ends over the stiffness of the stator."""
    fold = found.labelled(Label.FOLD)[0]
    border = trace(
        machine.system, "k_stator", (0.5, 4.0), guess=fold.orbit, determined={"speed": FoldCondition()}
    )
    stiffness = np.array([p.parameter for p in border])
    return Curve(border.column("speed"), stiffness, ("speed of the upper fold", "stiffness of the stator"))


INTERNAL = Machine(
    key="jeffcott-internal-damping",
    title="Rotor with internal damping: whirl",
    parameter="n",
    axis="speed n over the natural frequency",
    range=(1.2, 2.2),
    marched=(1.3, 1.5, 1.65),
    words="Damping of the shaft itself turns with it and drives a whirl that is slower than the shaft: the "
    "synchronous orbit loses its stability at a torus bifurcation (NS), beyond which the rotor whirls with "
    "two frequencies. D = 0.2, external damping a third of it, cubic damping 0.25, eccentricity 0.25, weight "
    "0.3924.",
    known=(
        Known(name="NS, speed n", value=1.7147671116, ours=place(Label.TORUS, 0)),
        Known(
            name="NS, angle of the multipliers (rad)",
            value=2.6163770287,
            ours=lambda found: abs(np.angle(found.labelled(Label.TORUS)[0].multipliers[0])),
        ),
    ),
)

RUB = Machine(
    key="jeffcott-rub",
    title="Rotor that rubs on its stator",
    parameter="speed",
    axis="speed over the critical one",
    range=(0.2, 2.0),
    swing="x peak to peak over the clearance",
    marched=(0.5, 0.9, 1.1, 1.6, 1.8),
    words="Unbalance, a weight, and a stator of twice the shaft's stiffness with friction 0.1: the resonance "
    "stiffens where the rotor touches, leans to high speeds and folds over.",
    two=over_stiffness,
)

JOURNAL = Machine(
    key="journal-bearing",
    title="Journal bearing: oil whirl",
    parameter="speed",
    axis="speed (rev/min)",
    range=(3000.0, 12000.0),
    unit=rpm(1.0),
    size=1e-6,
    swing="x peak to peak (µm)",
    at=(3500.0, 4500.0, 5000.0, 5500.0, 6000.0, 6500.0),
    marched=(4000.0, 6000.0, 7500.0),
    words="A rigid rotor on short bearings with a cavitated film (half-Sommerfeld) and a faint unbalance: "
    "where the film is too light it drags the shaft round at nearly half its speed. The onset for an "
    "unbalance that vanishes is known in closed form (Routh's criterion on the printed coefficients); ours "
    "is the NS of the synchronous orbit under 1 nm of eccentricity.",
    known=(
        Known(
            name="onset of oil whirl (rev/min)",
            value=whirl_onset() / rpm(1.0),
            ours=onset,
        ),
    ),
)

SQUEEZE = Machine(
    key="squeeze-film-damper",
    title="Squeeze-film damper",
    parameter="speed",
    axis="speed (rev/min)",
    range=(2000.0, 12000.0),
    unit=rpm(1.0),
    size=1e-6,
    swing="x peak to peak (µm)",
    marched=(3000.0, 5000.0, 8000.0, 11000.0),
    words="The same film about a ring that does not turn, on a centring spring: it damps the resonance, and "
    "stiffens as the orbit fills the clearance.",
)
