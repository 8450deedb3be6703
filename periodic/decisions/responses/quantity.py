"""Numbers of a response: its highest peak, the place of a special point, the motion at a value.

Each knows the features that it is made of, so that it can be followed as parameters change.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from periodic.bifurcations.label import Label
from periodic.checks import number
from periodic.conditions.functionals import Functional, Smooth, Value
from periodic.conditions.levels import Peak
from periodic.conditions.twoparameter.augmented import DoublingCondition, FoldCondition, TorusCondition
from periodic.conditions.twoparameter.grazing import GrazingCondition
from periodic.correction.condition import Condition, Given
from periodic.decisions.responses.feature import Count, Feature, Way
from periodic.decisions.responses.words import called
from periodic.orbit.scheme import Array
from periodic.results.branch import Branch
from periodic.results.point import Point
from periodic.system import System

CONDITIONS: dict[str, Callable[[System, Point], Condition]] = {
    Label.FOLD: lambda system, point: FoldCondition(),
    Label.DOUBLING: lambda system, point: DoublingCondition(),
    Label.TORUS: lambda system, point: TorusCondition(),
    Label.GRAZING: lambda system, point: GrazingCondition(_grazing(system, point)),
}
"""What holds an orbit at a special point, by its label; a new kind is one line."""


class AbsentError(Exception):
    """A response does not have what is asked of it."""


class ResponseLike(Protocol):
    """What quantities know of the response that they are of."""

    @property
    def parameter(self) -> str: ...
    @property
    def bounds(self) -> tuple[float, float]: ...
    def traced(
        self,
        system: System,
        values: Mapping[str, float],
        peaks: Mapping[str, Functional] | None = None,
        at: Sequence[float] = (),
    ) -> Branch: ...
    def way(self, system: System, count: Count) -> Way: ...


class Quantity(ABC):
    """A number of a response; `q <= 1.0` and `q >= 1.0` are constraints."""

    response: ResponseLike
    """The branch that it is of."""

    sign: float = 1.0
    """1 where the largest of the features' values counts, -1 where the least does."""

    @property
    def peaks(self) -> tuple[Smooth, ...]:
        """Functionals whose stationary places along the branch are to be located."""
        return ()

    @property
    def places(self) -> tuple[float, ...]:
        """Values of the parameter at which points are needed."""
        return ()

    @abstractmethod
    def features(self, way: Way, branch: Branch) -> list[Feature]:
        """Return what it is made of on a branch.

        Parameters
        ----------
        way : Way
            How orbits are found.
        branch : Branch
            The response.

        Returns
        -------
        list of Feature
            One or several, of which the largest or least counts.

        Raises
        ------
        AbsentError
            For a branch that does not have it.
        """

    def decisive(self, features: Sequence[Feature]) -> Feature:
        """Return the feature that gives it its value: of the largest, or the least.

        Parameters
        ----------
        features : sequence of Feature
            What it is made of.

        Returns
        -------
        Feature
            One of them.
        """
        return max(features, key=lambda feature: self.sign * feature.value)

    def __le__(self, bound: float) -> Constraint:
        return Constraint(self, _finite(bound), 1.0)

    def __ge__(self, bound: float) -> Constraint:
        return Constraint(self, _finite(bound), -1.0)


@dataclass(frozen=True)
class Constraint:
    """A quantity that must not exceed a bound, or not fall below one.

    Parameters
    ----------
    quantity : Quantity
        The quantity.
    bound : float
        The bound (SI).
    side : float
        1 for at most, -1 for at least.
    """

    quantity: Quantity
    bound: float
    side: float

    def __str__(self) -> str:
        return f"{self.quantity} {'<=' if self.side > 0 else '>='} {self.bound:g}"


@dataclass(frozen=True)
class Extreme(Quantity):
    """The highest (sign 1) or lowest (-1) value of a functional along a branch."""

    response: ResponseLike
    functional: Smooth
    sign: float
    stable: bool = False

    def __str__(self) -> str:
        return f"{'highest' if self.sign > 0 else 'lowest'} {called(self.functional)}"

    @property
    def peaks(self) -> tuple[Smooth, ...]:
        """The functional itself."""
        return (self.functional,)

    def features(self, way: Way, branch: Branch) -> list[Feature]:
        """Return the stationary places, the ends of the branch, and corners that are higher than beside."""
        name = self.response.parameter
        if any(stop.reason.numerical for stop in branch.stops):
            raise AbsentError(f"the branch over {name} stopped early: {branch.ending}")
        values = np.array([self.sign * float(self.functional(way.system, p.orbit)) for p in branch])
        counts = np.array([not self.stable or p.stable or p.label.critical for p in branch])
        found = []
        for k, point in enumerate(branch):
            pick = self._pick(way.system, branch, values, k) if counts[k] else None
            if pick is not None:
                named = f"{self} at {name} = {point.parameter:.6g}"
                found.append(Feature(way, point, self.functional, pick, named, self.response.bounds))
        if not found:
            kind = "stable motion" if self.stable else "peak"
            raise AbsentError(f"the branch over {name} has no {kind}: {branch.ending}")
        return found

    def _pick(self, system: System, branch: Branch, values: Array, k: int) -> dict[str, Condition] | None:
        """The conditions at point k if its value may be the extreme one; None if not."""
        point, name = branch[k], self.response.parameter
        inside = 0 < k < len(branch) - 1
        if not inside:
            return {} if point.parameter in self.response.bounds else None
        beside = max(values[k - 1], values[k + 1])
        if point.label == Label.PEAK and values[k] >= beside:
            return {name: Peak(self.functional)}
        ends = self.stable and point.label.critical and (branch[k - 1].stable or branch[k + 1].stable)
        held = point.label in CONDITIONS and (values[k] > beside or ends)
        return {name: CONDITIONS[point.label](system, point)} if held else None


@dataclass(frozen=True)
class SpecialPoint(Quantity):
    """The parameter, or a functional, at a special point of a branch."""

    response: ResponseLike
    label: str
    which: int = 0
    functional: Smooth | None = None

    def __post_init__(self) -> None:
        if self.label not in CONDITIONS:
            raise ValueError(f"label is {self.label!r}; it must be one of {', '.join(CONDITIONS)}")

    def __str__(self) -> str:
        what = self.response.parameter if self.functional is None else called(self.functional)
        return f"{what} at {self.label} {self.which}"

    def features(self, way: Way, branch: Branch) -> list[Feature]:
        """Return the special point."""
        points = branch.labelled(self.label)
        if self.which >= len(points):
            many = f"{len(points)} points {self.label}, counted from 0, and which is {self.which}"
            raise AbsentError(
                f"the branch over {branch.parameter} has {many if points else f'no point {self.label}'}"
            )
        point = points[self.which]
        pick = {self.response.parameter: CONDITIONS[self.label](way.system, point)}
        functional = self.functional or Value(self.response.parameter)
        return [Feature(way, point, functional, pick, str(self), self.response.bounds)]


@dataclass(frozen=True)
class AtValue(Quantity):
    """A functional of one of the motions at a value of the parameter."""

    response: ResponseLike
    value: float
    functional: Smooth
    sheet: int = 0

    def __str__(self) -> str:
        return f"{called(self.functional)} at {self.response.parameter} = {self.value:g}"

    @property
    def places(self) -> tuple[float, ...]:
        """The value."""
        return (self.value,)

    def features(self, way: Way, branch: Branch) -> list[Feature]:
        """Return the motion."""
        there = [point for point in branch if point.parameter == self.value]
        distinct = [p for k, p in enumerate(there) if k == 0 or p.orbit is not there[k - 1].orbit]
        if self.sheet >= len(distinct):
            raise AbsentError(
                f"sheet is {self.sheet}; the branch has {len(distinct)} motions at {self.value:g}"
            )
        return [Feature(way, distinct[self.sheet], self.functional, {}, str(self))]


def _grazing(system: System, point: Point) -> str:
    """The switch that grazes its level at a point: the one whose condition is met there, or nearly."""
    names = [switch.name for switch in system.switches]
    orbit = point.orbit
    missed = [
        abs(GrazingCondition(name).at(orbit, Given(0)).linearise(system, orbit, (0,)).value) for name in names
    ]
    return names[int(np.argmin(missed))]


def _finite(bound: float) -> float:
    if not np.isfinite(number("bound", bound)):
        raise ValueError(f"bound is {bound}; it must be finite")
    return float(bound)
