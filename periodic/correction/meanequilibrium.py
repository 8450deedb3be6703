"""The equilibrium under the mean of all loads over a period, about which a system vibrates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.correction.outcome import FAILURES
from periodic.orbit.construction import constant
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearPart, System
from periodic.system.precision import MOST_ITERATIONS

PHASES = np.linspace(0.0, 2 * np.pi, 32, endpoint=False)
"""Phases over which the excitation is averaged."""

BALANCED_RESIDUAL = 1e-9
"""Scaled residual, over the largest of states and unknowns, below which a system is in equilibrium."""

LEAST_LOAD_STEP = 1e-4
"""Smallest part of the load that is added at once."""


def resting(system: System, start: Orbit, part: LinearPart | None = None) -> Orbit | None:
    """Return the constant orbit with mean R(0, x, z, tau, p) = 0 over a period, at the parameters of `start`.

    The load that `start` does not balance at its beginning is added in steps for which Newton's method
    converges: a film, say, has no stiffness where it has no load, and ends at its clearance. None where
    `start` is in equilibrium already, and where the load overflows or cannot be added. `part` is the linear
    part of a split system, whose rows do not contain it.
    """
    point = np.concatenate([start.nodes[0], start.algebraic[0, 0]])
    try:
        with np.errstate(divide="raise", invalid="raise"):  # a mode that nothing holds has no rest
            balance = _Balance.of(system, start.parameter, part)
        missing = balance.rows(point)[0]
        if _balanced(missing, point) or not np.isfinite(missing).all():  # a load that overflows is none
            return None
        found = _loaded(balance, point, missing)
    except FAILURES:
        return None
    n = start.nodes.shape[1]
    if found is None:
        return None
    return constant(start.mesh, found[:n], found[n:], start.parameter, start.layout)


@dataclass(frozen=True)
class _Balance:
    """The mean rows of a system; of its linear part x = S f with S the static flexibility of its modes."""

    system: System
    parameter: Array
    states: NDArray[np.int_]
    forces: NDArray[np.int_]
    flexibility: Array

    @classmethod
    def of(cls, system: System, parameter: Array, part: LinearPart | None) -> _Balance:
        if part is None:
            none = np.empty(0, dtype=int)
            return cls(system, parameter, none, none, np.empty((0, 0)))
        modes = part.modes(parameter)
        flexibility = modes.direct - (modes.outputs @ (modes.inputs / modes.exponents[:, None])).real
        return cls(system, parameter, np.array(part.states), np.array(part.forces), flexibility)

    def rows(self, point: Array) -> tuple[Array, Array]:
        """Return the rows (n + m,) at states and unknowns (n + m,), and their Jacobian."""
        n, many = len(self.system.states), len(PHASES)
        x, z = (np.tile(values, (many, 1)) for values in (point[:n], point[n:]))
        line = self.system.linearise(np.zeros_like(x), x, z, PHASES, self.parameter)
        residual = line.residual.mean(axis=0)
        jacobian = np.concatenate([line.d_state, line.d_algebraic], axis=2).mean(axis=0)
        if len(self.states):
            given = np.concatenate([line.d_rate, line.d_state], axis=2)[:, :n]
            empty = np.flatnonzero(~given.any(axis=(0, 2)))
            if len(empty) > len(self.states):
                raise np.linalg.LinAlgError("a row of an own state is empty, as where its parameter is 0")
            residual[empty] = point[self.states] - self.flexibility @ point[n + self.forces]
            jacobian[empty] = 0.0
            jacobian[empty, self.states] = 1.0
            jacobian[np.ix_(empty, n + self.forces)] = -self.flexibility
        return residual, jacobian


def _loaded(balance: _Balance, point: Array, missing: Array) -> Array | None:
    """Return the point at which all of the load is carried; None where it cannot be added."""
    borne, step = 0.0, 1.0
    while borne < 1.0:
        part = min(1.0, borne + step)
        found = _solved(balance, point, (1.0 - part) * missing)
        if found is not None:
            point, borne, step = found, part, 2 * step
        elif (step := step / 2) < LEAST_LOAD_STEP:
            return None
    return point


def _solved(balance: _Balance, point: Array, load: Array) -> Array | None:
    """Return the point at which the rows are `load`, by Newton's method; None where it does not converge."""
    before = np.inf
    for _ in range(MOST_ITERATIONS):
        residual, jacobian = balance.rows(point)
        residual = residual - load
        size = np.abs(residual).max(initial=0.0)
        if _balanced(residual, point):
            return point
        if not (size < 10 * before and np.isfinite(jacobian).all()):
            return None
        before = size
        point = point - np.linalg.solve(jacobian, residual)
    return None


def _balanced(residual: Array, point: Array) -> bool:
    return bool(
        np.abs(residual).max(initial=0.0) < BALANCED_RESIDUAL * (1.0 + np.abs(point).max(initial=0.0))
    )
