"""The error estimate of small systems in one call of C (`estimate.c`), where their kernels are compiled."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from periodic.collocation.fastmotions.unresolved import FAST
from periodic.collocation.native.call import FOUND, given, prepared
from periodic.collocation.native.perturbations import carried, multiplied
from periodic.collocation.rounding import TERMS
from periodic.correction.error import LAST_DIGITS, REACH, STRAIGHT, ErrorEstimate, Halved, relative
from periodic.correction.newton import USUAL
from periodic.correction.outcome import FAILURES
from periodic.correction.problem import Problem
from periodic.events.impacts import jumping
from periodic.linear.unknowns import STEEP, Increment, size_of
from periodic.orbit.construction import bisect
from periodic.orbit.native.addresses import routine
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Spectrum
from periodic.system import System
from periodic.system.precision import EPSILON

_HALVES = ("stages_of", "unknowns_of", "middle")
_BETTER = tuple(f"better_{name}" for name in FOUND)
_ADDRESSES = (*FOUND, "profile", *_HALVES, "fundamental", "steps", "monodromy", "better_steps", *_BETTER)
_NUMBERS = (
    "along",
    "scale",
    "unit",
    "reach",
    "straight",
    "steep",
    "rounding",
    "digits",
    "fast",
    "apart",
    "shift",
)


class Estimate(ctypes.Structure):
    """`struct estimate` of estimate.c.

    Limits: `reach` is the arclength up to which the orbit of the same parameter is looked for, `straight` the
    largest factor by which d parameter / d arclength may change on the way, `steep` the rate of the states,
    in their size per rad, at which a mesh point of an orbit with kinks has half its weight in the metric,
    `rounding` the error of a switch relative to the terms that cancel in it, `digits` the relative rounding
    error of the parameter, `fast` the turn of a vibration in an interval (rad) above which it may be too fast
    for the mesh.
    """

    _fields_ = (
        *((name, ctypes.c_void_p) for name in _ADDRESSES),
        *((name, ctypes.c_double) for name in _NUMBERS),
        ("unresolved", ctypes.c_ssize_t),
    )


@dataclass(frozen=True)
class Estimated:
    """What `periodic.correction.error.deferred` returns, and whether a vibration may be too fast."""

    error: ErrorEstimate
    unresolved: bool


def estimated(problem: Problem, orbit: Orbit, tangent: Increment, spectrum: Spectrum) -> Estimated | None:
    """Return the errors of an orbit with one free parameter, or None where NumPy must be used."""
    ready = prepared(problem.system, orbit, orbit.mesh.bisected(), problem.free, USUAL)
    if ready is None:
        return None
    call = ready.call
    n, own = orbit.nodes.shape[1], Estimate()
    parts = [orbit.nodes, orbit.stages, orbit.algebraic, orbit.phases, orbit.parameter, tangent.profile]
    count, better = 2 * orbit.mesh.ntst, _room(orbit)
    matrices = [np.empty(shape) for shape in ((count + 1, n, n), (count, n, n), (n, n), (count, n, n))]
    kept = given(own, _ADDRESSES, [*parts, *orbit.mesh.scheme.halves, *matrices, *better])
    own.along, own.scale, own.unit = tangent.parameter, problem.scale, size_of(orbit)
    own.reach, own.straight, own.steep, own.fast = REACH, STRAIGHT, STEEP, FAST
    own.rounding, own.digits = TERMS * EPSILON, LAST_DIGITS
    code = routine(ready.library, "estimate", 2)(ctypes.addressof(call), ctypes.addressof(own))
    del kept
    if code:
        return None
    refined = partial(_halved, orbit, better)
    try:
        fundamental, monodromy = _passing(problem.system, orbit, refined, *matrices)
    except FAILURES:
        return None
    halved = Halved(own.apart, own.shift, spectrum.apart(monodromy), fundamental, monodromy)
    error = relative(problem, orbit, spectrum, halved, refined)
    return Estimated(error, bool(own.unresolved or ready.side.size))


def _passing(
    system: System,
    orbit: Orbit,
    better: Callable[[], Orbit],
    fundamental: Array,
    steps: Array,
    monodromy: Array,
    better_steps: Array,
) -> tuple[Array, Array]:
    """The fundamental matrices of the halved mesh, and the monodromy matrix of the better orbit.

    Raises FAILURES where a jump has no rates.
    """
    if not jumping(system, orbit):
        return fundamental, monodromy
    own = carried(system, bisect(orbit), steps)
    return multiplied(own), multiplied(carried(system, better(), better_steps))[-1]


def _room(orbit: Orbit) -> list[Array]:
    """Arrays for the same orbit on the halved mesh."""
    count, ncol, n = orbit.stages.shape
    shapes = (2 * count + 1, n), (2 * count, ncol, n), (2 * count, ncol, orbit.algebraic.shape[2])
    return [*map(np.empty, shapes), np.empty_like(orbit.phases), np.empty_like(orbit.parameter)]


def _halved(orbit: Orbit, arrays: list[Array]) -> Orbit:
    """The orbit of the arrays in which C has left its solution on the halved mesh."""
    nodes, stages, algebraic, phases, parameter = arrays
    return replace(
        orbit,
        mesh=orbit.mesh.bisected(),
        nodes=nodes,
        stages=stages,
        algebraic=algebraic,
        phases=phases,
        parameter=parameter,
    )
