"""The linear frequency response of a model: complex amplitudes of its outputs under the excitation.

Rows R and outputs Y are linearised at rest, in the excitation s = sin(k tau), c = cos(k tau) as well. With
dx = Re(X exp(i k tau)), dz = Re(Z exp(i k tau)), s = Re(-i exp(i k tau)) and c = Re(exp(i k tau)),

    (R_x + i k R_x') X + R_z Z = i R_s - R_c,      A = (Y_x + i k Y_x') X + Y_z Z - i Y_s + Y_c

for each harmonic k of the excitation: one, k = 1, unless parts ask for several orders.
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
from symbolic.interrupts import interruptible
from symbolic.motion.linear import Modes, RestFinder, varying
from symbolic.system.compile import all_states
from symbolic.system.compiled import CompiledSystem, with_values

RESONANT = 1e14
"""Condition number, rows and columns equilibrated, from which there is an undamped resonance."""


@dataclass(frozen=True, kw_only=True)
class FrequencyResponse:
    """Response over N values of a parameter: output j is rest + Re sum_k amplitude_k exp(i k tau).

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
    amplitude : ndarray of complex, shape (N, outputs, harmonics)
        In SI; infinite on an undamped resonance.
    rest : ndarray, shape (N, outputs)
        The outputs at rest, SI.
    harmonics : tuple of int
        The k.
    """

    parameter: str
    outputs: tuple[str, ...]
    values: Array
    omega: Array
    amplitude: Complex
    rest: Array
    harmonics: tuple[int, ...] = (1,)

    def complex_amplitude(self, output: str) -> Complex:
        """Return the complex amplitude of one output, that of the lowest harmonic.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Complex amplitudes, SI.
        """
        return self.amplitude[:, self._index(output), 0]

    def peak_to_peak(self, output: str) -> Array:
        """Return maximum minus minimum over a period: ``2 |amplitude|`` of a single harmonic.

        Parameters
        ----------
        output : str
            Its name.

        Returns
        -------
        ndarray, shape (N,)
            Peaks to peak, SI.
        """
        found = self.amplitude[:, self._index(output)]
        return np.array([swing(each, self.harmonics) for each in found])

    def phase(self, output: str) -> Array:
        """Return the phase relative to cos(k tau), k the lowest harmonic.

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
        still = ca.SX.zeros(e.waves.size1())
        results = [ca.substitute(result, e.waves, still) for result in results]
        return ca.Function("linear", [e.rate, e.state, e.algebraic, e.parameter, e.phase], results)

    @property
    def harmonics(self) -> tuple[int, ...]:
        """Those of the excitation, the lowest first; the first one where there is no excitation."""
        return self.system.expressions.harmonics or (1,)

    @interruptible()
    def amplitudes(self, modes: Modes) -> tuple[Complex, Array]:
        """Return amplitudes (outputs, harmonics) and rest values (outputs,) of the outputs, SI."""
        # The phase may stand in rows on its own, beside the excitation; at rest it is taken as 0.
        arguments = (np.zeros(len(modes.state)), modes.state, modes.algebraic, modes.parameter, 0.0)
        value, rate, unknown, waves = (np.array(result) for result in self._linear(*arguments))
        forced = np.zeros((len(value), 1), dtype=np.complex128)
        if waves.size:
            forced = waves.reshape(len(value), -1, 2) @ np.array([-1j, 1])
        found = [
            _answer(k, rate, unknown, forced[:, i], len(modes.algebraic))
            for i, k in enumerate(self.harmonics)
        ]
        size = len(modes.state) + len(modes.algebraic)
        return np.array(found).T, value[size:, 0]


def _answer(k: int, rate: Array, unknown: Array, forced: Complex, unknowns: int) -> Complex:
    """Amplitudes of the outputs at one harmonic, infinite where the rows are singular."""
    n = rate.shape[1]
    dynamic, size = unknown.astype(np.complex128), n + unknowns
    dynamic[:, :n] += 1j * k * rate
    if np.linalg.cond(equilibrated(dynamic[:size])) > RESONANT:
        return np.full(len(forced) - size, complex(np.inf))
    motion = np.linalg.solve(dynamic[:size], -forced[:size])
    return dynamic[size:] @ motion + forced[size:]


def swing(amplitudes: Complex, harmonics: Sequence[int]) -> float:
    """Return maximum minus minimum of Re sum_k amplitude_k exp(i k tau) over a period."""
    if len(harmonics) == 1 or not np.isfinite(amplitudes).all():
        return 2 * float(np.abs(amplitudes).max())
    k = np.array(harmonics)

    def value(tau: Array, order: int = 0) -> Array:
        return ((1j * k) ** order * amplitudes * np.exp(1j * np.multiply.outer(tau, k))).real.sum(axis=-1)

    tau = np.linspace(0, 2 * np.pi, 32 * int(k.max()), endpoint=False)
    ends = tau[[value(tau).argmin(), value(tau).argmax()]]
    for _ in range(4):
        bent = value(ends, 2)
        ends = ends - np.where(bent != 0, value(ends, 1) / np.where(bent != 0, bent, 1), 0)
    return float(max(np.ptp(value(tau)), np.ptp(value(ends))))


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
    system = all_states(system)
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
        harmonics=excited.harmonics,
    )


def peak(
    system: CompiledSystem, output: str, parameter: str, bounds: tuple[float, float]
) -> tuple[float, float]:
    """Return where an output's linear response is largest between the bounds, and its peak to peak there.

    Both in SI. The bounds must hold one peak only (take them about `symbolic.resonance`).
    """
    system = all_states(system)
    excited, index = Excited(system), [variable.name for variable in system.outputs].index(output)

    def height(value: float) -> float:
        found = excited.finder.modes(with_values(system, {parameter: float(value)}))
        return swing(excited.amplitudes(found)[0][index], excited.harmonics)

    width = abs(bounds[1] - bounds[0])
    best = scipy.optimize.minimize_scalar(
        lambda value: -height(value), bounds=bounds, method="bounded", options={"xatol": 1e-9 * width}
    )
    return float(best.x), height(best.x)
