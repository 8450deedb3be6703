"""Numbers that an orbit has: extremes, means and harmonics of its outputs, its parameters, its multipliers.

Each is a function of (system, orbit) and knows its derivative: `linearise` gives it as a row, exact for the
discretised orbit. Any other function of (system, orbit) serves where no derivative is needed.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from periodic import measure
from periodic.adjoint import Linear, gradient
from periodic.closure import Row
from periodic.dense import algebraic_at
from periodic.orbit import Orbit
from periodic.pointwise import Points, Slopes, collocation_points, gathered
from periodic.scheme import Array
from periodic.system import Differentiable, System, differentiable, index_of

Complex = NDArray[np.complex128]

NEWTON = 4
"""Newton steps that bring a sampled extremum to where its output is stationary."""

NEAR = 1e-3
"""How far (rad) such a step may go; an extremum at a kink is not stationary and stays where it is."""


class Functional(Protocol):
    """A number of an orbit."""

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the value (SI)."""


class Smooth(Functional, Protocol):
    """A number of an orbit with its derivative."""

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient in the orbit's numbers and the parameters `free`."""


def apart(functional: Functional, value: float, level: float) -> float:
    """Return value - level; of an angle the difference between -pi and pi."""
    if getattr(functional, "angle", False):
        return float(np.remainder(value - level + np.pi, 2 * np.pi) - np.pi)
    return value - level


def output_index(system: System, output: str) -> int:
    """Return the index of an output. Raises ValueError for a name that is none."""
    names = [o.name for o in system.outputs]
    if output not in names:
        raise ValueError(f"output is {output!r}; it must be one of {', '.join(names)}")
    return names.index(output)


@dataclass(frozen=True)
class Maximum:
    """Largest value of an output over the period."""

    output: str

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the maximum (SI)."""
        return float(measure.extrema(system, orbit).maximum[output_index(system, self.output)])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient: that of the output at the phase of its maximum."""
        phase = measure.extrema(system, orbit).maximum_phase
        return _at_extremum(differentiable(system), orbit, output_index(system, self.output), phase, free)


@dataclass(frozen=True)
class Minimum:
    """Least value of an output over the period."""

    output: str

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the minimum (SI)."""
        return float(measure.extrema(system, orbit).minimum[output_index(system, self.output)])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient: that of the output at the phase of its minimum."""
        phase = measure.extrema(system, orbit).minimum_phase
        return _at_extremum(differentiable(system), orbit, output_index(system, self.output), phase, free)


@dataclass(frozen=True)
class PeakToPeak:
    """Maximum minus minimum of an output over the period."""

    output: str

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the difference (SI)."""
        found, k = measure.extrema(system, orbit), output_index(system, self.output)
        return float(found.maximum[k] - found.minimum[k])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        found, k = measure.extrema(system, orbit), output_index(system, self.output)
        rows = (
            _at_extremum(differentiable(system), orbit, k, phases, free)
            for phases in (found.maximum_phase, found.minimum_phase)
        )
        return next(rows) + next(rows).scaled(-1.0)


@dataclass(frozen=True)
class Component:
    """Part of an output in a harmonic: 2/T integral of y cos(k tau - phase), k = order; k = 0: the mean.

    T is the orbit's period in tau. Phase 0 is the part in phase with cos(k tau), pi/2 that with sin(k tau).
    """

    output: str
    order: float = 1.0
    phase: float = 0.0

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the component (SI)."""
        points = collocation_points(orbit)
        values = system.output(*points.arguments(orbit))[:, output_index(system, self.output)]
        return float(values @ self._weights(orbit, points))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        k, points = output_index(system, self.output), collocation_points(orbit)
        line = differentiable(system).output_gradient(*points.arguments(orbit), free)
        weights = self._weights(orbit, points)
        turned = replace(self, phase=self.phase - np.pi / 2)._weights(orbit, points)
        slopes = Slopes(
            weights[:, None] * line.d_rate[:, k],
            weights[:, None] * line.d_state[:, k],
            weights[:, None] * line.d_algebraic[:, k],
            weights * line.d_phase[:, k] + self.order * turned * line.residual[:, k],
            weights @ line.d_parameter[:, k],
        )
        row = gathered(system, orbit, points, slopes, free)
        relative = (orbit.grid.width_gradient / orbit.grid.width[:, None])[points.index]
        outer = row.outer
        outer[: len(orbit.phases)] += (weights * line.residual[:, k]) @ relative
        return Row(float(weights @ line.residual[:, k]) + row.value, row.nodes, outer, row.stages)

    def _weights(self, orbit: Orbit, points: Points) -> Array:
        part = 1.0 if self.order == 0 else 2.0
        quadrature = np.tile(orbit.mesh.scheme.weights, orbit.mesh.ntst) * orbit.grid.width[points.index]
        wave = np.cos(self.order * points.phase - self.phase)
        return part / orbit.mesh.period * quadrature * wave


def mean(output: str) -> Component:
    """Return the mean of an output over the period."""
    return Component(output, 0.0)


@dataclass(frozen=True)
class Amplitude:
    """Amplitude of a harmonic of an output."""

    output: str
    order: float = 1.0

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the amplitude (SI)."""
        cosine, sine = (part(system, orbit) for part in _parts(self))
        return float(np.hypot(cosine, sine))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        cosine, sine = (part.linearise(system, orbit, free) for part in _parts(self))
        size = float(np.hypot(cosine.value, sine.value))
        row = cosine.scaled(cosine.value / size) + sine.scaled(sine.value / size)
        return Row(size, row.nodes, row.outer, row.stages)


@dataclass(frozen=True)
class PhaseLag:
    """Phase (rad) by which a harmonic of an output lags behind cos(k tau), from -pi to pi."""

    output: str
    order: float = 1.0
    angle = True

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the phase lag in rad."""
        cosine, sine = (part(system, orbit) for part in _parts(self))
        return float(np.arctan2(sine, cosine))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        cosine, sine = (part.linearise(system, orbit, free) for part in _parts(self))
        square = cosine.value**2 + sine.value**2
        row = sine.scaled(cosine.value / square) + cosine.scaled(-sine.value / square)
        return Row(float(np.arctan2(sine.value, cosine.value)), row.nodes, row.outer, row.stages)


def _parts(of: Amplitude | PhaseLag) -> tuple[Component, Component]:
    return Component(of.output, of.order), Component(of.output, of.order, np.pi / 2)


@dataclass(frozen=True)
class Value:
    """A parameter's value (SI): of interest where something determines it."""

    parameter: str

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the value."""
        return float(orbit.parameter[index_of(system, self.parameter)])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        k = index_of(system, self.parameter)
        outer = np.append(np.zeros(len(orbit.phases)), [float(i == k) for i in free])
        return Row(float(orbit.parameter[k]), np.zeros_like(orbit.nodes), outer)


@dataclass(frozen=True)
class Multiplier:
    """Modulus, angle (rad), real or imaginary part of a multiplier, counted from 0 by falling modulus.

    Of a pair the one with positive imaginary part comes first. Where its angle is 2 pi k/n an orbit is in
    resonance with motions of n periods.
    """

    which: int = 0
    part: str = "modulus"
    _parts: tuple[str, ...] = field(default=("modulus", "angle", "real", "imaginary"), repr=False)

    def __post_init__(self) -> None:
        if self.part not in self._parts:
            raise ValueError(f"part is {self.part!r}; it must be one of {', '.join(self._parts)}")

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the value."""
        return self._taken(self._eigen(differentiable(system), orbit)[1])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient, d mu = w' dM v / w' v; the multiplier must be a simple one."""
        linear, value, right, left = self._eigen(differentiable(system), orbit)
        unit = np.conj(value) / abs(value)
        factors = {"modulus": unit, "angle": -1j * unit / abs(value), "real": 1.0, "imaginary": -1j}
        left = factors[self.part] * left / (left @ right)
        source = (linear.source(left.real), linear.source(-left.imag))
        row = gradient(linear, linear.tangent(right.real), source[0], free)
        row += gradient(linear, linear.tangent(right.imag), source[1], free)
        return Row(self._taken(value) + row.value, row.nodes, row.outer, row.stages)

    @property
    def angle(self) -> bool:
        """Whether the value is an angle."""
        return self.part == "angle"

    def _taken(self, value: complex) -> float:
        angle = float(np.angle(value))
        return {"modulus": abs(value), "angle": angle, "real": value.real, "imaginary": value.imag}[self.part]

    def _eigen(self, system: Differentiable, orbit: Orbit) -> tuple[Linear, complex, Complex, Complex]:
        """The linearised flow; the multiplier, its eigenvector v and left eigenvector w (w' M = mu w')."""
        linear = Linear.about(system, orbit, ())
        values, vectors = np.linalg.eig(linear.monodromy)
        if not 0 <= self.which < len(values):
            raise ValueError(f"which is {self.which}; the orbit has the multipliers 0 to {len(values) - 1}")
        k = np.lexsort((-values.imag, -np.abs(values)))[self.which]
        others, left = np.linalg.eig(linear.monodromy.T)
        nearest = np.abs(others - values[k]).argmin()
        return linear, complex(values[k]), vectors[:, k] + 0j, left[:, nearest] + 0j


def _at_extremum(
    system: Differentiable, orbit: Orbit, output: int, phases: Array, free: tuple[int, ...]
) -> Row:
    """Value and gradient of an output at the phase where it is stationary.

    There it does not matter to first order that the point moves with its interval.
    """
    points = _points(system, orbit, np.array([_stationary(system, orbit, output, float(phases[output]))]))
    line = system.output_gradient(*points.arguments(orbit), free)
    slopes = Slopes(
        line.d_rate[:, output],
        line.d_state[:, output],
        line.d_algebraic[:, output],
        line.d_phase[:, output],
        line.d_parameter[0, output],
    )
    row = gathered(system, orbit, points, slopes, free)
    return Row(float(line.residual[0, output]) + row.value, row.nodes, row.outer, row.stages)


def _points(system: System, orbit: Orbit, tau: Array) -> Points:
    index, theta = orbit.locate(tau)
    return Points(index, theta, tau, orbit.rate(tau), orbit.state(tau), algebraic_at(system, orbit, tau))


def _stationary(system: System, orbit: Orbit, output: int, phase: float) -> float:
    """Return the phase near `phase` where an output is stationary, or `phase` where there is none near."""
    found = phase
    for _ in range(NEWTON):
        step = 1e-2 * float(orbit.grid.width[orbit.locate(np.array([found]))[0][0]])
        near = found + step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
        y = measure.outputs(system, orbit, near)[:, output]
        first = (8 * (y[3] - y[1]) - (y[4] - y[0])) / 12
        second = (16 * (y[3] + y[1]) - (y[4] + y[0]) - 30 * y[2]) / 12
        move = -step * first / second if second != 0 else 0.0
        if abs(found + move - phase) > NEAR:
            return phase
        found += move
        if abs(move) < 1e-3 * step:
            break
    return found
