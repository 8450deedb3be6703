"""Guards that are the same function, up to a factor: always, or where joints are held.

Sliders in parallel are strained at the same speed. Where friction between two masses holds, both have the
same speed, and so have the joints from either of them to the same place. Joints with the same guard stop
simultaneously.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import cast

import numpy as np

from periodic.events.modes import mode_after, of_held, of_kind, sides
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import HELD, STUCK, Kind, SurfaceLike, System
from periodic.system.precision import EPSILON

LOOKS = 3
"""States at which guards are compared."""

SAME = EPSILON**0.5
"""How far gradients of one function may be apart, relatively."""


@dataclass
class _Known:
    """Gradients and values of a system's switches at some states, and the twins found, by guards."""

    rows: Array
    twins: dict[tuple[int, ...], dict[int, int]] = field(default_factory=dict)
    holding: dict[tuple[int, ...], dict[int, int]] = field(default_factory=dict)


_KEPT: weakref.WeakKeyDictionary[System, _Known] = weakref.WeakKeyDictionary()


def twins(system: System, switch: int, held: Sequence[int] = ()) -> dict[int, int]:
    """Return the guards of surfaces that hold motions that are the same function, this one first.

    Each has the sign of the factor between it and the first. held: guards of friction that is held; guards
    that differ by multiples of these are the same.
    """
    every = of_held(system)
    if switch not in every or len(every) < 2:
        return {switch: 1}
    known = _known(system)
    key = (switch, *sorted(set(held) - {switch}))
    if key not in known.twins:
        known.twins[key] = _alike(known.rows, switch, every, key[1:])
    return known.twins[key]


def holding(system: System, switch: int, held: Sequence[int]) -> dict[int, int]:
    """Return which of the held joints hold a guard at 0, with the signs of its coefficients.

    The guard is a linear combination of their guards. Empty where it is not.
    """
    if not held or switch in held:
        return {}
    known, key = _known(system), (switch, *held)
    if key not in known.holding:
        known.holding[key] = _parts(known.rows, switch, held)
    return known.holding[key]


def _parts(rows: Array, switch: int, held: Sequence[int]) -> dict[int, int]:
    """The signs of a guard's coefficients in the guards of held joints; empty if it is no combination."""
    if _less(rows, switch, held).any():
        return {}
    along = rows[:, list(held)]
    parts = np.einsum("ij,ijk->ik", rows[:, switch], np.linalg.pinv(along)) * np.abs(along).max(axis=2)
    part = parts[0]
    return {k: 1 if c > 0 else -1 for k, c in zip(held, part, strict=True) if abs(c) > SAME * abs(part).max()}


def _alike(rows: Array, switch: int, every: Sequence[int], held: Sequence[int]) -> dict[int, int]:
    """The twins, by gradients and values at some states, less their parts along the held joints' guards."""
    own, found = _less(rows, switch, held), {switch: 1}
    for k in every if own.any() else ():
        other = _less(rows, k, held)
        factor = float(np.sum(own * other) / np.sum(own**2))
        if k != switch and factor and np.abs(other - factor * own).max() <= SAME * np.abs(other).max():
            found[k] = 1 if factor > 0 else -1
    return found


def _known(system: System) -> _Known:
    """Gradients and values of all switches at some states, shape (LOOKS, switches, n+1), from a cache."""
    if system not in _KEPT:
        state, _ = system.rest(system.nominal)
        moved = state + np.random.default_rng(1).normal(size=(LOOKS, len(state)))
        given = moved, np.arange(float(LOOKS)), system.nominal
        values = system.switch(*given)[:, :, None]
        _KEPT[system] = _Known(np.concatenate([system.switch_gradient(*given)[0], values], axis=2))
    return _KEPT[system]


def _less(rows: Array, switch: int, held: Sequence[int]) -> Array:
    """A guard's gradients and values, (LOOKS, n+1), less their projection on those of held joints."""
    own = rows[:, switch]
    if not held:
        return own
    along = rows[:, list(held)]
    left = own - np.einsum("ij,ijk,ikl->il", own, np.linalg.pinv(along), along)
    return np.where(np.abs(left) > SAME * np.abs(own).max(), left, 0.0)


def held_throughout(system: System, modes: Sequence[tuple[int, int]]) -> list[int]:
    """Return the guards of friction that is held all along, by the modes of surfaces all along.

    What a slider that is held all along is strained by need not stand still: that holds no motion.
    """
    friction = {surface.switch for surface in of_kind(system, Kind.SLIDING)}
    return [switch for switch, mode in modes if mode == HELD and switch in friction]


def held_at(system: System, events: Sequence[EventNode], node: int, always: Sequence[int] = ()) -> list[int]:
    """Return the guards of friction that is held before and after an event node, or `always`."""
    found = list(always)
    for surface in of_kind(system, Kind.SLIDING):
        if mode_after(surface, events[node]) is None and _held_before(surface, events, node):
            found.append(surface.switch)
    return found


def _held_before(surface: SurfaceLike, events: Sequence[EventNode], node: int) -> bool:
    """Whether the last event node before one that changes a surface's mode is where it begins to be held."""
    changes = (mode_after(surface, events[(node - m) % len(events)]) for m in range(1, len(events)))
    return next((mode for mode in changes if mode is not None), None) == STUCK


def held_in(system: System, orbit: Orbit, interval: int) -> list[int]:
    """Return the guards of friction that is held in an interval of an orbit."""
    modes = sides(system, orbit)[interval]
    each = (s for s in of_kind(system, Kind.SLIDING) if s.column is not None)
    return [s.switch for s in each if modes[cast(int, s.column)] in (STUCK, HELD)]
