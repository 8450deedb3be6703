"""An invariant curve of the stroboscopic map P, x(0) -> x(T), and how its equations are solved.

The curve u(theta), theta in [0, 2 pi), is a Fourier series given by its values at an odd number M of
equispaced angles. On a torus P turns it by the angle rho: with R the shift of a series in its angle,

    (R_{-rho} P(u))(theta_j) = u(theta_j),   sum_j (u_j - v_j) . v'_j = 0,

the second a phase condition with the curve v before (Schilder, Osinga & Vogt, SIAM J. Appl. Dyn. Syst.
4 (2005) 459-488; Kuznetsov, Elements of Applied Bifurcation Theory, 7.3).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.checks import one_of
from periodic.orbit.layout import Layout
from periodic.orbit.scheme import Array
from periodic.system import Flowing


@dataclass(frozen=True, eq=False)
class Torus:
    """A quasi-periodic motion of a forced system, by its section once in a period of the excitation.

    Parameters
    ----------
    states : ndarray, shape (M, n)
        Scaled states at tau = 0 and M equispaced angles theta.
    rotation : float
        rho in rad: by how much theta grows in one period.
    parameter : ndarray, shape (p,)
        The system's parameters.
    period : float
        Of the stroboscopic map, in tau.
    layout : Layout
        Names, units and scales.
    residual : float
        Largest residual of the invariance, scaled.
    tail : float
        Largest of the two highest harmonics of the curve, relative to its largest: an estimate of the error.
    """

    states: Array
    rotation: float
    parameter: Array
    period: float
    layout: Layout
    residual: float = np.inf
    tail: float = np.inf

    def __repr__(self) -> str:
        return f"Torus(rotation number {self.rotation_number:.9g}, {len(self.states)} angles)"

    @property
    def rotation_number(self) -> float:
        """Turns of the section in one period, rho / (2 pi), in [0, 1)."""
        return float(self.rotation / (2 * np.pi) % 1.0)

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters in SI units, by name."""
        both = zip(self.layout.parameters, self.parameter, strict=True)
        return {q.name: q.scale * float(value) for q, value in both}

    def section(self, name: str, angles: Array | None = None) -> Array:
        """Return a state around the section at tau = 0.

        Parameters
        ----------
        name : str
            A state; its velocity x' is dx/dt.
        angles : ndarray, optional
            theta in rad; by default the M equispaced ones.

        Returns
        -------
        ndarray
            SI values.

        Raises
        ------
        ValueError
            For a name that is no state.
        """
        known = [q.name for q in self.layout.states]
        one_of("section", name, known)
        column = self.layout.column(name)
        values = self.states if angles is None else self.states_at(np.asarray(angles))
        factor = column.scale * self.layout.omega(self.parameter) ** column.order
        return np.asarray(factor * values[:, column.index])

    def states_at(self, angles: Array) -> Array:
        """Return all scaled states of the section.

        Parameters
        ----------
        angles : ndarray, shape (K,)
            theta in rad.

        Returns
        -------
        ndarray, shape (K, n)
            The states.
        """
        own = 2 * np.pi * np.arange(len(self.states)) / len(self.states)
        return kernel(len(self.states), np.subtract.outer(angles, own))[0] @ self.states


def kernel(count: int, angle: Array) -> tuple[Array, Array]:
    """Return Dirichlet's kernel of `count` angles and its slope."""
    order = np.arange(1, count // 2 + 1)
    turn = np.multiply.outer(angle, order)
    return (1 + 2 * np.cos(turn).sum(axis=-1)) / count, -2 * (np.sin(turn) @ order) / count


@dataclass(frozen=True)
class Invariance:
    """The equations of an invariant curve in its M n states, rho and one free parameter."""

    system: Flowing
    free: int
    tolerance: float

    def linearise(self, torus: Torus) -> tuple[Array, Array]:
        """Return the residual (M n,) and its derivatives (M n, M n + 2). Raises ArithmeticError."""
        count, n = torus.states.shape
        images = np.empty((count, n))
        slopes = np.empty((count, n, n + 1))
        guess = np.asarray(self.system.rest(torus.parameter)[1])
        for j, state in enumerate(torus.states):
            flow = self.system.flow(
                state, guess, torus.parameter, np.array([0.0, torus.period]), (self.free,), self.tolerance
            )
            images[j], slopes[j] = flow.state[-1], flow.state_gradient[-1]
        own = 2 * np.pi * np.arange(count) / count
        back, slope = kernel(count, np.subtract.outer(own - torus.rotation, own))
        residual = (back @ images - torus.states).ravel()
        jacobian = np.empty((count, n, count * n + 2))
        moved = np.einsum("jk,kab->jakb", back, slopes[..., :n])
        jacobian[..., :-2] = moved.reshape(count, n, -1) - np.eye(count * n).reshape(count, n, -1)
        jacobian[..., -2] = -slope @ images
        jacobian[..., -1] = back @ slopes[..., n]
        return residual, jacobian.reshape(count * n, -1)


def phase_row(torus: Torus) -> Array:
    """The derivative of the curve in its angle: what the phase condition holds, over all unknowns."""
    count = len(torus.states)
    own = 2 * np.pi * np.arange(count) / count
    along = kernel(count, np.subtract.outer(own, own))[1] @ torus.states
    return np.append(along.ravel(), [0.0, 0.0])


def unknowns(torus: Torus, free: int) -> Array:
    """Return all unknowns of a torus as one array."""
    return np.concatenate([torus.states.ravel(), [torus.rotation, torus.parameter[free]]])


def moved(torus: Torus, free: int, values: Array) -> Torus:
    """Return the torus of other unknowns."""
    parameter = torus.parameter.copy()
    parameter[free] = values[-1]
    return replace(
        torus,
        states=values[:-2].reshape(torus.states.shape),
        rotation=float(values[-2]),
        parameter=parameter,
        residual=np.inf,
        tail=tail_of(values[:-2].reshape(torus.states.shape)),
    )


def tail_of(states: Array) -> float:
    """The highest two harmonics of a curve, relative to its largest one."""
    size = np.abs(np.fft.rfft(states, axis=0))[1:].max(axis=1)
    return float(size[-2:].max() / size.max())
