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
from periodic.phasespace.following.values import parameters
from periodic.results.point import Point
from periodic.system import System, check_system, check_value, index_of
from periodic.tori.family import Family, family_of, not_resolved
from periodic.tori.invariance import Unknowns
from periodic.tori.locking import kinds, orbits_beyond, passed, resonance
from periodic.tori.section import Section, TorusError
from periodic.tori.stability import stable, torus_multipliers
from periodic.tori.step import Located, Step
from periodic.tori.torusbranch import TorusBranch
from periodic.tori.toruspoint import TorusPoint

FIRST, LONGEST, SHORTEST = 0.02, 0.1, 1e-6
"""Steps along the family: the first, the longest and the shortest, in ranges of the parameter."""

LONGER, SHORTER, FARTHER = 1.4, 0.4, 2.0
"""Factors of a step after one that succeeded, and one that failed; of one over a resonance."""

BENDS = 0.3
"""Largest turn (rad) of the direction in a step."""

BORN = 0.02
"""Size of a torus, in that of the largest one, that is about to shrink to an orbit."""

MOST_STEPS = 1000
"""Most steps in each direction."""

BACK = 24
"""Tori back from which it is tried to pass over a narrow resonance."""

CALM = 1e-2
"""Tail of a torus beyond a resonance, as a part of the largest."""

LOCATED = 1e-6
"""Slope of the parameter along the family at a fold, and logarithm of a modulus, that are 0."""


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
    released: str = "",
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
    released : str
        Another parameter that changes so that the rotation number stays, if any.
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
    for end in (low, high):
        check_value(system.parameters[free], end)
    given = torus.parameter.copy()
    for name in values or {}:
        given[index_of(system, name)] = parameters(system, values)[index_of(system, name)]
    begin = torus.parameter[free] * scale if start is None else number("start", start)
    if not low <= begin <= high:
        raise ValueError(f"start is {begin:g}; it must lie within the bounds {low:g} to {high:g}")
    asked = [number("at", value) for value in ([at] if isinstance(at, int | float) else at)]
    other = _released(system, parameter, released)
    family = family_of(system, free, tol, (high - low) / scale, rough, other)
    held = family.held(replace(torus, parameter=given), begin / scale)
    refined = None if held is None else family.refined(held)
    if refined is None:
        raise TorusError(f"no torus is found at {parameter} = {begin:.9g}; another guess may lead to one")
    first, tangent = refined
    ways = [way for way, end in ((-1, low), (1, high)) if begin != end]
    with meter(f"tracing tori over {parameter}", "tori") as show:
        halves = []
        for way in ways:
            march = OneWay(family, parameter, (low / scale, high / scale), scale, asked, max_points)
            made = []
            for point in march.points(first, way * tangent):
                made.append(point)
                show(1, f"at {point.parameter:.6g}")
            halves.append((made, march))
    one = _point(family, first, begin, "EP" if len(halves) == 1 else "")
    orbits = tuple(orbit for _, march in halves for orbit in march.orbits)
    if len(halves) == 1:
        points, march = halves[0]
        return TorusBranch(parameter, (one, *points), ("where it starts", march.told), released, orbits)
    (before, early), (after, late) = halves
    each = (*before[::-1], one, *after)
    return TorusBranch(parameter, each, (early.told, late.told), released, orbits)


def _released(system: System, parameter: str, released: str) -> int | None:
    """The index of a parameter that is released, if any. Raises ValueError."""
    if not released:
        return None
    if released == parameter:
        raise ValueError(f"released is {released!r}, over which the tori are traced; it must be another")
    return index_of(system, released)


@dataclass
class OneWay:
    """One way along a family, within bounds of the parameter (scaled).

    stop: why it ended. lost: what lies between two of its tori and is not among them. orbits: on which it
    locks. tried: the ratios over which it was tried to pass.
    """

    family: Family
    parameter: str
    bounds: tuple[float, float]
    scale: float
    asked: Sequence[float]
    most: int
    stop: str = field(default="", init=False)
    lost: list[str] = field(default_factory=list, init=False)
    orbits: tuple[Point, ...] = field(default=(), init=False)
    tried: set[Fraction] = field(default_factory=set, init=False)

    @property
    def told(self) -> str:
        """Why it ended, and what on the way is not among its tori."""
        return "; ".join([self.stop, *self.lost])

    def points(self, first: Section, tangent: Array) -> Iterator[TorusPoint]:
        """Yield the tori after the first, along a tangent; `stop` is known at the end."""
        now, length, largest = self._one(first, ""), FIRST, first.size
        path = [(now, tangent)]
        for _ in range(whole("max_points", self.most)):
            taken = self._resolved(self._step(now, tangent, length), path)
            if taken is None:
                length *= SHORTER
                if length >= SHORTEST:
                    continue
                taken = self._resolved(self._over(path, now.torus), path)
            if taken is None:
                told = f"with a rotation number of {now.torus.rotation_number:.9g}"
                self._end(now.torus, tangent[-1], f"Newton's method finds no torus beyond, {told}")
                return
            step, after, ahead = taken
            yield from self._within(step, now.torus)
            if self.stop or self._refused(after.torus):
                return
            largest = max(largest, after.torus.size)
            if after.torus.size < BORN * largest and after.torus.size < now.torus.size:
                yield replace(after, label="EP")
                at = self.family.birth(now.torus, after.torus) * self.scale
                self.stop = f"the torus shrinks to an orbit, a torus bifurcation (NS) near {at:.9g}"
                return
            if after.torus.tail > self.family.rough:
                yield replace(after, label="EP")
                self._end(after.torus, ahead[-1], not_resolved(after.torus))
                return
            yield after
            now, tangent, length = after, ahead, min(LONGER * step.length, LONGEST)
            path.append((now, tangent))
        self.stop = f"{self.most} tori, as many as were asked for"

    def _refused(self, torus: Section) -> bool:
        """Whether a torus needs a value of the released parameter that is not allowed: the end then."""
        equations = self.family.equations
        if equations.released is None:
            return False
        variable = equations.system.parameters[equations.released]
        try:
            check_value(variable, float(torus.parameter[equations.released] * variable.scale))
        except ValueError as told:
            self.stop = f"the rotation number would ask for what is not allowed: {told}"
        return bool(self.stop)

    def _resolved(
        self, step: Step | None, path: list[tuple[TorusPoint, Array]]
    ) -> tuple[Step, TorusPoint, Array] | None:
        """A step, or one over a resonance it has come to, with its torus refined and the tangent there.

        None where one of them fails.
        """
        if step is None:
            return None
        if step.folds or step.after.torus.tail > self.family.rough:
            step = self._over(path, step.after.torus) or step
        if self.family.resolved(step.after.torus):
            return step, step.after, step.ahead
        finer = self.family.refined(step.after.torus)
        return finer and (step, self._one(finer[0], ""), finer[1] * np.sign(step.ahead[-1]))

    def _step(self, now: TorusPoint, tangent: Array, length: float) -> Step | None:
        """A step along the family; None where it fails, or turns too far."""
        found = self.family.corrected(now.torus, tangent, length)
        if found is None or through(now.torus, found[0]):
            return None
        weights = Unknowns(self.family.equations, now.torus).weights
        if weights @ (tangent * found[1]) < np.cos(BENDS):
            return None
        return Step(self.family, now, self._one(found[0], ""), tangent, found[1], length)

    def _over(self, path: list[tuple[TorusPoint, Array]], last: Section) -> Step | None:
        """A step over a resonance that a torus has come to, from a smooth one before; None without one.

        Newton's method is held at values of the parameter beyond: tangents near a resonance lead nowhere.
        """
        near, count = resonance(last), len(last.states)
        before = [each for each in path[-BACK:] if len(each[0].torus.states) == count]
        if near is None or near in self.tried or not before:
            return None
        self.tried.add(near)
        smooth = [each for each in before if each[0].torus.tail <= CALM * self.family.rough]
        start, tangent = smooth[-1] if smooth else min(before, key=lambda each: each[0].torus.tail)
        way, beyond = float(np.sign(tangent[-1])), SHORTEST * self.family.equations.scale
        while beyond < LONGEST * self.family.equations.scale:
            beyond *= FARTHER
            found = self.family.directed(start.torus, self.family.value(last) + way * beyond)
            if found is None or found[0].tail > CALM * self.family.rough:
                continue
            after = self._one(found[0], "")
            if not (passed(start.torus, after.torus, near) and self._inside(after)):
                continue
            further = self._step(after, way * found[1], FIRST)
            if further is not None and way * (further.after.parameter - after.parameter) > 0:
                low, high = sorted((start.parameter, after.parameter))
                orbits = self._locked(last, near, way)
                told = f"it locks at {near}" if orbits else f"a rotation number of {near} was passed over"
                self.lost.append(f"{told} somewhere between {low:.9g} and {high:.9g}")
                path.clear()
                return Step(self.family, start, after, tangent, way * found[1], FIRST)
        return None

    def _inside(self, point: TorusPoint) -> bool:
        """Whether a torus is within the bounds."""
        return self.bounds[0] < self.family.value(point.torus) < self.bounds[1]

    def _within(self, step: Step, last: Section) -> Iterator[TorusPoint]:
        """Yield what a step has beyond a last torus: special points, values asked for, the range's end."""
        a, b = self.family.value(step.now.torus), self.family.value(step.after.torus)
        found: list[tuple[Located, str, float]] = []
        if step.folds:
            found.append((step.fold(), "LP", b))
        found += [(located, label, b) for located, label in step.crossings()]
        for value in (v / self.scale for v in self.asked):
            if min(a, b) < value <= max(a, b):
                found.append((step.at_value(value), "UZ", value))
        low, high = self.bounds
        end = low if b <= low else high if b >= high else None
        if end is not None:
            found.append((step.at_value(end), "EP", end))
            self.stop = f"end of the range at {end * self.scale:.9g}"
        there: list[tuple[Section, str]] = []
        for located, label, value in found:
            if located.torus is None or located.off > LOCATED:
                self.lost.append(self._missed(located, label, value))
            if located.torus is not None and step.along(located.torus) > step.along(last):
                there.append((located.torus, label))
        for torus, label in sorted(there, key=lambda each: step.along(each[0])):
            yield self._one(torus, label)
            if label == "EP":
                return

    def _missed(self, located: Located, label: str, value: float) -> str:
        """That a torus within a step was not found, or not exactly."""
        if located.torus is None:
            return f"no torus {label} was found near {value * self.scale:.9g}"
        return (
            f"the torus {label} near {self.family.value(located.torus) * self.scale:.9g} was located to "
            f"{located.off:.0e} only: another family passes there"
        )

    def _one(self, torus: Section, label: str) -> TorusPoint:
        return _point(self.family, torus, self.family.value(torus) * self.scale, label)

    def _end(self, last: Section, way: float, otherwise: str) -> None:
        """Write down how the family ends at a torus: it locks, or otherwise."""
        near = resonance(last)
        orbits = () if near is None else self._locked(last, near, way)
        if near is None or last.free:
            self.stop = otherwise
        elif not orbits:
            self.stop = f"{otherwise}; that is near {near}, but no orbit of {_periods(near)} was found there"
        else:
            self.stop = (
                f"the motion locks: the rotation number {last.rotation_number:.9g} is near {near}; beyond "
                f"there are {kinds(orbits)} orbits of {_periods(near)}"
            )

    def _locked(self, last: Section, near: Fraction, way: float) -> tuple[Point, ...]:
        """Add the orbits on which a motion of an excited system locks at a ratio, and return them."""
        orbits = () if last.free else orbits_beyond(self.family, last, near.denominator, way)
        self.orbits += orbits
        return orbits


def _periods(near: Fraction) -> str:
    return "1 period" if near.denominator == 1 else f"{near.denominator} periods"


def through(before: Section, after: Section) -> bool:
    """Return whether a torus has shrunk to an orbit between two, and grown again on the other side of it."""
    one, other = (torus.states - torus.grid.weights @ torus.states for torus in (before, after))
    return bool(before.grid.weights @ (one * other).sum(axis=1) < 0)


def _point(family: Family, torus: Section, value: float, label: str) -> TorusPoint:
    found = torus_multipliers(family.equations.system, torus)
    return TorusPoint(torus, value, found, stable(np.abs(found), torus.free), label)
