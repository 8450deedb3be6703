"""Single shooting with SciPy's DOP853 for x'' = a(tau, x, x'): it shares nothing with `periodic`.

Where a has a kink at the zero of a switch s(tau, x), each piece is integrated to the zero and the next one
started there, on the other side; perturbations are carried along (a is continuous: no jump in them).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import OdeSolution, solve_ivp

Array = NDArray[np.float64]
TWO_PI = 2 * math.pi
Sided = Callable[[float, float, float, float], float]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """acceleration, by_x, by_v: a and its derivatives at (tau, x, v, side), side = sign of the switch."""

    acceleration: Sided
    by_x: Sided
    by_v: Sided
    switch: Callable[[float, float], float] | None = None


@dataclass(frozen=True)
class Period:
    """One period: its pieces, where they begin, the monodromy matrix."""

    start: Array
    end: Array
    monodromy: Array
    breaks: list[float]
    pieces: list[OdeSolution]

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first, then by imaginary part."""
        return in_order(np.linalg.eigvals(self.monodromy))

    @property
    def kinks(self) -> list[float]:
        """Phases at which the switch passes zero."""
        return self.breaks[1:-1]

    def state(self, tau: Array) -> Array:
        """x and v at phases from 0 to 2 pi, shape (len(tau), 2)."""
        index = np.clip(np.searchsorted(self.breaks, tau, side="right") - 1, 0, len(self.pieces) - 1)
        return np.array([self.pieces[i](t)[:2] for i, t in zip(index, tau, strict=True)])


def in_order(multipliers: Array) -> NDArray[np.complex128]:
    """Sort multipliers by falling modulus, conjugates by falling imaginary part."""
    values = np.asarray(multipliers, dtype=np.complex128)
    return values[np.lexsort([-values.imag, -np.round(np.abs(values), 9)])]


def one_period(problem: Problem, start: Array, rtol: float = 1e-12) -> Period:
    """Integrate x, v and two perturbations from tau = 0 to 2 pi."""
    tau, y = 0.0, np.concatenate([start, np.eye(2).ravel()])
    side = 1.0
    if problem.switch is not None:
        side = math.copysign(1.0, problem.switch(tau, start[0]))
    breaks, pieces = [tau], []
    while tau < TWO_PI:
        tau, y, dense, hit = _piece(problem, tau, y, side, rtol)
        breaks.append(tau)
        pieces.append(dense)
        side = -side if hit else side
    return Period(start, y[:2], y[2:].reshape(2, 2), breaks, pieces)


def _piece(
    problem: Problem, tau: float, y: Array, side: float, rtol: float
) -> tuple[float, Array, OdeSolution, bool]:
    def rhs(t: float, z: Array) -> Array:
        x, v = z[:2]
        stiffness, damping = problem.by_x(t, x, v, side), problem.by_v(t, x, v, side)
        motion = np.array([v, problem.acceleration(t, x, v, side)])
        return np.concatenate([motion, z[4:], stiffness * z[2:4] + damping * z[4:]])

    def event(t: float, z: Array) -> float:
        assert problem.switch is not None
        return problem.switch(t, z[0])

    event.terminal, event.direction = True, -side  # type: ignore[attr-defined]
    events = None if problem.switch is None else event
    solution = solve_ivp(
        rhs, (tau, TWO_PI), y, method="DOP853", rtol=rtol, atol=rtol, events=events, dense_output=True
    )
    assert solution.success, solution.message
    return float(solution.t[-1]), solution.y[:, -1], solution.sol, solution.status == 1


def periodic_orbit(problem: Problem, guess: Array, rtol: float = 1e-12) -> Period:
    """Newton on end - start = 0 from a guess of x and v at tau = 0."""
    state = np.array(guess, dtype=float)
    for _ in range(20):
        period = one_period(problem, state, rtol)
        gap = period.end - period.start
        if np.abs(gap).max() < 100 * rtol:
            return period
        state = state + np.linalg.solve(np.eye(2) - period.monodromy, gap)
    raise ArithmeticError("shooting did not converge")
