"""Harmonic balance, fast for smooth orbits; the number of harmonics adapts to each orbit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from periodic.checks import whole
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import UNKNOWN, ErrorEstimate
from periodic.correction.newton import USUAL, Correction, Equations, Linearise, moved
from periodic.correction.outcome import FAILURES, outcome_of
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.harmonic.balance import Balance, sampled
from periodic.harmonic.hill import FloquetForm, floquet
from periodic.harmonic.kinked import beside, has_kinks
from periodic.harmonic.series import NO_PHASES, FourierOrbit, harmonics_of, mesh_for, series, tail
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import FORCED, LEAST_SPAN, Orbit
from periodic.orbit.scheme import Array
from periodic.orbit.shallow import shallow
from periodic.refinement.demand import AIM
from periodic.stability.multipliers import Spectrum
from periodic.system import System, check_continuous
from periodic.system.precision import SMALLEST

WAYS = (1.0, 0.5, 0.25)
"""Parts of the way from the present to the needed number of harmonics, tried in turn."""

ROUGHLY = 1e-4
"""A guess omits harmonics that are smaller than this part of its peak to peak."""

KNOWN = 1e-2
"""Error of the multipliers above which they locate no special points; few harmonics make them jump."""

HILL = 8
"""Least number of harmonics (of the excitation frequency) in Hill's method; the orbit may have fewer."""

LEAST_HARMONICS = 3
"""Least number of harmonics of an orbit, unless it begins with fewer."""


@dataclass(frozen=True)
class FourierCorrection(Correction):
    """A corrected orbit with Floquet's form of its fundamental matrices."""

    floquet: FloquetForm = field(kw_only=True)


@dataclass(frozen=True, kw_only=True)
class HarmonicBalance(Discretisation):
    """Fourier series x = a_0 + sum_k a_k cos k w tau + b_k sin k w tau, their residual projected on the same.

    Parameters
    ----------
    harmonics : int
        Their initial number, of the excitation frequency; it is adapted to the tolerance.
    most : int
        The largest number; with most = harmonics = H a tolerance that H harmonics do not meet is refused.
    tolerance : float
        Tolerance to which their number is adapted; set by the trace.

    References
    ----------
    Krack & Gross, Harmonic Balance for Nonlinear Vibration Problems, 2019.
    """

    harmonics: int = 8
    most: int = 64
    tolerance: float = 1e-7

    def __post_init__(self) -> None:
        for name in ("harmonics", "most"):
            whole(name, getattr(self, name))
        if self.harmonics > self.most:
            raise ValueError(f"harmonics is {self.harmonics}; it must be at most most = {self.most}")

    @property
    def trusted(self) -> float:
        """Error of the multipliers above which they locate no special points."""
        return KNOWN

    def at(self, tolerance: float) -> HarmonicBalance:
        """Return it with as many harmonics as a tolerance will ask for."""
        return replace(self, tolerance=tolerance)

    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the constant orbit at rest, or a series of as many harmonics as an orbit seems to need."""
        check_continuous("HarmonicBalance", system)
        if near is None:
            mesh = mesh_for(self.harmonics, FORCED)
            return series(at_rest(system, mesh, parameter), mesh)
        least, most = self.harmonics * near.periods, self.most * near.periods
        full = series(near, mesh_for(most, near.mesh.period))
        large = np.flatnonzero(full.amplitudes > ROUGHLY * max(full.span(), LEAST_SPAN))
        wanted = int(np.clip(1 + large.max(initial=0), least, most))
        fitted = series(full, mesh_for(wanted, near.mesh.period))
        return with_unknowns(system, replace(fitted, parameter=parameter))

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the balanced equations."""
        return Balance(_series(orbit), sampled(system, _series(orbit), free))

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return it with its fundamental matrices by Hill's method, or as failed where there are none."""
        orbit = _series(correction.orbit)
        try:
            form = floquet(system, _at_least(system, orbit, HILL * orbit.periods))
            fundamental = form.fundamental(orbit)
        except FAILURES as error:
            return replace(correction, outcome=outcome_of(error))
        return FourierCorrection(**{**shallow(correction), "fundamental": fundamental, "floquet": form})

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the series cut or filled up with zeros, its unknowns solved for."""
        yield with_unknowns(system, series(orbit, mesh))

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by a Newton step with 3/2 times the harmonics (deferred correction).

        Where the equations have kinks: by a step on a mesh with event nodes at them.
        """
        assert isinstance(correction, FourierCorrection)
        system, orbit = problem.system, correction.orbit
        if has_kinks(system):
            return beside(problem, _series(orbit), tangent, spectrum, self.tolerance)
        more = harmonics_of(orbit.mesh) + max(4, harmonics_of(orbit.mesh) // 2)
        fine = with_unknowns(system, series(orbit, mesh_for(more, orbit.mesh.period)))
        try:
            error, better = finer(self.linearise, problem, orbit, fine, tangent)
        except FAILURES:
            return UNKNOWN
        try:
            multiplier = correction.floquet.error(system, _series(better))
        except FAILURES:
            multiplier = np.inf
        return ErrorEstimate(error, multiplier)

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Say how many harmonics the orbit needs."""
        return FourierRefinement(self, _series(orbit), error)


def finer(
    linearise: Linearise, problem: Problem, orbit: Orbit, fine: Orbit, tangent: Increment
) -> tuple[float, Orbit]:
    """Return the error and a better orbit, by a Newton step with more harmonics. Raises FAILURES."""
    direction = tangent.restricted(orbit, fine)
    arclength = ArclengthConstraint(fine, direction, 0.0, problem.units(fine), problem.index)
    closing = [*problem.side_conditions(fine), arclength]
    step = Equations(linearise, problem.system, problem.free, closing).step(fine)
    factor = USUAL.max_change / max(step.length, USUAL.max_change)
    error = float(np.abs(step.increment.stages).max()) / max(orbit.span(), LEAST_SPAN)
    return error, moved(problem.system, problem.free, fine, step.increment, factor)


class FourierRefinement(Refinement):
    """Numbers of harmonics for an orbit of `HarmonicBalance`."""

    def __init__(self, method: HarmonicBalance, orbit: FourierOrbit, error: ErrorEstimate) -> None:
        super().__init__(orbit, error)
        self.method, self.series = method, orbit

    @property
    def exhausted(self) -> bool:
        """Whether the orbit has the largest number of harmonics."""
        return self.series.harmonics >= self.method.most * self.series.periods

    @property
    def shortfall(self) -> str:
        """The sentence that says how far the spectrum has decayed."""
        left = tail(self.series, LEAST_SPAN)
        return (
            f"the spectrum's tail is {left:.1e} at {self.series.harmonics} harmonics (error estimate "
            f"{self.error.motion:.1e}); the tolerance is {self.method.tolerance:g}"
        )

    @property
    def _wanted(self) -> int:
        method, orbit = self.method, self.series
        least, most = min(LEAST_HARMONICS, method.harmonics) * orbit.periods, method.most * orbit.periods
        return int(np.clip(needed(orbit, self.error.worst, AIM * method.tolerance), least, most))

    def refined(self) -> Mesh:
        """Return the mesh for the number of harmonics that the orbit needs."""
        return mesh_for(self._wanted, self.series.mesh.period)

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield that mesh, then meshes with numbers of harmonics between the present one and that."""
        present, wanted = self.series.harmonics, self._wanted
        for part in WAYS:
            count = present + round(part * (wanted - present))
            if count != present or part == 1:
                yield mesh_for(count, self.series.mesh.period), NO_PHASES


def _series(orbit: Orbit) -> FourierOrbit:
    if not isinstance(orbit, FourierOrbit):
        raise ValueError(
            f"orbit is a {orbit!r}; harmonic balance needs the guess that its `guess` makes of it"
        )
    return orbit


def needed(orbit: FourierOrbit, error: float, goal: float) -> int:
    """The number of harmonics that brings an error to its goal, if the spectrum decays on at the same rate.

    From half to twice as many as there are.
    """
    present, amplitudes = orbit.harmonics, orbit.amplitudes
    if not np.isfinite(error):
        return 2 * present
    floor = SMALLEST
    top, last = amplitudes.max(), max(float(amplitudes[-max(present // 4, min(2, present)) :].max()), floor)
    rate = max(float(np.log(max(top, floor) / last)) / present, 0.01)
    change = np.log(max(error, floor) / goal) / rate
    return int(np.ceil(np.clip(present + change, present / 2, 2 * present)))


def _at_least(system: System, orbit: FourierOrbit, harmonics: int) -> FourierOrbit:
    """The same orbit with at least a given number of harmonics, those added zero."""
    if orbit.harmonics >= harmonics:
        return orbit
    return with_unknowns(system, series(orbit, mesh_for(harmonics, orbit.mesh.period)))


def with_unknowns(system: System, orbit: FourierOrbit) -> FourierOrbit:
    """Solve for the unknowns at the samples."""
    unknowns = algebraic_at(system, orbit, orbit.stage_phases.ravel())
    return replace(orbit, algebraic=unknowns.reshape(orbit.algebraic.shape))
