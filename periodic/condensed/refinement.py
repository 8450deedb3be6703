"""Meshes of condensed orbits: uniform, or as fine as contacts and the motion between them require."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.collocation import CollocationRefinement
from periodic.condensed.estimate import ContactError
from periodic.condensed.linearised import answer, exempt, local_rows
from periodic.condensed.memory import Memory
from periodic.correction.error import SAFETY
from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.scheme import Array
from periodic.refinement.demand import AIM
from periodic.refinement.equidistribution import SPLIT, density, spread
from periodic.system import jumps_of, linear_of

FINER, COARSER = 2.5, 2.0
"""How many times shorter and longer intervals may become at a time."""

FEWEST = 16
"""Least number of intervals a period outside contacts: excitation is a polynomial in each of them."""


LARGEST = 1e9
"""Bytes that an orbit's equations may take, see `periodic.condensed.memory`."""


class CondensedRefinement(CollocationRefinement):
    """Uniform meshes for systems without switches: tables of one interval then serve for all.

    With switches, as motion is exact for its forces, intervals without active forces need only resolve the
    motion and its excitation, evenly; the others are also as short as the multipliers require.
    """

    @property
    def exhausted(self) -> bool:
        """Whether the orbit has the largest number of intervals, or more than half of what memory allows."""
        return super().exhausted or (self._limited and 2 * self.orbit.mesh.ntst > self._most)

    @property
    def _largest(self) -> int:
        """The largest number of intervals: that of the settings, as memory bounds it too."""
        return self.method.ntst_max

    @property
    def shortfall(self) -> str:
        """Why the error exceeds its bound."""
        more = f"; more would take over {LARGEST / 1e9:g} GB of memory" if self._limited else ""
        return super().shortfall + more

    @property
    def _limited(self) -> bool:
        """Whether the orbit needs more intervals than there is memory for."""
        if self._in_wrong_mode or self._most == self.method.ntst_max:
            return False
        wanted = float(self._wanted @ self.orbit.grid.width) if self.system.switches else super()._ntst
        return wanted > self._most

    @cached_property
    def _most(self) -> int:
        """Largest number of intervals, by the settings and by memory."""
        part, most, orbit = linear_of(self.system), self.method.ntst_max, self.orbit
        assert part is not None
        # the next mesh has at most FINER times as many intervals
        if self._memory(part.size, 1.0).peak(min(most, int(FINER * orbit.mesh.ntst))) <= LARGEST:
            return most
        response, _ = answer(self.system, orbit, orbit.parameter, (), self.method.tolerance)
        active = self._active
        share = max(float(active.mean()), 1 / len(active))
        modes = len(response.modes.exponents)
        return max(self.method.ntst_min, self._memory(modes, share).most(most, LARGEST))

    def _memory(self, modes: int, active: float) -> Memory:
        """The memory for some modes, with forces that depend on motion in a fraction of the intervals."""
        part, orbit = linear_of(self.system), self.orbit
        assert part is not None
        places, forces = len(part.states), len(part.forces)
        own = orbit.nodes.shape[1] - places
        kinked = own > 0 or len(orbit.phases) > 0
        known = orbit.mesh.scheme.ncol, places, forces, own, modes, active, kinked
        return Memory(*known, even=not self.system.switches)

    @property
    def _ntst(self) -> int:
        return min(super()._ntst, self._most)

    def refined(self) -> Mesh:
        """Return a mesh with intervals where the orbit needs them, and its present event nodes."""
        return super().refined() if self.system.switches else self._even()

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes with the right event nodes and number of intervals, then with shallower ones."""
        if self.system.switches:
            yield from super().meshes()
        else:
            yield self._even(), np.zeros(0)

    def _even(self) -> Mesh:
        mesh = self.orbit.mesh
        return Mesh(mesh.scheme, (np.linspace(0, 1, self._ntst + 1),), (), mesh.period)

    def _made(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        wanted = self._wanted
        total = float(wanted @ self.orbit.grid.width)
        scale = np.clip(total, self.method.ntst_min, self._most) / total
        return spread(self.orbit, scale * wanted, events, phases, self.method.shortest)

    def _own(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The mesh of `_made`, which needs no spreading anew."""
        return self._made(events, phases)

    @property
    def _wanted(self) -> Array:
        """Intervals a rad that are wanted in each interval, (N,)."""
        orbit, width, error = self.orbit, self.orbit.grid.width, self.error
        active = self._active
        wanted = self._density(self._resolved)
        if jumps_of(self.system):
            retained = [k for k in self._resolved if k not in exempt(self.system)]
            wanted = np.where(active, wanted, self._density(retained))
        lacking = SAFETY * error.multiplier if error.curable > error.motion else 0.0
        beside = min(lacking, SAFETY * error.variation) if isinstance(error, ContactError) else lacking
        own = max(error.motion, lacking if lacking > 2 * beside else 0.0)
        points, share = orbit.mesh.scheme.ncol, wanted * width
        typical = max(float(share[part].mean()) for part in (active, ~active) if part.any())
        times, for_motion = (self._times(each, points + 1) for each in (own, error.motion))
        wanted *= (np.where(active, times, for_motion) if active.any() else times) / typical
        wanted = np.maximum(wanted, FEWEST * max(times, 1.0) / orbit.mesh.period)
        if not active.any():
            return wanted
        shorter = SPLIT * self._times(beside, 2 * points - 1) / width[active].max()
        return np.where(active, np.maximum(wanted, shorter), wanted)

    def _density(self, states: list[int]) -> Array:
        """The mesh density by the derivatives of some of the states, (N,)."""
        orbit = self.orbit
        return density(replace(orbit, nodes=orbit.nodes[:, states], stages=orbit.stages[:, :, states]))

    def _times(self, error: float, order: int) -> float:
        """Factor on the number of intervals that brings an error of an order to its aim."""
        ratio = error / (AIM * self.method.tolerance)
        return float(np.clip(ratio, COARSER**-order, FINER**order)) ** (1 / order)

    @cached_property
    def _forces(self) -> Array:
        """Moduli of the forces' derivatives in rates and states at the points, (P, k, 2 n)."""
        orbit, part = self.orbit, linear_of(self.system)
        assert part is not None
        rows = local_rows(self.system, part, orbit, ()).forces
        return np.abs(rows[:, :, 1 : 1 + 2 * orbit.nodes.shape[1]])

    @property
    def _resolved(self) -> list[int]:
        """States that a mesh resolves: those that are not exempt, and those that forces depend on."""
        n, exempted = self.orbit.nodes.shape[1], exempt(self.system)
        by_state = self._forces[:, :, n:].max(axis=(0, 1), initial=0.0) > 0
        return [k for k in range(n) if by_state[k] or k not in exempted]

    @property
    def _active(self) -> NDArray[np.bool_]:
        """Intervals where forces depend on states, (N,)."""
        return self._forces.reshape(len(self.orbit.grid.width), -1).max(axis=1, initial=0.0) > 0
