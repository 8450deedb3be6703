"""Motions of a model matched with what was measured: of each point the nearest motion of its branch.

In the space of place and measured numbers, each over its standard deviation, a branch is a curve z(s) and a
measurement a point z_i. The motion at the foot of the perpendicular is where the misfit |z(s) - z_i|^2 / 2 is
stationary along the branch; it is regular at folds too. Its residuals z(s(p), p) - z_i have exact derivatives
by those of the motion with this condition, the way of the foot along the branch included.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from periodic.conditions.functionals import Value
from periodic.conditions.levels import Peak
from periodic.decisions.fitting.measured import Measured, MeasuredQuantity
from periodic.decisions.fitting.misfit import Misfit, Target
from periodic.decisions.responses.feature import Feature, Way
from periodic.orbit.scheme import Array
from periodic.results.point import Point


@dataclass(frozen=True)
class Rows:
    """Residuals (m,), their derivatives in the free parameters (m, n), and in gains and offsets by name."""

    residual: Array
    slopes: Array
    sensors: Mapping[str, Array]


@dataclass(frozen=True)
class Spot:
    """A measured point as it is seen with given gains and offsets of the sensors.

    sensors: names of the gain and the offset of each functional, empty where they are known. values: those of
    gains and offsets, among others.
    """

    measured: Measured
    index: int
    sensors: tuple[tuple[str, str], ...]
    values: Mapping[str, float]

    def __str__(self) -> str:
        place = self.measured.places[self.index]
        return f"{self.measured.name} at {self.measured.response.parameter} = {place:.6g}"

    @cached_property
    def targets(self) -> tuple[Target, ...]:
        """What was measured: the place first."""
        data, k = self.measured, self.index
        place = Target(Value(data.response.parameter), float(data.places[k]), float(data.place_sigmas[k]))
        own = [
            Target(
                functional,
                float(values[k]),
                float(data.sigmas[functional][k]),
                self.values.get(gain, 1.0),
                self.values.get(offset, 0.0),
            )
            for (functional, values), (gain, offset) in zip(data.values.items(), self.sensors, strict=True)
        ]
        return (place, *own)

    @property
    def misfit(self) -> Misfit:
        """Half the squared distance of a motion from the point."""
        return Misfit(self.targets)


@dataclass(frozen=True)
class Foot:
    """A measured point and the nearest motion of its branch."""

    spot: Spot
    way: Way
    point: Point

    def __str__(self) -> str:
        return str(self.spot)

    @property
    def data(self) -> Measured:
        """What it was measured with."""
        return self.spot.measured

    def at(self, values: Mapping[str, float], free: Sequence[str]) -> Foot:
        """Return the nearest motion at other values of free parameters and sensors (SI). Raises LostError."""
        spot = replace(self.spot, values=values)
        return replace(self, spot=spot).moved({name: values[name] for name in free})

    def moved(self, values: Mapping[str, float]) -> Foot:
        """Return the nearest motion at other values of free parameters (SI). Raises LostError."""
        return replace(self, point=self._feature.at(values).point)

    @cached_property
    def _feature(self) -> Feature:
        misfit, place = self.spot.misfit, self.spot.measured.response.parameter
        return Feature(self.way, self.point, misfit, {place: Peak(misfit)}, f"the motion nearest to {self}")

    @cached_property
    def models(self) -> tuple[float, ...]:
        """Place and functionals of the motion (SI)."""
        return tuple(float(t.functional(self.way.system, self.point.orbit)) for t in self.spot.targets)

    @property
    def difference(self) -> Array:
        """All residuals, that of the place first."""
        return np.array([t.residual(m) for t, m in zip(self.spot.targets, self.models, strict=True)])

    def loosened(self, part: float) -> Array:
        """Return the residuals with further standard deviations, a part of what all points span."""
        own, k = self.spot.measured, self.spot.index
        coarse = own.loosened(part)
        numbers = [own.sigmas[f][k] / coarse.sigmas[f][k] for f in own.values]
        return self.difference * np.array([own.place_sigmas[k] / coarse.place_sigmas[k], *numbers])

    def rows(self, free: Sequence[str]) -> Rows:
        """Return residuals and their derivatives."""
        targets, changes = self.spot.targets, self._feature.changes
        rates = [changes.rates(target.functional) for target in targets]
        factors = [target.gain / target.sigma for target in targets]
        slopes = np.array([[f * r[name] for name in free] for f, r in zip(factors, rates, strict=True)])
        return Rows(self.difference, slopes, self._sensors if any(map(any, self.spot.sensors)) else {})

    @property
    def _sensors(self) -> dict[str, Array]:
        """Derivatives in gains and offsets, without their part along the branch, where the foot gives way."""
        changes = self.way.changes(self.point.orbit, {}, str(self))
        targets, place = self.spot.targets, self.spot.measured.response.parameter
        rates = [changes.rates(target.functional)[place] for target in targets[1:]]
        along = [t.gain / t.sigma * rate for t, rate in zip(targets[1:], rates, strict=True)]
        tangent = np.array([1 / targets[0].sigma, *along])
        tangent /= np.linalg.norm(tangent)
        found: dict[str, Array] = {}
        for k, (gain, offset) in enumerate(self.spot.sensors, start=1):
            unit = np.eye(len(targets))[k] / targets[k].sigma
            normal = unit - tangent * (tangent @ unit)
            found |= {gain: self.models[k] * normal} if gain else {}
            found |= {offset: normal} if offset else {}
        return found


@dataclass(frozen=True)
class Single:
    """A measured quantity and the feature that it is."""

    measured: MeasuredQuantity
    feature: Feature

    def __str__(self) -> str:
        return str(self.measured.quantity)

    @property
    def data(self) -> MeasuredQuantity:
        """What was measured."""
        return self.measured

    def at(self, values: Mapping[str, float], free: Sequence[str]) -> Single:
        """Return the feature at other values. Raises LostError."""
        return replace(self, feature=self.feature.at({name: values[name] for name in free}))

    @property
    def models(self) -> tuple[float, ...]:
        """The model's value (SI)."""
        return (self.feature.value,)

    @property
    def difference(self) -> Array:
        """The residual."""
        return np.array([(self.feature.value - self.measured.value) / self.measured.sigma])

    def loosened(self, part: float) -> Array:
        """Return the residual as it is."""
        return self.difference

    def rows(self, free: Sequence[str]) -> Rows:
        """Return the residual and its derivatives."""
        slopes = np.array([[self.feature.gradient[name] for name in free]]) / self.measured.sigma
        return Rows(self.difference, slopes, {})


@dataclass(frozen=True)
class Match:
    """A model at given values, with the motions that are nearest to what was measured.

    Parameters
    ----------
    values : mapping of str to float
        Free parameters (SI), then gains and offsets of sensors.
    free : tuple of str
        Names of the free parameters.
    parts : tuple of Foot or Single
        One for each measured point and quantity.
    """

    values: Mapping[str, float]
    free: tuple[str, ...]
    parts: tuple[Foot | Single, ...]

    def at(self, values: Mapping[str, float]) -> Match:
        """Return the match at other values, each motion followed. Raises LostError."""
        moved = tuple(part.at(values, self.free) for part in self.parts)
        return replace(self, values=dict(values), parts=moved)

    @cached_property
    def _rows(self) -> list[Rows]:
        return [part.rows(self.free) for part in self.parts]

    @property
    def residual(self) -> Array:
        """All residuals, over their standard deviations."""
        return np.concatenate([rows.residual for rows in self._rows])

    @property
    def jacobian(self) -> Array:
        """Their derivatives in all values (SI), in order."""
        sensors = list(self.values)[len(self.free) :]
        blocks = [
            np.column_stack(
                [rows.slopes, *(rows.sensors.get(s, np.zeros(len(rows.residual))) for s in sensors)]
            )
            for rows in self._rows
        ]
        return np.concatenate(blocks)

    def loosened(self, part: float) -> float:
        """Return chi squared if points had further standard deviations, a part of what all of them span."""
        return float(sum(np.sum(each.loosened(part) ** 2) for each in self.parts))

    @property
    def count(self) -> int:
        """Number of measured numbers, places not among them."""
        return sum(len(part.difference) - isinstance(part, Foot) for part in self.parts)

    @property
    def misfit(self) -> float:
        """The sum of the squares of all residuals, chi squared."""
        return float(sum(part.difference @ part.difference for part in self.parts))
