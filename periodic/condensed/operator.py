"""The linearised equations of a split system's orbit, in the unknowns of its places alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from periodic.condensed import transfer as transfers
from periodic.condensed.coupled import Coupled, folded
from periodic.condensed.floquet import Leading, ModalFloquet
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.recursion import pays
from periodic.condensed.transfer import Transfer
from periodic.linear import bordered
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system.precision import EPSILON


@dataclass(frozen=True)
class CondensedOperator:
    """The linearised equations of a split system; see `periodic.linear.operator.Operator`.

    Parameters
    ----------
    given : SplitLinearisation
        The system about the orbit.
    own : sequence of Row
        The rows of the event nodes.
    brief : bool
        Whether only the last fundamental matrix is needed.
    """

    given: SplitLinearisation
    own: Sequence[Row] = ()
    brief: bool = False

    @property
    def orbit(self) -> Orbit:
        """The orbit that the equations are linearised at."""
        return self.given.orbit

    @property
    def residual(self) -> float:
        """The largest residual."""
        return max(self.given.rows.residual, float(np.abs(self.given.missing).max()))

    @property
    def rounding(self) -> float:
        """Estimate of the states' relative rounding error: that of the phase of the fastest mode."""
        response = self.given.response
        turned = float(np.abs(response.modes.exponents).max(initial=0.0)) * response.period
        return float(EPSILON * turned * np.sqrt(self.orbit.mesh.ntst))

    @cached_property
    def system(self) -> Coupled:
        """The equations of forces and own states in periodic motion."""
        return Coupled(self.given, self.given.flexibility, wraps=1.0)

    @property
    def effect(self) -> Array:
        """About how much the states change with each free parameter over a period, shape (q,)."""
        k, (count, points, n) = len(self.orbit.phases), self.orbit.stages.shape
        forces = self.given.local.forces[:, :, 1 + 2 * n + k :]
        whole = self.given.flexibility.applied(forces.reshape(count, points, *forces.shape[1:]))
        states = np.abs(whole).max(axis=(0, 1, 2), initial=0.0)
        states += np.abs(self.given.affine[:, :, 1 + k :]).max(axis=(0, 1), initial=0.0)
        return np.asarray(
            states + np.abs(self.given.local.own[:, :, 1 + 2 * n + k :]).max(axis=(0, 1), initial=0.0)
        )

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`, shape (1 + len(rows), columns)."""
        system = self.system
        if self.transfer is not None:
            return self._recovered(right[0], *self._joined(self.transfer, rows, right))
        solved = self._by_interval if pays(system, right.shape[1]) else self._at_once
        inner, outer = solved(rows, right)
        return self._recovered(right[0], system.stages(inner, np.concatenate([right[:1], outer])), outer)

    @cached_property
    def transfer(self) -> Transfer | None:
        """The equations joined by transfer matrices, where that is cheapest."""
        kept, columns = ModalFloquet(self.given).kept, 1 + len(self.orbit.phases)
        cheaper = pays(self.system, columns) and transfers.pays(self.system, len(kept))
        return Transfer(self.system, kept) if cheaper else None

    def _joined(self, transfer: Transfer, rows: Sequence[Row], right: Array) -> tuple[Array, Array]:
        """States at the points, (P, n, r), and dy, from equations with c_0 and dy as unknowns."""
        count, whole = transfer.size, transfer.motion[-1]
        every = np.concatenate([-whole, transfer.rows((*self.own, *rows))])
        every[np.arange(count), np.arange(count)] += 1.0
        order = [count, *range(count), *range(count + 1, every.shape[1])]
        found = bordered.solve(every[:, order], right)
        return transfer.states(found[:count], right[0], found[count:]), found[count:]

    def _at_once(self, rows: Sequence[Row], right: Array) -> tuple[Array, Array]:
        """Forces and own states, (size, columns), and dy."""
        found, size = bordered.solve(self._bordered(rows), right), self.system.size
        return found[:size], found[size:]

    def _by_interval(self, rows: Sequence[Row], right: Array) -> tuple[Array, Array]:
        """Forces and own states, and dy, with initial values of the motion and dy as the only unknowns."""
        whole = self.system.restricted([folded(self.orbit, row) for row in (*self.own, *rows)])
        return self._begun(*whole, self.system.right, right)

    def _begun(self, inner: Array, outer: Array, moved: Array, right: Array) -> tuple[Array, Array]:
        """Forces and own states, and dy, of equations with right-hand sides `moved` (size, 1 + q).

        Rows `inner` in forces and own states and `outer` in (1, dy) close them.
        """
        floquet = self._floquet
        count, (unknowns, ends) = len(floquet.kept), floquet.free
        driven, left = floquet.driven(moved, np.zeros((count, moved.shape[1])))
        outer = outer + inner @ driven
        closed = [-left[:, :1], np.eye(count) - ends, -left[:, 1:]]
        found = bordered.solve(np.block([closed, [outer[:, :1], inner @ unknowns, outer[:, 1:]]]), right)
        given = np.concatenate([right[:1], found[count:]])
        return unknowns @ found[:count] + driven @ given, found[count:]

    @cached_property
    def _floquet(self) -> ModalFloquet:
        """Free motion beside the orbit."""
        return ModalFloquet(self.given, None if self.transfer is None else self.transfer.free)

    def _bordered(self, rows: Sequence[Row]) -> Array:
        """The equations with the rows of event nodes and side conditions, constants first."""
        system = self.system
        inner, outer = system.restricted([folded(self.orbit, row) for row in (*self.own, *rows)])
        size = system.size
        every = np.empty((size + len(inner), size + outer.shape[1]))
        every[:size, 0], every[size:, 0] = -system.right[:, 0], outer[:, 0]
        every[:size, 1 : 1 + size], every[:size, 1 + size :] = system.matrix, -system.right[:, 1:]
        every[size:, 1 : 1 + size], every[size:, 1 + size :] = inner, outer[:, 1:]
        return every

    def answered(self, rows: Sequence[Row], states: Array) -> Increment:
        """Return the increment of an orbit due to a disturbance (N, a, s) of the states at the places.

        Of systems without own states; the disturbance is part of the increment.
        """
        system, orbit, k = self.system, self.orbit, len(self.orbit.phases)
        flat = states.reshape(system.points, -1)
        missed = [folded(orbit, row)[0][:, system.places] for row in (*self.own, *rows)]
        asked = system.asked(flat[system.at, :, None])
        beside = np.array([float(np.vdot(m, flat)) for m in missed])
        solved = self._answered_at_once if self._floquet.chain is None else self._answered_by_interval
        inner, outer = solved(rows, asked, beside)
        stages = system.stages(inner, np.append(0.0, outer)[:, None])[..., 0]
        stages[:, system.places] += flat
        stages = stages.reshape(orbit.stages.shape)
        nodes = np.concatenate([stages[-1:, -1], stages[:, -1]])
        return Increment.of(orbit, nodes, stages, np.zeros_like(orbit.algebraic), outer[:k], outer[k:])

    def _answered_at_once(self, rows: Sequence[Row], asked: Array, beside: Array) -> tuple[Array, Array]:
        """Forces (size, 1) and dy due to forces (size, 1) and values of the rows."""
        aim = np.concatenate([[0.0], asked[:, 0], -beside])
        found = bordered.solve(self._bordered(rows), aim[:, None])
        return found[: self.system.size], found[self.system.size :, 0]

    def _answered_by_interval(self, rows: Sequence[Row], asked: Array, beside: Array) -> tuple[Array, Array]:
        """The same, with initial values of the motion and dy as the only unknowns."""
        inner, outer = self.system.restricted([folded(self.orbit, row) for row in (*self.own, *rows)])
        moved = np.concatenate([asked, self.system.right[:, 1:]], axis=1)
        outer[:, 0] = beside
        found, moves = self._begun(inner, outer, moved, np.eye(1 + len(inner))[:, :1])
        return found, moves[:, 0]

    def _recovered(self, constant: Array, states: Array, outer: Array) -> tuple[Increment, ...]:
        """The increments of states at the points, (P, n, r), and dy, (q, r)."""
        orbit, scheme, n = self.orbit, self.orbit.mesh.scheme, self.orbit.nodes.shape[1]
        stages, k = np.moveaxis(states, 2, 0).reshape(-1, *orbit.stages.shape), len(orbit.phases)
        ends = np.concatenate([orbit.stages[-1:, -1], orbit.stages[:, -1]])
        nodes = constant[:, None, None] * (ends - orbit.nodes)
        nodes[:, 1:] += stages[:, :, -1]
        nodes[:, 0] += stages[:, -1, -1]
        knots = np.concatenate([nodes[:, :-1, None], stages], axis=2)
        rates = scheme.stage_rates @ knots / orbit.grid.width[:, None, None]
        by_unknown, tied = self.given.rows.unknowns, self.given.rows.tied
        columns = np.empty((len(by_unknown), by_unknown.shape[2], len(stages)))
        first = 1 + 2 * n
        columns[:, 0] = constant
        if tied:
            ties = np.repeat(orbit.mesh.ties, scheme.ncol, axis=0)
            columns[:, first : first + ties.shape[1]] = outer[ties]
            columns[:, first + ties.shape[1] :] = outer[k:]
        else:
            columns[:, first:] = outer
        columns[:, 1 : 1 + n] = np.moveaxis(rates, 0, 3).reshape(len(columns), n, -1)
        columns[:, 1 + n : 1 + 2 * n] = states
        unknowns = np.moveaxis(by_unknown @ columns, 2, 0).reshape(-1, *orbit.algebraic.shape)
        return tuple(
            Increment.of(orbit, *moved[:3], moved[3][:k], moved[3][k:])
            for moved in zip(nodes, stages, unknowns, outer.T, strict=True)
        )

    @cached_property
    def leading(self) -> Leading:
        """Free motion in the invariant subspace of the leading multipliers."""
        return Leading(self._floquet)

    @property
    def fundamental(self) -> Array:
        """Fundamental matrices in the basis of the leading subspace, (N+1, r, r); or the last alone."""
        return self.leading.monodromy[None] if self.brief else self.leading.fundamental
