"""The error of a Fourier series where the equations have kinks.

Samples miss an excursion past a kink that lies between them, and the spectrum decays by a power of the
harmonic only. So the series is put on a mesh with event nodes at all its crossings, those between samples
included, and one Newton step of the collocation equations there estimates its distance from the orbit.
"""

from __future__ import annotations

from dataclasses import replace

from periodic.collocation.collocation import Collocation
from periodic.correction.error import ErrorEstimate, deferred
from periodic.correction.problem import Problem
from periodic.events.eventnodes import exact_crossings, placed
from periodic.events.modes import bends
from periodic.harmonic.series import NO_PHASES, FourierOrbit
from periodic.linear.unknowns import Increment
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.refinement.equidistribution import redistribute
from periodic.stability.multipliers import Spectrum
from periodic.system import System


def has_kinks(system: System) -> bool:
    """Whether the equations have kinks that a mesh can be tied to."""
    return bool(bends(system))


def beside(
    problem: Problem, orbit: FourierOrbit, tangent: Increment, spectrum: Spectrum, tolerance: float
) -> ErrorEstimate:
    """Estimate the errors of a series by a step of collocation on a mesh that is tied to its kinks."""
    system, method = problem.system, Collocation().at(tolerance)
    free = uniform(method.scheme or Scheme(), orbit.mesh.ntst, orbit.mesh.period)
    pieces = _on(system, orbit, free, NO_PHASES)
    crossings = sorted(exact_crossings(system, pieces), key=lambda crossing: crossing.phase)
    events, phases = placed(system, pieces, crossings) if crossings else ((), NO_PHASES)
    tied = _on(system, orbit, redistribute(pieces, free.ntst, events, phases, method.shortest), phases)
    return deferred(method.linearise, problem, tied, tangent.restricted(orbit, tied), spectrum)


def _on(system: System, orbit: FourierOrbit, mesh: Mesh, phases: Array) -> Orbit:
    """The series as a piecewise polynomial, its unknowns solved for."""
    pieces = transfer(orbit, mesh, phases)
    unknowns = algebraic_at(system, pieces, pieces.stage_phases.ravel())
    return replace(pieces, algebraic=unknowns.reshape(pieces.algebraic.shape))
