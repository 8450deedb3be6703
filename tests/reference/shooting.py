"""Single shooting with SciPy's DOP853: it shares nothing with `periodic`.

With the map over a span T and its variational equations,

    y' = f(t, y),    Y' = f_y(t, y) Y,    Y(0) = I,    M = Y(T),

an orbit is a zero of y(T) - y(0), found by Newton's method with M - I; its multipliers are M's eigenvalues.
Where f has a kink at the zero of a switch s(t, y), each piece is integrated to the zero and the next one
started there, on the other side; perturbations are carried along (f is continuous: no jump in them).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import OdeSolution, solve_ivp

from reference.integration import TWO_PI, Array

Sided = Callable[[float, float, float, float], float]


@dataclass(frozen=True, kw_only=True)
class Field:
    """f (n,) and its Jacobian f_y (n, n) at (t, y, side), side = sign of the switch (1 without one)."""

    rates: Callable[[float, Array, float], ArrayLike]
    jacobian: Callable[[float, Array, float], ArrayLike]
    switch: Callable[[float, Array], float] | None = None


@dataclass(frozen=True)
class Motion:
    """A motion over a span: its pieces, where they begin, and the matrix M of its perturbations."""

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
        """Times at which the switch passes zero."""
        return self.breaks[1:-1]

    def state(self, t: Array) -> Array:
        """y at times within the span, shape (len(t), n)."""
        n, last = self.start.size, len(self.pieces) - 1
        index = np.clip(np.searchsorted(self.breaks, t, side="right") - 1, 0, last)
        return np.array([self.pieces[i](at)[:n] for i, at in zip(index, t, strict=True)])


def in_order(multipliers: ArrayLike) -> NDArray[np.complex128]:
    """Sort multipliers by falling modulus, conjugates by falling imaginary part."""
    values = np.asarray(multipliers, dtype=np.complex128)
    return values[np.lexsort([-values.imag, -np.round(np.abs(values), 9)])]


def oscillator(
    *, acceleration: Sided, by_x: Sided, by_v: Sided, switch: Callable[[float, float], float] | None = None
) -> Field:
    """The field of x'' = a(t, x, v, side), y = (x, v), from a and its derivatives; the switch is s(t, x)."""
    return Field(
        rates=lambda t, y, side: [y[1], acceleration(t, y[0], y[1], side)],
        jacobian=lambda t, y, side: [[0.0, 1.0], [by_x(t, y[0], y[1], side), by_v(t, y[0], y[1], side)]],
        switch=None if switch is None else lambda t, y: switch(t, y[0]),
    )


def motion(field: Field, start: ArrayLike, span: float = TWO_PI, rtol: float = 1e-12) -> Motion:
    """Integrate y and its n perturbations from 0 to the span."""
    begin = np.array(start, dtype=float)
    n, t, y = begin.size, 0.0, np.concatenate([begin, np.eye(begin.size).ravel()])
    side = 1.0 if field.switch is None else math.copysign(1.0, field.switch(0.0, begin))
    breaks, pieces = [t], []
    while t < span:
        t, y, dense, hit = _piece(field, (t, span), y, n, side, rtol)
        breaks.append(t)
        pieces.append(dense)
        side = -side if hit else side
    return Motion(begin, y[:n], y[n:].reshape(n, n), breaks, pieces)


def _piece(
    field: Field, span: tuple[float, float], y: Array, n: int, side: float, rtol: float
) -> tuple[float, Array, OdeSolution, bool]:
    def rates(t: float, z: Array) -> Array:
        matrix = np.asarray(field.jacobian(t, z[:n], side)) @ z[n:].reshape(n, n)
        return np.concatenate([field.rates(t, z[:n], side), matrix.ravel()])

    def event(t: float, z: Array) -> float:
        assert field.switch is not None
        return field.switch(t, z[:n])

    event.terminal, event.direction = True, -side  # type: ignore[attr-defined]
    tight = {"method": "DOP853", "rtol": rtol, "atol": rtol, "dense_output": True}
    found = solve_ivp(rates, span, y, events=None if field.switch is None else event, **tight)
    assert found.success, found.message
    return float(found.t[-1]), found.y[:, -1], found.sol, found.status == 1


def periodic_orbit(field: Field, guess: ArrayLike, span: float = TWO_PI, rtol: float = 1e-12) -> Motion:
    """Newton on y(T) - y(0) = 0 from a guess of y(0)."""
    state = np.array(guess, dtype=float)
    for _ in range(20):
        found = motion(field, state, span, rtol)
        gap = found.end - found.start
        if np.abs(gap).max() < 100 * rtol:
            return found
        state = state + np.linalg.solve(np.eye(state.size) - found.monodromy, gap)
    raise ArithmeticError("shooting did not converge")
