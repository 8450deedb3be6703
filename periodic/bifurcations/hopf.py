"""Small oscillations about an equilibrium: Hopf points and linear normal modes, where branches begin.

The linearised motion d(dx)/dt = J dx about x0 has the oscillations x0 + a Re(exp(i tau) v), tau = omega t,
with J v = i omega v. At a Hopf point they are the first orbits of the branch that is born there; at a centre
of a conservative system they are its linear normal modes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from periodic.bifurcations.switching import FIRST_DISTANCE, SwitchError, switched
from periodic.conditions.phase import Conservative, PhaseCondition
from periodic.correction.condition import Condition
from periodic.equilibrium.linearise import rows_at
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import as_read_by, constant
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Scheme
from periodic.system import System, index_of

NTST = 24

ON_AXIS = 1e-4
"""Largest real part of a pair that counts as imaginary, as a part of its modulus."""

FIRST_LENGTHS = (1.0, 0.25, 1 / 16)
"""Distances at which the first orbit is sought, in units of FIRST_DISTANCE."""


def eigenvalues(system: System, orbit: Orbit, frequency: str = "omega") -> NDArray[np.complex128]:
    """Return the eigenvalues of small motion about an equilibrium: J v = lambda v, d(dx)/dt = J dx.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The equilibrium.
    frequency : str
        Name of the parameter omega with d/dt = omega d/dtau.

    Returns
    -------
    ndarray, shape (n,)
        Eigenvalues in 1/s, largest real part first.

    Raises
    ------
    numpy.linalg.LinAlgError
        Where the equations do not determine the rates of small motion: their matrix is singular.
    """
    orbit = as_read_by(system, orbit)
    omega = orbit.parameter[index_of(system, frequency)]
    found = np.linalg.eigvals(omega * rows_at(system, orbit, ()).jacobian).astype(np.complex128)
    return found[np.argsort(-found.real, kind="stable")]


def hopf(
    system: System,
    orbit: Orbit,
    parameter: str,
    *,
    frequency: str = "omega",
    distance: float | None = None,
) -> Orbit:
    """Return a small orbit of the branch that begins at a Hopf point (HB): a guess for `trace`.

    It lies along x0 + a Re(exp(i tau) v), J v = i omega v, at a parameter of its own.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The equilibrium at the Hopf point.
    parameter : str
        The parameter of the branch, to be traced with `frequency` determined by a PhaseCondition.
    frequency : str
        Name of the parameter omega with d/dt = omega d/dtau.
    distance : float, optional
        From the equilibrium, root mean square of the scaled states; default FIRST_DISTANCE or less.

    Returns
    -------
    Orbit
        The guess.

    Raises
    ------
    SwitchError
        Where the equilibrium is no Hopf point, or no orbit is found.
    ValueError
        For an orbit that is no equilibrium.
    """
    orbit = as_read_by(system, orbit)
    pairs = _pairs(system, orbit, frequency)
    nearest = pairs[np.abs(pairs.real / np.abs(pairs)).argmin()]
    if abs(nearest.real) > ON_AXIS * abs(nearest):
        raise SwitchError(
            f"the equilibrium is no Hopf point: its eigenvalue nearest the axis is {nearest:.6g}"
        )
    determined = {frequency: PhaseCondition()}
    return _oscillation(system, orbit, float(nearest.imag), frequency, parameter, determined, distance)


def normal_mode(
    system: System,
    orbit: Orbit,
    damping: str,
    *,
    which: int = 0,
    frequency: str = "omega",
    distance: float | None = None,
) -> Orbit:
    """Return a small orbit of a normal mode of a conservative system: a guess for `trace` in the frequency.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The equilibrium.
    damping : str
        A parameter that would dissipate energy, to be determined by the condition Conservative: it stays 0,
        and must be 0 at the equilibrium.
    which : int
        The mode, counted from 0 at the lowest frequency.
    frequency, distance
        As in `hopf`.

    Returns
    -------
    Orbit
        The guess.

    Raises
    ------
    SwitchError
        Where no eigenvalue is complex, or no orbit is found.
    ValueError
        For a mode that does not exist, and an orbit that is no equilibrium.
    """
    orbit = as_read_by(system, orbit)
    pairs = _pairs(system, orbit, frequency)
    omegas = np.sort(pairs[np.abs(pairs.real) <= ON_AXIS * np.abs(pairs)].imag)
    if which not in range(len(omegas)):
        raise ValueError(
            f"which is {which}; the equilibrium has {len(omegas)} undamped modes, counted from 0"
        )
    determined = {damping: Conservative()}
    return _oscillation(system, orbit, float(omegas[which]), frequency, frequency, determined, distance)


def _pairs(system: System, orbit: Orbit, frequency: str) -> NDArray[np.complex128]:
    """The eigenvalues with positive imaginary part."""
    if not orbit.equilibrium:
        raise ValueError("orbit is no equilibrium; it must be one, of a branch by method=Equilibrium()")
    found = eigenvalues(system, orbit, frequency)
    oscillating = found[found.imag > 0]
    if not len(oscillating):
        raise SwitchError("no orbits begin at the equilibrium: none of its eigenvalues is complex")
    return oscillating


def _oscillation(
    system: System,
    orbit: Orbit,
    omega: float,
    frequency: str,
    parameter: str,
    determined: Mapping[str, Condition],
    distance: float | None,
) -> Orbit:
    """Solve on the arclength constraint some way along the linear oscillation of frequency omega."""
    values = orbit.parameter.copy()
    values[index_of(system, frequency)] = omega
    at_rest = replace(orbit, parameter=values)
    origin = constant(uniform(Scheme(), NTST), orbit.nodes[0], orbit.algebraic[0, 0], values, orbit.layout)
    direction = oscillating(system, at_rest, origin)
    last: SwitchError | None = None
    for length in [FIRST_DISTANCE * part for part in FIRST_LENGTHS] if distance is None else [distance]:
        try:
            return switched(system, origin, direction, parameter, determined, length)
        except SwitchError as error:
            last = error
    assert last is not None
    raise last


def oscillating(system: System, at_rest: Orbit, origin: Orbit, near: complex = 1j) -> Increment:
    """Return the oscillation Re(exp(i tau) v) of states and unknowns, v an eigenvector of dx' = J dx.

    Parameters
    ----------
    system : System
        The equations.
    at_rest : Orbit
        The equilibrium.
    origin : Orbit
        The same on the mesh that the increment is for.
    near : complex
        Where its eigenvalue is, per unit of tau.

    Returns
    -------
    Increment
        The oscillation, of the eigenvector's size.
    """
    rows = rows_at(system, at_rest, ())
    values, vectors = np.linalg.eig(rows.jacobian)
    v = vectors[:, np.abs(values - near).argmin()]
    v = v * np.exp(-1j * np.angle(v[np.abs(v).argmax()]))
    unknowns = rows.unknowns @ v

    def turning(vector: NDArray[np.complex128], tau: NDArray[np.float64]) -> NDArray[np.float64]:
        return (np.exp(1j * tau)[..., None] * vector).real

    nodes = turning(v, origin.mesh.nodes(origin.phases))
    return Increment(
        nodes=nodes,
        stages=turning(v, origin.stage_phases),
        algebraic=turning(unknowns, origin.stage_phases),
        phases=np.zeros(0),
        parameters=np.zeros(1),
        profile=nodes,
    )
