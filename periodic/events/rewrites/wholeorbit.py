"""An orbit that grazes a level everywhere at once, as a circle in a ring: it has no extremum, so no row."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from periodic.correction.change import Beyond
from periodic.events.modes import surface_of
from periodic.events.rewrites.table import SHORT
from periodic.events.sideconditions import Clearance
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials
from periodic.events.violations import Breach, Violation
from periodic.orbit.orbit import Orbit
from periodic.system import Kind, System

RIPPLES = 2.0
"""Distance from its level at which a switch that is constant along the orbit is held, in its variations."""

FLAT = 1e-5
"""Variation of a switch along an orbit, as a part of its size, up to which it is constant."""


@dataclass(frozen=True)
class WholeOrbit:
    """Grazing of a level by a whole orbit: the branch goes on beyond it on the same mesh."""

    name: str
    condition: Clearance
    part: float

    grazes = True
    strict = True
    final = True
    nearer = False
    last = False
    otherwise = None

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield the orbit a little beyond."""
        dense, held = SwitchPolynomials(system, orbit), self.condition
        at = dense.nearest(held.switch, held.side, held.phase)
        for depth in SHORT:
            beyond = Clearance(held.switch, -held.side, at.phase, depth * dense.size(held.switch))
            yield Beyond(orbit.mesh, orbit.phases, beyond, grazes=False)


def whole_orbit(system: System, before: Orbit, violation: Violation, part: float) -> WholeOrbit | None:
    """Return the grazing of a whole orbit, if a violation is one, held where there still is a tangent."""
    k, dense = violation.switch, SwitchPolynomials(system, before)
    if violation.breach is not Breach.EXCURSION or not isinstance(violation.at, Extremum):
        return None
    if surface_of(system, k).kind == Kind.IMPACT or not dense.flat(k, FLAT):
        return None
    ripple = RIPPLES * float(np.ptp(dense.knots[:, :, k]))
    held = Clearance(k, violation.side, violation.at.phase, ripple)
    return WholeOrbit(f"{system.switches[k].name} is grazed", held, part) if ripple else None
