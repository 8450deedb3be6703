"""Newton's iteration of small systems in one call of C (`newton.c`), where their kernels are compiled.

It solves for an orbit on one arclength constraint, all surfaces kept in the modes of the guess. Where it
fails (a singular matrix, event nodes that cross, other modes at the end) `corrected` returns None, and the
whole iteration is done in NumPy.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from periodic.collocation.native.call import FOUND, ORIGIN, SOLVED, Call, given, laid_out, prepared
from periodic.collocation.native.perturbations import carried, multiplied, tame
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.condition import SideCondition
from periodic.correction.newton import Correction, NewtonSettings
from periodic.correction.outcome import FAILURES, Outcome
from periodic.events.impacts import jumping
from periodic.linear.unknowns import Increment
from periodic.orbit.native.addresses import routine
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System

_OUTCOMES = {0: Outcome.CONVERGED, 5: Outcome.TOO_MANY}
"""Return codes of newton that are results as they stand; after any other NumPy finds out what is wrong."""


def corrected(
    system: System,
    guess: Orbit,
    free: tuple[int, ...],
    conditions: Sequence[SideCondition],
    settings: NewtonSettings,
) -> Correction | None:
    """Return what `periodic.correction.newton.correct` does, or None."""
    constraint = conditions[0] if len(conditions) == 1 else None
    if not (isinstance(constraint, ArclengthConstraint) and free == (constraint.index,)):
        return None
    ready = prepared(system, guess, guess.mesh, free, settings)
    if ready is None:
        return None
    call = ready.call
    call.most = settings.max_iterations
    kept = _constrained(call, constraint)
    orbit, kernel, maps, steps = _into(call, guess)
    outcome = _OUTCOMES.get(routine(ready.library, "newton")(ctypes.addressof(call)))
    del kept
    if outcome is None or not ready.holds(system, orbit):
        return None
    ended = (outcome, int(call.iterations), call.size, call.residual)
    if outcome is not Outcome.CONVERGED:
        return Correction(orbit, *ended, np.full((1, call.n, call.n), np.nan), None)
    nodes, stages, algebraic, outer = kernel
    along = Increment.of(orbit, nodes, stages, algebraic, outer[: call.k], outer[call.k :])
    fundamental = _fundamental(system, orbit, maps, steps)
    if fundamental is None:
        return None
    return Correction(orbit, *ended, fundamental, along, gentle=bool(call.gentle))


def _fundamental(system: System, orbit: Orbit, maps: Array, steps: Array) -> Array | None:
    """The fundamental matrices; None where a jump has no rates or they grow too much, which NumPy reports."""
    if not jumping(system, orbit):
        return maps[:, :, 1 : 1 + orbit.nodes.shape[1]]
    try:
        own = carried(system, orbit, steps)
    except FAILURES:
        return None
    return multiplied(own) if tame(own) else None


def _constrained(call: Call, constraint: ArclengthConstraint) -> list[Array]:
    """Write a constraint into a call; return the arrays to keep alive, as the call has their addresses."""
    origin = constraint.origin
    names, arrays = ["weighted", "origin_nodes"], [constraint.weighted, origin.nodes]
    if call.k:
        names += [*(f"origin_{name}" for name in ORIGIN), "lengths"]
        arrays += [origin.node_rates, origin.knots, origin.knot_rates, origin.phases]
        arrays += [origin.grid.left, origin.grid.width, constraint.lengths]
    call.origin_parameter = origin.parameter[constraint.index]
    call.slope = constraint.direction.parameter / constraint.scale**2
    call.distance = constraint.distance
    return given(call, names, arrays)


def _into(call: Call, guess: Orbit) -> tuple[Orbit, list[Array], Array, Array]:
    """Arrays that C writes into: the orbit, at first the guess, the parts of the kernel, maps and steps."""
    begun = (guess.nodes, guess.stages, guess.algebraic, guess.phases, guess.parameter)
    shapes = [array.shape for array in begun]
    own = laid_out(call, FOUND, shapes)
    for array, value in zip(own, begun, strict=True):
        array[...] = value
    change = [*shapes[:3], (call.k + 1,)]
    passing = [(call.count + 1, call.n, 2 + call.n + call.k), (call.count, call.n, call.n)]
    maps, steps, *parts = laid_out(call, SOLVED, [*passing, *change, *change])
    nodes, stages, algebraic, phases, parameter = own
    orbit = Orbit(guess.mesh, nodes, stages, algebraic, phases, parameter, layout=guess.layout)
    return orbit, parts[4:], maps, steps
