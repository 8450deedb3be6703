"""Numbers that an orbit has: extremes, means and harmonics of its outputs, its parameters, its multipliers.

Each is a function of (system, orbit) and knows its derivative: `linearise` gives it as a row, exact for the
discretised orbit. Any other function of (system, orbit) serves where no derivative is needed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.checks import one_of
from periodic.conditions.variations import variations
from periodic.linear.variation import Variations
from periodic.orbit.construction import as_read_by
from periodic.orbit.gradients import Points, Slopes, collocation_points, gathered
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import System, differentiable, index_of

Complex = NDArray[np.complex128]


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
    return names.index(one_of("output", output, names))


@dataclass(frozen=True)
class Component:
    """Part of an output in a harmonic: 2/T integral of y cos(k tau - phase) dtau; k = 0: the mean.

    T is the orbit's period in tau.

    Parameters
    ----------
    output : str
        Name of the output.
    order : float
        Order k of the harmonic.
    phase : float
        In rad: 0 for the part in phase with cos(k tau), pi/2 for that with sin(k tau).
    """

    output: str
    order: float = 1.0
    phase: float = 0.0

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the component (SI)."""
        orbit = as_read_by(system, orbit)
        points = collocation_points(orbit)
        values = system.output(*points.arguments(orbit))[:, output_index(system, self.output)]
        return float(values @ self._weights(orbit, points))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        k, points = output_index(system, self.output), collocation_points(orbit)
        line = differentiable(system).output_gradient(*points.arguments(orbit), free)
        weights = self._weights(orbit, points)
        quarter_later = replace(self, phase=self.phase - np.pi / 2)._weights(orbit, points)
        slopes = Slopes(
            weights[:, None] * line.d_rate[:, k],
            weights[:, None] * line.d_state[:, k],
            weights[:, None] * line.d_algebraic[:, k],
            weights * line.d_phase[:, k] + self.order * quarter_later * line.residual[:, k],
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
    """Return the mean of an output over the period.

    Parameters
    ----------
    output : str
        Name of the output.

    Returns
    -------
    Component
        The functional, of order 0.
    """
    return Component(output, 0.0)


@dataclass(frozen=True)
class Amplitude:
    """Amplitude of a harmonic of an output (SI).

    Parameters
    ----------
    output : str
        Name of the output.
    order : float
        Order k of the harmonic.
    """

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
    """Phase (rad) by which a harmonic of an output lags behind cos(k tau), from -pi to pi.

    Parameters
    ----------
    output : str
        Name of the output.
    order : float
        Order k of the harmonic.
    """

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
    """A parameter's value (SI), of interest where a condition determines it.

    Parameters
    ----------
    parameter : str
        Name of the parameter.
    """

    parameter: str

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the value."""
        return float(as_read_by(system, orbit).parameter[index_of(system, self.parameter)])

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        k = index_of(system, self.parameter)
        outer = np.append(np.zeros(len(orbit.phases)), [float(i == k) for i in free])
        return Row(float(orbit.parameter[k]), np.zeros_like(orbit.nodes), outer)


@dataclass(frozen=True)
class Multiplier:
    """Modulus, angle (rad), real or imaginary part of a Floquet multiplier.

    Where its angle is 2 pi k/n an orbit is in resonance with motions of n periods.

    Parameters
    ----------
    which : int
        The multiplier, counted from 0 by falling modulus; of a pair the one with positive imaginary part
        comes first.
    part : {"modulus", "angle", "real", "imaginary"}
        What of it.

    Raises
    ------
    ValueError
        For another part; when called, for a multiplier that there is not.
    """

    which: int = 0
    part: str = "modulus"
    _parts: ClassVar[tuple[str, ...]] = ("modulus", "angle", "real", "imaginary")

    def __post_init__(self) -> None:
        one_of("part", self.part, self._parts)

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the value."""
        found, k = self._found(system, as_read_by(system, orbit))
        return self._taken(complex(found.multipliers[k]))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient; the multiplier must be a simple one."""
        found, k = self._found(system, orbit)
        value = complex(found.multipliers[k])
        unit = np.conj(value) / abs(value)
        factors = {"modulus": unit, "angle": -1j * unit / abs(value), "real": 1.0, "imaginary": -1j}
        row = found.multiplier(k, complex(factors[self.part]), free)
        return Row(self._taken(value) + row.value, row.nodes, row.outer, row.stages)

    @property
    def angle(self) -> bool:
        """Whether the value is an angle."""
        return self.part == "angle"

    def _taken(self, value: complex) -> float:
        angle = float(np.angle(value))
        return {"modulus": abs(value), "angle": angle, "real": value.real, "imaginary": value.imag}[self.part]

    def _found(self, system: System, orbit: Orbit) -> tuple[Variations, int]:
        """All multipliers, and the index of this one."""
        found = variations(system, orbit, ())
        values = found.multipliers
        if not 0 <= self.which < len(values):
            raise ValueError(f"which is {self.which}; the orbit has the multipliers 0 to {len(values) - 1}")
        return found, int(np.lexsort((-values.imag, -np.abs(values)))[self.which])
