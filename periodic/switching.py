"""From a special point to the branch that begins there: doubled orbits at a PD, another branch at a BP.

With M v = mu v, mu = -1 or 1, the new branch leaves along x(tau) + s Phi(tau) v, Phi the fundamental matrix.
Where mu = -1 this perturbation has the opposite sign in the second period.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from periodic import bordered, collocation
from periodic.closure import Condition, Direction, Metric, PhaseCondition, Plane, closures
from periodic.crossing import tangents
from periodic.equilibrium import increment
from periodic.mesh import Mesh
from periodic.newton import Outcome, correct
from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.solve import along
from periodic.system import System, index_of

FAR = 0.02
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
    """Return an orbit of twice the period near one that is about to double (PD): a guess for `trace`.

    `parameter` is that of the branch, `determined` as in `trace`; the new orbit lies `distance` (root mean
    square of the scaled states; default: FAR times the largest peak to peak) away, at a parameter of its own.
    Raises SwitchError.
    """
    orbit = orbit.collocated()
    once = away(system, orbit, -1, autonomous=False)
    twice = _twice(orbit)
    nodes = np.concatenate([once.nodes[:-1], -once.nodes])
    direction = Direction(
        nodes=nodes,
        stages=np.concatenate([once.stages, -once.stages]),
        algebraic=np.concatenate([once.algebraic, -once.algebraic]),
        phases=np.zeros(2 * len(orbit.phases)),
        profile=nodes,
        parameter=0.0,
        others=np.zeros(0),
    )
    return switched(system, twice, direction, parameter, determined or {}, distance)


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

    Arguments as in `doubled`; a negative distance gives the orbit on the other side. Of two branches of
    equilibria it is the one that leads away from `leaving`, a nearby equilibrium of the other; without one,
    that along which the parameter changes less. Raises SwitchError.
    """
    if orbit.equilibrium:
        across = _across(system, orbit, index_of(system, parameter), leaving)
        return switched(system, orbit, across, parameter, determined or {}, distance)
    autonomous = any(isinstance(c, PhaseCondition) for c in (determined or {}).values())
    orbit = orbit.collocated()
    direction = away(system, orbit, 1, autonomous)
    return switched(system, orbit, direction, parameter, determined or {}, distance)


def _across(system: System, orbit: Orbit, index: int, leaving: Orbit | None) -> Direction:
    """The tangent of the other branch of equilibria at a branch point."""
    found = tangents(system, orbit, index)
    if not found:
        raise SwitchError("no other branch of equilibria crosses there")
    if leaving is None:
        return found[0]
    jump = float(leaving.parameter[index] - orbit.parameter[index])
    way = replace(found[0], profile=leaving.nodes[0] - orbit.nodes, parameter=jump)
    metric = Metric(1.0)

    def aligned(tangent: Direction) -> float:
        length = np.sqrt(metric.dot(orbit, tangent, tangent))
        return abs(metric.dot(orbit, tangent, way)) / float(length)

    return min(found, key=aligned)


def switched(
    system: System,
    origin: Orbit,
    direction: Direction,
    parameter: str,
    determined: Mapping[str, Condition],
    distance: float | None,
) -> Orbit:
    """Solve on the plane across a direction, some way along it. Raises SwitchError."""
    free = tuple(index_of(system, name) for name in (parameter, *determined))
    length = FAR * origin.span() if distance is None else distance
    metric = Metric(1.0)
    direction = replace(direction, others=np.zeros(len(determined)))
    direction = direction.scaled(1 / float(np.sqrt(metric.dot(origin, direction, direction))))
    plane = Plane(origin, direction, length, metric, free[0])
    guess = along(system, free, origin, direction, length)
    closing = [*closures(list(determined.values()), free[1:], guess), plane]
    found = correct(system, guess, free, closing, increment=increment if origin.equilibrium else None)
    if found.outcome is not Outcome.CONVERGED:
        raise SwitchError(f"no orbit of the new branch was found {length:.3g} away: {found.outcome.value}")
    return found.orbit


def _twice(orbit: Orbit) -> Orbit:
    """The same orbit gone through twice."""
    mesh = orbit.mesh
    both = mesh.breaks * 2
    breaks = both if mesh.anchors else (np.concatenate([both[0] / 2, (1 + both[1][1:]) / 2]),)
    return replace(
        orbit,
        mesh=Mesh(mesh.scheme, breaks, mesh.anchors * 2, 2 * mesh.period),
        nodes=np.concatenate([orbit.nodes[:-1], orbit.nodes]),
        stages=np.concatenate([orbit.stages] * 2),
        algebraic=np.concatenate([orbit.algebraic] * 2),
        phases=np.concatenate([orbit.phases, orbit.phases + mesh.period]),
    )


def away(system: System, orbit: Orbit, multiplier: int, autonomous: bool) -> Direction:
    """The perturbation that is multiplied by 1 or -1 over the period; of any length."""
    orbit = orbit.collocated()
    condensed = collocation.condense(system, orbit, ())
    fundamental = bordered.chain(condensed)[:, :, 1 : 1 + orbit.nodes.shape[1]]
    flow = orbit.node_rates[0] if autonomous and multiplier == 1 else None
    nodes = fundamental @ _kept(fundamental[-1] - multiplier * np.eye(len(fundamental[-1])), flow)
    stages, algebraic = condensed.recover(nodes, np.zeros(len(orbit.phases)), 0.0)
    return Direction(nodes, stages, algebraic, np.zeros(len(orbit.phases)), nodes, 0.0, np.zeros(0))


def _kept(matrix: Array, flow: Array | None) -> Array:
    """The vector nearest to the kernel of a matrix, across the flow if there is one."""
    if flow is not None:
        matrix = np.concatenate([matrix, flow[None, :] / np.linalg.norm(flow)])
    return np.linalg.svd(matrix)[2][-1]
