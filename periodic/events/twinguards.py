"""Guards that are one function, up to a factor: always, or where joints are held.

The speeds at which sliders side by side are strained are one. Where friction between two masses holds, they
have one speed: so have the joints from either of them to the same place. What has one guard stops at once.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import cast

import numpy as np

from periodic.events.modes import mode_after, of_held, of_kind, sides
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, Kind, System, surfaces_of
from periodic.system.precision import EPSILON

LOOKS = 3
"""States at which guards are compared."""

SAME = EPSILON**0.5
"""How far gradients of one function may be apart, relatively."""

_KEPT: weakref.WeakKeyDictionary[System, dict[tuple[int, ...], dict[int, int]]] = weakref.WeakKeyDictionary()
"""What was found, by systems, and by the switch and the held joints."""


def twins(system: System, switch: int, held: Sequence[int] = ()) -> dict[int, int]:
    """Return the guards of surfaces at which motions may be held that are one function, this one first.

    Parameters
    ----------
    system : System
        The system.
    switch : int
        A guard.
    held : sequence of int
        Guards of friction that is held: what differs by multiples of these is one.

    Returns
    -------
    dict of int to int
        The guards, each with the sign of the factor between it and the first.
    """
    every = of_held(system)
    if switch not in every or len(every) < 2:
        return {switch: 1}
    kept = _KEPT.setdefault(system, {})
    key = (switch, *sorted(set(held) - {switch}))
    if key not in kept:
        kept[key] = _alike(system, switch, every, key[1:])
    return kept[key]


def holding(system: System, switch: int, held: Sequence[int]) -> dict[int, int]:
    """Return which of the held joints hold a guard at 0, with the signs of its parts along theirs.

    Its guard is a sum of multiples of theirs. Empty where it is not.
    """
    rows = _rows(system)
    if not held or switch in held or _less(rows, switch, held).any():
        return {}
    along = rows[:, list(held)]
    parts = np.einsum("ij,ijk->ik", rows[:, switch], np.linalg.pinv(along)) * np.abs(along).max(axis=2)
    part = parts[0]
    return {k: 1 if c > 0 else -1 for k, c in zip(held, part, strict=True) if abs(c) > SAME * abs(part).max()}


def _alike(system: System, switch: int, every: Sequence[int], held: Sequence[int]) -> dict[int, int]:
    """The twins, by gradients and values at some states, less what they have of those of held joints."""
    rows = _rows(system)
    own, found = _less(rows, switch, held), {switch: 1}
    for k in every if own.any() else ():
        other = _less(rows, k, held)
        factor = float(np.sum(own * other) / np.sum(own**2))
        if k != switch and factor and np.abs(other - factor * own).max() <= SAME * np.abs(other).max():
            found[k] = 1 if factor > 0 else -1
    return found


def _rows(system: System) -> Array:
    """Gradients and values of all switches at some states, shape (LOOKS, switches, n+1)."""
    state, _ = system.rest(system.nominal)
    moved = state + np.random.default_rng(1).normal(size=(LOOKS, len(state)))
    given = moved, np.arange(float(LOOKS)), system.nominal
    return np.concatenate([system.switch_gradient(*given)[0], system.switch(*given)[:, :, None]], axis=2)


def _less(rows: Array, switch: int, held: Sequence[int]) -> Array:
    """A guard's gradients and values, (LOOKS, n+1), less their parts along those of held joints."""
    own = rows[:, switch]
    if not held:
        return own
    along = rows[:, list(held)]
    left = own - np.einsum("ij,ijk,ikl->il", own, np.linalg.pinv(along), along)
    return np.where(np.abs(left) > SAME * np.abs(own).max(), left, 0.0)


def held_at(system: System, events: Sequence[EventNode], node: int, always: Sequence[int] = ()) -> list[int]:
    """Return the guards of friction that is held before and after an event node, or `always`."""
    found = list(always)
    for surface in surfaces_of(system):
        if surface.kind != Kind.SLIDING or mode_after(surface, events[node]) is not None:
            continue
        changes = (mode_after(surface, events[(node - m) % len(events)]) for m in range(1, len(events)))
        if next((mode for mode in changes if mode is not None), None) == STUCK:
            found.append(surface.switch)
    return found


def held_in(system: System, orbit: Orbit, interval: int) -> list[int]:
    """Return the guards of friction that is held in an interval of an orbit."""
    modes = sides(system, orbit)[interval]
    each = (s for s in of_kind(system, Kind.SLIDING) if s.column is not None)
    return [s.switch for s in each if modes[cast(int, s.column)] in (STUCK, HELD)]
