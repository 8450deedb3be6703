"""Changes of mode that an impact causes: it takes guards of other surfaces to their other side.

An impact of a mass reverses its speed, and with it the speed at which friction on the mass slides. The mode
of that surface changes at the impact's own event node. Against a moving belt the guard may also jump without
a change of sign, or be 0 just before or just after an impact whose speed is not 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.events.impacts import slope_before, tied
from periodic.events.modes import mode_after, sides
from periodic.events.rates import before
from periodic.events.thresholds import AT_LEVEL
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System, guards, surfaces_of


@dataclass(frozen=True)
class Sides:
    """A guard just before and just after an impact, in parts of its largest value, and its mode before."""

    before: float
    after: float
    mode: int

    @property
    def reached(self) -> int:
        """The side of the guard after the impact; its mode before where it is at its level."""
        return int(np.sign(self.after)) if abs(self.after) > AT_LEVEL else self.mode


def beside(system: System, orbit: Orbit, index: int, surface: SurfaceLike) -> Sides:
    """Return a guard before and after an impact."""
    interval, x, phase = before(orbit, index)
    after = orbit.nodes[orbit.mesh.starts[index]][None]
    states = np.concatenate([orbit.stages.reshape(-1, x.shape[1]), x, after])
    tau = np.concatenate([orbit.stage_phases.ravel(), phase, phase])
    modes = sides(system, orbit)[interval]  # those before the impact
    values = guards(system, states, tau, orbit.parameter, np.repeat(modes[None], len(tau), axis=0))
    values = values[:, surface.switch]
    values = values / (float(np.abs(values).max()) or 1.0)
    early, late = float(values[-2]), float(values[-1])
    mode = 0 if surface.column is None else int(sides(system, orbit)[interval, surface.column])
    if mode == 0 and abs(early) > AT_LEVEL:
        mode = int(np.sign(early))
    return Sides(early, late, mode)


def thrown(system: System, orbit: Orbit, surface: SurfaceLike) -> list[int]:
    """Return the impacts of an orbit, by their event nodes, at which the guard of another surface jumps.

    Impacts at which the guard would be 0 if they had no speed are left out, as for friction on the ground:
    there the guard passes its level once the impact is gone.
    """
    if surface.kind not in (Kind.SLIDING, Kind.SLIDER):
        return []
    return [index for index in tied(system, orbit) if _thrown(system, orbit, surface.switch, index)]


def _thrown(system: System, orbit: Orbit, switch: int, index: int) -> bool:
    """Whether a guard jumps at an impact, and is not 0 between x- and x+ where the impact has no speed."""
    _, x, phase = before(orbit, index)
    start, own = orbit.mesh.starts[index], orbit.mesh.events[index].switch
    after = orbit.nodes[start][None]
    by_state, by_phase, _ = system.switch_gradient(after, phase, orbit.parameter)
    arriving = slope_before(system, orbit, index)
    leaving = float(by_phase[0, own] + by_state[0, own] @ orbit.node_rates[start])
    if arriving == leaving:
        return False
    still = x + arriving / (arriving - leaving) * (after - x)
    states, tau = np.concatenate([x, after, still]), np.repeat(phase, 3)
    early, late, between = system.switch(states, tau, orbit.parameter)[:, switch]
    least = AT_LEVEL * max(abs(early), abs(late))
    return bool(abs(late - early) > least and abs(between) > least)


def others(system: System, event: EventNode) -> list[SurfaceLike]:
    """Return the surfaces that an impact may take to their other sides."""
    bent = (Kind.KINK, Kind.JUMP, Kind.SLIDING, Kind.SLIDER, Kind.RELAY)
    return [s for s in surfaces_of(system) if s.kind in bent and s.switch != event.switch]


def brought_about(system: System, orbit: Orbit, index: int) -> tuple[tuple[int, int], ...]:
    """Return the modes that an impact of an orbit causes, in the form of its event node."""
    event = orbit.mesh.events[index]
    found = [pair for pair in event.modes if pair == (event.switch, STUCK)]  # it rests on the wall
    for surface in others(system, event):
        stated, own = mode_after(surface, event), beside(system, orbit, index, surface)
        if stated == STUCK and abs(own.after) <= AT_LEVEL:
            found.append((surface.switch, STUCK))
        elif own.reached not in (0, own.mode):
            found.append((surface.switch, own.reached))
    return tuple(found)
