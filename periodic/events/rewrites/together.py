"""Sliders that are released together: the rest of the word determines which.

A slider that is carried stops where its strain turns. If it is released the same way, and has not slipped
since, it is released where the strain is back at that turn. So are all sliders that stopped there with it, at
one event node. Where dry friction in parallel stopped there too and holds the strain, they are released with
the friction. A slider that slips in between is released by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from periodic.events.modes import mode_after, of_kind, release, surface_of
from periodic.events.rewrites.sites import Node
from periodic.events.twinguards import held_at, holding, twins
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind, SurfaceLike, System

EARLIER, LATER = (-0.5, 2.0), (1.0, 2.0 / 3.0)
"""Part and power of the length of a slip by which a slider is released before others that have not slipped,
and after friction: the strain to be made up is as the length squared, and the strain grows from friction's
release as the cube of time."""


def together(system: System, nodes: Sequence[Node], size: float, held: Sequence[int] = ()) -> list[Node]:
    """Return event nodes in order, with sliders released together where the word says so, else by themselves.

    size: of the excursion that begins or ends; releases of single sliders are moved by it. held: the guards
    of friction that is held all along.
    """
    joints = of_kind(system, Kind.SLIDING, Kind.SLIDER)
    word = Word(system, list(nodes), held)
    for surface in of_kind(system, Kind.SLIDER) if len(joints) > 1 else ():
        for _ in nodes:
            each = (_placed(word, surface, r, size) for r in word.releases(surface))
            changed = next((placed for placed in each if placed is not None), None)
            if changed is None:
                break
            word = Word(system, sorted(changed, key=lambda node: node[1]), held)
    return word.nodes


@dataclass(frozen=True)
class Word:
    """The event nodes of an orbit of a system, and the guards of friction that is held all along."""

    system: System
    nodes: list[Node]
    held: Sequence[int]
    _modes: dict[int, list[int | None]] = field(default_factory=dict, init=False)
    _held: dict[int, list[int]] = field(default_factory=dict, init=False)

    def modes(self, surface: SurfaceLike) -> list[int | None]:
        """Return the mode of a surface after each event node; None where the node does not change it."""
        if surface.switch not in self._modes:
            self._modes[surface.switch] = [mode_after(surface, event) for event, _ in self.nodes]
        return self._modes[surface.switch]

    def releases(self, surface: SurfaceLike) -> Iterator[Release]:
        """Yield the releases of a slider."""
        own = [(j, mode) for j, mode in enumerate(self.modes(surface)) if mode is not None]
        for k, (j, mode) in enumerate(own):
            (stop, stuck), (_, carried) = own[k - 1], own[(k - 2) % len(own)]
            if mode != STUCK:
                returns = len(own) > 2 and stuck == STUCK and carried == mode
                yield Release(j, mode, stop if returns else None)

    def held_at(self, node: int) -> list[int]:
        """Return the guards of friction that is held before and after an event node."""
        if node not in self._held:
            self._held[node] = held_at(self.system, [event for event, _ in self.nodes], node, self.held)
        return self._held[node]

    def twins(self, surface: SurfaceLike, node: int) -> list[tuple[SurfaceLike, int]]:
        """Return the other surfaces with the same guard as one at an event node, and their signs."""
        each = twins(self.system, surface.switch, self.held_at(node)).items()
        return [(surface_of(self.system, k), sign) for k, sign in each if k != surface.switch]

    def holding(self, surface: SurfaceLike, node: int) -> dict[int, int]:
        """Return the guards of friction that holds the strain of a slider after a node, with signs."""
        each = of_kind(self.system, Kind.SLIDING)
        stopped = [k.switch for k in each if self.modes(k)[node] == STUCK]
        return holding(self.system, surface.switch, [*self.held_at(node), *stopped])

    def freed(self, surface: SurfaceLike, node: int) -> bool:
        """Whether friction is released at a node that held the strain of a slider before."""
        each = of_kind(self.system, Kind.SLIDING)
        released = [k.switch for k in each if self.modes(k)[node] not in (None, STUCK)]
        held = [*self.held_at(node), *released]
        return bool(released and set(holding(self.system, surface.switch, held)) & set(released))


@dataclass(frozen=True)
class Release:
    """The release of a slider: the node, the direction, and the node at which it stopped after having been
    carried the same way; None where it was not."""

    node: int
    direction: int
    stop: int | None


def _placed(word: Word, surface: SurfaceLike, own: Release, size: float) -> list[Node] | None:
    """The nodes with a release moved to where it belongs; None where it is there already."""
    system, nodes = word.system, word.nodes
    leader = _leader(word, surface, own)
    joint = _partners(word, surface, own)
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


def _leader(word: Word, surface: SurfaceLike, own: Release) -> int | None:
    """The node at which a slider is released with others; None where it is released by itself."""
    if own.stop is None:
        return None
    if friction := word.holding(surface, own.stop):
        each = ((_after(word.modes(surface_of(word.system, k)), own.stop), k) for k in friction)
        after, k = min(((after, k) for after, k in each if after), default=(0, 0))
        if not after:
            return None
        node = (own.stop + after) % len(word.nodes)
        onward = word.modes(surface_of(word.system, k))[node] == friction[k] * own.direction
        return node if onward else None
    for other, _ in word.twins(surface, own.stop):
        if other.kind == Kind.SLIDER and word.modes(other)[own.stop] == STUCK:
            for release in word.releases(other):
                with_others = release.stop == own.stop and not word.freed(surface, release.node)
                if with_others and _one_guard(word, surface, other, own.stop, release.node):
                    return release.node
    return None


def _one_guard(word: Word, one: SurfaceLike, other: SurfaceLike, begin: int, end: int) -> bool:
    """Whether two surfaces are twins from one node to another; held friction may keep both guards at 0."""
    if other.switch in twins(word.system, one.switch):
        return True
    count = (end - begin) % len(word.nodes)
    between = ((begin + m) % len(word.nodes) for m in range(count + 1))
    return all(other in (k for k, _ in word.twins(one, node)) for node in between)


def _after(modes: Sequence[int | None], node: int) -> int:
    """The number of nodes from one to the next that changes a surface's mode; 0 where none does."""
    changes = (m for m in range(1, len(modes) + 1) if modes[(node + m) % len(modes)] is not None)
    return next(changes, 0)


def _partners(word: Word, surface: SurfaceLike, own: Release) -> list[SurfaceLike]:
    """A slider's twins, and friction that held its strain, that the slider's event node changes as well."""
    friction = {} if own.stop is None else word.holding(surface, own.stop)
    each = [*(k for k, _ in word.twins(surface, own.node)), *(surface_of(word.system, k) for k in friction)]
    return [other for other in each if word.modes(other)[own.node] is not None]


def without(system: System, event: EventNode, guard: int) -> EventNode | None:
    """Return the event node of twins without one of them; None where no other is left."""
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
