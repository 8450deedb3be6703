"""Families of tori traced over a parameter: folds, births at NS, locking, loss of smoothness."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from periodic.checks import number, two, whole
from periodic.display.meter import meter
from periodic.orbit.layout import layout_of
from periodic.orbit.scheme import Array
from periodic.phasespace.values import parameters
from periodic.system import System, check_system, index_of
from periodic.tori.family import MOST_ANGLES, Family, family_of, resampled
from periodic.tori.invariance import Unknowns
from periodic.tori.section import Section, TorusError
from periodic.tori.stability import moduli, stable
from periodic.tori.torusbranch import TorusBranch, TorusPoint

FIRST, LONGEST, SHORTEST = 0.02, 0.1, 1e-6
"""Steps along the family: the first, the longest and the shortest, in ranges of the parameter."""

LONGER, SHORTER = 1.4, 0.4
"""Factors of a step after one that succeeded, and one that failed."""

BENDS = 0.3
"""Largest turn (rad) of the direction in a step."""

BORN = 0.02
"""Size of a torus, in that of the largest one, that is about to shrink to an orbit."""

MOST_STEPS = 1000
"""Most steps in each direction."""

LARGEST = 20
"""Largest denominator of a rotation number at which a torus is said to lock."""

LOCKS = 0.05
"""Distance of a rotation number from p/q, over 1/q^2, at which a family that ends locks."""

FOLD = 1e-9
"""Slope of the parameter along the family at a fold."""

SECANTS = 30
"""Most steps towards a fold."""


def traced(
    system: System,
    torus: Section,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    tol: float = 1e-8,
    rough: float = 1e-5,
    values: Mapping[str, float] | None = None,
    max_points: int = MOST_STEPS,
) -> TorusBranch:
    """Return the family of tori through a torus over a parameter: see `per.trace`.

    Parameters
    ----------
    system : System
        The equations.
    torus : Section
        A torus of the family, or one near it.
    parameter : str
        The parameter.
    bounds : tuple of float
        Its range (SI).
    start : float, optional
        Where the family starts; default at the torus.
    at : float or sequence of float
        Values that get a torus of their own.
    tol : float
        Largest residual, scaled.
    rough : float
        Largest `tail`: tori get as many angles as it asks for, up to 641.
    values : mapping of str to float, optional
        Other parameters (SI), in place of the torus's.
    max_points : int
        Most tori in each direction.

    Returns
    -------
    TorusBranch
        The tori, and why the family ends on either side.

    Raises
    ------
    ValueError
        For what is not allowed.
    TorusError
        Where no torus is found at the start.
    """
    check_system(system)
    free = index_of(system, parameter)
    scale = layout_of(system).parameters[free].scale
    low, high = two("bounds", bounds)
    given = torus.parameter.copy()
    for name in values or {}:
        given[index_of(system, name)] = parameters(system, values)[index_of(system, name)]
    begin = torus.parameter[free] * scale if start is None else number("start", start)
    if not low <= begin <= high:
        raise ValueError(f"start is {begin:g}; it must lie within the bounds {low:g} to {high:g}")
    asked = [number("at", value) for value in ([at] if isinstance(at, int | float) else at)]
    family = family_of(system, free, tol, (high - low) / scale, rough)
    first = family.held(replace(torus, parameter=given), begin / scale)
    first = None if first is None else family.refined(first)
    if first is None:
        raise TorusError(f"no torus is found at {parameter} = {begin:.9g}; another guess may lead to one")
    ways = [way for way, end in ((-1, low), (1, high)) if begin != end]
    with meter(f"tracing tori over {parameter}", "tori") as show:
        halves = []
        for way in ways:
            march = OneWay(family, parameter, (low / scale, high / scale), scale, way, asked, max_points)
            made = []
            for point in march.points(first):
                made.append(point)
                show(1, f"at {point.parameter:.6g}")
            halves.append((made, march.told))
    one = _point(family, first, begin, "EP" if len(halves) == 1 else "")
    if len(halves) == 1:
        points, stop = halves[0]
        return TorusBranch(parameter, (one, *points), ("where it starts", stop))
    (before, begins), (after, ends) = halves
    return TorusBranch(parameter, (*before[::-1], one, *after), (begins, ends))


@dataclass
class OneWay:
    """One way along a family, within bounds of the parameter (scaled).

    stop: why it ended. lost: what lies between two of its tori and was not found.
    """

    family: Family
    parameter: str
    bounds: tuple[float, float]
    scale: float
    way: int
    asked: Sequence[float]
    most: int
    stop: str = field(default="", init=False)
    lost: list[str] = field(default_factory=list, init=False)

    @property
    def told(self) -> str:
        """Why it ended, and what on the way was not found."""
        return "; ".join([self.stop, *self.lost])

    def points(self, first: Section) -> Iterator[TorusPoint]:
        """Yield the tori after the first; `stop` is known at the end."""
        now, tangent, length = first, self._ahead(first), FIRST
        largest = first.size
        for _ in range(whole("max_points", self.most)):
            found = self.family.corrected(now, tangent, length)
            if found is None or through(now, found[0]) or self._turn(now, tangent, found[1]) > BENDS:
                length *= SHORTER
                if length < SHORTEST:
                    self.stop = self._lost(now)
                    return
                continue
            after, direction = found
            yield from self._within(now, after, direction, tangent)
            if self.stop:
                return
            largest = max(largest, after.size)
            if after.size < BORN * largest and after.size < now.size:
                yield self._one(after, "EP")
                self.stop = self._born(now, after)
                return
            refined = self.family.refined(after)
            if refined is None or refined.tail > self.family.rough:
                last = refined or after
                yield self._one(last, "EP")
                self.stop = (
                    f"the torus loses its smoothness: its highest harmonics are {last.tail:.0e} of the "
                    f"largest with {len(last.states)} angles, and {MOST_ANGLES} are not enough"
                )
                return
            if len(refined.states) != len(after.states):
                direction = self._again(now, refined)
            yield self._one(refined, "")
            now, tangent, length = refined, direction, min(LONGER * length, LONGEST)
        self.stop = f"{self.most} tori, as many as were asked for"

    def _ahead(self, first: Section) -> Array:
        """The direction in which the parameter goes the way asked for, the rest unchanged."""
        unknowns = Unknowns(self.family.equations, first)
        found = np.zeros(len(unknowns.weights))
        found[-1] = self.way
        return found

    def _turn(self, now: Section, before: Array, after: Array) -> float:
        """By how much (rad) the direction turns; nothing on the first step, whose direction is no tangent."""
        weights = Unknowns(self.family.equations, now).weights
        if np.count_nonzero(before) == 1:
            return 0.0
        return float(np.arccos(np.clip(weights @ (before * after), -1.0, 1.0)))

    def _again(self, now: Section, refined: Section) -> Array:
        """The direction from a torus to one with more angles."""
        return self.family.direction(resampled(now, len(refined.states)), refined)

    def _within(self, now: Section, after: Section, ahead: Array, before: Array) -> Iterator[TorusPoint]:
        """Yield what lies between two tori: a fold, values asked for, the end of the range."""
        free = self.family.equations.free
        a, b = float(now.parameter[free]), float(after.parameter[free])
        if np.count_nonzero(before) > 1 and before[-1] * ahead[-1] < 0:
            yield from self._found(self._fold(now, before, after), "LP", b)
        for value in sorted((v / self.scale for v in self.asked), key=lambda v: abs(v - a)):
            if min(a, b) < value <= max(a, b):
                yield from self._found(self.family.between(now, after, value), "UZ", value)
        low, high = self.bounds
        for end, past in ((low, b <= low), (high, b >= high)):
            if past:
                yield from self._found(self.family.between(now, after, end), "EP", end)
                self.stop = f"end of the range at {end * self.scale:.9g}"
                return

    def _found(self, torus: Section | None, label: str, value: float) -> Iterator[TorusPoint]:
        """Yield a torus with its label; where there is none, write that down."""
        if torus is None:
            self.lost.append(f"no torus {label} was found near {value * self.scale:.9g}")
        else:
            yield self._one(torus, label)

    def _fold(self, now: Section, tangent: Array, after: Section) -> Section | None:
        """The torus at which the parameter turns back, by secants on its slope."""
        unknowns = Unknowns(self.family.equations, now)
        far = float(np.sqrt(unknowns.weights @ (unknowns.of(after) - unknowns.of(now)) ** 2))
        values = {0.0: now, far: after}
        for _ in range(SECANTS):
            if not (three := self._three(values, float(np.sign(tangent[-1])))):
                return None
            (s0, p0), (s1, p1), (s2, p2) = three
            bend = (p2 - p1) / (s2 - s1) - (p1 - p0) / (s1 - s0)
            if bend == 0:
                return None
            slope = (p1 - p0) / (s1 - s0)
            top = (s0 + s1) / 2 - slope * (s2 - s0) / (2 * bend)
            if not 0 < top < 2 * far or min(abs(top - s) for s in values) < FOLD * far:
                break
            found = self.family.corrected(now, tangent, top)
            if found is None:
                return None
            values[top] = found[0]
        return max(values.items(), key=lambda each: self._value(each[1]) * np.sign(tangent[-1]))[1]

    def _three(self, values: dict[float, Section], sign: float) -> list[tuple[float, float]]:
        """Places and parameters of three tori about the fold."""
        if len(values) == 2:
            (s0, early), (s1, late) = sorted(values.items())
            middle = self.family.corrected(early, self.family.direction(early, late), (s1 - s0) / 2)
            if middle is None:
                return []
            values[(s0 + s1) / 2] = middle[0]
        ways = [(s, self._value(torus)) for s, torus in sorted(values.items())]
        top = max(range(len(ways)), key=lambda k: sign * ways[k][1])
        begin = min(max(top - 1, 0), max(len(ways) - 3, 0))
        return ways[begin : begin + 3]

    def _value(self, torus: Section) -> float:
        return float(torus.parameter[self.family.equations.free])

    def _one(self, torus: Section, label: str) -> TorusPoint:
        return _point(self.family, torus, self._value(torus) * self.scale, label)

    def _born(self, before: Section, after: Section) -> str:
        """Where the torus has no size, by its square, which grows linearly from there."""
        a, b = before.size**2, after.size**2
        at = self._value(after) + (self._value(after) - self._value(before)) * b / (a - b)
        return f"the torus shrinks to an orbit, a torus bifurcation (NS) near {at * self.scale:.9g}"

    def _lost(self, now: Section) -> str:
        """Why no further torus was found."""
        turns = now.rotation_number
        near = Fraction(turns).limit_denominator(LARGEST)
        if abs(turns - near) < LOCKS / near.denominator**2:
            return (
                f"the motion locks: the rotation number {turns:.9g} is near {near}; beyond there are orbits "
                f"of {near.denominator} periods"
            )
        return f"Newton's method finds no torus beyond, with a rotation number of {turns:.9g}"


def through(before: Section, after: Section) -> bool:
    """Return whether a torus has shrunk to an orbit between two, and grown again on the other side of it."""
    one, other = (torus.states - torus.states.mean(axis=0) for torus in (before, after))
    return bool((one * other).sum() < 0)


def _point(family: Family, torus: Section, value: float, label: str) -> TorusPoint:
    sizes = moduli(family.equations.system, torus)
    return TorusPoint(torus, value, sizes, stable(sizes, torus.free), label)
