"""A motion integrated through kinks and impacts: it is begun anew where a switch crosses its level.

The step control of an integrator sees a kink where it evaluates the rates beside it. A short excursion past
a level - a stop that is just touched - lies between two evaluations, and the motion goes on as if there were
none. So the switches are looked at along the motion. Between neighbouring phases each is the cubic with its
values and rates at both ends, known to the error of such cubics over two of these intervals; its Bernstein
coefficients enclose it. Where it may pass its level the phases are put closer, until that is known. At an
impact the state is mapped.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from symbolic.arrays import Array
from symbolic.equations.expressions import Expressions
from symbolic.integration.cvodes import IntegrationError, spaced

LONGEST_INTERVAL = math.pi / 32
"""Longest interval (rad) between two phases at which switches are looked at."""

PARTS = 16
"""Into how many an interval is cut in which a switch may pass its level."""

SHORTEST = 1e-6
"""Intervals (rad) that are cut no more: an excursion within one is as deep as rounding."""

NOISE = 1e-12
"""A switch that is as near to its level, as a part of its largest value, is at it."""

BEYOND = 1e-13
"""How far past its level, in the same part, a switch is where the motion is begun anew: on its new side."""

RESOLVED = 1e-15
"""Phases (rad) that are so near to each other are the same."""

SAFE = 4.0
"""How many times its estimate the error of a cubic may be."""

MOST_CROSSINGS = 1000
"""Most crossings in a period of the excitation, 2 pi in tau."""

ROOT = 50
"""Most iterations for the phase of a crossing."""

Reset = Callable[[int, float, Array], Array]
"""Maps y at the impact of a switch: (switch, phase, y) to y."""

Sweep = Callable[[Array, Array], Array]
"""Integrates from y (w,) at phase[0] to all of phase (K,): y at each, shape (K, w)."""


@dataclass(frozen=True)
class SwitchCrossing:
    """Where a switch passes its level: the phases just before and after it, y at both, and the switch's rate.

    An impact has one phase, and y is mapped between them.
    """

    switch: int
    before: float
    after: float
    y_before: Array
    y: Array
    rate: float


@dataclass(frozen=True)
class Followed:
    """A motion at the phases asked for, (K, w), and the crossings on its way."""

    values: Array
    crossings: list[SwitchCrossing]

    def with_impacts(self, phase: Array) -> tuple[Array, Array]:
        """Return phases and values with each impact twice, before and after it."""
        impacts = [p for p in self.crossings if p.before == p.after]
        places = np.repeat(np.searchsorted(phase, [p.before for p in impacts]), 2)
        tau = np.insert(phase, places, np.repeat([p.before for p in impacts], 2))
        each = np.reshape([y for p in impacts for y in (p.y_before, p.y)], (-1, self.values.shape[1]))
        return tau, np.insert(self.values, places, each, axis=0)


@dataclass(frozen=True, eq=False)
class SwitchCrossings:
    """Follows motions of y = (x, z) through the levels 0 of some switches.

    Parameters
    ----------
    expressions : Expressions
        The equations.
    rates : casadi.SX
        (x', z') in terms of their symbols.
    kinks : sequence of int
        Indices of the switches at whose level 0 the equations have a kink.
    impacts : sequence of int
        Indices of those whose fall to 0 is an impact.
    """

    expressions: Expressions
    rates: ca.SX
    kinks: Sequence[int]
    impacts: Sequence[int] = ()

    @cached_property
    def switches(self) -> list[int]:
        """Indices of all of them."""
        return [*self.kinks, *self.impacts]

    def follow(
        self, sweep: Sweep, y: Array, phase: Array, parameter: Array, reset: Reset | None = None
    ) -> Followed:
        """Integrate from y at phase[0] to all of `phase`, which rises.

        Raises IntegrationError where there are too many crossings.
        """
        if not self.switches:
            return Followed(sweep(y, phase), [])
        every, wanted = _filled(phase)
        size = np.zeros(len(self.switches))

        def spread(y: Array, along: Array) -> Array:
            """To phases that are too near for the integrator as well: there on the tangent."""
            last = spaced(along)
            used, place = np.unique(last, return_inverse=True)
            values = sweep(y, along[used]) if len(used) > 1 else y[None]
            near = np.flatnonzero(last != np.arange(len(along)))
            values = values[place]
            for k in near:
                rate = np.array(self._rate(values[k], along[last[k]], parameter)).ravel()
                values[k] = values[k] + (along[k] - along[last[k]]) * rate
            return values

        way = _Way(self, spread, reset, parameter, float(phase[0]), float(phase[-1]), size)
        found, i = [y[None]], 0
        while i < len(every) - 1:
            values = spread(found[-1][-1], every[i:])
            at = way.first(values, every[i:])
            if at is None:
                found.append(values[1:])
                break
            found.append(values[1 : at.interval + 1])
            i += at.interval
            found.append(way.across(values[at.interval], every[i], every[i + 1])[None])
            i += 1
        return Followed(np.concatenate(found)[wanted], way.crossings)

    @cached_property
    def _measure(self) -> ca.Function:
        e = self.expressions
        s = e.switches[self.switches]
        n = e.state.size1()
        rate = ca.jtimes(s, e.state, self.rates[:n]) + ca.jacobian(s, e.phase)
        return ca.Function("switches", [ca.vertcat(e.state, e.algebraic), e.phase, e.parameter], [s, rate])

    @cached_property
    def _rate(self) -> ca.Function:
        e = self.expressions
        return ca.Function("rate", [ca.vertcat(e.state, e.algebraic), e.phase, e.parameter], [self.rates])

    def measured(self, values: Array, phase: Array, parameter: Array) -> tuple[Array, Array]:
        """Return the switches and their rates along a motion, each of shape (K, switches)."""
        s, rate = self._measure(values.T, phase[None, :], parameter)
        return np.array(s).T, np.array(rate).T


@dataclass(frozen=True)
class _Doubt:
    """The first interval in which switches may pass their levels, and those that do, by their ends."""

    interval: int
    passing: NDArray[np.int_]
    certain: bool


@dataclass
class _Way:
    """One motion on its way, from one phase to another."""

    through: SwitchCrossings
    sweep: Sweep
    reset: Reset | None
    parameter: Array
    begin: float
    end: float
    size: Array
    crossings: list[SwitchCrossing] = field(default_factory=list)

    def _measured(self, values: Array, phase: Array) -> tuple[Array, Array]:
        return self.through.measured(values, phase, self.parameter)

    def first(self, values: Array, phase: Array) -> _Doubt | None:
        """Return the first interval in which a switch may pass its level; None where none may."""
        s, rate = self._measured(values, phase)
        self.size = np.maximum(self.size, np.abs(s).max(axis=0))
        noise = NOISE * self.size
        width = np.diff(phase)[:, None]
        inner = [s[:-1] + width * rate[:-1] / 3, s[1:] - width * rate[1:] / 3]
        begin = np.where(np.abs(s[:-1]) <= noise, inner[0], s[:-1])  # it has crossed there, or touches
        falls = len(self.through.kinks)  # the impacts: none of them has happened yet
        begin[:, falls:] = np.where(np.abs(s[:-1, falls:]) <= noise[falls:], noise[falls:], begin[:, falls:])
        end = np.where(np.abs(s[1:]) <= noise, inner[1], s[1:])
        bounds, error = np.array([begin, *inner, end]), SAFE * _errors(s, rate, phase)
        mixed = (bounds.min(axis=0) - error < -noise) & (bounds.max(axis=0) + error > noise)
        if not mixed.any():
            return None
        j = int(np.flatnonzero(mixed.any(axis=1))[0])
        passing = mixed[j] & (begin[j] * end[j] < 0)
        return _Doubt(j, np.flatnonzero(passing), bool((passing == mixed[j]).all()))

    def across(self, y: Array, begin: float, end: float) -> Array:
        """Return y at the end of an interval, through all crossings in it. Raises IntegrationError."""
        while True:
            phase = np.linspace(begin, end, PARTS + 1)
            values = self.sweep(y, phase)
            at = self.first(values, phase)
            if at is None:
                return values[-1]
            j, left, right = at.interval, phase[at.interval], phase[at.interval + 1]
            if right - left > SHORTEST and not at.certain:
                y, begin = self.across(values[j], left, right), right
            elif len(at.passing):
                ends = slice(j, j + 2)
                each = [self._event(values[ends], phase[ends], int(k)) for k in at.passing]
                self._met(min(each, key=lambda crossing: crossing.after))
                y, begin = self.crossings[-1].y, self.crossings[-1].after
            else:
                y, begin = values[j + 1], right
            if not begin < end:
                return y

    def _met(self, crossing: SwitchCrossing) -> None:
        self.crossings.append(crossing)
        if len(self.crossings) > MOST_CROSSINGS * math.ceil((self.end - self.begin) / (2 * math.pi)):
            what = "impacts pile up" if self.reset is not None else "the equations have too many kinks"
            raise IntegrationError(f"{what} at tau = {crossing.after:.6g}", crossing.after)

    def _event(self, values: Array, phase: Array, k: int) -> SwitchCrossing:
        """Return the crossing of a switch between two phases, or its impact."""
        kinks = self.through.kinks
        if k < len(kinks):
            return self._crossing(values, phase, k)
        assert self.reset is not None
        at, y = float(phase[0]), values[0]
        if self._measured(values[:1], phase[:1])[0][0, k] > NOISE * self.size[k]:
            found = self._crossing(values, phase, k)
            at, y = found.before, found.y_before
        rate = float(self._measured(y[None], np.array([at]))[1][0, k])
        return SwitchCrossing(
            self.through.switches[k], at, at, y, self.reset(self.through.impacts[k - len(kinks)], at, y), rate
        )

    def _crossing(self, values: Array, phase: Array, k: int) -> SwitchCrossing:
        """Return where a switch passes its level between two phases, by Newton's method on either side."""
        (low, high), (before, after) = (float(tau) for tau in phase), values
        beyond = BEYOND * float(self.size[k])
        s, rate = (a[:, k] for a in self._measured(values, phase))
        side = math.copysign(1.0, s[1])
        roots = CubicHermiteSpline(phase, s, rate).roots(extrapolate=False)
        guess, near, slope = float(roots[0]) if len(roots) else low, [False, False], 0.0
        for _ in range(ROOT):
            at = guess if low < guess < high else (low + high) / 2
            y = self.sweep(values[0], np.array([phase[0], at]))[-1]
            now, slope = (float(a[0, k]) for a in self._measured(y[None], np.array([at])))
            past = side * now > 0
            near[past] = near[past] or abs(now) <= beyond
            low, high, before, after = (low, at, before, y) if past else (at, high, y, after)
            if all(near) or high - low <= RESOLVED:
                break
            aim = -side if near[True] else side
            guess = at + (aim * beyond / 2 - now) / slope if slope else low
        return SwitchCrossing(self.through.switches[k], low, high, before, after, slope)


def _filled(phase: Array) -> tuple[Array, NDArray[np.int_]]:
    """Phases that are nowhere farther apart than LONGEST_INTERVAL, and the indices of the given ones."""
    counts = np.maximum(np.ceil(np.diff(phase) / LONGEST_INTERVAL), 1).astype(int)
    places = np.append(0, np.cumsum(counts))
    inner = np.arange(places[-1]) - np.repeat(places[:-1], counts)
    every = np.repeat(phase[:-1], counts) + np.repeat(np.diff(phase) / counts, counts) * inner
    return np.append(every, phase[-1]), places


def _errors(s: Array, rate: Array, phase: Array) -> Array:
    """Errors of the cubics on the K-1 intervals, by what those over two of them miss in between.

    A cubic is off by s''''/24 (t - a)^2 (b - t)^2; of a single interval nothing is known.
    """
    if len(phase) < 3:
        return np.full((len(phase) - 1, s.shape[1]), np.inf)
    a, b = (phase[1:-1] - phase[:-2])[:, None], (phase[2:] - phase[1:-1])[:, None]
    t = a / (a + b)
    left, right = (1 + 2 * t) * (1 - t) ** 2, t**2 * (3 - 2 * t)
    slopes = (a + b) * (t * (1 - t) ** 2 * rate[:-2] - t**2 * (1 - t) * rate[2:])
    fourth = np.abs(left * s[:-2] + right * s[2:] + slopes - s[1:-1]) / (a * b) ** 2
    near = np.maximum(np.concatenate([fourth[:1], fourth]), np.concatenate([fourth, fourth[-1:]]))
    return near * (np.diff(phase)[:, None] / 2) ** 4
