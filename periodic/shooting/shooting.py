"""Shooting, single and multiple: the orbit as trajectories of a trusted integrator that join.

It shares no equation with collocation and serves to check it. The mesh is only there to interpolate the
trajectory; the system's flow looks after the kinks, so nothing is tied to them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from periodic.checks import number, whole
from periodic.collocation.meshmethod import check_intervals, check_scheme, scheme_for
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import ErrorEstimate, Halving, deferred
from periodic.correction.newton import Correction
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.linear.bordering import Chain
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.refinement.demand import wanted_ntst
from periodic.refinement.equidistribution import redistribute
from periodic.shooting.flow import segment_maps
from periodic.stability.graded import spectrum_of
from periodic.stability.multipliers import Spectrum
from periodic.system import Flowing, System, check_continuous

TIGHTER = 0.1
"""Tolerance of the second integration, by which errors are estimated, as a part of the first one's."""

MARGIN = 1e-3
"""How far the integrator's tolerance must lie below that of the orbits: its errors add up over the period."""

LEAST_WIDTH = 1e-12
"""Breaks closer than this, as a part of the period, are one."""

NO_EVENTS = np.zeros(0)


@dataclass(frozen=True)
class Shooting(Discretisation):
    """phi(x_s) = x_{s+1}: trajectories that join, by a System with `flow` (see `periodic.system.Flowing`).

    Parameters
    ----------
    segments : int
        How many trajectories make up an orbit; more of them where perturbations grow strongly.
    tolerance : float
        Of the integrator, relative and absolute in scaled variables; at most 1e-3 times that of the orbits,
        and well below Newton's.
    scheme : Scheme, optional
        Points at which trajectories are kept in each interval; default as many as the tolerance asks for.
    ntst, ntst_min, ntst_max : int
        Intervals to begin with, fewest and most.
    orbits : float
        Tolerance that meshes are made for; set by the trace.

    References
    ----------
    Seydel, Practical Bifurcation and Stability Analysis, 7.5.
    """

    segments: int = 1
    tolerance: float = 1e-12
    scheme: Scheme | None = None
    ntst: int = 24
    ntst_min: int = 8
    ntst_max: int = 1000
    orbits: float = 1e-7

    def __post_init__(self) -> None:
        whole("segments", self.segments)
        check_scheme(self.scheme)
        if not 1e-12 <= number("tolerance", self.tolerance) <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-12 and 0.01")
        check_intervals(self.ntst, self.ntst_min, self.ntst_max)

    def at(self, tolerance: float) -> Shooting:
        """Return the method with a scheme for a tolerance. Raises ValueError if its own is too loose."""
        if self.tolerance > MARGIN * tolerance:
            raise ValueError(
                f"tolerance of Shooting is {self.tolerance:g}; for orbits to {tolerance:g} "
                f"it must be at most {MARGIN * tolerance:g}"
            )
        return replace(self, scheme=self.scheme or scheme_for(tolerance), orbits=tolerance)

    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the constant orbit at rest, or an orbit on a mesh without event nodes.

        Raises ValueError for a system without `flow`.
        """
        _flowing(system)
        scheme = self.scheme or Scheme()
        if near is None:
            return at_rest(system, uniform(scheme, self.ntst), parameter)
        period = near.mesh.period
        places = np.sort(np.mod(near.mesh.nodes(near.phases) / period, 1.0))
        breaks = np.concatenate([[0.0], places[(places > LEAST_WIDTH) & (places < 1 - LEAST_WIDTH)], [1.0]])
        breaks = breaks[np.append(True, np.diff(breaks) > LEAST_WIDTH)]
        mesh = Mesh(scheme, (breaks,), (), period)
        return replace(transfer(near, mesh, NO_EVENTS), parameter=parameter)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the conditions that the trajectories join, from a flow with its derivatives."""
        return Chain(segment_maps(_flowing(system), orbit, free, self.segments, self.tolerance))

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit interpolated onto the mesh."""
        yield transfer(orbit, mesh, phases)

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors, those of interpolation included, by a step with a tighter integration."""

        def tighter(system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
            tolerance = TIGHTER * self.tolerance
            return Chain(segment_maps(_flowing(system), orbit, free, self.segments, tolerance))

        how = Halving(kinked=bool(problem.system.switches))
        return deferred(tighter, problem, correction.orbit, tangent, spectrum, how)

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the multipliers, where motions grow by many decades from the segments one by one."""
        return spectrum_of(correction.fundamental, correction.operator, trivial, self.tolerance)

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Say how many intervals interpolate the orbit."""
        return ShootingRefinement(self, orbit, error)


class ShootingRefinement(Refinement):
    """Meshes that interpolate an orbit of `Shooting` to its tolerance."""

    def __init__(self, method: Shooting, orbit: Orbit, error: ErrorEstimate) -> None:
        super().__init__(orbit, error)
        self.method = method

    @property
    def exhausted(self) -> bool:
        """Whether the orbit has the largest number of intervals."""
        return self.orbit.mesh.ntst >= self.method.ntst_max

    def refined(self) -> Mesh:
        """Return the mesh that interpolates the orbit."""
        method, error = self.method, replace(self.error, multiplier=0.0)  # no mesh improves the multipliers
        limits = (method.ntst_min, method.ntst_max)
        ntst = wanted_ntst(self.orbit, error, method.orbits, *limits, self.orbit.mesh.ntst)
        return redistribute(self.orbit, ntst, (), NO_EVENTS, 0.005 * method.orbits)

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield that mesh."""
        yield self.refined(), NO_EVENTS


def _flowing(system: System) -> Flowing:
    if not hasattr(system, "flow"):
        raise ValueError(
            f"system is a {type(system).__name__} without flow, which shooting needs; "
            f"it must be a Flowing system (symbolic.compile makes one of a model)"
        )
    check_continuous("Shooting", system)
    return cast(Flowing, system)
