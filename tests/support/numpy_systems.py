"""Hand-written NumPy systems with known orbits: what `periodic` asks of a model, without `symbolic`.

All are oscillators in the phase tau = Omega t, with states x and v = dx/dtau:

    Omega^2 x'' + 2 zeta Omega x' + r(x, tau) = F cos tau
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

Array = NDArray[np.float64]
OMEGA, ZETA, FORCE = 0, 1, 2


@dataclass(frozen=True)
class Quantity:
    """A state, unknown, parameter or output."""

    name: str
    unit: str = ""
    scale: float = 1.0
    value: float = 0.0


@dataclass(frozen=True)
class Switch:
    """A function with a kink in time at its levels."""

    name: str
    direction: int = 0
    levels: tuple[float, ...] = (0.0,)


@dataclass(frozen=True)
class Lines:
    """Residual (N, 2+m) and its derivatives."""

    residual: Array
    d_rate: Array
    d_state: Array
    d_algebraic: Array
    d_phase: Array
    d_parameter: Array


class LinearOscillator:
    """r = x: everything is known in closed form."""

    states = (Quantity("x", "m"), Quantity("v", "m"))
    algebraics: tuple[Quantity, ...] = ()
    outputs = (Quantity("x", "m"), Quantity("force", "N"))
    switches: tuple[Switch, ...] = ()

    def __init__(self, Omega: float = 0.8, zeta: float = 0.05, F: float = 1.0) -> None:
        self.parameters = (
            Quantity("Omega", "rad/s", value=Omega),
            Quantity("zeta", value=zeta),
            Quantity("F", "N", value=F),
        )

    @property
    def nominal(self) -> Array:
        """Parameter values, shape (3,)."""
        return np.array([p.value for p in self.parameters])

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """Return r, dr/dx and dr/dtau."""
        return x, np.ones_like(x), np.zeros_like(x)

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Lines:
        """Rows x' - v and the equation of motion."""
        omega, zeta, force = parameter
        v, acceleration = state[:, 1], rate[:, 1]
        r, r_x, r_tau = self.restoring(state[:, 0], phase)
        zero, one = np.zeros_like(v), np.ones_like(v)
        motion = omega**2 * acceleration + 2 * zeta * omega * v + r - force * np.cos(phase)
        by_omega = 2 * omega * acceleration + 2 * zeta * v
        by_parameter = np.stack([by_omega, 2 * omega * v, -np.cos(phase)], axis=1)[:, list(free)]
        return Lines(
            np.stack([rate[:, 0] - v, motion], axis=1),
            np.array([[[1.0, 0.0], [0.0, omega**2]]]).repeat(len(v), axis=0),
            np.stack([np.stack([zero, -one], 1), np.stack([r_x, 2 * zeta * omega * one], 1)], axis=1),
            np.zeros((len(v), 2, 0)),
            np.stack([zero, r_tau + force * np.sin(phase)], axis=1),
            np.stack([np.zeros_like(by_parameter), by_parameter], axis=1),
        )

    def move(self, algebraic: Array, increment: Array) -> Array:
        """Newton's own step."""
        return algebraic + increment

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """x and the restoring force."""
        return np.stack([state[:, 0], self.restoring(state[:, 0], phase)[0]], axis=1)

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """No switch."""
        return np.zeros((len(phase), 0))

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """No switch."""
        return np.zeros((len(phase), 0, 2)), np.zeros((len(phase), 0)), np.zeros((len(phase), 0, 3))

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """The undeformed spring."""
        return np.zeros(2), np.zeros(len(self.algebraics))

    def exact_state(self, phase: Array) -> Array:
        """The steady response of r = x at the nominal parameters, shape (len(phase), 2)."""
        omega, zeta, force = self.nominal
        turning = force / (1 - omega**2 + 2j * zeta * omega) * np.exp(1j * phase)
        return np.stack([turning.real, (1j * turning).real], axis=1)

    def exact_multipliers(self) -> NDArray[np.complex128]:
        """exp(lambda T), positive imaginary part first."""
        omega, zeta, _ = self.nominal
        pair = -zeta + np.array([1j, -1j]) * np.sqrt(1 - zeta**2)
        return np.exp(2 * np.pi * pair / omega)


class AlgebraicOscillator(LinearOscillator):
    """The linear oscillator with its spring force sinh(z), z given by 0 = sinh(z) - x."""

    algebraics = (Quantity("z"),)

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Lines:
        """The algebraic row comes last."""
        lines = super().linearise(rate, state, algebraic, phase, parameter, free)
        spring, slope = np.sinh(algebraic[:, 0]), np.cosh(algebraic[:, 0])
        d_state = np.concatenate([lines.d_state, np.zeros((len(phase), 1, 2))], axis=1)
        d_state[:, 1, 0], d_state[:, 2, 0] = 0.0, -1.0
        zero = np.zeros_like(slope)
        off = spring - state[:, 0]
        return Lines(
            np.stack([lines.residual[:, 0], lines.residual[:, 1] + off, off], axis=1),
            np.concatenate([lines.d_rate, np.zeros((len(phase), 1, 2))], axis=1),
            d_state,
            np.stack([zero, slope, slope], axis=1)[:, :, None],
            np.column_stack([lines.d_phase, zero]),
            np.concatenate([lines.d_parameter, np.zeros((len(phase), 1, len(free)))], axis=1),
        )

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """x and the spring force as the unknown gives it."""
        return np.column_stack([state[:, 0], np.sinh(algebraic[:, 0])])


class BilinearOscillator(LinearOscillator):
    """r = x for x > 0 and 4 x for x < 0; the switch x marks both passages unless it is left out."""

    def __init__(
        self, Omega: float = 0.8, zeta: float = 0.05, F: float = 1.0, *, declared: bool = True
    ) -> None:
        super().__init__(Omega, zeta, F)
        self.switches = (Switch("x = 0"),) if declared else ()

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """Return r, dr/dx and dr/dtau."""
        stiffness = np.where(x > 0, 1.0, 4.0)
        return stiffness * x, stiffness, np.zeros_like(x)

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """The switch is x itself."""
        return state[:, : len(self.switches)]

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """Derivatives of x in state, phase and parameters."""
        count = len(self.switches)
        by_state = np.zeros((len(phase), count, 2))
        by_state[:, :, 0] = 1.0
        return by_state, np.zeros((len(phase), count)), np.zeros((len(phase), count, 3))


class MeissnerOscillator(LinearOscillator):
    """r = 1.5 x where cos tau > 0, else 0.5 x: the multipliers are those of two matrix exponentials."""

    switches = (Switch("cos tau = 0"),)

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """Return r, dr/dx and dr/dtau (away from the jumps)."""
        stiffness = np.where(np.cos(phase) > 0, 1.5, 0.5)
        return stiffness * x, stiffness, np.zeros_like(x)

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """A function of the phase alone."""
        return np.cos(phase)[:, None]

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """Derivatives of cos tau in state, phase and parameters."""
        return np.zeros((len(phase), 1, 2)), -np.sin(phase)[:, None], np.zeros((len(phase), 1, 3))

    def exact_multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of exp(A2 T/2) exp(A1 T/2), positive imaginary part (or the larger) first."""
        omega, zeta, _ = self.nominal
        halves = [expm(np.pi / omega * np.array([[0.0, 1.0], [-k, -2 * zeta]])) for k in (1.5, 0.5)]
        values = np.linalg.eigvals(halves[1] @ halves[0]).astype(complex)
        return values[np.lexsort([-values.real, -values.imag])]


class BrokenOscillator(LinearOscillator):
    """The linear oscillator whose equations are not numbers beyond a frequency (default: anywhere)."""

    def __init__(self, limit: float = 0.0) -> None:
        super().__init__()
        self.limit = limit

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Lines:
        """Return NaN above the limit."""
        lines = super().linearise(rate, state, algebraic, phase, parameter, free)
        if parameter[OMEGA] > self.limit:
            lines.residual[:] = np.nan
        return lines
