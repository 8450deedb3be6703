"""Tori over a parameter: steps by arclength, and the torus at a value."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from periodic.checks import positive
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.tori.breaks import breaks_of, moved
from periodic.tori.grid import Grid
from periodic.tori.invariance import Invariance, Unknowns, solved
from periodic.tori.section import Section

FINEST = 1e-13
"""Finest tolerance of the integration."""

FINER = 100.0
"""How many times finer than tori motions are integrated."""

ROUNDS = 12
"""Most times that angles are added, or breaks moved."""

MOST_ANGLES = 641
"""Most angles of a section."""


@dataclass(frozen=True, eq=False)
class Family:
    """The tori over a parameter, to a largest residual `tol`; rough: tails from which angles are added."""

    equations: Invariance
    tol: float
    rough: float = np.inf

    def corrected(
        self, now: Section, tangent: Array, length: float, guess: Section | None = None
    ) -> tuple[Section, Array] | None:
        """Return the torus a step along the family and the tangent there; None where Newton fails."""
        unknowns = Unknowns(self.equations, now)
        values, held = unknowns.of(now), unknowns.weights * tangent
        ahead = values + length * tangent
        begin = unknowns.torus(ahead) if guess is None else guess
        return solved(self.equations, begin, now, held, float(held @ ahead), self.tol)

    def held(self, guess: Section, value: float, before: Section | None = None) -> Section | None:
        """Return the torus near a guess at a value of the parameter; None where Newton fails."""
        found = self.directed(guess, value, before)
        return None if found is None else found[0]

    def directed(
        self, guess: Section, value: float, before: Section | None = None
    ) -> tuple[Section, Array] | None:
        """Return the torus at a value as `held` does, and the tangent along which the parameter grows."""
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

    def value(self, torus: Section) -> float:
        """Return the parameter (scaled) of a torus."""
        return float(torus.parameter[self.equations.free])

    def birth(self, before: Section, after: Section) -> float:
        """Return where a torus that shrinks has no size, by its square, which grows linearly from there."""
        low, high = self.value(before), self.value(after)
        a, b = before.size**2, after.size**2
        return high + (high - low) * b / (a - b)

    def refined(self, torus: Section) -> tuple[Section, Array] | None:
        """Return a torus with as many angles as it needs, and the tangent: see `directed`.

        None where that fails.
        """
        value = self.value(torus)
        found = self.directed(torus, value)
        for _ in range(ROUNDS):
            if found is None or self.resolved(found[0]):
                break
            now, count = found[0], len(found[0].states)
            breaks = breaks_of(self.equations.system, now)
            if len(breaks) == len(now.breaks) and now.tail > self.rough:
                if count >= MOST_ANGLES:
                    break
                count = 2 * count - 1
            found = self.directed(resampled(now, count, breaks), value)
        return found

    def resolved(self, torus: Section) -> bool:
        """Return whether a torus has enough angles, and breaks where it crosses surfaces."""
        broken = moved(torus.breaks, breaks_of(self.equations.system, torus))
        return torus.tail <= self.rough and not broken


def resampled(torus: Section, count: int, breaks: Array) -> Section:
    """Return a torus with another number of angles, or other breaks."""
    return replace(torus, states=torus.states_at(Grid(count, breaks).angles), breaks=breaks)


def not_resolved(torus: Section) -> str:
    """Return that a torus cannot be resolved, in words."""
    return (
        f"the torus loses its smoothness: its highest harmonics are {torus.tail:.0e} of the largest with "
        f"{len(torus.states)} angles, and {MOST_ANGLES} are not enough"
    )


def family_of(
    system: System,
    free: int,
    tol: float,
    scale: float = 1.0,
    rough: float = math.inf,
    released: int | None = None,
) -> Family:
    """Return the tori of a system over a parameter, by its index; one released: see `Invariance`."""
    tolerance = max(positive("tol", tol) / FINER, FINEST)
    return Family(Invariance(system, free, tolerance, scale, released), tol, rough)
