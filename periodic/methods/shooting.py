"""Shooting, single and multiple: the orbit as trajectories of a trusted integrator that join.

It shares no equation with collocation and serves to check it. The mesh is only there to interpolate the
trajectory; the integrator's step control passes the kinks, so nothing is tied to them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from periodic import events, rotation, shooting
from periodic.accuracy import ErrorEstimate, estimate
from periodic.adapt import redistribute
from periodic.anchors import Crossing
from periodic.closure import Closure, Plane
from periodic.mesh import Mesh, uniform
from periodic.methods.collocation import wanted_ntst
from periodic.newton import Condense, Correction, NewtonSettings, correct, linear_step
from periodic.orbit import Orbit, at_rest, transfer
from periodic.rotation import Turn
from periodic.scheme import Array
from periodic.settings import MeshSettings
from periodic.system import Flowing, System

if TYPE_CHECKING:
    from periodic.solve import Solved, Task

TIGHTER = 0.1
"""Tolerance of the integration that an orbit is held against, as a part of its own."""

MARGIN = 1e-3
"""How far the integrator's tolerance must lie below that of the orbits: its errors add up over the period."""

APART = 1e-12
"""Breaks closer than this, as a part of the period, are one."""

NO_ANCHORS = np.zeros(0)


@dataclass(frozen=True)
class Shooting:
    """See `periodic.methods.protocol.Method`. The System must have `flow`: see `periodic.system.Flowing`.

    segments: how many trajectories make up an orbit; more of them where perturbations grow strongly.
    tolerance: of the integrator, relative and absolute in scaled variables; at most MARGIN times that of the
    orbits (`MeshSettings.tolerance`), and well below Newton's.
    """

    segments: int = 1
    tolerance: float = 1e-12
    passages = events.PASSAGES
    branching = (events.BRANCHING,)
    schemes = ()

    def __post_init__(self) -> None:
        if not (self.segments >= 1 and float(self.segments).is_integer()):
            raise ValueError(f"segments is {self.segments}; it must be a whole number of at least 1")
        if not 1e-12 <= self.tolerance <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-12 and 0.01")

    def rest(self, system: System, settings: MeshSettings, parameter: Array) -> Orbit:
        """Return the constant orbit at the system's rest values. Raises ValueError for one without `flow`."""
        self._check(system, settings)
        return at_rest(system, uniform(settings.scheme, settings.ntst), parameter)

    def adopted(self, system: System, settings: MeshSettings, guess: Orbit, parameter: Array) -> Orbit:
        """Return a guess on a mesh without anchors. Raises ValueError for a system without `flow`."""
        self._check(system, settings)
        period = guess.mesh.period
        places = np.sort(np.mod(guess.mesh.nodes(guess.phases) / period, 1.0))
        breaks = np.concatenate([[0.0], places[(places > APART) & (places < 1 - APART)], [1.0]])
        breaks = breaks[np.append(True, np.diff(breaks) > APART)]
        mesh = Mesh(settings.scheme, (breaks,), (), period)
        return replace(transfer(guess, mesh, NO_ANCHORS), parameter=parameter)

    def correct(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        closures: Sequence[Closure],
        settings: NewtonSettings,
    ) -> Correction:
        """Solve for the orbit near `guess`."""
        increment = partial(linear_step, condense=self._condense(self.tolerance))
        return correct(system, guess, free, closures, settings, increment)

    def estimate(self, task: Task, correction: Correction, plane: Plane) -> ErrorEstimate:
        """Estimate the errors, those of interpolation included, by a step with a tighter integration."""
        orbit, monodromy, tighter = correction.orbit, correction.monodromy, TIGHTER * self.tolerance
        condense = self._condense(tighter)
        return estimate(task.system, orbit, monodromy, plane, task.free, task.conditions, condense)

    def wanted(self, task: Task, orbit: Orbit, error: ErrorEstimate) -> list[Crossing]:
        """Return no crossings."""
        return []

    def genuine(self, system: System, orbit: Orbit) -> bool:
        """Nothing to lose."""
        return True

    def exhausted(self, settings: MeshSettings, orbit: Orbit) -> bool:
        """Whether an orbit has the largest number of intervals."""
        return orbit.mesh.ntst >= settings.ntst_max

    def shortfall(self, task: Task, solved: Solved) -> str:
        """Return error estimate and number of intervals."""
        return f"error estimate {solved.error.motion:.1e} with {solved.orbit.mesh.ntst} intervals"

    def meshes(self, task: Task, solved: Solved) -> Iterator[tuple[Mesh, Array]]:
        """Yield the mesh that interpolates the orbit to its tolerance."""
        yield self.mesh_for(task, solved), NO_ANCHORS

    def mesh_for(self, task: Task, new: Solved) -> Mesh:
        """Return the mesh that interpolates an orbit to its tolerance."""
        ntst = wanted_ntst(task, new.orbit, replace(new.error, multiplier=0.0))  # no mesh betters multipliers
        return redistribute(new.orbit, ntst, (), NO_ANCHORS, task.settings.mesh.shortest)

    def guesses(self, task: Task, old: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit interpolated onto the mesh."""
        yield transfer(old, mesh, phases)

    def turned(self, base: Correction, new: Correction) -> Turn:
        """How far lightly damped pairs of multipliers turn."""
        return rotation.turned(base, new)

    def _check(self, system: System, settings: MeshSettings) -> None:
        _flowing(system)
        if self.tolerance > MARGIN * settings.tolerance:
            raise ValueError(
                f"tolerance of Shooting is {self.tolerance:g}; for orbits to {settings.tolerance:g} "
                f"it must be at most {MARGIN * settings.tolerance:g}"
            )

    def _condense(self, tolerance: float) -> Condense:
        def condense(system: System, orbit: Orbit, free: tuple[int, ...]) -> shooting.Condensed:
            return shooting.condense(_flowing(system), orbit, free, self.segments, tolerance)

        return condense


def _flowing(system: System) -> Flowing:
    if not hasattr(system, "flow"):
        raise ValueError(
            f"system is a {type(system).__name__} without flow, which shooting needs; "
            f"it must be a Flowing system (symbolic.compile makes one of a model)"
        )
    return cast(Flowing, system)
