"""Whether the orbits of a branch keep their words, on samples: at every point, not only at those judged.

The engine's own test encloses polynomials, and leaves out what begins or ends at an event node. Here the
guard of each joint is looked at, and its releases where it is held, at many phases, with nothing left out.
"""

from __future__ import annotations

import numpy as np

import periodic as per
from periodic.events.modes import sides
from periodic.orbit.orbit import Orbit
from periodic.system import HELD, MINUS, PLUS, STUCK, System, guards, surfaces_of

PLACES = np.linspace(0.0, 1.0, 9)
"""In each interval."""

FAR = 1e-6
"""How far a switch may be past its level, as a part of its largest value: the orbits' tolerance, ..."""

ROUNDING = 16 * np.finfo(float).eps
"""... beside rounding, as a part of the largest state: a slip that has just begun has a speed of 1e-11."""


def outside(system: System, orbit: Orbit) -> tuple[float, str]:
    """Return how far the joints of an orbit are outside their modes at the most, in parts, and which is."""
    modes, scheme = sides(system, orbit), orbit.mesh.scheme
    states = np.einsum("tl,iln->itn", scheme.basis(PLACES), orbit.knots).reshape(-1, orbit.nodes.shape[1])
    tau = (orbit.grid.left[:, None] + orbit.grid.width[:, None] * PLACES).ravel()
    values = guards(system, states, tau, orbit.parameter, np.repeat(modes, len(PLACES), axis=0))
    most, worst, rounding = 0.0, "", ROUNDING * float(np.abs(states).max())
    for surface in surfaces_of(system):
        if surface.releases is None or surface.column is None:
            continue
        mode = np.repeat(modes[:, surface.column], len(PLACES))
        (up, down), held = surface.releases, (mode == STUCK) | (mode == HELD)
        signs = np.where((mode == PLUS) | (mode == MINUS), mode, 0.0)
        past = {surface.switch: -signs * values[:, surface.switch]}
        past |= {up: np.where(held, values[:, up], 0.0), down: np.where(held, -values[:, down], 0.0)}
        limit = float(np.abs(values[:, [up, down]]).max())
        for k, far in past.items():
            part = (float(far.max()) - rounding) / max(
                limit if k != surface.switch else np.abs(values[:, k]).max(), 1e-300
            )
            if part > most:
                most, worst = part, f"{system.switches[k].name} at {tau[far.argmax()]:.4f} rad"
    return most, worst


def strays(system: System, branch: per.Branch) -> list[str]:
    """Return the points of a branch whose orbits do not keep their words."""
    found = list[str]()
    for point in branch:
        far, where = outside(system, point.orbit)
        if far > FAR:
            found.append(f"Omega {point.parameter!r}: {where} is {far:.1e} of its range outside its mode")
    return found
