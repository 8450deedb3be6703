"""Sliders that are let go together: which of them, the rest of the word says.

A slider that is carried, stops where its strain turns, and is let go the same way as it was carried is let go
where the strain is back at that turn, if it has not slipped since. So are all that stopped there with it, at
one event node; and where dry friction beside them stopped there too and holds the strain, they go with it. As
soon as one of them slips in between it is let go by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from periodic.events.modes import mode_after, of_kind, release, surface_of, twins
from periodic.events.rewrites.sites import Node
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind, SurfaceLike, System

EARLIER, LATER = (-0.5, 2.0), (1.0, 2.0 / 3.0)
"""Part and power of the length of a slip, by which a slider is let go before others that have not slipped,
and after friction: the strain it has to make up for is as its square, and grows from friction's release as
the cube of time."""


def together(system: System, nodes: Sequence[Node], size: float) -> list[Node]:
    """Return event nodes in order with sliders let go together where they are, and by themselves elsewhere.

    size: of what begins or ends, by which those that are let go by themselves are put aside.
    """
    found = list(nodes)
    for surface in of_kind(system, Kind.SLIDER):
        if len(twins(system, surface.switch)) > 1:
            for _ in nodes:
                each = (_placed(system, surface, found, r, size) for r in _releases(surface, found))
                changed = next((placed for placed in each if placed is not None), None)
                if changed is None:
                    break
                found = sorted(changed, key=lambda node: node[1])
    return found


@dataclass(frozen=True)
class Release:
    """Where a slider is let go: the node, the direction, and the node at which it stopped after having been
    carried the same way; None where it was not."""

    node: int
    direction: int
    stop: int | None


def _releases(surface: SurfaceLike, nodes: Sequence[Node]) -> Iterator[Release]:
    """Yield the releases of a slider."""
    modes = [(j, mode_after(surface, event)) for j, (event, _) in enumerate(nodes)]
    own = [(j, mode) for j, mode in modes if mode is not None]
    for k, (j, mode) in enumerate(own):
        (stop, stuck), (_, carried) = own[k - 1], own[k - 2]
        if mode != STUCK:
            returns = len(own) > 2 and stuck == STUCK and carried == mode
            yield Release(j, mode, stop if returns else None)


def _placed(
    system: System, surface: SurfaceLike, nodes: list[Node], own: Release, size: float
) -> list[Node] | None:
    """The nodes with one release where it belongs; None where it is there."""
    leader = _leader(system, surface, nodes, own)
    joint = _partners(system, surface, nodes[own.node][0])
    if leader == own.node or (leader is None and not joint):
        return None
    phase, found = nodes[own.node][1], list(nodes)
    rest = without(system, nodes[own.node][0], surface.switch)
    if leader is not None:
        event, at = found[leader]
        found[leader] = replace(event, modes=(*event.modes, (surface.switch, own.direction))), at
    if rest is not None:
        found[own.node] = rest, phase
    if leader is None:
        friction = any(k.kind == Kind.SLIDING for k in joint)
        part, power = LATER if friction else EARLIER
        alone = EventNode(release(surface, own.direction), own.direction)
        found.append((alone, phase + part * size**power))
    elif rest is None:
        del found[own.node]
    return found


def _leader(system: System, surface: SurfaceLike, nodes: Sequence[Node], own: Release) -> int | None:
    """The node at which a slider is let go with others; None where it is let go by itself."""
    if own.stop is None:
        return None
    each = [surface_of(system, k) for k in twins(system, surface.switch) if k != surface.switch]
    for other in each:
        if other.kind == Kind.SLIDING and mode_after(other, nodes[own.stop][0]) == STUCK:
            release = _after(other, nodes, own.stop)
            return release if mode_after(other, nodes[release][0]) == own.direction else None
    beside = (
        r.node for k in each if k.kind == Kind.SLIDER for r in _releases(k, nodes) if r.stop == own.stop
    )
    return next(beside, None)


def _after(surface: SurfaceLike, nodes: Sequence[Node], node: int) -> int:
    """The next node that changes a surface's mode."""
    count = len(nodes)
    each = ((node + m) % count for m in range(1, count + 1))
    return next(j for j in each if mode_after(surface, nodes[j][0]) is not None)


def _partners(system: System, surface: SurfaceLike, event: EventNode) -> list[SurfaceLike]:
    """The twins that an event node changes as well."""
    each = (surface_of(system, k) for k in twins(system, surface.switch) if k != surface.switch)
    return [other for other in each if mode_after(other, event) is not None]


def without(system: System, event: EventNode, guard: int) -> EventNode | None:
    """Return the event node of twins without one of them; None where it is its alone."""
    others = event.modes_beside(guard)
    if surface_of(system, event.switch).switch != guard:
        return replace(event, modes=others)
    if not others:
        return None
    if event.switch == guard:
        return EventNode(others[0][0], event.direction, event.level, others)
    second = surface_of(system, others[0][0])
    if second.releases is None:
        return None
    return EventNode(release(second, event.direction), event.direction, event.level, others[1:])
