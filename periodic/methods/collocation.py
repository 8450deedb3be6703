"""Orthogonal collocation on meshes tied to the kinks of the motion: the method for every orbit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from periodic import anchors, events, rotation
from periodic.accuracy import ErrorEstimate, estimate
from periodic.adapt import redistribute
from periodic.anchors import Crossing
from periodic.closure import Closure, Plane
from periodic.mesh import Mesh, uniform
from periodic.newton import Correction, NewtonSettings, correct
from periodic.orbit import Orbit, at_rest, transfer
from periodic.relax import relax
from periodic.rotation import Turn
from periodic.scheme import Array, Family, Scheme
from periodic.settings import DEEPEST, MeshSettings
from periodic.system import System

if TYPE_CHECKING:
    from periodic.solve import Solved, Task

AIM = 0.25
"""The part of the tolerance that a new mesh aims at."""

ASIDE = (1.0, 0.0, 10.0)
"""How far before its kink an anchor begins on a new mesh (rad), in tolerances; tried in turn."""

SHALLOWER = (10.0, 100.0)
"""How much shallower anchors are tried where a new mesh fails."""


@dataclass(frozen=True)
class Collocation:
    """See `periodic.methods.protocol.Method`; scheme and mesh are chosen by the settings."""

    passages = events.PASSAGES
    branching = (events.BRANCHING,)
    schemes = (Scheme(Family.RADAU, 5), Scheme(Family.GAUSS, 4), Scheme(Family.RADAU, 3))

    def rest(self, system: System, settings: MeshSettings, parameter: Array) -> Orbit:
        """Return the constant orbit at the system's rest values."""
        return at_rest(system, uniform(settings.scheme, settings.ntst), parameter)

    def adopted(self, system: System, settings: MeshSettings, guess: Orbit, parameter: Array) -> Orbit:
        """Return a guess in the settings' scheme, its hard intervals solved locally."""
        if guess.equilibrium:
            guess = transfer(guess, uniform(settings.scheme, settings.ntst), guess.phases)
        old = guess.mesh
        mesh = Mesh(settings.scheme, old.breaks, old.anchors, old.period)
        adopted = replace(transfer(guess, mesh, guess.phases), parameter=parameter, equilibrium=False)
        return relax(system, adopted)

    def correct(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        closures: Sequence[Closure],
        settings: NewtonSettings,
    ) -> Correction:
        """Solve for the orbit near `guess`."""
        return correct(system, guess, free, closures, settings)

    def estimate(self, task: Task, correction: Correction, plane: Plane) -> ErrorEstimate:
        """Estimate the errors by a Newton step on the halved mesh."""
        return estimate(
            task.system, correction.orbit, correction.monodromy, plane, task.free, task.conditions
        )

    def wanted(self, task: Task, orbit: Orbit, error: ErrorEstimate) -> list[Crossing]:
        """Return the crossings to tie the mesh to, at levels that the orbit is accurate enough for."""
        settings, meaningful = task.settings.mesh.anchors, DEEPEST * min(error.orbit, 1.0)
        deepest = max(settings.deepest, meaningful)
        return anchors.wanted(task.system, orbit, replace(settings, deepest=deepest))

    def genuine(self, system: System, orbit: Orbit) -> bool:
        """Whether every anchor is a crossing in its own direction."""
        return anchors.genuine(system, orbit)

    def exhausted(self, settings: MeshSettings, orbit: Orbit) -> bool:
        """Whether an orbit has the largest number of intervals."""
        return orbit.mesh.ntst >= settings.ntst_max

    def shortfall(self, task: Task, solved: Solved) -> str:
        """Return error estimate and number of intervals."""
        return f"error estimate {solved.error.motion:.1e} with {solved.orbit.mesh.ntst} intervals"

    def meshes(self, task: Task, solved: Solved) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes with the right anchors and number of intervals, then with shallower anchors."""
        old, shortest = solved.orbit, task.settings.mesh.shortest
        for chosen in _choices(task, solved):
            tied, phases = anchors.placed(task.system, old, chosen)
            yield (
                redistribute(old, wanted_ntst(task, solved.orbit, solved.error), tied, phases, shortest),
                phases,
            )

    def mesh_for(self, task: Task, new: Solved) -> Mesh:
        """Return a mesh with intervals where the orbit needs them, and its present anchors."""
        orbit, shortest = new.orbit, task.settings.mesh.shortest
        return redistribute(
            orbit, wanted_ntst(task, orbit, new.error), orbit.mesh.anchors, orbit.phases, shortest
        )

    def guesses(self, task: Task, old: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit with its anchors a little before their kinks, where they are well defined.

        Past its kink a switch hardly changes, and Newton has nothing to hold on to.
        """
        deep = np.array([a.direction if a.level > 0 else 0.0 for a in mesh.anchors])
        for aside in ASIDE if deep.any() else (0.0,):
            shifted = phases + aside * task.settings.mesh.tolerance * deep
            yield relax(task.system, transfer(old, mesh, shifted))

    def turned(self, base: Correction, new: Correction) -> Turn:
        """How far lightly damped pairs of multipliers turn."""
        return rotation.turned(base, new)


def _choices(task: Task, solved: Solved) -> Iterator[list[Crossing]]:
    yield solved.wanted
    settings = task.settings.mesh.anchors
    levels = [c.anchor.level for c in solved.wanted if c.anchor.level > 0]
    for factor in SHALLOWER if levels else ():
        shallower = replace(settings, deepest=factor * min(levels))
        yield anchors.wanted(task.system, solved.orbit, shallower)


def wanted_ntst(task: Task, orbit: Orbit, error: ErrorEstimate) -> int:
    """The number of intervals that brings the error estimate to its aim."""
    mesh = task.settings.mesh
    order = mesh.scheme.ncol + 1
    ratio = error.worst / (AIM * mesh.tolerance) if np.isfinite(error.worst) else 4.0**order
    factor = float(np.clip(ratio, 2.0**-order, 2.5**order)) ** (1 / order)
    return int(np.clip(np.ceil(factor * orbit.mesh.ntst), mesh.ntst_min, mesh.ntst_max))
