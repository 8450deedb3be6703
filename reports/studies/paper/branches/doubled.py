"""Orbits of two excitation periods: found by time integration, traced, and where they come from."""

from __future__ import annotations

from functools import cache

import numpy as np

import periodic
from periodic import Branch, Label
from reports.studies.paper.common.discs import HEAVY, OIL_A, OIL_B, OIL_B_HEAVY
from reports.studies.paper.common.scenes import system
from reports.studies.paper.common.tracing import branch, traced
from symbolic.integration.flow import Flow, Trajectory
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM
from symbolic.system.compiled import with_values

SCENE = OIL_A
KNOCKED = 500.0
"""Speed in rev/min at which a hard knock starts the large motion."""

KNOCK = (-1.0, -1.0)
"""What it changes x and dx/dtau by, in static deflections."""

SETTLED = 80
"""Double periods after which the motion has settled to the integration's accuracy."""

DOUBLINGS = {
    OIL_A: (640.0, 480.0),
    HEAVY: (760.0, 560.0),
    OIL_B: (640.0, 480.0),
    OIL_B_HEAVY: (760.0, 560.0),
}
"""Ranges of speed (rev/min) about twice the natural speed of each disc."""


@cache
def knocked() -> Trajectory:
    """Return the motion at 500 rev/min over two excitation periods, once settled from a hard knock.

    It starts at rest but for the knock. CVODES, tolerance 1e-9.
    """
    disc, values = system(SCENE), {"speed": KNOCKED * RPM}
    rest, flow = modes(disc, values), Flow(disc, 1e-9)
    state, unknown = rest.state.copy(), rest.algebraic
    state[:2] += KNOCK
    phase = np.linspace(0, 4 * np.pi, 801)
    for _ in range(SETTLED):
        last = flow.run(state, unknown, with_values(disc, values), phase)
        state, unknown = last.state[-1], last.algebraic[-1]
    return last


@cache
def doubled() -> Branch:
    """Return the closed branch of orbits of two excitation periods through the knocked motion."""
    disc, motion = system(SCENE), knocked()
    parameter = with_values(disc, {"speed": KNOCKED * RPM})
    guess = periodic.sampled(motion.phase, motion.state, motion.algebraic, parameter)
    return traced(disc, "speed", (400, 640), start=KNOCKED, guess=guess)


def small(name: str = SCENE) -> Branch:
    """Return the orbits of one period about twice the natural speed of a disc."""
    return branch(name, *DOUBLINGS[name])


def speeds(found: Branch, label: Label) -> list[float]:
    """Return the speeds (rev/min) of the points with one label, slowest first, each once."""
    rounded = {round(p.parameter / RPM, 3): p.parameter / RPM for p in found.labelled(label)}
    return [rounded[key] for key in sorted(rounded)]
