"""Solutions at given distances inside one continuation step, and roots of functions of them."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from periodic.bifurcations.testfunction import PARABOLA_LEFT
from periodic.correction.outcome import Outcome
from periodic.correction.predictor import cubic, tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.root import root
from periodic.orbit.orbit import Orbit

BESIDE_ROOT = (1e-9, -1e-9, 1e-8, -1e-8, 1e-7, -1e-7)
"""Distances, as parts of the interval, from a root where Newton fails, as where branches cross: an orbit
there is taken for the root."""

ORBIT_ERRORS = 1e1
"""Factor on these distances for orbits, which have errors of their own, over those for equilibria."""


class RejectedError(Exception):
    """A step that cannot be taken, or inside which Newton failed on an arclength constraint.

    The message says why. shorter: the part of the step to be tried next; halves of a step that leads to an
    orbit of no size would lead there again and again.
    """

    def __init__(self, why: str, shorter: float = 0.6) -> None:
        super().__init__(why)
        self.shorter = shorter


class _NoOrbitError(RejectedError):
    """Newton failed at a distance from a step's base."""

    def __init__(self, why: str, distance: float) -> None:
        super().__init__(why)
        self.distance = distance


@dataclass(frozen=True)
class WithinStep:
    """Orbits on arclength constraints at given distances from a step's base, each solved for once.

    The guess is the cubic to the step's end, where there is one, then the base's tangent: orbits solved for
    close to a singular one have lost digits that a guess must not carry on.
    """

    solver: Solver
    base: Solution
    known: dict[float, Solution]
    end: float | None = None

    def at(self, distance: float, *, nearest: bool = False) -> Solution:
        """Return the orbit at a distance. Raises RejectedError where there is none.

        nearest: whether the first guess is the cubic between the nearest known orbits, not from the base.
        """
        if distance not in self.known:
            self.known[distance] = self._solved(distance, nearest)
        return self.known[distance]

    def _solved(self, distance: float, nearest: bool) -> Solution:
        solver, base = self.solver, self.base
        constraint = solver.constraint(base.orbit, base.tangent, distance)
        newton, failure = solver.tolerance.newton.closest, Outcome.TOO_MANY
        for guess in self._guesses(distance, nearest):
            found = solver.on(guess, constraint, newton)
            if found.ok:
                return found
            failure = found.outcome
        raise _NoOrbitError(failure.value, distance)

    def _guesses(self, distance: float, nearest: bool) -> Iterator[Orbit]:
        below, above = (
            max((k for k in self.known if k < distance), default=None),
            min((k for k in self.known if k > distance), default=None),
        )
        if nearest and below is not None and above is not None:
            a, b = self.known[below], self.known[above]
            yield cubic(self.solver, a, b, above - below, distance - below, self.base)
        if self.end is not None:
            yield cubic(self.solver, self.base, self.known[self.end], self.end, distance)
        yield tangent(self.solver.problem, self.base, distance)

    def root(
        self,
        ends: tuple[float, float],
        function: Callable[[Solution], float],
        precision: float,
        *,
        aside: bool = False,
    ) -> tuple[float, Solution]:
        """Return distance and solution where a function changes sign between two distances from the base.

        `aside` accepts a solution very near to it where there is none at the place itself.
        """

        def value(distance: float) -> float:
            return self.at(distance).once(function)

        at_ends = [value(end) for end in ends]
        if at_ends[0] * at_ends[1] > 0:  # the root lies at an end, within the orbits' error
            nearest = ends[int(abs(at_ends[1]) < abs(at_ends[0]))]
            return nearest, self.at(nearest)
        try:
            place = root(value, *ends, precision)
            return place, self.at(place)
        except _NoOrbitError as failed:
            if not aside:
                raise
            return self._aside(ends, failed)

    def _aside(self, ends: tuple[float, float], failed: _NoOrbitError) -> tuple[float, Solution]:
        """Return the solution nearest to where there was none; raise what failed if there is none near."""
        length = (ends[1] - ends[0]) * (1 if self.base.orbit.equilibrium else ORBIT_ERRORS)
        for part in BESIDE_ROOT:
            distance = failed.distance + part * length
            if min(ends) <= distance <= max(ends):
                with contextlib.suppress(_NoOrbitError):
                    return distance, self.at(distance)
        raise failed


MINIMUM_TRIALS = 15
"""Most orbits solved for within a step to find a second change of sign."""

CONFIRMED = 0.1
"""Relative error with which a parabola must predict the function."""

LEAST_SHARE = 0.1
"""Least distance of a new trial from the place of the least value, as a part of that to its neighbour."""


def second_change(
    value: Callable[[float], float], known: dict[float, float], place: float, expected: float = np.nan
) -> float | None:
    """Return a distance within a step at which a function, positive where it is known, is negative, if any.

    The first trial is at `place`, where the value is `expected` unless the function changes sign nearby; then
    parabolas lead to the minimum until one has predicted the value there.
    """
    known = dict(known)
    for _ in range(MINIMUM_TRIALS):
        if place in known:
            return None
        least = min(known.values())
        known[place] = found = value(place)
        if found < 0:
            return float(place)
        foreseen = abs(found - expected) < CONFIRMED * found
        if foreseen and (len(known) == 3 or found > PARABOLA_LEFT * least):
            return None
        place, expected = _lowest(known)
    return None


def _lowest(known: dict[float, float]) -> tuple[float, float]:
    """Return the next trial for a function's minimum, and the value that a parabola predicts there.

    It is the vertex of the parabola about the least value, or halfway to the neighbour of an end.
    """
    at = sorted(known)
    least = at.index(min(at, key=lambda distance: known[distance]))
    near = at[max(0, min(least - 1, len(at) - 3)) :][:3]
    parabola = _through(near, [known[distance] for distance in near])
    if 0 < least < len(at) - 1:
        vertex, middle = float(parabola.deriv().roots()[0]), near[1]
        gap = (near[2] if vertex > middle else near[0]) - middle
        place = middle + gap * max((vertex - middle) / gap, LEAST_SHARE)
    else:
        place = (at[least] + at[1 if least == 0 else -2]) / 2
    return place, float(parabola(place))


def _through(at: list[float], values: list[float]) -> np.polynomial.Polynomial:
    """The parabola through three points."""
    a, b, c = at
    first = [(values[1] - values[0]) / (b - a), (values[2] - values[1]) / (c - b)]
    second = (first[1] - first[0]) / (c - a)
    start = np.polynomial.Polynomial([values[0] - first[0] * a, first[0]])
    return start + second * np.polynomial.Polynomial([a * b, -(a + b), 1.0])
