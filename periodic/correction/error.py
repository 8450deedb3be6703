"""The error estimate: one Newton step on the mesh with every interval halved (deferred correction).

The step solves the linearised equations on a discretisation that is 2^(ncol+1) times more accurate between
mesh points, so its increment is the error of the orbit to first order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.condition import SideCondition
from periodic.correction.newton import USUAL, Linearise, Linearised, NewtonSettings, linearised, moved
from periodic.correction.outcome import FAILURES
from periodic.correction.problem import Problem
from periodic.linear.unknowns import Increment, at_fixed_phase, parameter_only, size_of
from periodic.orbit.construction import bisect
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.stability.shares import shares
from periodic.stability.spectrum import Spectrum
from periodic.stability.spectrum import apart as powers_apart
from periodic.system import System

Solved = Callable[[System, Orbit, tuple[int, ...], Sequence[SideCondition], NewtonSettings], Linearised]
"""What linearises the equations at an orbit and solves them; raises FAILURES."""

LEAST_SPAN = 1e-6
"""Peak to peak (scaled) that errors are compared with at the least: an orbit may shrink to a rest."""

SAFETY = 3.0
"""How much smaller than a tolerance error estimates are to be, which beside kinks are not just right."""


@dataclass(frozen=True)
class ErrorEstimate:
    """Relative errors of an orbit, as estimated.

    Parameters
    ----------
    orbit : float
        Largest error of the states over their largest peak to peak.
    multiplier : float
        Error of the sums of the Floquet multipliers and of their squares, relative to the largest one where
        that exceeds 1. Those of a multiplier that is d < 1 from the next one may be 2/d times as large, as
        they are where two of them meet.
    parameter : float
        Error of the continuation parameter across the branch, so that of an LP its place, relative.
    rounding : float
        What of the multipliers' error is rounding of the states, about.
    by_orbit : float
        What of it the orbit's own error makes, where the equations change at events.
    shares : ndarray, shape (N,), optional
        What each interval adds to the rest of it, relative to each other.
    """

    orbit: float
    multiplier: float
    parameter: float = 0.0
    rounding: float = field(default=0.0, compare=False)
    by_orbit: float = field(default=0.0, compare=False)
    shares: Array | None = field(default=None, compare=False, repr=False, kw_only=True)

    @property
    def motion(self) -> float:
        """What is held against the tolerance but for the multipliers."""
        return SAFETY * max(self.orbit, self.parameter)

    def blur(self, value: float, scale: float) -> float:
        """Return what a value of the parameter is known to.

        Parameters
        ----------
        value : float
            The value (SI).
        scale : float
            Length of the range that it is in.

        Returns
        -------
        float
            Its error (SI).
        """
        return SAFETY * self.parameter * max(abs(value), SMALL * scale)

    @property
    def worst(self) -> float:
        """What is held against the tolerance."""
        return max(self.motion, SAFETY * self.multiplier)

    @property
    def curable(self) -> float:
        """The same without what no finer mesh betters."""
        return self.worst if self.multiplier > ROUNDED * self.rounding else self.motion

    @property
    def spread(self) -> float:
        """The same without what single intervals add to the multipliers' error."""
        return max(self.motion, SAFETY * self.by_orbit)


EXACT = ErrorEstimate(0.0, 0.0)
"""Of what is not discretised."""

UNKNOWN = ErrorEstimate(np.inf, np.inf, np.inf)
"""Where the errors could not be estimated."""


ROUNDED = 3.0
"""How many times the rounding expected of them multipliers may be off by rounding."""

SMALL = 0.1
"""Values of a parameter, in parts of its range, with which its error is compared at the least."""


BEST = 2e-12
"""Relative error of an orbit that rounding may leave; beside a touch it is far more in the multipliers."""

LAST_DIGITS = 4 * float(np.finfo(float).eps)
"""To how much of itself a parameter is known at the most."""

STRAIGHT = 0.1
"""Part of the way to a fold for which a branch is straight: with the parameter a part p of its direction, a
fold is about p away."""

TURNING = 1e-3
"""Part below which it is at one: no orbit beside it has that parameter to its last digits."""


def deferred(
    linearise: Linearise,
    problem: Problem,
    orbit: Orbit,
    tangent: Increment,
    spectrum: Spectrum,
    only_at_points: NDArray[np.bool_] | None = None,
    solved: Solved | None = None,
    kinked: bool | None = None,
    lengths: bool = False,
    digits: float = 0.0,
) -> ErrorEstimate:
    """Estimate the errors of a converged orbit, held on the arclength constraint across its tangent.

    Where the equations change at events, the multipliers depend on when these are, so on the orbit's own
    error: they are those of the better orbit, at the same parameter but about a fold.

    Parameters
    ----------
    linearise : callable
        The equations that the orbit is held against on the halved mesh, as `Discretisation.linearise` has
        them.
    problem : Problem
        What is solved.
    orbit : Orbit
        The converged orbit.
    tangent : Increment
        Tangent of the branch.
    spectrum : Spectrum
        The orbit's multipliers.
    only_at_points : ndarray of bool, shape (N, n), optional
        States that count at the orbit's mesh points alone, not between them.
    solved : callable, optional
        Linearises and solves in one; by default `periodic.correction.newton.linearised`, with `linearise`.
    kinked : bool, optional
        Whether the equations change at events; by default whether the mesh has event nodes.
    lengths : bool
        Whether the constraint holds the lengths of brief excursions too, as it does in steps: at a fold
        beside a touch these change far more along the branch than the states do.
    digits : float
        To how much of itself the parameter is known of which the effect on the multipliers is asked for: it
        is rounding.

    Returns
    -------
    ErrorEstimate
        Relative errors; infinite ones where the halved mesh cannot be solved on.
    """
    fine = bisect(orbit)
    onto = _onto(tangent, fine)
    onto = replace(onto, phases=tangent.phases) if lengths else onto
    across = ArclengthConstraint(fine, onto, 0.0, problem.units(fine), problem.index, size_of(orbit))
    closing = [*problem.side_conditions(fine), across]
    solve, shared = solved or partial(linearised, linearise), (problem.free, closing, USUAL)
    try:
        found = solve(problem.system, fine, *shared)
        beside = found
        if len(orbit.mesh.exact_ends) if kinked is None else kinked:
            onto_branch = found.increment + _along(found, problem, size_of(orbit))
            better = moved(problem.system, problem.free, found.orbit, onto_branch)
            beside = solve(problem.system, better, *shared)
        multiplier, unknown = spectrum.apart(beside.fundamental[-1], beside.operator), 0.0
        if digits:
            far = _last_digits(beside, problem, size_of(orbit), digits)
            other = solve(problem.system, moved(problem.system, problem.free, beside.orbit, far), *shared)
            unknown = _powers(spectrum, other.fundamental[-1], beside.fundamental[-1])
    except FAILURES:
        return UNKNOWN
    change = found.increment
    nodes = found.orbit.nodes - fine.nodes + change.nodes
    stages = found.orbit.stages - fine.stages + change.stages
    at_nodes = np.abs(at_fixed_phase(fine, nodes, change.phases))
    between = np.abs(stages - fine.knot_rates[:, 1:] * _stage_shift(fine, change.phases))
    if only_at_points is not None:
        at_nodes[1::2][only_at_points] = 0.0
        between *= ~np.repeat(only_at_points, 2, axis=0)[:, None]
    apart = float(max(at_nodes.max(), between.max()))
    monodromy = beside.fundamental[-1]
    halved = Halved(apart, abs(change.parameter), multiplier, found.fundamental, monodromy)
    error = relative(problem, orbit, spectrum, halved)
    if not unknown:
        return error
    rounding, by_orbit = error.rounding + unknown, error.by_orbit + unknown
    return replace(error, multiplier=error.multiplier + unknown, rounding=rounding, by_orbit=by_orbit)


@dataclass(frozen=True)
class Halved:
    """What the halved mesh says of an orbit: errors of its states, of the parameter and of the multipliers,
    its fundamental matrices, (2N+1, n, n), and the monodromy matrix of the better orbit."""

    apart: float
    shift: float
    multiplier: float
    fundamental: Array
    monodromy: Array


def relative(problem: Problem, orbit: Orbit, spectrum: Spectrum, found: Halved) -> ErrorEstimate:
    """Return the estimate that follows, of which as much is rounding as of the orbit's own error is."""
    largest = max(abs(problem.value(orbit)), SMALL * problem.scale)
    own, parameter = found.apart / max(orbit.span(), LEAST_SPAN), found.shift / largest
    by_orbit = _powers(spectrum, found.monodromy, found.fundamental[-1])
    rounding = by_orbit * min(1.0, BEST / max(own, parameter, BEST))
    sized = bool(problem.system.switches) and orbit.span() > LEAST_SPAN
    each = shares(spectrum.fundamental, found.fundamental) if sized else None
    return ErrorEstimate(own, found.multiplier, parameter, rounding, by_orbit, shares=each)


def _along(found: Linearised, problem: Problem, size: float) -> Increment:
    """The way along the branch from where a step across it leads to the orbit of the same parameter.

    None at a fold, where the orbit of the same parameter is far away, or there is none. The parameter is
    known to rounding alone, which beside a touch moves a contact: it is added to the way but at a fold.
    """
    kernel = found.kernel
    part = _part(found, problem, size)
    if part < TURNING:
        return kernel.scaled(0.0)
    shift, least = found.increment.parameter, LAST_DIGITS * abs(problem.value(found.orbit))
    near = abs(shift) < STRAIGHT * part**2 * problem.scale
    way = (shift if near else 0.0) + float(np.copysign(least, shift))
    return kernel.scaled(-way / kernel.parameter)


def _last_digits(found: Linearised, problem: Problem, size: float, digits: float) -> Increment:
    """The way along the branch by which a parameter that is known to so much of itself may be off, but at a
    fold."""
    kernel = found.kernel
    at_fold = _part(found, problem, size) < TURNING
    return kernel.scaled(0.0 if at_fold else digits * abs(problem.value(found.orbit)) / kernel.parameter)


def _part(found: Linearised, problem: Problem, size: float) -> float:
    """The part of the branch's direction that the parameter is."""
    kernel = found.kernel
    still = replace(kernel, phases=np.zeros_like(kernel.phases))  # lengths of excursions tell of no fold
    length = float(np.sqrt(still.dot(still, found.orbit, problem.units(found.orbit), size)))
    return abs(kernel.parameter) / (length * problem.scale)


def _powers(spectrum: Spectrum, one: Array, two: Array) -> float:
    """How far two monodromy matrices are apart in their multipliers, over the largest one."""
    return powers_apart(one / spectrum.radius, two / spectrum.radius)


def _stage_shift(orbit: Orbit, later: Array) -> Array:
    """How far the collocation points move in tau with the event nodes, shape (N, ncol, 1)."""
    grid, points = orbit.grid, orbit.mesh.scheme.points
    left, stretch = grid.left_gradient @ later, grid.width_gradient @ later
    return (left[:, None] + stretch[:, None] * points)[:, :, None]


def _onto(tangent: Increment, fine: Orbit) -> Increment:
    """What the arclength constraint needs of a tangent on the halved mesh."""
    coarse, blank = tangent.profile, parameter_only(fine, tangent.parameter)
    profile = np.empty_like(fine.nodes)
    profile[::2] = coarse
    profile[1::2] = (coarse[1:] + coarse[:-1]) / 2
    return Increment(blank.nodes, blank.stages, blank.algebraic, blank.phases, tangent.parameters, profile)


def shortfall(points: Sequence[tuple[float, ErrorEstimate]], tolerance: float, parameter: str) -> str:
    """Return a sentence on the points whose error estimates exceed a tolerance; an empty one if none does.

    Parameters
    ----------
    points : sequence of (float, ErrorEstimate)
        Parameter and errors of the points of a branch.
    tolerance : float
        Bound of their error estimates, relative.
    parameter : str
        Name of the continuation parameter.

    Returns
    -------
    str
        "3 of 139 points: multipliers to 1e-3 only, near Omega = 0.7107".
    """
    kinds = {
        "orbits": [error.motion for _, error in points],
        "multipliers": [SAFETY * error.multiplier for _, error in points],
    }
    missed = {
        kind: worst for kind, errors in kinds.items() if (worst := max(errors, default=0.0)) > tolerance
    }
    if not missed:
        return ""
    among = [value for value, error in points if error.worst > tolerance]
    worst = max(points, key=lambda point: point[1].worst)[0]
    low, high = min(among), max(among)
    where = f"near {parameter} = {worst:.6g}"
    if high - low > 1e-3 * max(abs(low), abs(high)):
        where = f"from {parameter} = {low:.6g} to {high:.6g}"
    reached = " and ".join(f"{kind} {_to(error)}" for kind, error in missed.items())
    return f"{len(among)} of {len(points)} points: {reached}, {where}"


def _to(error: float) -> str:
    """An error rounded up to a power of ten."""
    return f"to 1e{int(np.ceil(np.log10(error) - 1e-9)):d} only" if np.isfinite(error) else "not known"
