"""A feature of a response: an orbit that conditions pick, and a number of it, at whatever parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from periodic.bifurcations.label import Label
from periodic.conditions.functionals import Functional
from periodic.conditions.sensitivity import Changes
from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.orbit.orbit import Orbit
from periodic.results.point import Point
from periodic.system import System
from periodic.tracing.trace import continuation
from periodic.tracing.watch import Watch

MOST_PARTS = 64
"""Into how many parts a way between two sets of parameters is cut where Newton does not take it at once."""


class LostError(Exception):
    """A feature is not found at other parameters: it may have ceased to exist on the way."""


@dataclass
class Count:
    """How many orbits were solved for."""

    orbits: int = 0


@dataclass(frozen=True, kw_only=True)
class Way:
    """How orbits are found: the equations, what else determines them, tolerance and method."""

    system: System
    determined: Mapping[str, Condition] = field(default_factory=dict)
    tol: float | Tolerance = Accuracy.STANDARD
    method: Discretisation | None = None
    count: Count = field(default_factory=Count)

    def solved(
        self, orbit: Orbit, values: Mapping[str, float], pick: Mapping[str, Condition]
    ) -> Point | None:
        """Return the orbit near another one at given values (SI) that meets conditions, if there is one.

        `pick` are the conditions besides those of every orbit.
        """
        held, at = self._held(orbit, values, pick)
        problem = Problem(self.system, held, (at, at + (abs(at) or 1.0)), {**self.determined, **pick})
        others = {name: value for name, value in values.items() if name != held}
        self.count.orbits += 1
        run = continuation(
            problem,
            orbit,
            tol=self.tol,
            method=self.method,
            values=others,
            watch=Watch(peaks={}),
        )
        point = next(run, None)
        return None if point is None or point.label is Label.FAILED else point

    def changes(self, orbit: Orbit, pick: Mapping[str, Condition], name: str) -> Changes:
        """Return how an orbit changes with each parameter. Raises LostError where it does not meet them."""
        try:
            return Changes.of(self.system, orbit, {**self.determined, **pick})
        except (ArithmeticError, ValueError) as error:
            raise LostError(f"{name}: {error}") from error

    def _held(
        self, orbit: Orbit, values: Mapping[str, float], pick: Mapping[str, Condition]
    ) -> tuple[str, float]:
        """Return a parameter that is not determined, and its value."""
        taken = {*self.determined, *pick}
        known = {p.name: float(v) for p, v in zip(self.system.parameters, orbit.parameter, strict=True)}
        free = [name for name in known if name not in taken]
        name = next((name for name in free if name in values), free[0] if free else "")
        if not name:
            raise ValueError("all parameters of the system are determined; one must be left to be held")
        return name, float(values.get(name, known[name]))


@dataclass(frozen=True)
class Feature:
    """An orbit picked by conditions, and the functional that is read off it.

    Parameters
    ----------
    way : Way
        How orbits are found.
    point : Point
        The orbit, and what is known of it.
    functional : Functional
        What is read; it must have a derivative.
    pick : mapping of str to Condition
        What determines the orbit besides what determines every orbit, by parameter.
    name : str
        What it is, in words.
    bounds : tuple of float, optional
        Range (SI) of the parameter that `pick` determines, outside of which it is none.
    """

    way: Way
    point: Point
    functional: Functional
    pick: Mapping[str, Condition] = field(default_factory=dict)
    name: str = ""
    bounds: tuple[float, float] | None = None

    @property
    def orbit(self) -> Orbit:
        """The orbit."""
        return self.point.orbit

    @cached_property
    def value(self) -> float:
        """The number (SI)."""
        return float(self.functional(self.way.system, self.orbit))

    @cached_property
    def changes(self) -> Changes:
        """How the orbit changes with each parameter. Raises LostError."""
        return self.way.changes(self.orbit, self.pick, self.name)

    @cached_property
    def gradient(self) -> dict[str, float]:
        """Derivatives of the number in every parameter that is not determined (SI), by name.

        Raises LostError.
        """
        return self.changes.rates(self.functional)

    def at(self, values: Mapping[str, float]) -> Feature:
        """Return the same feature at other values of parameters (SI). Raises LostError."""
        known = self.orbit.parameters
        begin = {name: float(known[name]) for name in values}
        here, done, part = self, 0.0, 1.0
        while done < 1:
            wanted = min(done + part, 1.0)
            there = {n: begin[n] + wanted * (values[n] - begin[n]) for n in values} if wanted < 1 else values
            found = here._stepped(there)
            if found is None:
                part /= 2
                if part < 1 / MOST_PARTS:
                    raise LostError(f"{self.name} is not found beyond {_said(begin, values, done)}")
                continue
            here, done = found, wanted
        return here

    def _stepped(self, values: Mapping[str, float]) -> Feature | None:
        """The feature at other values, by Newton's method from where its changes lead; None if that fails."""
        try:
            guess = self.changes.predicted(values)
            found = self.way.solved(guess, values, self.pick)
        except (ArithmeticError, ValueError, LostError):
            return None
        return None if found is None or not self._inside(found) else replace(self, point=found)

    def _inside(self, point: Point) -> bool:
        """Whether what `pick` determines is in its range."""
        if self.bounds is None or not self.pick:
            return True
        low, high = sorted(self.bounds)
        return low <= point.orbit.parameters[next(iter(self.pick))] <= high


def _said(begin: Mapping[str, float], values: Mapping[str, float], done: float) -> str:
    reached = {name: begin[name] + done * (values[name] - begin[name]) for name in values}
    return ", ".join(f"{name} = {value:.6g}" for name, value in reached.items())
