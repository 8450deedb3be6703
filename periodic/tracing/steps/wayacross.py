"""The way from one orbit to another, and the tangent there, on the mesh of the first.

Where the second has the same event nodes in another order, points correspond that lie as far between them;
where it has others, points at the same phase.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from periodic.correction.predictor import difference, rates_at_fixed_phases
from periodic.correction.solution import Solution
from periodic.linear.unknowns import Increment, node_phase_gradient
from periodic.orbit.mesh import wrapped
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array


def way_and_tangent(base: Solution, new: Solution) -> tuple[Increment, Increment]:
    """Return the way from a solution to another, and the tangent there.

    Parameters
    ----------
    base, new : Solution
        On one mesh, or with other event nodes, or these in another order.

    Returns
    -------
    way, tangent : Increment
        On the mesh of the first.
    """
    if new.orbit.mesh.matches(base.orbit.mesh):
        return difference(base.problem, base.orbit, new.orbit), new.tangent
    orbit, free = base.orbit, list(base.problem.free)
    if Counter(orbit.mesh.events) != Counter(new.orbit.mesh.events):
        return _at_fixed_phases(base, new)
    other = matched(orbit, new.orbit)
    shifts = np.array([wrapped(s, orbit.mesh.period) for s in new.orbit.phases[other] - orbit.phases])
    gradient, rates = node_phase_gradient(orbit), new.tangent.phases[other]
    at = orbit.mesh.nodes(orbit.phases) + gradient @ shifts
    moving = _profile(new, at) + new.orbit.rate(at) * (gradient @ rates)[:, None]
    apart = new.orbit.parameter[free] - orbit.parameter[free]
    way = _increment(orbit, new.orbit.state(at) - orbit.nodes, shifts, apart)
    return way, _increment(orbit, moving, rates, new.tangent.parameters)


def _at_fixed_phases(base: Solution, new: Solution) -> tuple[Increment, Increment]:
    """The way to an orbit with other event nodes, and the tangent there, by states at the same phases.

    Event nodes move as the tangent at the base says: which of them correspond is not known.
    """
    orbit, free = base.orbit, list(base.problem.free)
    at, apart = orbit.mesh.nodes(orbit.phases), new.orbit.parameter[free] - orbit.parameter[free]
    rates = base.tangent.phases / base.tangent.parameter

    def moving(profile: Array, parameters: Array) -> Increment:
        shifts = rates * parameters[0]
        nodes = profile + orbit.node_rates * (node_phase_gradient(orbit) @ shifts)[:, None]
        return _increment(orbit, nodes, shifts, parameters)

    way = moving(new.orbit.state(at) - orbit.nodes, apart)
    return way, moving(_profile(new, at), new.tangent.parameters)


def matched(one: Orbit, other: Orbit) -> list[int]:
    """Return for each event node of an orbit the nearest alike of another one."""
    period = one.mesh.period
    return [
        min(
            (j for j, alike in enumerate(other.mesh.events) if alike == event),
            key=lambda j: abs(wrapped(other.phases[j] - phase, period)),
        )
        for event, phase in zip(one.mesh.events, one.phases, strict=True)
    ]


def _profile(solution: Solution, tau: Array) -> Array:
    """How the states change along the branch at phases, these held."""
    index, theta = solution.orbit.locate(tau)
    basis = solution.orbit.mesh.scheme.basis(theta)
    return np.einsum("tl,tln->tn", basis, rates_at_fixed_phases(solution)[index])


def _increment(orbit: Orbit, nodes: Array, phases: Array, parameters: Array) -> Increment:
    """An increment of which no more is known than continuation measures."""
    stages, algebraic = np.zeros_like(orbit.stages), np.zeros_like(orbit.algebraic)
    return Increment.of(orbit, nodes, stages, algebraic, phases, parameters)
