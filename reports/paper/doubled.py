"""Orbits of two excitation periods: found by time integration, traced, and where they come from."""

from __future__ import annotations

from functools import cache

import numpy as np

import periodic
from reports.paper.scenes import branch, system
from reports.view import RPM
from symbolic.flow import Flow, Trajectory
from symbolic.linear import modes, with_values

SCENE = "vitrea79-810N"
KNOCKED = 500.0
"""Speed in rev/min at which a hard knock starts the large motion."""

KNOCK = (-1.0, -1.0)
"""What it changes x and dx/dtau by, in static deflections."""

SETTLED = 80
"""Double periods after which the motion has settled to the integration's accuracy."""

DOUBLINGS = {
    "vitrea79-810N": (640.0, 480.0),
    "vitrea79-2100N": (760.0, 560.0),
    "turbo33-810N": (640.0, 480.0),
    "turbo33-2100N": (760.0, 560.0),
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
def doubled() -> periodic.Branch:
    """Return the closed branch of orbits of two excitation periods through the knocked motion."""
    disc, motion = system(SCENE), knocked()
    parameter = with_values(disc, {"speed": KNOCKED * RPM})
    guess = periodic.sampled(motion.phase, motion.state, motion.algebraic, parameter)
    return periodic.trace(disc, "speed", (400 * RPM, 640 * RPM), start=KNOCKED * RPM, guess=guess)


def small(name: str = SCENE) -> periodic.Branch:
    """Return the orbits of one period about twice the natural speed of a disc."""
    return branch(name, *DOUBLINGS[name])


def speeds(found: periodic.Branch, label: periodic.Label) -> list[float]:
    """Return the speeds (rev/min) of the points with one label, slowest first, each once."""
    rounded = {round(p.parameter / RPM, 3): p.parameter / RPM for p in found.labelled(label)}
    return [rounded[key] for key in sorted(rounded)]
