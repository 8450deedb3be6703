"""Harmonic balance: the quick method for smooth orbits, with as many harmonics as each needs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from periodic import balance, events, newton, rotation
from periodic.accuracy import LEAST_SPAN, UNKNOWN, ErrorEstimate
from periodic.anchors import Crossing
from periodic.closure import Closure, Plane, closures
from periodic.dense import algebraic_at
from periodic.fourier import NO_PHASES, FourierOrbit, harmonics_of, mesh_for, series, tail
from periodic.hill import Floquet, floquet
from periodic.mesh import Mesh
from periodic.newton import Correction, NewtonSettings, Outcome
from periodic.orbit import FORCED, Orbit, at_rest
from periodic.rotation import Turn
from periodic.scheme import Array
from periodic.settings import MeshSettings
from periodic.solve import on_mesh
from periodic.system import System

if TYPE_CHECKING:
    from periodic.solve import Solved, Task

AIM = 0.1
"""The part of the tolerance that a new number of harmonics aims at."""

ROUGHLY = 1e-4
"""Harmonics of a guess that are smaller, as a part of its peak to peak, are left to Newton."""

KNOWN = 1e-2
"""Error of the multipliers above which they tell no special points."""

HILL = 8
"""Fewest harmonics (of the excitation frequency) that Hill's method is given; the orbit's may be fewer."""

LEAST = 3
"""Fewest harmonics that an orbit is given, unless it begins with fewer."""


@dataclass(frozen=True)
class FourierCorrection(Correction):
    """A correction that knows Floquet's form of its fundamental matrices."""

    floquet: Floquet = field(kw_only=True)

    @classmethod
    def of(cls, found: Correction, form: Floquet, fundamental: Array) -> FourierCorrection:
        """Add it, and the fundamental matrices themselves, to a correction."""
        return cls(
            found.orbit,
            found.outcome,
            found.iterations,
            found.increment,
            found.residual,
            fundamental,
            found.kernel,
            floquet=form,
        )


def _where_known(test: events.Test) -> events.Test:
    """The test, believed where the multipliers are known well enough: those of few harmonics may jump."""

    def genuine(task: Task, solved: Solved) -> bool:
        return solved.error.multiplier < KNOWN and test.genuine(task, solved)

    return replace(test, genuine=genuine)


@dataclass(frozen=True, kw_only=True)
class HarmonicBalance:
    """See `periodic.methods.protocol.Method`. harmonics: of the excitation frequency, to begin with.

    They become fewer or more, up to `most`, as the tolerance asks for; with most = harmonics = H there are
    never more than H, and a tolerance that they do not meet is refused.
    """

    harmonics: int = 8
    most: int = 64
    passages = tuple(_where_known(test) for test in events.PASSAGES)
    branching = (_where_known(events.BRANCHING),)
    schemes = ()

    def __post_init__(self) -> None:
        for name in ("harmonics", "most"):
            value = getattr(self, name)
            if not (value >= 1 and float(value).is_integer()):
                raise ValueError(f"{name} is {value}; it must be a whole number of at least 1")
        if self.harmonics > self.most:
            raise ValueError(f"harmonics is {self.harmonics}; it must be at most most = {self.most}")

    def rest(self, system: System, settings: MeshSettings, parameter: Array) -> Orbit:
        """Return the constant orbit at the system's rest values."""
        mesh = mesh_for(self.harmonics, FORCED)
        return series(at_rest(system, mesh, parameter), mesh)

    def adopted(self, system: System, settings: MeshSettings, guess: Orbit, parameter: Array) -> Orbit:
        """Return a guess as a series of as many harmonics as it seems to need, at given parameters."""
        least, most = self.harmonics * guess.periods, self.most * guess.periods
        full = series(guess, mesh_for(most, guess.mesh.period))
        large = np.flatnonzero(full.amplitudes > ROUGHLY * max(full.span(), LEAST_SPAN))
        wanted = int(np.clip(1 + large.max(initial=0), least, most))
        fitted = series(full, mesh_for(wanted, guess.mesh.period))
        return _with_unknowns(system, replace(fitted, parameter=parameter))

    def correct(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        closures: Sequence[Closure],
        settings: NewtonSettings,
    ) -> Correction:
        """Solve for the orbit near `guess`; its fundamental matrices are Hill's."""
        found = newton.correct(system, guess, free, closures, settings, balance.increment)
        if found.outcome is not Outcome.CONVERGED:
            return found
        assert isinstance(found.orbit, FourierOrbit)
        try:
            form = floquet(system, _at_least(system, found.orbit, HILL * found.orbit.periods))
            return FourierCorrection.of(found, form, form.fundamental(found.orbit))
        except FloatingPointError:
            return replace(found, outcome=Outcome.NOT_FINITE)
        except np.linalg.LinAlgError:
            return replace(found, outcome=Outcome.SINGULAR)

    def estimate(self, task: Task, correction: Correction, plane: Plane) -> ErrorEstimate:
        """Estimate the errors by a Newton step with half as many harmonics again (deferred correction)."""
        assert isinstance(correction, FourierCorrection)
        orbit = correction.orbit
        more = harmonics_of(orbit.mesh) + max(4, harmonics_of(orbit.mesh) // 2)
        fine = _with_unknowns(task.system, series(orbit, mesh_for(more, orbit.mesh.period)))
        across = Plane(fine, on_mesh(plane.direction, orbit, fine), 0.0, plane.metric, plane.index)
        closing = [*closures(task.conditions, task.others, fine), across]
        step = balance.increment(task.system, fine, task.free, closing)
        if isinstance(step, Outcome):
            return UNKNOWN
        error = float(np.abs(step.stages).max()) / max(orbit.span(), LEAST_SPAN)
        factor = min(1.0, newton.MAX_CHANGE / max(step.length, np.finfo(float).tiny))
        better = newton.advance(task.system, step, task.free, factor)
        assert isinstance(better, FourierOrbit)
        try:
            multiplier = correction.floquet.error(task.system, better)
        except (FloatingPointError, np.linalg.LinAlgError):
            multiplier = np.inf
        return ErrorEstimate(error, multiplier)

    def wanted(self, task: Task, orbit: Orbit, error: ErrorEstimate) -> list[Crossing]:
        """Return no crossings: a series cannot be tied to them."""
        return []

    def genuine(self, system: System, orbit: Orbit) -> bool:
        """There is nothing that might not be genuine."""
        return True

    def exhausted(self, settings: MeshSettings, orbit: Orbit) -> bool:
        """Whether an orbit has the largest number of harmonics."""
        return harmonics_of(orbit.mesh) >= self.most * orbit.periods

    def shortfall(self, task: Task, solved: Solved) -> str:
        """Say how far the spectrum has fallen."""
        orbit = solved.orbit
        assert isinstance(orbit, FourierOrbit)
        left = tail(orbit, LEAST_SPAN)
        return (
            f"the spectrum's tail is {left:.1e} at {orbit.harmonics} harmonics (error estimate "
            f"{solved.error.motion:.1e}); the tolerance is {task.settings.mesh.tolerance:g}"
        )

    def meshes(self, task: Task, solved: Solved) -> Iterator[tuple[Mesh, Array]]:
        """Yield the mesh for the number of harmonics that the orbit needs."""
        yield self.mesh_for(task, solved), NO_PHASES

    def mesh_for(self, task: Task, new: Solved) -> Mesh:
        """Return the mesh for the number of harmonics that an orbit needs."""
        orbit = new.orbit
        assert isinstance(orbit, FourierOrbit)
        least, most = min(LEAST, self.harmonics) * orbit.periods, self.most * orbit.periods
        goal = AIM * task.settings.mesh.tolerance
        wanted = int(np.clip(needed(orbit, new.error.worst, goal), least, most))
        return mesh_for(wanted, orbit.mesh.period)

    def guesses(self, task: Task, old: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the series cut or filled up with zeros, its unknowns solved for."""
        yield _with_unknowns(task.system, series(old, mesh))

    def turned(self, base: Correction, new: Correction) -> Turn:
        """How far lightly damped pairs of multipliers turn."""
        return rotation.turned(base, new)


def needed(orbit: FourierOrbit, error: float, goal: float) -> int:
    """The number of harmonics that brings an error to its goal, if the spectrum falls on as it has fallen.

    From half to twice as many as there are.
    """
    present, amplitudes = orbit.harmonics, orbit.amplitudes
    if not np.isfinite(error):
        return 2 * present
    floor = np.finfo(float).tiny
    top, last = amplitudes.max(), max(float(amplitudes[-max(present // 4, min(2, present)) :].max()), floor)
    rate = max(float(np.log(max(top, floor) / last)) / present, 0.01)
    change = np.log(max(error, floor) / goal) / rate
    return int(np.ceil(np.clip(present + change, present / 2, 2 * present)))


def _at_least(system: System, orbit: FourierOrbit, harmonics: int) -> FourierOrbit:
    """The same orbit with at least so many harmonics, the further ones zero."""
    if orbit.harmonics >= harmonics:
        return orbit
    return _with_unknowns(system, series(orbit, mesh_for(harmonics, orbit.mesh.period)))


def _with_unknowns(system: System, orbit: FourierOrbit) -> FourierOrbit:
    """Solve for the unknowns at the samples."""
    unknowns = algebraic_at(system, orbit, orbit.stage_phases.ravel())
    return replace(orbit, algebraic=unknowns.reshape(orbit.algebraic.shape))
