"""What lies between two tori of a family: folds, multipliers that cross the unit circle, values asked for."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from periodic.bifurcations.label import Label
from periodic.orbit.scheme import Array
from periodic.tori.family import Family
from periodic.tori.invariance import Unknowns
from periodic.tori.section import Section
from periodic.tori.stability import AT_ONE, across, crossing, torus_multipliers
from periodic.tori.toruspoint import TorusPoint

CROSSED = 1e-10
"""Part of a step to which folds and multipliers on the unit circle are located."""

ALONG = 0.8
"""Cosine of the largest angle between the tangents of a step: beyond, another family was found."""


@dataclass(frozen=True, eq=False)
class Located:
    """A torus within a step, None where none was found; off: how far what should be 0 there is from it."""

    torus: Section | None
    off: float = 0.0


@dataclass(frozen=True, eq=False)
class Step:
    """A step of a length along a family, from a torus and its tangent to another and its tangent `ahead`."""

    family: Family
    now: TorusPoint
    after: TorusPoint
    tangent: Array
    ahead: Array
    length: float

    def along(self, torus: Section) -> float:
        """Return how far a torus is along the step."""
        return float(self._unknowns.weights @ (self._away(torus) * self._away(self.after.torus)))

    def at_value(self, value: float) -> Located:
        """Return the torus at a value of the parameter (scaled)."""
        return Located(self.family.between(self.now.torus, self.after.torus, value))

    @property
    def folds(self) -> bool:
        """Whether the parameter turns back."""
        return bool(self.tangent[-1] * self.ahead[-1] < 0)

    def crossings(self) -> list[tuple[Located, str]]:
        """Return the tori at which multipliers cross the unit circle, but for the one that does at a fold."""
        before, after = (int((self._logs(each) > 0).sum()) for each in (self.now, self.after))
        passed = list(range(min(before, after), max(before, after)))
        if self.folds:
            passed = passed[1:]
        found: list[tuple[Located, str]] = []
        while passed:
            located = self._crossed(passed.pop(0))
            if located.torus is None or located.off > AT_ONE:
                return [*found, (Located(None), "on the unit circle")]
            label = crossing(self.family.equations.system, located.torus)
            if label == Label.TORUS:
                passed = passed[1:]
            found.append((located, str(label)))
        return found

    def fold(self) -> Located:
        """Return the torus at which the parameter turns back."""
        return self._root(lambda torus, tangent: float(tangent[-1]))

    def _crossed(self, k: int) -> Located:
        """The torus whose k-th multiplier is on the unit circle."""
        system = self.family.equations.system
        return self._root(lambda torus, tangent: _logs(torus_multipliers(system, torus), torus.free)[k])

    def _root(self, function: Callable[[Section, Array], float]) -> Located:
        """The torus within the step at which a function of torus and tangent is 0, or the nearest to it."""
        known = {0.0: (self.now.torus, self.tangent), self.length: (self.after.torus, self.ahead)}
        values = {length: function(*each) for length, each in known.items()}

        def off(length: float) -> float:
            if length not in known:
                known[length] = self._at(length, known)
                values[length] = function(*known[length])
            return values[length]

        if values[0.0] * values[self.length] < 0:
            with contextlib.suppress(ArithmeticError):  # then the nearest is given, and how near it is
                scipy.optimize.brentq(off, 0.0, self.length, xtol=CROSSED * self.length)
        nearest = min(values, key=lambda length: abs(values[length]))
        return Located(known[nearest][0], abs(values[nearest]))

    def _at(self, length: float, known: dict[float, tuple[Section, Array]]) -> tuple[Section, Array]:
        """The torus after a part of the step, and its tangent, from those that are known at others.

        Raises ArithmeticError.
        """
        unknowns, held = self._unknowns, self._unknowns.weights * self.tangent
        ends = max(k for k in known if k < length), min(k for k in known if k > length)
        places = [unknowns.of(known[k][0]) for k in ends]
        slopes = [known[k][1] / (held @ known[k][1]) for k in ends]
        guess = scipy.interpolate.CubicHermiteSpline(ends, places, slopes)(length)
        found = self.family.corrected(self.now.torus, self.tangent, length, unknowns.torus(guess))
        if found is None or held @ found[1] < ALONG:
            raise ArithmeticError("no torus of the family is found within a step")
        return found

    @staticmethod
    def _logs(point: TorusPoint) -> Array:
        return _logs(point.multipliers, point.torus.free)

    @cached_property
    def _unknowns(self) -> Unknowns:
        return Unknowns(self.family.equations, self.now.torus)

    def _away(self, torus: Section) -> Array:
        return self._unknowns.of(torus) - self._unknowns.of(self.now.torus)


def _logs(found: Array, free: bool) -> Array:
    """Logarithms of the moduli of multipliers that are not along the torus, the largest first."""
    sizes = np.maximum(np.abs(found), np.finfo(float).tiny)
    return np.asarray(np.log(sizes[across(sizes, free)]))
