"""The linear frequency response of a model: complex amplitudes of its outputs under the excitation.

Rows R and outputs Y are linearised at rest, in the excitation s = sin tau, c = cos tau as well. With
dx = Re(X exp(i tau)), dz = Re(Z exp(i tau)), s = Re(-i exp(i tau)) and c = Re(exp(i tau)),

    (R_x + i R_x') X + R_z Z = i R_s - R_c,      A = (Y_x + i Y_x') X + Y_z Z - i Y_s + Y_c.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np
import scipy

from symbolic.arrays import Array, Complex
from symbolic.checks import one_of, sequence
from symbolic.motion.linear import Modes, RestFinder, varying
from symbolic.system.compiled import CompiledSystem, with_values

SINGULAR = 1e14
"""Condition number, rows and columns equilibrated, from which there is an undamped resonance."""


@dataclass(frozen=True, kw_only=True)
class FrequencyResponse:
    """Response over N values of a parameter: output j is rest + Re(amplitude exp(i tau)).

    Parameters
    ----------
    parameter : str
        Its name.
    outputs : tuple of str
        Names of the outputs.
    values : ndarray, shape (N,)
        The parameter, SI.
    omega : ndarray, shape (N,)
        Excitation frequency in rad/s.
    amplitude : ndarray of complex, shape (N, outputs)
        In SI; infinite on an undamped resonance.
    rest : ndarray, shape (N, outputs)
        The outputs at rest, SI.
    """

    parameter: str
    outputs: tuple[str, ...]
    values: Array
    omega: Array
    amplitude: Complex
    rest: Array

    def complex_amplitude(self, output: str) -> Complex:
        """Return the complex amplitude of one output.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Complex amplitudes, SI.
        """
        return self.amplitude[:, self._index(output)]

    def peak_to_peak(self, output: str) -> Array:
        """Return maximum minus minimum over a period, 2 |amplitude|.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Peaks to peak, SI.
        """
        return 2 * np.abs(self.complex_amplitude(output))

    def phase(self, output: str) -> Array:
        """Return the phase relative to cos tau.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Phases in rad, in (-pi, pi].
        """
        return np.angle(self.complex_amplitude(output))

    def at_rest(self, output: str) -> Array:
        """Return one output at rest.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Its values at rest, SI.
        """
        return self.rest[:, self._index(output)]

    def _index(self, output: str) -> int:
        return self.outputs.index(one_of("output", output, self.outputs))


@dataclass(frozen=True, eq=False)
class Excited:
    """The response of `system` at any parameters; made once for many of them."""

    system: CompiledSystem

    @cached_property
    def finder(self) -> RestFinder:
        """What finds the rest."""
        return RestFinder(self.system)

    @cached_property
    def _linear(self) -> ca.Function:
        """Rows and outputs: values and derivatives in x', (x, z) and (s, c), without excitation."""
        e = self.system.expressions
        variables = (e.rate, ca.vertcat(e.state, e.algebraic), e.waves)
        results = [e.waved, *(ca.jacobian(e.waved, v) for v in variables)]
        results = [ca.substitute(result, e.waves, ca.SX.zeros(2)) for result in results]
        return ca.Function("linear", [e.rate, e.state, e.algebraic, e.parameter, e.phase], results)

    def amplitudes(self, modes: Modes) -> tuple[Complex, Array]:
        """Return complex amplitudes and rest values of the outputs, both (outputs,), SI."""
        n, size = len(modes.state), len(modes.state) + len(modes.algebraic)
        # The phase may stand in rows on its own, beside the excitation; at rest it is taken as 0.
        arguments = (np.zeros(n), modes.state, modes.algebraic, modes.parameter, 0.0)
        value, rate, unknown, waves = (np.array(result) for result in self._linear(*arguments))
        dynamic = unknown.astype(np.complex128)
        dynamic[:, :n] += 1j * rate
        forced = waves @ np.array([-1j, 1])
        if np.linalg.cond(equilibrated(dynamic[:size])) > SINGULAR:
            return np.full(len(value) - size, complex(np.inf)), value[size:, 0]
        motion = np.linalg.solve(dynamic[:size], -forced[:size])
        return dynamic[size:] @ motion + forced[size:], value[size:, 0]


def equilibrated(matrix: Complex) -> Complex:
    """Return a matrix with rows, then columns, divided by their largest modulus; zero ones are left."""
    for axis in (1, 0):
        largest = np.abs(matrix).max(axis=axis, keepdims=True)
        matrix = matrix / np.where(largest > 0, largest, 1.0)
    return matrix


def response(
    system: CompiledSystem,
    parameter: str,
    at: Sequence[float] | Array,
    values: Mapping[str, float] | None = None,
) -> FrequencyResponse:
    """Return the linear frequency response about the rest at each value of a parameter.

    Parameters
    ----------
    system : CompiledSystem
        The system.
    parameter : str
        Name of the parameter that is varied.
    at : sequence of float
        Its values, SI.
    values : mapping of str to float, optional
        Further parameters (SI) that differ from their nominal values.

    Returns
    -------
    FrequencyResponse
        Complex amplitudes of all outputs.

    Raises
    ------
    ValueError
        For a name that is no parameter or is also in `values`, and a value out of range.
    NoRestError
        Where no equilibrium is found.
    """
    varied, points = varying(system, parameter, values), sequence("at", at)
    excited = Excited(system)
    found = [excited.finder.modes(varied(value)) for value in points]
    answers = [excited.amplitudes(modes) for modes in found]
    return FrequencyResponse(
        parameter=parameter,
        outputs=tuple(output.name for output in system.outputs),
        values=np.array(points),
        omega=np.array([modes.omega for modes in found]),
        amplitude=np.array([amplitude for amplitude, _ in answers]),
        rest=np.array([rest for _, rest in answers]),
    )


def peak(
    system: CompiledSystem, output: str, parameter: str, bounds: tuple[float, float]
) -> tuple[float, float]:
    """Return where an output's linear response is largest between the bounds, and its peak to peak there.

    Both in SI. The bounds must hold one peak only (take them about `symbolic.resonance`).
    """
    excited, index = Excited(system), [variable.name for variable in system.outputs].index(output)

    def swing(value: float) -> float:
        found = excited.finder.modes(with_values(system, {parameter: float(value)}))
        return 2 * abs(excited.amplitudes(found)[0][index])

    width = abs(bounds[1] - bounds[0])
    best = scipy.optimize.minimize_scalar(
        lambda value: -swing(value), bounds=bounds, method="bounded", options={"xatol": 1e-9 * width}
    )
    return float(best.x), swing(best.x)
