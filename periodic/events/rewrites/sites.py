"""Sites: places on one orbit at which a row of the table may be applied, and what that does to its word."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from periodic.correction.condition import SideCondition
from periodic.events.rewrites.table import Row
from periodic.events.switchpolynomials import Extremum
from periodic.orbit.mesh import EventNode, wrapped
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array

Node = tuple[EventNode, float]
"""An event node and its phase."""


@dataclass(frozen=True)
class Added:
    """A new event node: it lies part * size^power from a phase."""

    event: EventNode
    phase: float
    part: float
    power: float = 1.0

    def at(self, size: float) -> Node:
        """Return the event node with its phase for a size."""
        return self.event, self.phase + self.part * size**self.power


@dataclass(frozen=True)
class Site:
    """A place where an excursion, or another change of the word, may begin or end.

    Parameters
    ----------
    row : Row
        The row of the table.
    switch : int
        The switch that decides.
    at : Extremum or int
        An extremum of the switch, or an event node.
    held : SideCondition
        The condition that is 0 on the orbit where it begins or ends.
    value : float
        How far the condition is from 0; positive as long as it is not reached.
    added : tuple of Added
        New event nodes; with the first of them the change begins.
    removed : tuple of int
        Event nodes that are removed.
    replaced : tuple of (int, EventNode)
        Event nodes that keep their phase, with those that take their place.
    """

    row: Row
    switch: int
    at: Extremum | int
    held: SideCondition
    value: float
    added: tuple[Added, ...] = ()
    removed: tuple[int, ...] = ()
    replaced: tuple[tuple[int, EventNode], ...] = ()

    def begin(self, orbit: Orbit, size: float) -> Node:
        """The event node at which the change begins, with its phase, for a size."""
        early = any(each.part < 0 for each in self.added)
        if self.replaced and isinstance(self.at, int) and not early:
            node, event = self.replaced[0]
            return event, float(orbit.phases[node])
        return self.added[0].at(size)


def edited(orbit: Orbit, sites: Iterable[Site], size: float) -> list[Node]:
    """Return event nodes and phases of an orbit after the edits at some sites."""
    nodes = dict(enumerate(zip(orbit.mesh.events, map(float, orbit.phases), strict=True)))
    added = list[Node]()
    for site in sites:
        for index, event in site.replaced:
            nodes[index] = event, nodes[index][1]
        for index in site.removed:
            nodes.pop(index, None)
        added += [each.at(size) for each in site.added]
    return [*nodes.values(), *added]


def ordered(both: Iterable[Node], orbit: Orbit) -> tuple[tuple[EventNode, ...], Array]:
    """Return event nodes and their phases in order, the first phase in [0, period)."""
    placed = in_order(both, orbit)
    return tuple(event for event, _ in placed), np.array([phase for _, phase in placed])


def in_order(both: Iterable[Node], orbit: Orbit) -> list[Node]:
    """Return event nodes in the order of their phases, these in [0, period)."""
    wrapped = ((event, float(np.mod(phase, orbit.mesh.period))) for event, phase in both)
    return sorted(wrapped, key=lambda node: node[1])


def has(events: tuple[EventNode, ...], phases: Array, node: Node, orbit: Orbit) -> bool:
    """Return whether an event node is among others at its own phase: sliders may be released with others."""
    place = np.mod(node[1], orbit.mesh.period)
    return any(event == node[0] and phase == place for event, phase in zip(events, phases, strict=True))


def index_of(events: tuple[EventNode, ...], phases: Array, node: Node, orbit: Orbit) -> int:
    """Return the index of an event node."""
    place = np.mod(node[1], orbit.mesh.period)
    return next(i for i, event in enumerate(events) if event == node[0] and phases[i] == place)


def apart(one: float, other: float, orbit: Orbit) -> float:
    """Return how far two phases are from each other."""
    return abs(wrapped(one - other, orbit.mesh.period))
