"""Motions followed one after the other, by what a system has for one of them: where there is no compiler.

Tangents are differences to motions beside, drawn near again after each stretch (Benettin et al., Meccanica 15
(1980) 9-20): independent of the equations' derivatives, and of saltation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.following.parts import Each
from periodic.system import Moving, surfaces_of
from periodic.system.ensembles import DIVERGED, FOLLOWED, LOST

APART = 1e-6
"""Distance of a motion beside: with a tolerance of 1e-10 differences have four digits."""

LEAST = 1e-14
"""A tangent of which no more is left beside the others has vanished."""


@dataclass(frozen=True, eq=False)
class OneByOne:
    """Motions of a system at parameters (p,): see `periodic.system.ensembles.EnsembleLike`."""

    system: Moving
    parameter: Array
    tolerance: float
    largest: float

    def begin(self, state: Array) -> Array:
        """Return y (S, w) of states (S, n), with the unknowns of the system at rest."""
        return np.hstack([state, np.tile(self.system.rest(self.parameter)[1], (len(state), 1))])

    def tangents_at(self, y: Array) -> Array:
        """Return tangents (S, n, w): unknowns follow from the states when motions begin."""
        return np.tile(np.eye(len(self.system.states), y.shape[1]), (len(y), 1, 1))

    def run(
        self,
        start: Array,
        count: int,
        stretch: float,
        *,
        modes: Any = None,
        keep: bool = False,
        tangents: Array | None = None,
        raw: bool = False,
        targets: tuple[Array, Sequence[int], Array, float] | None = None,
    ) -> Each:
        """Follow motions: see `periodic.system.ensembles.EnsembleLike`."""
        many, width = start.shape
        w = np.zeros((many, 0, width)) if tangents is None else np.array(tangents)
        own = np.zeros((many, len(surfaces_of(self.system))), dtype=int)
        if modes is not None:
            own[:] = modes
        sections = np.full((many, count + 1, width), np.nan) if keep else None
        growth = np.zeros((many, count, w.shape[1]))
        found = Each(start.copy(), own, np.zeros(many, int), np.full(many, -1), sections, growth, w, 0 * own)
        for s in range(many):
            self._one(found, s, count, stretch, modes is not None, raw, targets)
        return found

    def _one(
        self,
        found: Each,
        s: int,
        count: int,
        stretch: float,
        known: bool,
        raw: bool,
        targets: tuple[Array, Sequence[int], Array, float] | None,
    ) -> None:
        """Follow one motion, and write down what becomes of it."""
        before = -1
        if found.sections is not None:
            found.sections[s, 0] = found.ends[s]
        for c in range(count):
            at = c * stretch, (c + 1) * stretch
            y, modes = found.ends[s], list(found.modes[s]) if known or c else None
            try:
                later, after, changes = self._after(y, modes, at)
                if found.growth.shape[2]:
                    found.tangents[s] = [
                        (self._after(y + APART * w, modes, at)[0] - later) / APART for w in found.tangents[s]
                    ]
            except ArithmeticError:
                found.outcome[s] = LOST
                return
            found.ends[s], found.modes[s] = later, after
            found.changes[s] = changes
            n = len(self.system.states)
            if not np.abs(later[:n]).max() <= self.largest:
                found.outcome[s] = DIVERGED
                return
            if found.growth.shape[2] and not raw:
                found.tangents[s], found.growth[s, c] = orthonormal(found.tangents[s])
            if found.sections is not None:
                found.sections[s, c + 1] = later
            now = _arrived(later[:n], targets)
            if now >= 0 and now == before:
                found.label[s] = now
                return
            before = now
        found.outcome[s] = FOLLOWED

    def _after(
        self, y: Array, modes: Sequence[int] | None, at: tuple[float, float]
    ) -> tuple[Array, Sequence[int], Any]:
        """y at the end of a stretch, the modes, and how often each changed."""
        n = len(self.system.states)
        given = y[:n], y[n:], self.parameter, np.array(at), self.tolerance
        path = self.system.motion(*given) if modes is None else self.system.motion(*given, modes)
        changed = [event.surface for event in path.events if event.before != event.after]
        counts = np.bincount(changed, minlength=len(path.modes))
        later: Array = np.concatenate([path.state[-1], path.algebraic[-1]])
        return later, path.modes, counts


def orthonormal(tangents: Array) -> tuple[Array, Array]:
    """Return tangents (k, w) as an orthonormal basis, and logarithms of what each had beside those before."""
    basis, upper = np.linalg.qr(tangents.T)
    size = np.abs(np.diag(upper))
    left = size > LEAST * np.linalg.norm(tangents, axis=1)
    with np.errstate(divide="ignore"):
        grown = np.where(left, np.log(np.where(left, size, 1.0)), -np.inf)
    return basis.T * (np.sign(np.diag(upper)) * left)[:, None], grown


def _arrived(state: Array, targets: tuple[Array, Sequence[int], Array, float] | None) -> int:
    """Whose place a state is near, -1 for none."""
    if targets is None or not len(targets[0]):
        return -1
    places, whose, unit, radius = targets
    apart = np.abs((places - state) / unit).max(axis=1)
    nearest = int(apart.argmin())
    return int(whose[nearest]) if apart[nearest] <= radius else -1
