"""The normal form of a period doubling: whether the doubled orbits that begin there are stable."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.collocation.elimination import eliminated
from periodic.condensed.condensedcollocation import mesh_method
from periodic.conditions.adjoint import polynomial
from periodic.correction.newton import moved_unknowns
from periodic.linear.bordering import chain
from periodic.linear.unknowns import mean_weights
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.system import System
from periodic.system.precision import CONVERGED, MOST_ITERATIONS

MONODROMY_STEP = 3e-3
"""Length of the differences, which are of fourth order, as a part of the motion q."""


def flip_coefficient(system: System, orbit: Orbit) -> float:
    """Return the cubic coefficient of the period map P on the centre manifold of a period doubling.

    With A = P'(x_0), A q = -q, A^T p = -p, p q = 1, and the second and third derivatives B, C of P,

        c = p (C(q, q, q) + 3 B(q, (I - A)^-1 B(q, q))) / 6;   xi -> -xi + c xi^3.

    The derivatives are differences of monodromy matrices of motions that begin beside the orbit, by the
    orbit's own collocation. The root mean square
    of q over the period, on the mesh points, is the orbit's largest peak to peak (scaled states).

    Parameters
    ----------
    system : System
        The equations of a forced system: the map of an autonomous one is that of a section.
    orbit : Orbit
        The orbit at the doubling, a piecewise polynomial without event nodes.

    Returns
    -------
    float
        c. Positive: stable doubled orbits on the side where the orbit is unstable (supercritical); negative:
        unstable ones on the other side (subcritical).

    Raises
    ------
    ValueError
        For a Fourier series, an orbit with event nodes and a system that is condensed.
    FloatingPointError, numpy.linalg.LinAlgError
        Where a motion beside the orbit is not found, and where -1 is no simple multiplier.

    References
    ----------
    Kuznetsov, Elements of Applied Bifurcation Theory, eq. 5.48.
    """
    polynomial(orbit)
    if len(orbit.phases) or not mesh_method(system).all_states:
        raise ValueError("orbit has event nodes, or its system is condensed; it must be a smooth one")
    fundamental = chain(eliminated(system, orbit, ()))[:, :, 1:]
    A = fundamental[-1]
    q, p = _critical(A), _critical(A.T)
    size = orbit.span() if orbit.span() > LEAST_SPAN else 1.0
    motion = np.einsum("j,jn->", mean_weights(orbit), (fundamental @ q) ** 2)
    q = q * size / np.sqrt(motion)
    if abs(p @ q) < CONVERGED * np.linalg.norm(p) * np.linalg.norm(q):
        raise FloatingPointError("the multiplier -1 is no simple one")
    p = p / (p @ q)
    beside = {k: monodromy(system, orbit, k * MONODROMY_STEP * q) for k in (-2, -1, 1, 2)} | {0: A}
    first = (beside[-2] - 8 * beside[-1] + 8 * beside[1] - beside[2]) / (12 * MONODROMY_STEP)
    second = (-beside[-2] + 16 * beside[-1] - 30 * A + 16 * beside[1] - beside[2]) / (12 * MONODROMY_STEP**2)
    still = np.linalg.solve(np.eye(len(A)) - A, first @ q)
    return float(p @ (second @ q + 3 * first @ still)) / 6


def _critical(matrix: Array) -> Array:
    """The real eigenvector of the eigenvalue nearest to -1."""
    values, vectors = np.linalg.eig(matrix)
    found = vectors[:, np.abs(values + 1).argmin()]
    return np.asarray(found.real)


def monodromy(system: System, orbit: Orbit, shift: Array) -> Array:
    """Return the derivative (n, n) of the period map at a distance (n,) from where an orbit begins.

    Raises FloatingPointError where Newton's iteration does not find the motion on the orbit's mesh.
    """
    still, change = np.zeros(0), np.append(1.0, shift)
    allowed = CONVERGED * max(orbit.span(), 1.0)
    for _ in range(MOST_ITERATIONS):
        local = eliminated(system, orbit, ())
        maps = chain(local)
        nodes = maps @ change
        stages, algebraic = local.recover(nodes, still, 1.0)
        orbit = replace(
            orbit,
            nodes=orbit.nodes + nodes,
            stages=orbit.stages + stages,
            algebraic=moved_unknowns(system, orbit.algebraic, algebraic),
        )
        if np.abs(nodes).max() <= allowed:
            return np.asarray(chain(eliminated(system, orbit, ()))[-1, :, 1:])
        change[1:] = 0.0
    raise FloatingPointError("a motion beside the orbit was not found")
