"""Points of a machine's branch against DOP853 and accelerations written out by hand.

From a point's state the motion is followed through one period, with its perturbations by central differences;
a Newton step from there says how far the state is from that of the true orbit. Nothing of `symbolic` or
`periodic` is followed: only the point's numbers are read.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from support.drawn.machines.machine import Machine

import periodic as per

Array = NDArray[np.float64]

TIMES = 10.0
"""An error is that many times what is claimed before it is wrong, as an estimate tells its order."""

DIFFERENCES = 1e-6, 1e-7, 1e-8
"""Steps of the differences, in the scale of a state; the smaller ones too where a point seems wrong.

Beside a grazing larger ones go from one pattern of contacts to another, and know multipliers less well.
"""

DIGITS = 1e-3
"""What differences know multipliers to beside kinks; so near to the unit circle stability is not judged."""

FAR = 1e5
"""Growth of perturbations over a period beyond which the integration's own rounding decides."""

BESIDE = 1e-4
"""Least singular value of M - 1, over its largest, below which no orbit at a fixed speed is known: a fold."""

RTOL = 1e-12

KNOWN = 100 * RTOL
"""Relative error of a state up to which an orbit is not told from the integration's own: of a bearing that is
preloaded by micrometres, and moves by 1e-13 m, that is more than what is claimed."""

STEPS = 1000
"""Fewest steps of a period: a contact that is shorter may be passed unseen."""

CLOSER = 16
"""How many times more are taken before a point is said to be wrong."""


@dataclass(frozen=True)
class Verdict:
    """Errors of a point: of its state, in peaks to peak; of its multipliers; whether its stability is so."""

    orbit: float
    multipliers: float
    stability: bool

    def wrong(self, point: per.Point, tol: float) -> str:
        """Say what a point claims that is not so, or nothing."""
        if not self.orbit <= TIMES * max(tol, point.error.orbit):
            return f"orbit {self.orbit:.1e}, claimed {point.error.orbit:.1e}"
        if not self.multipliers <= max(DIGITS, TIMES * point.error.multiplier):
            return f"multipliers {self.multipliers:.1e}, claimed {point.error.multiplier:.1e}"
        return "" if self.stability else f"stable is {point.stable}"


def judged(machine: Machine, scales: Array, point: per.Point, tol: float) -> Verdict:
    """Judge a point, with more steps where it seems wrong. Raises ArithmeticError where rounding decides."""
    found = _compared(machine, scales, point, STEPS, DIFFERENCES[0])
    if not found.wrong(point, tol):
        return found
    closer = [_compared(machine, scales, point, CLOSER * STEPS, apart) for apart in DIFFERENCES]
    return min(closer, key=lambda verdict: verdict.multipliers)


def _compared(machine: Machine, scales: Array, point: per.Point, steps: int, step: float) -> Verdict:
    begin = np.asarray(point.orbit.state(np.zeros(1))[0], dtype=float)
    n = len(begin)
    beside = np.concatenate([np.zeros((n, 1)), step * np.eye(n), -step * np.eye(n)], axis=1)
    ends = _followed(machine, scales, point.parameter, begin[:, None] + beside, steps)
    end, monodromy = ends[:, 0], (ends[:, 1 : n + 1] - ends[:, n + 1 :]) / (2 * step)
    growth = float(np.linalg.norm(monodromy, 2))
    if not growth < FAR:
        raise ArithmeticError(f"perturbations grow by {growth:.1e} in a period")
    closing, gap = np.eye(n) - monodromy, end - begin
    singular = np.linalg.svd(closing, compute_uv=False)
    fold = singular[-1] < BESIDE * singular[0]
    off = gap / max(growth, 1.0) if fold else np.linalg.solve(closing, gap)
    size = max(float(np.ptp(point.orbit.nodes, axis=0).max()), 1e-6)
    true, own = np.linalg.eigvals(monodromy), np.asarray(point.multipliers)
    first, second = np.poly(true), np.poly(own)
    apart = float(np.abs(first - second).max() / np.abs(first).max())
    near = float(np.abs(np.abs(np.concatenate([true, own])) - 1).min()) < max(DIGITS, 10 * apart)
    stable = bool(near or point.stable == bool((np.abs(true) < 1).all()))
    error = max(float(np.abs(off).max()) - KNOWN * float(np.abs(begin).max()), 0.0)
    return Verdict(error / size, apart, stable)


def _followed(machine: Machine, scales: Array, speed: float, begin: Array, steps: int) -> Array:
    """States (n, r) after a period of the phase; coordinates and q' = dq/dtau by turns."""
    assert machine.accelerations is not None
    pace, given = machine.pace * speed, machine.accelerations
    each = scales[:, None]

    def rates(tau: float, flat: Array) -> Array:
        z = flat.reshape(begin.shape)
        found = np.empty_like(z)
        found[::2] = z[1::2]
        found[1::2] = given(tau, each * z[::2], pace * each * z[1::2], speed) / (each * pace**2)
        return found.ravel()

    tight = {"method": "DOP853", "rtol": RTOL, "atol": RTOL, "max_step": 2 * np.pi / steps}
    found = solve_ivp(rates, (0.0, 2 * np.pi), begin.ravel(), **tight)
    if not found.success:
        raise ArithmeticError(found.message)
    return np.asarray(found.y[:, -1].reshape(begin.shape))
