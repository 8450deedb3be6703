"""Extremes of outputs over the period, as functionals with their derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.conditions.functionals import output_index
from periodic.orbit import extrema as measure
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.gradients import Points, Slopes, gathered
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import Differentiable, System, differentiable
from periodic.system.precision import MOST_ITERATIONS

LONGEST_MOVE = 1e-3
"""How far (rad) such a step may go; an extremum at a kink is not stationary and stays where it is."""


@dataclass(frozen=True)
class Maximum:
    """Largest value of an output over the period (SI).

    Parameters
    ----------
    output : str
        Name of the output.
    """

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
    """Least value of an output over the period (SI).

    Parameters
    ----------
    output : str
        Name of the output.
    """

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
    """Maximum minus minimum of an output over the period (SI).

    Parameters
    ----------
    output : str
        Name of the output.
    """

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
    for _ in range(MOST_ITERATIONS):
        step = 1e-2 * float(orbit.grid.width[orbit.locate(np.array([found]))[0][0]])
        near = found + step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
        y = measure.outputs(system, orbit, near)[:, output]
        first = (8 * (y[3] - y[1]) - (y[4] - y[0])) / 12
        second = (16 * (y[3] + y[1]) - (y[4] + y[0]) - 30 * y[2]) / 12
        move = -step * first / second if second != 0 else 0.0
        if abs(found + move - phase) > LONGEST_MOVE:
            return phase
        found += move
        if abs(move) < 1e-3 * step:
            break
    return found
