"""Whether two words differ without grazing: only by events that change places, and by slips and sticks.

Where a level is grazed (by an excursion, a stick inside a slip, the first slip of a slider) multipliers jump,
and the branch has a labelled point. Swaps, adding-, crossing- and switching-sliding, and stops that become
one, graze nothing: between two orbits whose words differ by these alone no point is to be located.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from periodic.events.modes import mode_after
from periodic.events.rewrites.sites import Node
from periodic.system import STUCK, Kind, SurfaceLike, System, surfaces_of


@dataclass(frozen=True)
class Stay:
    """A stretch of the period in which a surface is in one mode, and the modes before and after it."""

    mode: int
    begin: float
    length: float
    before: int
    after: int

    def overlaps(self, other: Stay, period: float) -> bool:
        """Whether another one lies at the same phases, in part."""
        later = float(np.mod(other.begin - self.begin, period))
        return later < self.length or period - later < other.length


def without_grazing(system: System, one: Sequence[Node], other: Sequence[Node], period: float) -> bool:
    """Return whether no level is grazed between two orbits that are near each other, by their words.

    What may only begin or end with grazing must be in both words, at phases that overlap.

    Parameters
    ----------
    system : System
        The system.
    one, other : sequence of (EventNode, float)
        The event nodes of both orbits in order, with their phases.
    period : float
        The period (rad).
    """
    for surface in surfaces_of(system):
        stays, others = (_stays(surface, nodes, period) for nodes in (one, other))
        if surface.kind == Kind.SLIDING:
            both = (stays, others), (others, stays)
            if bool(stays) != bool(others) or not all(_persist(*pair, period) for pair in both):
                return False
        elif not _alike(stays, others, period):
            return False
    return True


def _stays(surface: SurfaceLike, nodes: Sequence[Node], period: float) -> list[Stay]:
    """The stretches in which a surface is in one mode after the other; none where it never changes."""
    each = ((mode_after(surface, event), phase) for event, phase in nodes)
    own = [(mode, phase) for mode, phase in each if mode is not None]
    found = list[Stay]()
    for k, (mode, phase) in enumerate(own):
        after, end = own[(k + 1) % len(own)]
        found.append(Stay(mode, phase, float(np.mod(end - phase, period)) or period, own[k - 1][0], after))
    return found


def _alike(stays: Sequence[Stay], others: Sequence[Stay], period: float) -> bool:
    """Whether both have as many stretches in each mode, and each has one of the other in its place."""
    if sorted(stay.mode for stay in stays) != sorted(stay.mode for stay in others):
        return False
    both = (stays, others), (others, stays)
    return all(_overlapped(stay, theirs, {stay.mode}, period) for ours, theirs in both for stay in ours)


def _persist(stays: Iterable[Stay], others: Sequence[Stay], period: float) -> bool:
    """Whether what friction does in one word may be there, in the other word, or begin without grazing.

    A slip may begin where friction holds, and a stick where it reverses.
    """
    for stay in stays:
        reverses = stay.mode == STUCK and stay.before == -stay.after
        if not reverses and not _overlapped(stay, others, {STUCK, stay.mode}, period):
            return False
    return True


def _overlapped(stay: Stay, others: Iterable[Stay], modes: set[int], period: float) -> bool:
    """Whether a stretch overlaps one of others that is in one of some modes."""
    return any(other.mode in modes and stay.overlaps(other, period) for other in others)
