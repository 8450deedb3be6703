"""Motion anywhere in a structure, from the forces at its places: exact between mesh points as well."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from periodic.condensed.modal.moments import Moments
from periodic.condensed.modal.response import Response
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import as_read_by, transfer
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.system import ModesLike, System, linear_of

SCHEME = Scheme(Family.RADAU, 7)
"""Collocation points at which the forces of a Fourier series are evaluated."""


def motion(
    system: System, orbit: Orbit, freedoms: Sequence[int] | None, tau: ArrayLike, structure: str | None = None
) -> tuple[Array, Array]:
    """Return displacements and velocities of any degrees of freedom of a structure along an orbit.

    An operating deflection shape is the displacement of all degrees of freedom at one phase. For stresses and
    other linear functions of displacements see `recovery`.

    Parameters
    ----------
    system : System
        A system compiled from a structure.
    orbit : Orbit
        An orbit of it.
    freedoms : sequence of int, or None
        Indices of d degrees of freedom, counted from 0; None for all of them.
    tau : array_like, shape (K,)
        Phases in rad; tau = Omega t.
    structure : str, optional
        Name of the structure, where the system has several.

    Returns
    -------
    displacement, velocity : ndarray, shape (K, d)
        In SI: m and m/s of a structure in SI.

    Raises
    ------
    ValueError
        For a system without a structure, a name or index that does not exist, an orbit of another system.
    """
    part = linear_of(system)
    if part is None:
        raise ValueError("system has no structure; motion elsewhere is that of its states, as orbit['x'](t)")
    orbit = _with_forces(system, as_read_by(system, orbit))
    observed_at = part.observed(orbit.parameter, freedoms, structure)
    phases = np.atleast_1d(np.asarray(tau, dtype=float))
    forces = np.ascontiguousarray(orbit.algebraic[:, :, list(part.forces)])
    states = _states(observed_at, orbit, forces, phases)
    return states[:, ::2], states[:, 1::2]


def displacements(
    system: System, orbit: Orbit, nodes: Sequence[tuple[str, int]], tau: Array, structure: str
) -> Array:
    """Return displacements (SI) of nodes of a structure, (K, nodes), whether it is condensed or not.

    A node is its output's name, for systems with all states, and its degree of freedom, for condensed ones.
    """
    if linear_of(system) is None:
        return np.stack([orbit[name](tau / orbit.omega) for name, _ in nodes], axis=1)
    return motion(system, orbit, [k for _, k in nodes], tau, structure)[0]


def _with_forces(system: System, orbit: Orbit) -> Orbit:
    """The orbit as a piecewise polynomial with the forces at its collocation points."""
    if type(orbit) is Orbit:
        return orbit
    pieces = transfer(orbit, uniform(SCHEME, max(2 * orbit.mesh.ntst, 32), orbit.mesh.period), orbit.phases)
    unknowns = algebraic_at(system, pieces, pieces.stage_phases.ravel())
    return Orbit(
        pieces.mesh,
        pieces.nodes,
        pieces.stages,
        unknowns.reshape(pieces.algebraic.shape),
        pieces.phases,
        pieces.parameter,
        layout=orbit.layout,
    )


def _states(modes: ModesLike, orbit: Orbit, forces: Array, tau: Array) -> Array:
    """Outputs of the modes at phases, (K, s)."""
    scheme, grid = orbit.mesh.scheme, orbit.grid
    history = Response(modes, scheme, grid, orbit.mesh.period).history(forces)
    index, place = orbit.locate(tau)
    found = np.empty((len(tau), len(modes.outputs)))
    for interval in np.unique(index):
        here, width = np.flatnonzero(index == interval), grid.width[interval]
        moments = Moments(scheme, tuple(place[here]))
        table = moments.table(width * modes.exponents)
        driven = modes.inputs @ forces[interval].T
        z = table.growth * history[interval][:, None] + width * np.einsum("jab,jb->ja", table.moment, driven)
        force = moments.derivatives[0, 1:] @ forces[interval]
        rate = moments.derivatives[1, 1:] @ forces[interval] / width
        found[here] = (modes.outputs @ z).real.T + force @ modes.direct.T + rate @ modes.direct_rate.T
    return found
