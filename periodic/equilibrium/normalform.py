"""The normal form of a Hopf point: whether the orbits that are born there are stable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from periodic.equilibrium.linearise import Rows, rows_at
from periodic.orbit.construction import as_read_by
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, index_of
from periodic.system.precision import CONVERGED, MOST_ITERATIONS, difference_step

Complex = NDArray[np.complex128]

DIFFERENCE_STEP = difference_step(order=4, derivative=2)
"""Length of the differences (scaled states), which are of fourth order."""


def first_lyapunov(system: System, orbit: Orbit, frequency: str = "omega") -> float:
    """Return the first Lyapunov coefficient l1 of a Hopf point, of states as scaled in the system.

    With A = J(x0), A q = i omega q, A^T p = -i omega p, <q, q> = <p, q> = 1, and the second and third
    derivatives B, C of dx/dt = f(x),

        2 omega l1 = Re <p, C(q, q, q*) - 2 B(q, A^-1 B(q, q*)) + B(q*, (2 i omega - A)^-1 B(q, q))>.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The equilibrium at the Hopf point.
    frequency : str
        Name of the parameter omega with d/dt = omega d/dtau.

    Returns
    -------
    float
        l1 in 1/s. Negative: stable orbits on the side where the equilibrium is unstable (supercritical);
        positive: unstable orbits on the side where it is stable (subcritical).

    Raises
    ------
    ValueError
        For an orbit that is no equilibrium.
    numpy.linalg.LinAlgError
        Where the rates of motion are not determined.

    References
    ----------
    Kuznetsov, Elements of Applied Bifurcation Theory, eq. 5.62.
    """
    if not orbit.equilibrium:
        raise ValueError("orbit is no equilibrium; it must be one, of a branch by method=Equilibrium()")
    orbit = as_read_by(system, orbit)
    omega = float(orbit.parameter[index_of(system, frequency)])

    def jacobian(shift: Array) -> Array:
        return omega * _moving(system, orbit, shift).jacobian

    A = jacobian(np.zeros(orbit.nodes.shape[1]))
    speed, q = _eigenvector(A)
    p = _eigenvector(A.T)[1].conj()
    p = p / np.vdot(p, q).conj()
    real, imaginary = q.real, q.imag

    first = _slope(jacobian, real) + 1j * _slope(jacobian, imaginary)
    mixed = _bend(jacobian, real + imaginary) - _bend(jacobian, real - imaginary)
    second = _bend(jacobian, real) - _bend(jacobian, imaginary) + 0.5j * mixed
    still = np.linalg.solve(A, first @ q.conj())
    twice = np.linalg.solve(2j * speed * np.eye(len(A)) - A, first @ q)
    # B is symmetric: B(q, v) is the slope of J along q, times v.
    total = second @ q.conj() - 2 * first @ still + first.conj() @ twice
    return float(np.vdot(p, total).real / (2 * speed))


def _eigenvector(matrix: Array) -> tuple[float, Complex]:
    """Frequency and eigenvector of the pair nearest the imaginary axis, its positive member."""
    values, vectors = np.linalg.eig(matrix)
    off = np.where(values.imag > 0, np.abs(values.real / np.maximum(np.abs(values), 1e-300)), np.inf)
    return float(values[off.argmin()].imag), vectors[:, off.argmin()].astype(np.complex128)


def _slope(function: Callable[[Array], Array], along: Array) -> Array:
    """First derivative along a vector."""
    a, b, c, d = (function(k * DIFFERENCE_STEP * along) for k in (-2, -1, 1, 2))
    return (a - 8 * b + 8 * c - d) / (12 * DIFFERENCE_STEP)


def _bend(function: Callable[[Array], Array], along: Array) -> Array:
    """Second derivative along a vector."""
    a, b, c, d, e = (function(k * DIFFERENCE_STEP * along) for k in (-2, -1, 0, 1, 2))
    return (-a + 16 * b - 30 * c + 16 * d - e) / (12 * DIFFERENCE_STEP**2)


def _moving(system: System, orbit: Orbit, shift: Array) -> Rows:
    """The equations beside an equilibrium, linearised about the rates and unknowns that they give there."""
    n = orbit.nodes.shape[1]
    beside, rate = replace(orbit, nodes=orbit.nodes + shift), np.zeros(n)
    for _ in range(MOST_ITERATIONS):
        rows = rows_at(system, beside, (), rate)
        change = np.linalg.solve(rows.d_motion, -rows.residual)
        rate, beside = rate + change[:n], replace(beside, algebraic=beside.algebraic + change[n:])
        if np.abs(change).max() < CONVERGED * (1 + np.abs(rate).max()):
            break
    return rows_at(system, beside, (), rate)
