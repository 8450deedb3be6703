"""Sliders of one strain that come to be let go at once, because a slip before them ends or begins.

They are let go in an order that the turns of the strain decide (Masing); only where their limits cross as a
parameter changes do two that stopped at one turn change places. One that slipped last the same way is let go
where the strain is back at the turn at which it stopped, one that slipped the other way at twice its limit
from that turn. So two releases meet

- where a slip ends: both stopped at one turn, one of them has slipped since, and is let go the earlier the
  longer that slip was (as its square),
- where a slip begins: one is let go where the strain is back at a turn, at which the other just reached its
  limit; beyond, both stop there.

In both cases they are let go at one event node beyond.
"""

from __future__ import annotations

from collections.abc import Iterator

from periodic.events.modes import mode_after, surface_of
from periodic.events.rewrites.ends import Excursion, ends, excursions
from periodic.events.rewrites.grazingonsets import sites_of
from periodic.events.rewrites.rewrite import rewritten
from periodic.events.rewrites.sites import Site
from periodic.events.rewrites.table import LIMIT_GRAZING, SWAP
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind, SurfaceLike, System


def slip_that_joins(system: System, orbit: Orbit, swap: Excursion) -> Site | None:
    """Return where a slip ends or begins so that two event nodes that come together become one.

    None where they may change places. The site of one that begins has event nodes to add.
    """
    if swap.row is not SWAP:
        return None
    nodes = (orbit.mesh.events[j % len(orbit.phases)] for j in (swap.index, swap.index + 1))
    both = [slider for slider in (_slider(system, event) for event in nodes) if slider is not None]
    if len(both) < 2:
        return None
    before = _at_once(both, orbit.mesh.events)
    for site, size in _slips(system, orbit, [slider for slider, _ in both]):
        if _at_once(both, rewritten(system, orbit, [site], size)[0]) > before:
            return site
    return None


def _slips(system: System, orbit: Orbit, sliders: list[SurfaceLike]) -> Iterator[tuple[Site, float]]:
    """Yield the slips of sliders that may end or begin, with sizes; what is nearest to its limit first."""
    for slip in excursions(system, orbit):
        if slip.row is LIMIT_GRAZING and surface_of(system, orbit.mesh.events[slip.index].switch) in sliders:
            yield ends(system, orbit, slip)[0], slip.size(system, orbit)
    sites = sites_of(system, orbit, LIMIT_GRAZING.name, sliders)
    for site in sorted(sites, key=lambda site: abs(site.value)):
        yield site, LIMIT_GRAZING.least


def _slider(system: System, event: EventNode) -> tuple[SurfaceLike, int] | None:
    """The slider that an event node lets go, and its mode then; None where it is another event."""
    surface = surface_of(system, event.switch)
    mode = mode_after(surface, event) if surface.kind == Kind.SLIDER else None
    return None if mode is None or mode == STUCK else (surface, mode)


def _at_once(sliders: list[tuple[SurfaceLike, int]], events: tuple[EventNode, ...]) -> int:
    """The number of event nodes at which all sliders are let go, each to the side that is given."""
    return sum(all(mode_after(slider, event) == way for slider, way in sliders) for event in events)
