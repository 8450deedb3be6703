"""Symmetries of a system, and the images of its motions under them.

S is a symmetry where with every motion x(tau) S x(tau) is one too: P(S x) = S P(x), P the map over a period.
Of an excited system S x(tau + pi) may be one: with Q(x) = S x(pi) then P = Q Q. S changes signs of
coordinates, and the order of few (Golubitsky & Stewart, The Symmetry Perspective, Birkhaeuser 2002).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.box import Box
from periodic.phasespace.following.crowd import Crowd
from periodic.system.ensembles import FOLLOWED

PERMUTED, SIGNED = 3, 6
"""Most coordinates in any order and with any signs, and with any signs alone; more change signs together."""

POINTS = 16
"""Places at which a symmetry is tried."""

SAME, FINE = 1e-6, 1e-11
"""How near two states must come there, in widths of the box, and the tolerance of the integration."""


@dataclass(frozen=True, eq=False)
class Symmetry:
    """S (n, n) of scaled states, and the phase (rad) by which motions are ahead of their images."""

    matrix: Array
    shift: float
    name: str

    def image(self, crowd: Crowd, states: Array) -> Array:
        """Return the images (K, n) of states at phase 0; NaN of those that cannot be followed."""
        ahead = _ahead(crowd, states, self.shift) if self.shift else states
        return np.asarray(ahead @ self.matrix.T)

    def holds(self, crowd: Crowd, states: Array, ends: Array, width: Array) -> bool:
        """Return whether it is one at states (K, n) that are at `ends` a period later."""
        once = self.image(crowd, states)
        if self.shift:
            return bool((np.abs(self.image(crowd, once) - ends) < SAME * width).all())
        return bool((np.abs(_ahead(crowd, once, FORCED) - ends @ self.matrix.T) < SAME * width).all())


def symmetries_of(crowd: Crowd, box: Box, seed: int, excited: bool) -> tuple[Symmetry, ...]:
    """Return the symmetries of a system, those that change something.

    They are tried at places of a box: where motions from all of them diverge none is known.
    """
    crowd = replace(crowd, tolerance=FINE)
    states = box.draw(POINTS, seed, crowd.system, crowd.parameter)
    ends = _ahead(crowd, states, FORCED)
    known = np.isfinite(ends).all(axis=1)
    states, ends = states[known], ends[known]
    if not len(states):
        return ()
    each = candidates(box, excited)
    likely = (one for one in each if one.holds(crowd, states[:1], ends[:1], box.width))
    return tuple(one for one in likely if one.holds(crowd, states, ends, box.width))


def candidates(box: Box, excited: bool) -> Iterator[Symmetry]:
    """Yield what may be a symmetry: coordinates go with their velocities."""
    groups: dict[str, list[int]] = {}
    for k, name in enumerate(box.names):
        groups.setdefault(name.rstrip("'"), []).append(k)
    names, count = list(groups), len(groups)
    orders = itertools.permutations(range(count)) if count <= PERMUTED else [tuple(range(count))]
    for order in orders:
        if any(len(groups[names[k]]) != len(groups[names[i]]) for k, i in enumerate(order)):
            continue
        for signs in _signs(count):
            matrix = np.zeros((len(box.names),) * 2)
            for k, (i, sign) in enumerate(zip(order, signs, strict=True)):
                for to, of in zip(groups[names[k]], groups[names[i]], strict=True):
                    matrix[to, of] = sign * box.unit[of] / box.unit[to]
            moved = _told(names, order, signs)
            for shift in (0.0, FORCED / 2) if excited else (0.0,):
                told = [*([moved] if moved else []), *(["half a period later"] if shift else [])]
                if told:
                    yield Symmetry(matrix, shift, " ".join(told))


def _signs(count: int) -> Iterator[tuple[int, ...]]:
    if count > SIGNED:
        return iter([(1,) * count, (-1,) * count])
    return itertools.product((1, -1), repeat=count)


def _told(names: list[str], order: tuple[int, ...], signs: tuple[int, ...]) -> str:
    """What is put in place of coordinates, in words."""
    each = zip(names, (names[i] for i in order), signs, strict=True)
    other = [(name, f"-{of}" if sign < 0 else of) for name, of, sign in each]
    return ", ".join(f"{name} -> {of}" for name, of in other if name != of)


def _ahead(crowd: Crowd, states: Array, stretch: float) -> Array:
    """States a stretch later, (K, n); NaN of those that cannot be followed."""
    found = crowd.run(crowd.begin(states), 1, stretch)
    return np.where(found.outcome[:, None] == FOLLOWED, found.ends[:, : states.shape[1]], np.nan)
