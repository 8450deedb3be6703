"""Event-exact single shooting of systems with kinks, jumps and impacts: it shares nothing with `periodic`.

Between events y' = f(t, y) of the mode, the signs of all switches s(t, y). At a zero of a switch its sign
changes, or the state is reset, y+ = r(t, y-); perturbations Y change by the saltation matrix

    S = r_y + (f+ - r_y f- - r_t) s_y / (s_t + s_y f-)

(di Bernardo et al., Piecewise-smooth Dynamical Systems, 2.5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from reference.integration import TWO_PI, Array
from reference.shooting import Motion

Signs = tuple[float, ...]

APART = 1e-7
"""Time after an event within which the same switch is not looked at again."""


@dataclass(frozen=True)
class Surface:
    """A switch s(t, y) with its derivatives (s_t, s_y), and r with (r_t, r_y) where the state is reset."""

    value: Callable[[float, Array], float]
    gradient: Callable[[float, Array], tuple[float, Array]]
    reset: Callable[[float, Array], tuple[Array, Array, Array]] | None = None


@dataclass(frozen=True)
class Hybrid:
    """f (n,) and f_y (n, n) at (t, y, signs), and the surfaces."""

    rates: Callable[[float, Array, Signs], ArrayLike]
    jacobian: Callable[[float, Array, Signs], ArrayLike]
    surfaces: Sequence[Surface]


def motion(system: Hybrid, start: ArrayLike, span: float = TWO_PI, rtol: float = 1e-13) -> Motion:
    """Integrate y and its n perturbations from 0 to the span, each piece to its event."""
    begin = np.array(start, dtype=float)
    n, t, y = begin.size, 0.0, np.concatenate([begin, np.eye(begin.size).ravel()])
    signs = tuple(1.0 if s.value(0.0, begin) > 0 else -1.0 for s in system.surfaces)
    breaks, pieces, last = [t], [], -1
    while t < span:
        found = _piece(system, (t, span), y, n, signs, last, rtol)
        t, y = float(found.t[-1]), found.y[:, -1]
        breaks.append(t)
        pieces.append(found.sol)
        if found.status == 1:
            last = next(k for k, times in enumerate(found.t_events) if len(times))
            signs, y = _passed(system, last, t, y, n, signs)
    return Motion(begin, y[:n], y[n:].reshape(n, n), breaks, pieces)


def _piece(system: Hybrid, span: tuple[float, float], y: Array, n: int, signs: Signs, last: int, rtol: float):
    def rates(t: float, z: Array) -> Array:
        matrix = np.asarray(system.jacobian(t, z[:n], signs)) @ z[n:].reshape(n, n)
        return np.concatenate([system.rates(t, z[:n], signs), matrix.ravel()])

    def event(k: int):
        def value(t: float, z: Array) -> float:
            # The surface just left: away from it, whatever rounding says.
            near = k == last and t - span[0] < APART
            return signs[k] if near else system.surfaces[k].value(t, z[:n])

        value.terminal, value.direction = True, -signs[k]  # type: ignore[attr-defined]
        return value

    events = [event(k) for k in range(len(system.surfaces))]
    tight = {"method": "DOP853", "rtol": rtol, "atol": rtol, "dense_output": True, "max_step": 0.2}
    found = solve_ivp(rates, span, y, events=events, **tight)
    assert found.success, found.message
    return found


def _passed(system: Hybrid, k: int, t: float, z: Array, n: int, signs: Signs) -> tuple[Signs, Array]:
    """The signs, and the state with its perturbations, after an event."""
    surface, y, perturbed = system.surfaces[k], z[:n], z[n:].reshape(n, n)
    before = np.asarray(system.rates(t, y, signs))
    if surface.reset is None:
        signs = tuple(-s if i == k else s for i, s in enumerate(signs))
        after, by_t, by_y = y, np.zeros(n), np.eye(n)
    else:
        after, by_t, by_y = surface.reset(t, y)
    s_t, s_y = surface.gradient(t, y)
    jump = np.asarray(system.rates(t, after, signs)) - by_y @ before - by_t
    saltation = by_y + np.outer(jump, s_y) / (s_t + s_y @ before)
    return signs, np.concatenate([after, (saltation @ perturbed).ravel()])


def periodic_orbit(system: Hybrid, guess: ArrayLike, span: float = TWO_PI, rtol: float = 1e-13) -> Motion:
    """Newton on y(T) - y(0) = 0 from a guess of y(0)."""
    state = np.array(guess, dtype=float)
    for _ in range(20):
        found = motion(system, state, span, rtol)
        gap = found.end - found.start
        if np.abs(gap).max() < 100 * rtol:
            return found
        state = state + np.linalg.solve(np.eye(state.size) - found.monodromy, gap)
    raise ArithmeticError("shooting did not converge")
