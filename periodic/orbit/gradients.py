"""Gradients at points along an orbit, gathered into a gradient in the orbit's own numbers.

A point lies at theta in interval j, tau = left_j + theta width_j; states and rates there are linear in the
orbit's numbers (`Orbit.spread`), and z follows from the algebraic rows. Event nodes move tau and stretch the
intervals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system import GradientLike, LinearisationLike, System


@dataclass(frozen=True)
class Points:
    """K points of an orbit, and what the equations take there.

    Parameters
    ----------
    index, theta : ndarray, shape (K,)
        Interval, and place in it.
    phase : ndarray, shape (K,)
        tau in rad.
    rate, state : ndarray, shape (K, n)
        dx/dtau and x, scaled.
    algebraic : ndarray, shape (K, m)
        Unknowns z, scaled.
    """

    index: NDArray[np.int_]
    theta: Array
    phase: Array
    rate: Array
    state: Array
    algebraic: Array

    def arguments(self, orbit: Orbit) -> tuple[Array, Array, Array, Array, Array]:
        """Return what the equations take.

        Parameters
        ----------
        orbit : Orbit
            The orbit that the points are of.

        Returns
        -------
        tuple of ndarray
            (x', x, z, tau, p).
        """
        return self.rate, self.state, self.algebraic, self.phase, orbit.parameter


@dataclass(frozen=True)
class Slopes:
    """Derivatives of a sum over K points.

    Parameters
    ----------
    rate, state : ndarray, shape (K, n)
        In dx/dtau and x at each point.
    algebraic : ndarray, shape (K, m)
        In z.
    phase : ndarray, shape (K,)
        In tau.
    parameter : ndarray, shape (q,)
        In the free parameters.
    """

    rate: Array
    state: Array
    algebraic: Array
    phase: Array
    parameter: Array

    @staticmethod
    def of(gradient: GradientLike, free: tuple[int, ...]) -> Slopes:
        """Return the slopes of a sum whose gradient at each point is given.

        Parameters
        ----------
        gradient : GradientLike
            The gradient at K points.
        free : tuple of int
            Indices of the free parameters.

        Returns
        -------
        Slopes
            The sum's derivatives.
        """
        parameter = gradient.parameter.sum(axis=0)[list(free)]
        return Slopes(gradient.rate, gradient.state, gradient.algebraic, gradient.phase, parameter)


def collocation_points(orbit: Orbit) -> Points:
    """Return the collocation points of an orbit, interval by interval.

    Parameters
    ----------
    orbit : Orbit
        The orbit.

    Returns
    -------
    Points
        N ncol of them.
    """
    count, ncol, n = orbit.stages.shape
    return Points(
        np.repeat(np.arange(count), ncol),
        np.tile(orbit.mesh.scheme.points, count),
        orbit.stage_phases.ravel(),
        orbit.knot_rates[:, 1:].reshape(-1, n),
        orbit.stages.reshape(-1, n),
        orbit.algebraic.reshape(count * ncol, orbit.algebraic.shape[2]),
    )


def gathered(system: System, orbit: Orbit, points: Points, slopes: Slopes, free: tuple[int, ...]) -> Row:
    """Return the gradient of a sum over points in the orbit's own numbers.

    Parameters
    ----------
    system : System
        The system, whose algebraic rows determine z.
    orbit : Orbit
        The orbit.
    points : Points
        Its points.
    slopes : Slopes
        Derivatives of the sum there.
    free : tuple of int
        Indices of the free parameters.

    Returns
    -------
    Row
        The gradient; its value is 0, or what the algebraic rows still leave.

    Raises
    ------
    numpy.linalg.LinAlgError
        Where the algebraic rows do not determine z.
    """
    value, slopes = _without_algebraic(system, orbit, points, slopes, free)
    nodes, stages = orbit.spread(points.index, points.theta, slopes.state, slopes.rate)
    left, stretch = orbit.grid.left_gradient[points.index], orbit.grid.width_gradient[points.index]
    moved = slopes.phase @ (left + points.theta[:, None] * stretch)
    width = orbit.grid.width[points.index]
    shorter = (np.einsum("pn,pn->p", slopes.rate, points.rate) / width) @ stretch
    return Row(value, nodes, np.append(moved - shorter, slopes.parameter), stages)


def _without_algebraic(
    system: System, orbit: Orbit, points: Points, slopes: Slopes, free: tuple[int, ...]
) -> tuple[float, Slopes]:
    """Eliminate z through the algebraic rows: dz = -R_z^-1 (R + R_x' dx' + R_x dx + R_tau dtau + R_p dp)."""
    if slopes.algebraic.shape[1] == 0:
        return 0.0, slopes
    n = slopes.state.shape[1]
    line = system.linearise(*points.arguments(orbit), free)
    left = -solved(line, slopes.algebraic)
    return float((left * line.residual[:, n:]).sum()), Slopes(
        slopes.rate + np.einsum("pm,pmn->pn", left, line.d_rate[:, n:]),
        slopes.state + np.einsum("pm,pmn->pn", left, line.d_state[:, n:]),
        np.zeros_like(slopes.algebraic),
        slopes.phase + np.einsum("pm,pm->p", left, line.d_phase[:, n:]),
        slopes.parameter + np.einsum("pm,pmq->q", left, line.d_parameter[:, n:]),
    )


def solved(line: LinearisationLike, right: Array) -> Array:
    """Solve with the transposed derivative of the algebraic rows in z, g_z' w = r.

    Parameters
    ----------
    line : LinearisationLike
        The equations linearised at K points.
    right : ndarray, shape (K, m)
        One right-hand side r a point.

    Returns
    -------
    ndarray, shape (K, m)
        w.
    """
    n = line.d_state.shape[2]
    transposed = np.swapaxes(line.d_algebraic[:, n:], 1, 2)
    return np.linalg.solve(transposed, right[:, :, None])[..., 0].astype(float, copy=False)
