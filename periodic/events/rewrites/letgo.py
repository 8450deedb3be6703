"""Sliders that come to be let go at once because a slip before them ends.

Two sliders stopped at one turn of their strain. One of them then slipped, and is let go by itself after that;
the other is let go where the strain is back at that turn. The shorter the slip, the nearer to each other are
both releases: they meet where it is gone, and beyond, neither has slipped and they are one event. So that is
the end of the slip; its releases never change places. How near they are is the square of the slip's length.
"""

from __future__ import annotations

from periodic.events.modes import mode_after, surface_of
from periodic.events.rewrites.ends import Excursion, ends, excursions
from periodic.events.rewrites.rewrite import rewritten
from periodic.events.rewrites.table import LIMIT_GRAZING, SWAP
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


def let_go_at_once(system: System, orbit: Orbit, swap: Excursion) -> bool:
    """Return whether two event nodes that come together become one where the slip of a slider ends."""
    if swap.row is not SWAP:
        return False
    nodes = (orbit.mesh.events[j % len(orbit.phases)] for j in (swap.index, swap.index + 1))
    both = [_slider(system, event) for event in nodes]
    if any(slider is None for slider in both) or _one(both, orbit.mesh.events):
        return False
    slips = (excursion for excursion in excursions(system, orbit) if excursion.row is LIMIT_GRAZING)
    own = (slip for slip in slips if surface_of(system, orbit.mesh.events[slip.index].switch) in both)
    for slip in own:
        gone, size = ends(system, orbit, slip), slip.size(system, orbit)
        if _one(both, rewritten(system, orbit, gone, size)[0]):
            return True
    return False


def _slider(system: System, event: EventNode) -> SurfaceLike | None:
    """The slider that an event node lets go; None where it is another event."""
    surface = surface_of(system, event.switch)
    mode = mode_after(surface, event) if surface.kind == Kind.SLIDER else None
    return None if mode is None or mode == STUCK else surface


def _one(sliders: list[SurfaceLike | None], events: tuple[EventNode, ...]) -> bool:
    """Whether all sliders are let go at one event node."""
    each = ([mode_after(slider, event) for slider in sliders if slider is not None] for event in events)
    return any(None not in modes and STUCK not in modes for modes in each)
