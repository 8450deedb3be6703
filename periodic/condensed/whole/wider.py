"""Orbits with all states, of systems that were condensed to the nonlinear places of their equations."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from periodic.condensed.modal.response import Response
from periodic.orbit.algebraic import algebraic_at
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System, Within


@dataclass(frozen=True)
class WholeSystem:
    """See `periodic.correction.problem.Wider`.

    Parameters
    ----------
    split : Within
        The condensed system, which is solved; its states are some of the whole system's.
    """

    split: Within

    @property
    def system(self) -> System:
        """The system with all states."""
        return self.split.whole

    def expanded(self, orbit: Orbit) -> Orbit:
        """Return an orbit with all states, which follow from the forces exactly."""
        split, part = self.split, self.split.linear
        assert part is not None
        modes, mesh = split.everything(orbit.parameter), orbit.mesh
        forces = np.ascontiguousarray(orbit.algebraic[:, :, list(part.forces)])
        stages = Response(modes, mesh.scheme, orbit.grid, mesh.period).stages(forces)
        stages[:, :, list(split.kept)] = orbit.stages
        nodes = np.concatenate([stages[-1:, -1], stages[:, -1]])
        unknowns = orbit.algebraic[:, :, : len(split.whole.algebraics)]
        return replace(orbit, nodes=nodes, stages=stages, algebraic=unknowns, layout=layout_of(split.whole))

    def restricted(self, orbit: Orbit) -> Orbit:
        """Return an orbit with the states at the places, and the forces there."""
        split, kept = self.split, list(self.split.kept)
        more = len(split.algebraics) - orbit.algebraic.shape[2]
        found = replace(
            orbit,
            nodes=orbit.nodes[:, kept],
            stages=orbit.stages[:, :, kept],
            algebraic=np.concatenate([orbit.algebraic, self._nothing(orbit, more)], axis=2),
            layout=layout_of(split),
        )
        forces = algebraic_at(split, found, found.stage_phases.ravel())
        return replace(found, algebraic=forces.reshape(found.algebraic.shape))

    @staticmethod
    def _nothing(orbit: Orbit, more: int) -> Array:
        return np.zeros((*orbit.algebraic.shape[:2], more))
