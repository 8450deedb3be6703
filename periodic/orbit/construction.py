"""Orbits that need no solving: constants, and orbits carried to another mesh or to other scales."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from periodic.checks import number
from periodic.orbit.layout import Layout, layout_of
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import System, VariableLike, check_system


def as_read_by(system: System, orbit: Orbit) -> Orbit:
    """Return an orbit in the scales of a system; the same one if it has them already.

    Parameters
    ----------
    system : System
        The system that is to read it.
    orbit : Orbit
        An orbit of it, or of an equal system with other scales.

    Returns
    -------
    Orbit
        The orbit whose numbers the system takes.

    Raises
    ------
    ValueError
        Where the orbit's names or units are not the system's, and for what is no system or orbit.
    """
    check_system(system)
    if not isinstance(orbit, Orbit):
        raise ValueError(f"orbit is a {type(orbit).__name__}; it must be an Orbit, as point.orbit is")
    if orbit.layout is None or orbit.layout.fits(system):
        return orbit
    return orbit.expressed_in(layout_of(system))


def at_rest(system: System, mesh: Mesh, parameter: Array) -> Orbit:
    """Return the constant orbit at the system's rest values.

    Parameters
    ----------
    system : System
        The system.
    mesh : Mesh
        The orbit's mesh.
    parameter : ndarray, shape (p,)
        The parameters in SI.

    Returns
    -------
    Orbit
        The orbit.
    """
    return constant(mesh, *system.rest(parameter), parameter, layout_of(system))


def standing_at(system: System, values: Mapping[str, float]) -> Orbit:
    """Return an equilibrium at nominal parameters, with some states and unknowns given by name: a guess.

    Parameters
    ----------
    system : System
        The system.
    values : mapping of str to float
        Values (SI) by name; the others are at rest.

    Returns
    -------
    Orbit
        A constant orbit, marked as an equilibrium.

    Raises
    ------
    ValueError
        For a name that is no state or unknown, and a value that is no finite number.
    """
    parameter = np.array(system.nominal, dtype=float)
    rest = np.concatenate(system.rest(parameter))
    variables: list[VariableLike] = [*system.states, *system.algebraics]
    names = [variable.name for variable in variables]
    for name, value in values.items():
        if name not in names:
            raise ValueError(f"guess has {name!r}; it must be one of {', '.join(names)}")
        if not np.isfinite(number(f"guess of {name}", value)):
            raise ValueError(f"guess of {name} is {value}; it must be a finite number")
        rest[names.index(name)] = value / variables[names.index(name)].scale
    n = len(system.states)
    still = constant(uniform(Scheme(), 1), rest[:n], rest[n:], parameter, layout_of(system))
    return replace(still, equilibrium=True)


def constant(
    mesh: Mesh, state: Array, algebraic: Array, parameter: Array, layout: Layout | None = None
) -> Orbit:
    """Return the constant orbit of a state and unknowns.

    Parameters
    ----------
    mesh : Mesh
        The orbit's mesh.
    state : ndarray, shape (n,)
        Scaled states.
    algebraic : ndarray, shape (m,)
        Scaled unknowns.
    parameter : ndarray, shape (p,)
        The parameters in SI.
    layout : Layout, optional
        Names, units and scales.

    Returns
    -------
    Orbit
        The orbit.
    """
    count, ncol = mesh.ntst, mesh.scheme.ncol
    return Orbit(
        mesh,
        np.tile(state, (count + 1, 1)),
        np.tile(state, (count, ncol, 1)),
        np.tile(algebraic, (count, ncol, 1)),
        np.zeros(0),
        np.array(parameter, dtype=float),
        layout=layout,
    )


def transfer(orbit: Orbit, mesh: Mesh, phases: Array) -> Orbit:
    """Return an orbit interpolated onto another mesh.

    Parameters
    ----------
    orbit : Orbit
        The orbit.
    mesh : Mesh
        Its new mesh.
    phases : ndarray, shape (k,)
        Where the new mesh's event nodes lie, in rad.

    Returns
    -------
    Orbit
        The interpolant: no solution before it is corrected.
    """
    grid = mesh.grid(phases)
    tau = (grid.left[:, None] + grid.width[:, None] * mesh.scheme.points).ravel()
    inside = tau - 1e-9 * np.repeat(grid.width, mesh.scheme.ncol)
    shape = (mesh.ntst, mesh.scheme.ncol, -1)
    stages = tau.reshape(shape[:2]).copy()
    at = mesh.nodes(phases)
    for start in mesh.starts:  # where the state may jump: x- before, x+ after
        stages[start - 1, -1] -= 1e-9 * grid.width[start - 1]
        at[start] += 1e-9 * grid.width[start]
    if mesh.events:
        at[-1] = at[0]
    return Orbit(
        mesh,
        orbit.state(at),
        orbit.state(stages.ravel()).reshape(shape),
        orbit.algebraic_guess(inside).reshape(*shape[:2], orbit.algebraic.shape[2]),
        phases,
        orbit.parameter,
        layout=orbit.layout,
    )


def bisect(orbit: Orbit) -> Orbit:
    """Return the same piecewise polynomial on the mesh with every interval halved.

    Parameters
    ----------
    orbit : Orbit
        The orbit.

    Returns
    -------
    Orbit
        The orbit on 2 N intervals.
    """
    scheme = orbit.mesh.scheme
    stages, unknowns, middle = scheme.halves
    count = 2 * orbit.mesh.ntst
    nodes = np.empty((count + 1, orbit.nodes.shape[1]))
    nodes[::2] = orbit.nodes
    nodes[1::2] = middle @ orbit.knots
    return replace(
        orbit,
        mesh=orbit.mesh.bisected(),
        nodes=nodes,
        stages=(stages @ orbit.knots).reshape(count, scheme.ncol, -1),
        algebraic=(unknowns @ orbit.algebraic).reshape(count, scheme.ncol, orbit.algebraic.shape[2]),
    )
