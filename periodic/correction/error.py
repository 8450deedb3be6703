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
from periodic.correction.newton import Equations, Linearise, LinearisedEquations, moved, stretched
from periodic.correction.outcome import FAILURES
from periodic.correction.problem import Problem
from periodic.linear.unknowns import Increment, at_fixed_phase, parameter_only, size_of
from periodic.orbit.construction import bisect
from periodic.orbit.orbit import LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Spectrum
from periodic.stability.multipliers import apart as powers_apart
from periodic.stability.shares import shares
from periodic.system.precision import EPSILON

Solved = Callable[[Equations, Orbit], LinearisedEquations]
"""A function that linearises equations at an orbit and solves them; raises FAILURES."""

AT_WORST = 30.0
"""Factor by which an error may exceed its estimate, for instance where other errors are far larger."""

SAFETY = 3.0
"""Factor by which error estimates must be below a tolerance: beside kinks they are only approximate."""


@dataclass(frozen=True)
class ErrorEstimate:
    """Relative errors of an orbit, as estimated.

    Parameters
    ----------
    orbit : float
        Largest error of the states over their largest peak to peak.
    multiplier : float
        Error of the sums of the Floquet multipliers and of their squares, relative to the largest one where
        that exceeds 1. The error of a multiplier at a distance d < 1 from the next one may be 2/d times as
        large, as it is where two of them meet.
    parameter : float
        Relative error of the continuation parameter in the plane normal to the branch; so that of an LP.
    rounding : float
        Approximate part of the multipliers' error that is due to rounding of the states.
    by_orbit : float
        Part of the multipliers' error that is due to the orbit's own, where the equations change at events.
    shares : ndarray, shape (N,), optional
        Contributions of the intervals to the rest of the multipliers' error, relative to each other.
    peaks : float
        Largest error of an output's minimum or maximum over its peak to peak, of outputs that are no states:
        a steep function of the states, as the load of a contact is, has a larger error than they have. NaN
        where it is not known. No mesh is refined for it.
    better : callable, optional
        Returns the better orbit, on the halved mesh, with whose outputs `peaks` is computed.
    """

    orbit: float
    multiplier: float
    parameter: float = 0.0
    rounding: float = field(default=0.0, compare=False)
    by_orbit: float = field(default=0.0, compare=False)
    shares: Array | None = field(default=None, compare=False, repr=False, kw_only=True)
    peaks: float = field(default=np.nan, compare=False, kw_only=True)
    better: Callable[[], Orbit] | None = field(default=None, compare=False, repr=False, kw_only=True)

    @property
    def motion(self) -> float:
        """The error that is compared with the tolerance, without that of the multipliers."""
        return SAFETY * max(self.orbit, self.parameter)

    def blur(self, value: float, scale: float) -> float:
        """Return the error of a value of the parameter.

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
        return SAFETY * self.parameter * unit_of(value, scale)

    @property
    def worst(self) -> float:
        """The error that is compared with the tolerance, that of the multipliers included."""
        return max(self.motion, SAFETY * self.multiplier)

    @property
    def curable(self) -> float:
        """`worst` without an error of the multipliers that no finer mesh reduces."""
        return self.worst if self.multiplier > SAFETY * self.rounding else self.motion

    @property
    def spread(self) -> float:
        """`worst` without the contributions of single intervals to the multipliers' error."""
        return max(self.motion, SAFETY * self.by_orbit)


EXACT = ErrorEstimate(0.0, 0.0)
"""Errors of an orbit that is not discretised."""

UNKNOWN = ErrorEstimate(np.inf, np.inf, np.inf)
"""Errors that could not be estimated."""


LEAST_VALUE = 0.1
"""Least value of a parameter, as a part of its range, to which its error is relative."""


def unit_of(value: float, scale: float) -> float:
    """To what the error of a parameter is relative: its value, or a part of its range where that is more."""
    return max(abs(value), LEAST_VALUE * scale)


BEST = 2e-12
"""Relative error of an orbit that rounding may leave; beside a grazing it is far more in the multipliers."""

LAST_DIGITS = 4 * EPSILON
"""Relative rounding error of a parameter."""

REACH = 0.1
"""Arclength along a branch within which the orbit of the same parameter is sought."""

STRAIGHT = 2.0
"""Largest factor by which d parameter / d arclength may change on the way there: else a fold is near."""


@dataclass(frozen=True, kw_only=True)
class Halving:
    """Settings of `deferred` that depend on the method.

    Parameters
    ----------
    only_at_points : ndarray of bool, shape (N, n), optional
        States that count at the orbit's mesh points alone, not between them.
    solved : callable, optional
        Linearises and solves in one; by default `Equations.solved`.
    kinked : bool, optional
        Whether the equations change at events; by default whether the mesh has event nodes.
    lengths : bool
        Whether the constraint holds the lengths of brief excursions too, as it does in steps: at a fold
        beside a grazing these change far more along the branch than the states do.
    digits : float
        Relative rounding error of the parameter, whose effect on the multipliers is added to their error and
        to its rounding; 0 for none.
    """

    only_at_points: NDArray[np.bool_] | None = None
    solved: Solved = Equations.solved
    kinked: bool | None = None
    lengths: bool = False
    digits: float = 0.0


def deferred(
    linearise: Linearise,
    problem: Problem,
    orbit: Orbit,
    tangent: Increment,
    spectrum: Spectrum,
    how: Halving | None = None,
) -> ErrorEstimate:
    """Estimate the errors of a converged orbit, held in the plane normal to the branch's tangent.

    Where the equations change at events, the multipliers depend on the events' phases, so on the orbit's own
    error: they are compared with those of the better orbit, at the same parameter except near a fold.

    Parameters
    ----------
    linearise : callable
        Returns the linearised equations on the halved mesh, as `Discretisation.linearise` does.
    problem : Problem
        What is solved.
    orbit : Orbit
        The converged orbit.
    tangent : Increment
        Tangent of the branch.
    spectrum : Spectrum
        The orbit's multipliers.
    how : Halving, optional
        Settings that depend on the method.

    Returns
    -------
    ErrorEstimate
        Relative errors; infinite ones where the equations on the halved mesh cannot be solved.
    """
    how, fine = how or Halving(), bisect(orbit)
    onto = _onto(tangent, fine)
    onto = replace(onto, phases=tangent.phases) if how.lengths else onto
    across = ArclengthConstraint(fine, onto, 0.0, problem.units(fine), problem.index, size_of(orbit))
    closing = [*problem.side_conditions(fine), across]
    equations = Equations(linearise, problem.system, problem.free, closing)
    on_branch = _OnBranch(problem, partial(how.solved, equations), size_of(orbit))
    try:
        found = on_branch.solve(fine)
        beside = found
        if len(orbit.mesh.exact_ends) if how.kinked is None else how.kinked:
            beside = on_branch.at_same_parameter(found)
        multiplier, unknown = spectrum.apart(beside.fundamental[-1], beside.operator), 0.0
        if how.digits:
            other = on_branch.beyond(beside, how.digits * abs(problem.value(beside.orbit)))
            unknown = _powers(spectrum, other.fundamental[-1], beside.fundamental[-1])
    except FAILURES:
        return UNKNOWN
    change = found.increment
    nodes = found.orbit.nodes - fine.nodes + change.nodes
    stages = found.orbit.stages - fine.stages + change.stages
    at_nodes = np.abs(at_fixed_phase(fine, nodes, change.phases))
    between = np.abs(stages - fine.knot_rates[:, 1:] * _stage_shift(fine, change.phases))
    if how.only_at_points is not None:
        at_nodes[1::2][how.only_at_points] = 0.0
        between *= ~np.repeat(how.only_at_points, 2, axis=0)[:, None]
    apart = float(max(at_nodes.max(), between.max()))
    monodromy = beside.fundamental[-1]
    halved = Halved(apart, abs(change.parameter), multiplier, found.fundamental, monodromy)
    better = partial(moved, problem.system, problem.free, found.orbit, change)
    error = relative(problem, orbit, spectrum, halved, None if problem.wider else better)
    if not unknown:
        return error
    rounding, by_orbit = error.rounding + unknown, error.by_orbit + unknown
    return replace(error, multiplier=error.multiplier + unknown, rounding=rounding, by_orbit=by_orbit)


@dataclass(frozen=True)
class Halved:
    """Results on the halved mesh: errors of an orbit's states, of the parameter and of the multipliers, the
    orbit's fundamental matrices, (2N+1, n, n), and the monodromy matrix of the better orbit."""

    apart: float
    shift: float
    multiplier: float
    fundamental: Array
    monodromy: Array


def relative(
    problem: Problem,
    orbit: Orbit,
    spectrum: Spectrum,
    found: Halved,
    better: Callable[[], Orbit] | None = None,
) -> ErrorEstimate:
    """Return the estimate; rounding has the same part in `by_orbit` as in the orbit's own error."""
    largest = unit_of(problem.value(orbit), problem.scale)
    own, parameter = found.apart / max(orbit.span(), LEAST_SPAN), found.shift / largest
    by_orbit = _powers(spectrum, found.monodromy, found.fundamental[-1])
    rounding = by_orbit * min(1.0, BEST / max(own, parameter, BEST))
    sized = bool(problem.system.switches) and orbit.span() > LEAST_SPAN
    each = shares(spectrum.fundamental, found.fundamental) if sized else None
    return ErrorEstimate(own, found.multiplier, parameter, rounding, by_orbit, shares=each, better=better)


@dataclass(frozen=True)
class _OnBranch:
    """The equations linearised again, at more accurate orbits of the branch.

    Beside a fold the orbit at the same parameter is far away, or there is none. The arclength to it is the
    change of parameter over d parameter / d arclength. It is followed where it is short and this rate changes
    little on the way; near grazing the rate may be small without a fold, as orbits change much with the
    parameter.
    """

    problem: Problem
    solve: Callable[[Orbit], LinearisedEquations]
    size: float

    def at_same_parameter(self, found: LinearisedEquations) -> LinearisedEquations:
        """Return them at the better orbit at the same parameter; near a fold at the nearest. Raises FAILURES.

        Rounding of the parameter, which near grazing moves the ends of a contact, is added to the change of
        parameter, with the sign for which lengths of excursions change more.
        """
        shift = found.increment.parameter
        least = float(np.copysign(LAST_DIGITS * abs(self.problem.value(found.orbit)), shift))
        for far in (shift, 0.0):
            both = (self._along(found, -(far + rounding)) for rounding in (least, -least))
            ways = [found.increment + way for way in both if way is not None]
            there = self._there(found, max(ways, key=partial(stretched, found.orbit))) if ways else None
            if there is not None:
                return there
        return self.solve(self._moved(found, found.increment))

    def beyond(self, found: LinearisedEquations, way: float) -> LinearisedEquations:
        """Return them at a parameter that is larger by `way`; near a fold, where none is found, `found`."""
        along = self._along(found, way)
        there = None if along is None else self._there(found, along)
        return found if there is None else there

    def _along(self, found: LinearisedEquations, way: float) -> Increment | None:
        """The increment along the branch by which the parameter changes by `way`; None where that is far.

        An increment that changes an excursion by more than its length is also far.
        """
        kernel = found.kernel
        if not self._length(found) * abs(way) <= REACH * abs(kernel.parameter) > 0:
            return None
        along = kernel.scaled(way / kernel.parameter)
        return along if stretched(found.orbit, along) <= 1 else None

    def _there(self, found: LinearisedEquations, way: Increment) -> LinearisedEquations | None:
        """The equations at the end of a way; None where the branch is not straight on it."""
        try:
            there = self.solve(self._moved(found, way))
        except FAILURES:
            return None
        straight = 1 / STRAIGHT < there.kernel.parameter / found.kernel.parameter < STRAIGHT
        return there if straight else None

    def _moved(self, found: LinearisedEquations, by: Increment) -> Orbit:
        return moved(self.problem.system, self.problem.free, found.orbit, by)

    def _length(self, found: LinearisedEquations) -> float:
        """Arclength of the kernel, lengths of excursions left out: their changes do not indicate a fold."""
        kernel = found.kernel
        still = replace(kernel, phases=np.zeros_like(kernel.phases))
        return float(np.sqrt(still.dot(still, found.orbit, self.problem.units(found.orbit), self.size)))


def _powers(spectrum: Spectrum, one: Array, two: Array) -> float:
    """Distance of two monodromy matrices in the powers of their multipliers, over the largest multiplier."""
    return powers_apart(one / spectrum.radius, two / spectrum.radius)


def _stage_shift(orbit: Orbit, later: Array) -> Array:
    """How far the collocation points move in tau with the event nodes, shape (N, ncol, 1)."""
    grid, points = orbit.grid, orbit.mesh.scheme.points
    left, stretch = grid.left_gradient @ later, grid.width_gradient @ later
    return (left[:, None] + stretch[:, None] * points)[:, :, None]


def _onto(tangent: Increment, fine: Orbit) -> Increment:
    """The parts of a tangent that the arclength constraint needs, on the halved mesh."""
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
