"""Active forces and own states solved interval by interval, without equations of the whole period.

Forces and own states u of an interval follow from the modes z and own states s that it begins with,

    D u = b + Z z + S s,    z+ = exp(lambda h) z + E f,    s+ = s at its end,

so that cost grows with the number of intervals and with the square of the number of modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.coupled import Coupled
from periodic.condensed.modal.moments import Complex
from periodic.condensed.modalsaltation import ModalSaltation
from periodic.orbit.scheme import Array

INTERVAL = 6e4
"""Operations that an interval costs at the least."""


def pays(system: Coupled, columns: int) -> bool:
    """Return whether equations with `columns` right-hand sides are cheaper to solve interval by interval."""
    response = system.given.response
    coordinates = 2 * len(response.modes.exponents) + len(system.others)
    intervals = system.intervals if len(system.others) else len(system.held)
    each = system.ncol * (len(system.active) + len(system.others))
    # on a uniform mesh coefficients depend on the distance of two intervals alone
    way = 4.0 * coordinates / system.intervals + 2.0 * columns if response.uniform else 4.0 * coordinates
    return cheaper(system.size, coordinates, intervals, each, way)


def cheaper(size: float, coordinates: int, intervals: float, each: int, way: float) -> bool:
    """Return whether `size` equations, `each` of them an interval, are cheaper interval by interval.

    coordinates: of the motion, two a mode and own states; way: operations that one coefficient of the
    equations of the whole period takes.
    """
    at_once = size**2 * (0.7 * size + way)
    return at_once > intervals * (INTERVAL + 4.0 * each * coordinates**2)


Added = dict[int, tuple[Complex, Array]]
"""What events add to modes (J, r) and own states (o, r), by the intervals that they end."""


class IntervalRecursion:
    """The equations of the intervals with forces that depend on the motion, own states or events.

    Parameters
    ----------
    system : Coupled
        The equations; how they are closed over the period is not read.
    saltations : sequence of ModalSaltation
        Events at which forces jump.
    """

    def __init__(self, system: Coupled, saltations: Sequence[ModalSaltation] = ()) -> None:
        given, own = system.given, len(system.others)
        self.system, self.response = system, given.response
        self.saltations = {each.interval: each for each in saltations}
        ends = np.array(sorted(self.saltations), dtype=int)
        self.intervals = np.arange(system.intervals) if own else np.union1d(system.held, ends)
        self.at = self.intervals[:, None] * system.ncol + np.arange(system.ncol)
        self.forces = system.ncol * len(system.active)
        blocks, begun, left = self._rows(given.rows.forces[self.at][:, :, system.active], -1.0)
        size = self.forces
        blocks[:, np.arange(size), np.arange(size)] += 1.0
        if own:
            rows = self._rows(given.rows.own[self.at], 1.0)
            blocks, begun, left = (
                np.concatenate(pair, axis=1) for pair in zip((blocks, begun, left), rows, strict=True)
            )
        self.inverse = np.linalg.inv(blocks)
        self.by_modes, self.by_own = -self.inverse @ begun, -self.inverse @ left

    def _rows(self, rows: Array, sign: float) -> tuple[Array, Array, Array]:
        """Rows (C, a, r, w) in the interval's unknowns, and in the modes and own states at its beginning.

        Shapes (C, a r, m), (C, a r, 2 J), (C, a r, o).
        """
        system, response = self.system, self.response
        count, points, each, _ = rows.shape
        by_place = sign * rows[..., [1 + system.n + k for k in system.places]]
        local = response.local[self.intervals][..., system.active]
        blocks = [(by_place @ local.reshape(count, points, len(system.places), self.forces))]
        stage_outputs = response.stage_outputs[self.intervals]
        begun = by_place @ np.concatenate([stage_outputs.real, -stage_outputs.imag], axis=3)
        width = system.given.orbit.grid.width[self.intervals]
        weights = system.given.orbit.mesh.scheme.stage_rates / width[:, None, None]
        rates = sign * rows[..., 1 + system.others]
        inside = rates[:, :, :, None, :] * weights[:, :, None, 1:, None]
        same = np.arange(points)
        inside[:, same, :, same] += np.swapaxes(sign * rows[..., 1 + system.n + system.others], 0, 1)
        blocks.append(inside.reshape(count, points, each, points * len(system.others)))
        left = rates * weights[:, :, None, :1]
        found = np.concatenate(blocks, axis=3), begun, left
        by_unknowns, by_modes, by_own = (a.reshape(count, points * each, a.shape[3]) for a in found)
        return by_unknowns, by_modes, by_own

    @cached_property
    def _leaves(self) -> Array:
        """Modes at the end of an interval per unit of the forces in it, (C, 2 J, a k)."""
        left = self.response.impulse[self.intervals][..., self.system.active]
        left = left.reshape(*left.shape[:2], self.forces)
        return np.concatenate([left.real, left.imag], axis=1)

    def run(
        self,
        right: Array | None,
        modes: Complex,
        own: Array,
        passed: dict[int, tuple[Complex, Array]] | None = None,
    ) -> tuple[Array, Complex, Array]:
        """Return unknowns (size, r), modes (J, r) and own states (o, r) at the end of the period.

        `right` (size, r) are right-hand sides of the system's equations, None for 0; `modes` and `own` are
        those at the beginning. `passed` is filled with the jumps of modes and own states at events, at fixed
        tau, by interval; without it event nodes are held, and nothing jumps.
        """
        response, exponents = self.response, self.response.modes.exponents
        found = np.zeros((len(self.intervals), self.inverse.shape[1], modes.shape[1]))
        if right is not None:
            found += self.inverse @ self._by_interval(right)
        count, leaves, now = len(exponents), self._leaves, 0.0
        z, grown = modes, response.grown[self.intervals]
        for i, interval in enumerate(self.intervals):
            begin = response.start[interval]
            if i == 0 or interval > self.intervals[i - 1] + 1:
                z = np.exp(exponents * (begin - now))[:, None] * z
            found[i] += self.by_modes[i] @ np.concatenate([z.real, z.imag]) + self.by_own[i] @ own
            left = leaves[i] @ found[i, : self.forces]
            z = grown[i][:, None] * z + (left[:count] + 1j * left[count:])
            own, now = found[i, found.shape[1] - len(own) :], response.end[interval]
            if passed is not None and interval in self.saltations:
                passed[interval] = more = self._passed(self.saltations[interval], z, own)
                z, own = z + more[0], own + more[1]
        z = np.exp(exponents * (response.period - now))[:, None] * z
        return self._together(found), z, own

    def _passed(self, saltation: ModalSaltation, z: Complex, own: Array) -> tuple[Complex, Array]:
        """Jumps at an event of modes (J, r) and own states (o, r) that arrive there."""
        system = self.system
        early = saltation.row[system.places] @ (self.response.modes.outputs @ z).real
        early = early + saltation.row[system.others] @ own
        return saltation.modes[:, None] * early, saltation.own[:, None] * early

    def _by_interval(self, right: Array) -> Array:
        """Right-hand sides (size, r) as (C, m, r)."""
        system, r = self.system, right.shape[1]
        forces = np.zeros((len(self.intervals), self.forces, r))
        forces[self._held] = right[: system.count].reshape(-1, self.forces, r)
        own = right[system.count :].reshape(len(self.intervals), self.inverse.shape[1] - self.forces, r)
        return np.concatenate([forces, own], axis=1)

    def _together(self, found: Array) -> Array:
        """Unknowns (C, m, r) as the system has them, (size, r)."""
        r = found.shape[2]
        forces, own = found[self._held, : self.forces], found[:, self.forces :]
        return np.concatenate([forces.reshape(-1, r), own.reshape(-1, r)])

    @cached_property
    def _held(self) -> NDArray[np.int_]:
        """Which of the intervals have forces that depend on the motion."""
        return np.searchsorted(self.intervals, self.system.held)
