"""Tori over a parameter: steps by arclength, and the torus at a value."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from periodic.checks import positive
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.tori.invariance import Invariance, Unknowns, solved
from periodic.tori.section import Section

FINEST = 1e-13
"""Finest tolerance of the integration."""

FINER = 100.0
"""How many times finer than tori motions are integrated."""

MOST_ANGLES = 641
"""Most angles of a section."""


@dataclass(frozen=True, eq=False)
class Family:
    """The tori over a parameter, to a largest residual `tol`; rough: tails from which angles are added."""

    equations: Invariance
    tol: float
    rough: float = np.inf

    def corrected(self, now: Section, tangent: Array, length: float) -> tuple[Section, Array] | None:
        """Return the torus a step along the family and the direction there; None where Newton fails."""
        unknowns = Unknowns(self.equations, now)
        values, held = unknowns.of(now), unknowns.weights * tangent
        guess = unknowns.torus(values + length * tangent)
        found = solved(self.equations, guess, now, held, float(held @ (values + length * tangent)), self.tol)
        return None if found is None else (found, self.direction(now, found))

    def direction(self, before: Section, after: Section) -> Array:
        """Return the unit tangent from a torus to another with as many angles."""
        unknowns = Unknowns(self.equations, after)
        ahead = unknowns.of(after) - unknowns.of(before)
        return np.asarray(ahead / np.sqrt(unknowns.weights @ ahead**2))

    def held(self, guess: Section, value: float, before: Section | None = None) -> Section | None:
        """Return the torus near a guess at a value of the parameter; None where Newton fails."""
        unknowns = Unknowns(self.equations, guess)
        last = np.zeros(len(unknowns.weights))
        last[-1] = 1.0
        at = guess.parameter.copy()
        at[self.equations.free] = value
        level = value / self.equations.scale
        return solved(self.equations, replace(guess, parameter=at), before or guess, last, level, self.tol)

    def between(self, before: Section, after: Section, value: float) -> Section | None:
        """Return the torus at a value of the parameter between two."""
        unknowns = Unknowns(self.equations, after)
        low, high = unknowns.of(before), unknowns.of(after)
        share = (value / self.equations.scale - low[-1]) / (high[-1] - low[-1])
        return self.held(unknowns.torus(low + share * (high - low)), value, after)

    def refined(self, torus: Section) -> Section | None:
        """Return a torus with as many angles as it needs, at its parameter; None where that fails."""
        now: Section | None = torus
        while now is not None and now.tail > self.rough and len(now.states) < MOST_ANGLES:
            now = self.held(
                resampled(now, 2 * len(now.states) - 1), float(now.parameter[self.equations.free])
            )
        return now


def resampled(torus: Section, count: int) -> Section:
    """Return a torus with another number of angles."""
    angles = 2 * np.pi * np.arange(count) / count
    return replace(torus, states=torus.states_at(angles))


def family_of(system: System, free: int, tol: float, scale: float = 1.0, rough: float = math.inf) -> Family:
    """Return the tori of a system over a parameter, by its index."""
    tolerance = max(positive("tol", tol) / FINER, FINEST)
    return Family(Invariance(system, free, tolerance, scale), tol, rough)
