"""Orbits of piecewise linear systems from event to event, in extended precision.

Where `reference.piecewise` follows one period from a state, here the phases of all passages and the states
there are unknowns at once, so that an excursion however short is as well conditioned as a long one. Residuals
are summed in 80 bits by Taylor series of the flow, the Jacobian of Newton's iteration is in double precision.
What comes out is exact to about 1e-17 in the states, and the pattern of passages is then verified on the
whole period.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from reference.integration import Array
from reference.piecewise import Piecewise
from reference.shooting import in_order

Long = NDArray[np.longdouble]

TERMS = 26
"""Terms of the Taylor series, over steps in which the generator's norm is 1."""

CLEAR = 1e-13
"""How far a switch may be past its level where it should not pass it: rounding."""


@dataclass(frozen=True)
class Orbit:
    """Phases of the passages (k,), or where it was begun; states there (k, n); its monodromy matrix."""

    phases: Long
    states: Long
    monodromy: Array
    wrong: float

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        return in_order(np.linalg.eigvals(self.monodromy))


@dataclass(frozen=True)
class Pieces:
    """The pieces of an orbit between passages: which switch passes where each begins, and the sides on it."""

    system: Piecewise
    omega: float
    span: float
    switches: tuple[int, ...]
    sides: NDArray[np.bool_]

    def ends(self, phases: Long) -> Long:
        """Duration of each piece."""
        lengths = np.diff(np.append(phases, phases[0] + np.longdouble(self.span)))
        return lengths / np.longdouble(self.omega)

    def generator(self, piece: int) -> Array:
        """The matrix of (y, 1, cos, sin) on a piece."""
        return self.system.generator(self.omega, self.sides[piece])

    def extended(self, state: Long, phase: np.longdouble) -> Long:
        """(y, 1, cos, sin) at a phase."""
        return np.concatenate([state, [1.0, np.cos(phase), np.sin(phase)]]).astype(np.longdouble)

    def flow(self, piece: int, state: Long, phase: np.longdouble, duration: np.longdouble) -> Long:
        """Where a state leads on a piece."""
        generator = self.generator(piece).astype(np.longdouble)
        natural = np.sqrt(np.abs(np.linalg.eigvals(self.generator(piece))).max())
        steps = int(np.ceil(max(float(duration) * natural**2, 1.0)))
        z, h = self.extended(state, phase), duration / steps
        for _ in range(steps):
            term = z.copy()
            for k in range(1, TERMS):
                term = generator @ term * (h / k)
                z = z + term
        return z[: len(state)]

    def values(self, states: Long) -> Long:
        """Every switch at states (points, n)."""
        return states @ self.system.normals.T.astype(np.longdouble) - self.system.gaps

    def residual(self, phases: Long, states: Long) -> Long:
        """What the pieces miss the next one's begin by, and the switches their levels."""
        durations, following = self.ends(phases), np.roll(states, -1, axis=0)
        missed = [self.flow(i, states[i], phases[i], durations[i]) - following[i] for i in range(len(phases))]
        held = [self.values(states)[i, k] for i, k in enumerate(self.switches)]
        return np.concatenate([*missed, held])

    def jacobian(self, phases: Long, states: Long) -> tuple[Array, list[Array]]:
        """Its derivatives in states and phases, and the fundamental matrix of each piece."""
        k, n = states.shape
        full, matrices = np.zeros((k * n + len(self.switches), k * n + k)), []
        for i, duration in enumerate(self.ends(phases)):
            following, rows = (i + 1) % k, slice(i * n, (i + 1) * n)
            generator = self.generator(i)
            flow = scipy.linalg.expm(generator * float(duration))
            z = self.extended(states[i], phases[i]).astype(float)
            rate, turned = (generator @ flow @ z)[:n] / self.omega, z.copy()
            turned[:n], turned[n], turned[n + 1], turned[n + 2] = 0.0, 0.0, -z[n + 2], z[n + 1]
            matrices.append(flow[:n, :n])
            full[rows, rows] += flow[:n, :n]
            full[rows, following * n : (following + 1) * n] -= np.eye(n)
            if self.switches:
                full[rows, k * n + i] += (flow @ turned)[:n] - rate
                full[rows, k * n + following] += rate
        for i, switch in enumerate(self.switches):
            full[k * n + i, i * n : (i + 1) * n] = self.system.normals[switch]
        return (full if self.switches else full[:, : k * n]), matrices

    def wrong(self, phases: Long, states: Long) -> float:
        """How far a switch is on the wrong side of its level, at the most, on the whole orbit."""
        worst = 0.0
        for i, duration in enumerate(self.ends(phases)):
            generator = self.generator(i)
            fastest = np.abs(np.linalg.eigvals(generator)).max()
            count = int(np.ceil(40 * max(1.0, float(duration) * fastest)))
            step = scipy.linalg.expm(generator * float(duration) / count)
            z = self.extended(states[i], phases[i])
            every = np.empty((count + 1, len(z)))
            every[0] = z
            for j in range(count):
                every[j + 1] = step @ every[j]
            n = states.shape[1]
            sign = np.where(self.sides[i], 1.0, -1.0)
            value = sign * (every[:, :n] @ self.system.normals.T - self.system.gaps)
            slope = sign * ((every @ generator.T)[:, :n] @ self.system.normals.T) * float(duration) / count
            inner = (slope[:-1] < 0) & (slope[1:] > 0)
            turn = np.where(inner, slope[:-1] / np.where(inner, slope[:-1] - slope[1:], 1.0), 0.0)
            lowest = value[:-1] + turn * slope[:-1] / 2
            worst = max(worst, -min(value.min(), np.where(inner, lowest, 0.0).min()))
        return worst


def exact(
    system: Piecewise, omega: float, phases: Array, states: Array, switches: tuple[int, ...], span: float
) -> Orbit:
    """Solve for the orbit near passages of given switches, or without any near a state at one phase."""
    phi, y = np.asarray(phases, dtype=np.longdouble), np.asarray(states, dtype=np.longdouble)
    middle, n = _sides(system, omega, phi, y, switches, span), y.shape[1]
    pieces = Pieces(system, omega, span, switches, middle)
    least = np.inf
    for _ in range(30):
        residual = pieces.residual(phi, y)
        jacobian, matrices = pieces.jacobian(phi, y)
        step = np.linalg.solve(jacobian, -residual.astype(float))
        size = float(np.abs(step).max())
        if size < 1e-12 and (size == 0.0 or size > least / 4):
            monodromy = np.eye(n)
            for matrix in matrices:
                monodromy = matrix @ monodromy
            return Orbit(phi, y, monodromy, pieces.wrong(phi, y))
        least = min(least, size)
        y = y + step[: y.size].reshape(y.shape)
        if switches:
            phi = phi + step[y.size :]
    raise ArithmeticError(f"the orbit between events did not converge, last step {size:.1e}")


def _sides(
    system: Piecewise, omega: float, phases: Long, states: Long, switches: tuple[int, ...], span: float
) -> NDArray[np.bool_]:
    """Sides on each piece: of the switch that passes where it begins by its rate there, else by value."""
    value = (states.astype(float) @ system.normals.T - system.gaps) > 0
    n = states.shape[1]
    for i, switch in enumerate(switches):
        value[i, switch] = False  # on the level the force of a stop is 0
        phase = float(phases[i])
        z = np.concatenate([states[i].astype(float), [1.0, np.cos(phase), np.sin(phase)]])
        value[i, switch] = system.normals[switch] @ (system.generator(omega, value[i]) @ z)[:n] > 0
    return value
