"""The draft of a certificate: pieces between events, nodes, and steps of lengths that can be enclosed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from flint import arb, fmpq

from periodic.orbit.orbit import Orbit
from periodic.proof.check import NotProvedError, Problem, Step, nth, taylor, value
from periodic.proof.samples import Event, along, events

SHARE = 0.7
"""Part of the length that the series of the motion itself allows, as that of a box around it is worse."""

SHORTER = Fraction(5, 8)
"""Factor on a step that could not be enclosed."""

LEAST = 1e-5, 1e-8
"""Part of a piece that a step at a singularity has: a Hertzian contact begins and ends with one of order 1.

The first while orbits are known to the tolerance of a trace, the second thereafter.
"""

APART = 1e-10
"""Part of the period by which two events are apart at least."""

SHORTEST = 1e-13
"""Part of a piece below which steps are given up."""

SMALL = 1e-3
"""Size of a scaled state below which errors are compared with it."""

NEAR = 1e-3
"""Part of a piece at its ends in which states are found from the end, not read from the orbit."""

INSIDE = 1e-13
"""Part of a piece after an impact at which its first state is read."""

MOST_STEPS = 2000
"""Steps of a piece at the most."""

FORESEEN, GROWING = 12, 1.5
"""Steps over which their length must have grown by that factor, where too many of that length are left."""


def ratio(number: float | arb) -> str:
    """A number, or the middle of a ball, as a fraction."""
    if isinstance(number, arb):
        mantissa, exponent = (int(k) for k in number.mid().man_exp())
        exact = Fraction(mantissa) * Fraction(2) ** exponent
    else:
        exact = Fraction(float(number))
    return f"{exact.numerator}/{exact.denominator}"


@dataclass(frozen=True)
class Fineness:
    """How finely motions are followed; whether a proof is found hangs on it, and how small a box, no truth.

    Parameters
    ----------
    bits : int
        Precision of the ball arithmetic.
    order : int
        Of the Taylor series.
    remainder : float
        That of a step, relative to the largest number of a state, that its length is chosen for.
    accurate, accurate_slopes : float
        Error of a step, relative to the state, and of its derivatives, that are accepted.
    growth : float
        Growth of small differences from one node to the next at the most.
    """

    bits: int
    order: int
    remainder: float
    accurate: float
    accurate_slopes: float
    growth: float


POINT = Fineness(128, 24, 1e-22, 1e-18, 1e-12, 100.0)
"""For an orbit, a fold or a doubling."""

RANGE = Fineness(64, 10, 1e-9, np.inf, np.inf, 3.0)
"""For the orbits of a range, whose boxes are wide."""


@dataclass(frozen=True)
class Piece:
    """A piece of an orbit between two places tau, the sides of all branches in it, and what ends it.

    `struck`: whether it begins with an impact.
    """

    begin: float
    end: float
    sides: dict[str, int]
    until: str | None
    struck: bool


def pieces(
    problem: Problem, values: Mapping[str, float], orbit: Orbit, impacts: Mapping[str, int]
) -> list[Piece]:
    """Return the pieces of an orbit between its events; impacts are where the orbit has them, by switch."""
    found: list[Event] = events(problem, values, orbit, impacts)
    for one, other in zip(found, found[1:], strict=False):
        if other.phase - one.phase < APART * orbit.mesh.period:
            raise NotProvedError(
                f"two events meet: comparisons {one.names[0]} and {other.names[0]} change at once"
            )
    places = [0.0, *(event.phase for event in found), orbit.mesh.period]
    names = [*(event.names[0] for event in found), None]
    middles = np.array([(a + b) / 2 for a, b in zip(places, places[1:], strict=False)])
    at = along(problem, values, orbit, middles)
    return [
        Piece(
            a,
            b,
            {n: 1 if n in impacts or at[f"?{n}"][k] > 0 else -1 for n in problem.compared},
            until,
            k > 0 and names[k - 1] in impacts,
        )
        for k, (a, b, until) in enumerate(zip(places, places[1:], names, strict=False))
    ]


@dataclass
class March:
    """Steps through a piece, from state to state, as long as they can be enclosed with a small remainder."""

    problem: Problem
    sides: dict[str, int]
    least: float
    fine: Fineness = POINT
    s: Fraction = Fraction(0)

    def step(self, y: Sequence[arb], end: Fraction) -> tuple[list[object], Step, list[arb]]:
        """Take the longest step from y, to `end` at the most; return length and order, it, and its end."""
        left = end - self.s
        length, order = self._length(y)
        if self.s and end == 1 and left <= 2 * self.least:
            length, order = 1.0, 1  # nothing but a singularity at the end of a piece makes steps so short
        h = Fraction(length)
        h = left if h >= left else min(h, left / 2)  # none ends just before an event
        while (taken := self._taken(y, h, order)) is None:
            h *= SHORTER
            if h < SHORTEST:
                raise NotProvedError("the motion could not be enclosed, however short the steps")
        self.s += h
        return [f"{h.numerator}/{h.denominator}", order], *taken

    def _taken(self, y: Sequence[arb], h: Fraction, order: int) -> tuple[Step, list[arb]] | None:
        try:
            taken = Step(self.problem, list(y), arb(exact(self.s)), arb(exact(h)), order, self.sides)
        except NotProvedError:
            return None
        (ends,) = taken.ends(y)
        if order == 1:
            return taken, ends
        small = all(float(e.rad()) <= self.fine.accurate * max(abs(float(e)), SMALL) for e in ends)
        by = taken.derivative
        known = all(
            float(by[i, j].rad()) <= self.fine.accurate_slopes
            for i in range(by.nrows())
            for j in range(by.ncols())
        )
        return (taken, ends) if small and known and self._sides_known(taken) else None

    def _sides_known(self, taken: Step) -> bool:
        """Whether each comparison has its side half way through a step: it has there also beside an event."""
        if not self.problem.compared:
            return True
        own = taken.polynomials()
        middles = {name: value(own[f"?{name}"], taken.h / 2) for name in self.problem.compared}
        return all(middle == 0 or self.sides[name] * middle > 0 for name, middle in middles.items())

    def _length(self, y: Sequence[arb]) -> tuple[float, int]:
        order = self.fine.order
        try:
            motion = taylor(self.problem, y, arb(exact(self.s)), self.sides, order)
        except NotProvedError:
            return self.least, 1
        lengths = []
        for a in motion:
            size = max(abs(float(nth(a, 0))), SMALL)
            for k in (order - 1, order):
                term = float(abs(nth(a, k)).mid())
                if not np.isfinite(term):
                    return self.least, 1
                if term > 0:
                    lengths.append((self.fine.remainder * size / term) ** (1 / k))
        return SHARE * min(lengths, default=1.0), order


def exact(number: Fraction) -> fmpq:
    """A fraction as python-flint has it."""
    return fmpq(number.numerator, number.denominator)


Place = tuple[Fraction, list[arb]]
"""A part s of a piece, and the unknowns there."""

Steps = list[list[list[object]]]
"""By node the steps that follow it, each its length as a fraction of the piece and its order."""


def placed(
    problem: Problem, orbit: Orbit, piece: Piece, unknown: Sequence[float], fine: Fineness = POINT
) -> tuple[list[Place], Steps]:
    """Return nodes in a piece, with the states that an orbit has there, and the steps between them."""
    march = March(problem, piece.sides, LEAST[0], fine)
    places: list[Place] = []
    steps: Steps = []
    y: list[arb] = []
    while march.s < 1:
        part = float(march.s)
        if not y or NEAR < part < 1 - NEAR:
            tau = piece.begin + (part or INSIDE * piece.struck) * (piece.end - piece.begin)
            place = np.array([tau])
            known = [*orbit.state(place)[0], *orbit.algebraic_guess(place)[0], *unknown]
            known += [tau, piece.end - piece.begin] * problem.events
            y = [arb(float(a)) for a in known]
        places.append((march.s, y))
        y, own = _until(march, y, Fraction(1))
        steps.append(own)
    return places, steps


def stepped(
    problem: Problem, sides: dict[str, int], places: Sequence[Place], least: float, fine: Fineness = POINT
) -> Steps:
    """Return the steps of a piece between given nodes."""
    ends = [*(s for s, _ in places[1:]), Fraction(1)]
    march = March(problem, sides, least, replace(fine, growth=np.inf))
    return [_until(march, y, end)[1] for (_, y), end in zip(places, ends, strict=True)]


def _until(march: March, y: list[arb], end: Fraction) -> tuple[list[arb], list[list[object]]]:
    steps: list[list[object]] = []
    growth = 1.0
    lengths: list[float] = []
    while march.s < end and growth < march.fine.growth:
        before = march.s
        text, taken, ends = march.step(y, end)
        steps.append(text)
        lengths.append(float(march.s - before))
        left = float(end - march.s) / lengths[-1]
        grown = len(lengths) <= FORESEEN or lengths[-1] > GROWING * lengths[-1 - FORESEEN]
        if len(lengths) > MOST_STEPS or (left > MOST_STEPS and not grown):
            raise NotProvedError(
                f"a piece of the orbit would take some {len(lengths) + left:.0f} steps, of {MOST_STEPS} at "
                f"the most: its fastest motions are too fast for it"
            )
        y = [arb(a.mid()) for a in ends]
        growth *= _norm(taken)
    return y, steps


def _norm(step: Step) -> float:
    by = step.derivative
    return max(sum(float(abs(by[i, j]).mid()) for j in range(by.ncols())) for i in range(by.nrows()))
