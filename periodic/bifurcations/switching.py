"""From a special point to the branch that begins there: doubled orbits at a PD, another branch at a BP.

With M v = mu v, mu = -1 or 1, the new branch leaves along x(tau) + s Phi(tau) v, Phi the fundamental matrix.
Where mu = -1 this perturbation has the opposite sign in the second period.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from periodic.conditions.phase import open_phase
from periodic.conditions.variations import equations, variations
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.condition import Condition, side_conditions
from periodic.correction.newton import correct, moved
from periodic.equilibrium.crossing import tangents
from periodic.equilibrium.linearise import linearise
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import as_read_by
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.row import Row
from periodic.system import System, index_of

FIRST_DISTANCE = 0.02
"""Distance of the first orbit of the new branch from the old one, in peak-to-peak values of the orbit."""


class SwitchError(ArithmeticError):
    """No orbit of the new branch was found; the message says why."""


def doubled(
    system: System,
    orbit: Orbit,
    parameter: str,
    *,
    determined: Mapping[str, Condition] | None = None,
    distance: float | None = None,
) -> Orbit:
    """Return an orbit of twice the period near a period doubling (PD): a guess for `trace`.

    It lies along x(tau) + s Phi(tau) v, M v = -v, at a parameter of its own.

    Parameters
    ----------
    system : System
        The equations.
    orbit : Orbit
        The orbit at the PD.
    parameter : str
        The parameter of the branch.
    determined : mapping of str to Condition, optional
        As in `trace`.
    distance : float, optional
        From the orbit, root mean square of the scaled states; default FIRST_DISTANCE times the largest peak
        to peak (of an orbit at rest FIRST_DISTANCE).

    Returns
    -------
    Orbit
        The guess, of twice the period.

    Raises
    ------
    ValueError
        Where nothing determines the period of an orbit of a system that is not excited.
    SwitchError
        Where no orbit of the new branch is found.
    """
    orbit = as_read_by(system, orbit).collocated()
    if not any(condition.trivial for condition in (determined or {}).values()):
        _check_excited(system, orbit, parameter)
    once = away(system, orbit, -1, autonomous=False)
    twice = repeated(orbit, 2)
    nodes = np.concatenate([once.nodes[:-1], -once.nodes])
    direction = Increment(
        nodes=nodes,
        stages=np.concatenate([once.stages, -once.stages]),
        algebraic=np.concatenate([once.algebraic, -once.algebraic]),
        phases=np.zeros(2 * len(orbit.phases)),
        parameters=np.zeros(1),
        profile=nodes,
    )
    return switched(system, twice, direction, parameter, determined or {}, distance)


def _check_excited(system: System, orbit: Orbit, parameter: str) -> None:
    """Raise ValueError where the equations leave phase and period of an orbit open."""
    if not orbit.equilibrium and (why := open_phase(system, orbit.parameter, parameter)):
        raise ValueError(f"determined has no phase condition: {why}")


def branched(
    system: System,
    orbit: Orbit,
    parameter: str,
    *,
    determined: Mapping[str, Condition] | None = None,
    distance: float | None = None,
    leaving: Orbit | None = None,
) -> Orbit:
    """Return an orbit of the branch that crosses another at a branch point (BP): a guess for `trace`.

    An orbit lies along x(tau) + s Phi(tau) v, M v = v, an equilibrium along the tangent of the other branch,
    each at a parameter of its own.

    Parameters
    ----------
    system, orbit, parameter, determined
        As in `doubled`, the orbit at the BP.
    distance : float, optional
        As in `doubled`; a negative one gives the orbit on the other side.
    leaving : Orbit, optional
        A nearby equilibrium of the branch to leave. Without it the guess is on that of two branches of
        equilibria along which the parameter changes less.

    Returns
    -------
    Orbit
        The guess.

    Raises
    ------
    SwitchError
        Where no orbit of the new branch is found.
    """
    orbit = as_read_by(system, orbit)
    if orbit.equilibrium:
        other_tangent = _other_tangent(system, orbit, index_of(system, parameter), leaving)
        return switched(system, orbit, other_tangent, parameter, determined or {}, distance)
    autonomous = any(c.trivial for c in (determined or {}).values())
    orbit = orbit.collocated()
    direction = away(system, orbit, 1, autonomous)
    return switched(system, orbit, direction, parameter, determined or {}, distance)


def _other_tangent(system: System, orbit: Orbit, index: int, leaving: Orbit | None) -> Increment:
    """The tangent of the other branch of equilibria at a branch point."""
    found = tangents(system, orbit, index)
    if not found:
        raise SwitchError("no other branch of equilibria crosses there")
    if leaving is None:
        return found[0]
    leaving = as_read_by(system, leaving)
    jump = float(leaving.parameter[index] - orbit.parameter[index])
    way = replace(found[0], profile=leaving.nodes[0] - orbit.nodes, parameters=np.array([jump]))

    def aligned(tangent: Increment) -> float:
        length = np.sqrt(tangent.dot(tangent, orbit, 1.0))
        return abs(tangent.dot(way, orbit, 1.0)) / float(length)

    return min(found, key=aligned)


def switched(
    system: System,
    origin: Orbit,
    direction: Increment,
    parameter: str,
    determined: Mapping[str, Condition],
    distance: float | None,
) -> Orbit:
    """Return the orbit some way along a direction, solved on the arclength constraint.

    Parameters
    ----------
    system : System
        The equations.
    origin : Orbit
        Where another branch begins.
    direction : Increment
        The new branch's tangent there, of any length.
    parameter : str
        The parameter of the branch.
    determined : mapping of str to Condition
        Further free parameters with the conditions that determine them.
    distance : float or None
        From the origin, root mean square of the scaled states; None for FIRST_DISTANCE times the orbit's own
        size.

    Returns
    -------
    Orbit
        An orbit of the new branch: a guess for `trace`.

    Raises
    ------
    SwitchError
        Where none is found.
    """
    free = tuple(index_of(system, name) for name in (parameter, *determined))
    size = origin.span()
    length = FIRST_DISTANCE * (size if size > LEAST_SPAN else 1.0) if distance is None else distance
    parameters = np.append(direction.parameter, np.zeros(len(determined)))
    unit = 1 / float(np.sqrt(direction.dot(direction, origin, 1.0)))
    direction = replace(direction, parameters=parameters).scaled(unit)
    constraint = ArclengthConstraint(origin, direction, length, 1.0, free[0])
    guess = moved(system, free, origin, direction, length)
    closing = [*side_conditions(list(determined.values()), free[1:], guess), constraint]
    found = correct(linearise if origin.equilibrium else equations, system, guess, free, closing)
    if not found.ok:
        raise SwitchError(f"no orbit of the new branch was found {length:.3g} away: {found.outcome.value}")
    return found.orbit


def repeated(orbit: Orbit, times: int) -> Orbit:
    """Return the same orbit gone through several times.

    Parameters
    ----------
    orbit : Orbit
        The orbit.
    times : int
        How many times.

    Returns
    -------
    Orbit
        The orbit over so many of its periods.
    """
    mesh, ntst = orbit.mesh, len(orbit.nodes) - 1
    if mesh.events:
        breaks = mesh.breaks * times
    else:
        breaks = (np.append(np.concatenate([(k + mesh.breaks[0][:-1]) / times for k in range(times)]), 1.0),)
    return replace(
        orbit,
        mesh=Mesh(mesh.scheme, breaks, mesh.events * times, times * mesh.period, mesh.modes),
        nodes=np.concatenate([*[orbit.nodes[:ntst]] * (times - 1), orbit.nodes]),
        stages=np.concatenate([orbit.stages] * times),
        algebraic=np.concatenate([orbit.algebraic] * times),
        phases=np.concatenate([orbit.phases + k * mesh.period for k in range(times)]),
    )


def away(system: System, orbit: Orbit, multiplier: int, autonomous: bool) -> Increment:
    """The perturbation that is multiplied by 1 or -1 over the period; of any length.

    Raises numpy.linalg.LinAlgError where no force depends on the motion.
    """
    orbit = orbit.collocated()
    closed = variations(system, orbit, ()).repeating(multiplier)
    matrix = closed.matrix
    if not matrix.size:
        raise np.linalg.LinAlgError("no force depends on the motion")
    if autonomous and multiplier == 1:  # across the flow
        flow = np.zeros_like(orbit.nodes)
        flow[0] = orbit.node_rates[0]
        other_tangent = closed.functional(Row(0.0, flow, np.zeros(len(orbit.phases))))
        matrix = np.concatenate([matrix, other_tangent[None] / np.linalg.norm(other_tangent)])
    found = closed.tangent(np.linalg.svd(matrix)[2][-1])
    still = np.zeros(len(orbit.phases))
    return Increment(found.nodes, found.stages, found.algebraic, still, np.zeros(1), found.nodes)
