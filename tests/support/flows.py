"""Autonomous systems omega x' = f(x, p) in NumPy with derivatives by the complex step, and their starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from reference.integration import limit_cycle, over_period

import periodic as per
from support.numpy_systems import Array, Lines, Quantity

STEP = 1e-200
AUTONOMOUS = {"omega": per.PhaseCondition()}
Field = Callable[[NDArray, NDArray], NDArray]


@dataclass(frozen=True)
class Autonomous:
    """f(x (n, N), p) -> (n, N); the parameters are omega, then those of f."""

    field: Field
    order: int
    names: tuple[str, ...]
    values: tuple[float, ...]
    algebraics = ()
    switches = ()

    @property
    def states(self) -> tuple[Quantity, ...]:
        """x1 to xn."""
        return tuple(Quantity(f"x{k + 1}") for k in range(self.order))

    outputs = states

    @property
    def parameters(self) -> tuple[Quantity, ...]:
        """omega and those of the field."""
        named = zip(("omega", *self.names), self.nominal, strict=True)
        return tuple(Quantity(name, value=value) for name, value in named)

    @property
    def nominal(self) -> Array:
        """omega = 1 and the field's values."""
        return np.array([1.0, *self.values])

    def linearise(
        self,
        rate: Array,
        state: Array,
        algebraic: Array,
        phase: Array,
        parameter: Array,
        free: tuple[int, ...] = (),
    ) -> Lines:
        """Residual omega x' - f and its derivatives."""
        count, n = state.shape
        omega, p = parameter[0], parameter[1:]
        residual = omega * rate - self.field(state.T, p).T
        steps = [state + 1j * STEP * row for row in np.eye(n)]
        d_state = -np.stack([self.field(x.T, p).T.imag / STEP for x in steps], axis=2)
        d_parameter = np.zeros((count, n, len(free)))
        for column, k in enumerate(free):
            if k == 0:
                d_parameter[:, :, column] = rate
            else:
                moved = p + 1j * STEP * (np.arange(1, len(p) + 1) == k)
                d_parameter[:, :, column] = -self.field(state.T.astype(complex), moved).T.imag / STEP
        d_rate = np.tile(omega * np.eye(n), (count, 1, 1))
        return Lines(residual, d_rate, d_state, np.zeros((count, n, 0)), np.zeros((count, n)), d_parameter)

    def move(self, algebraic: Array, increment: Array) -> Array:
        """Nothing to move."""
        return algebraic + increment

    def output(self, rate: Array, state: Array, algebraic: Array, phase: Array, parameter: Array) -> Array:
        """The states."""
        return state

    def switch(self, state: Array, phase: Array, parameter: Array) -> Array:
        """None."""
        return np.zeros((len(phase), 0))

    def switch_gradient(self, state: Array, phase: Array, parameter: Array) -> tuple[Array, Array, Array]:
        """None."""
        count, n = state.shape
        return np.zeros((count, 0, n)), np.zeros((count, 0)), np.zeros((count, 0, len(parameter)))

    def rest(self, parameter: Array) -> tuple[Array, Array]:
        """The origin."""
        return np.zeros(self.order), np.zeros(0)

    def simulated(self, start: list[float], until: float, crossing: int, turns: int = 1) -> per.Orbit:
        """Return the orbit after `until`, from a rising passage of a state through its mean to a later."""
        p = np.array(self.values)

        def rhs(t: float, x: Array) -> Array:
            return self.field(x, p)

        begin, period = limit_cycle(rhs, start, until, crossing, turns=turns)
        phase, state = over_period(rhs, begin, period)
        parameter = np.array([2 * np.pi / period, *self.values])
        return per.sampled(phase, state, np.zeros((len(phase), 0)), parameter)


def van_der_pol(mu: float) -> Autonomous:
    """x'' - mu (1 - x^2) x' + x = 0."""
    return Autonomous(lambda x, p: np.array([x[1], p[0] * (1 - x[0] ** 2) * x[1] - x[0]]), 2, ("mu",), (mu,))


def feedback(alpha: float) -> Autonomous:
    """x''' = -alpha x'' - x' - x + x^2."""

    def field(x: NDArray, p: NDArray) -> NDArray:
        return np.array([x[1], x[2], -p[0] * x[2] - x[1] - x[0] + x[0] ** 2])

    return Autonomous(field, 3, ("alpha",), (alpha,))


def lorenz(rho: float) -> Autonomous:
    """Lorenz's equations, sigma = 10, b = 8/3, lengths divided by 100."""

    def field(x: NDArray, p: NDArray) -> NDArray:
        return np.array(
            [10 * (x[1] - x[0]), x[0] * (p[0] - 100 * x[2]) - x[1], 100 * x[0] * x[1] - 8 / 3 * x[2]]
        )

    return Autonomous(field, 3, ("rho",), (rho,))


def stuart_landau(mu: float) -> Autonomous:
    """z' = (mu + i) z - |z|^2 z: the orbit |z| = sqrt(mu), period 2 pi, multiplier exp(-4 pi mu)."""

    def field(x: NDArray, p: NDArray) -> NDArray:
        square = x[0] ** 2 + x[1] ** 2
        return np.array([(p[0] - square) * x[0] - x[1], (p[0] - square) * x[1] + x[0]])

    return Autonomous(field, 2, ("mu",), (mu,))


def period(point: per.Point) -> float:
    """T of an orbit."""
    return point.orbit.periods * 2 * np.pi / point.orbit.parameter[0]
