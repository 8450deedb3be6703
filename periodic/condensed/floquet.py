"""The leading Floquet multipliers of a split system, whatever the number of its states.

Free motion from modes and own states (z_0, s_0) causes forces at the places, which act on the motion in turn:

    M = exp(lambda T) + L_T (1 - F' L)^-1 F' R,

a diagonal matrix plus a product whose rank is at most the number of unknowns at the places.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.condensed.coupled import Coupled
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.modalsaltation import ModalSaltation
from periodic.condensed.recursion import Added, IntervalRecursion, pays
from periodic.condensed.subspace import invariant
from periodic.linear.unknowns import Increment
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Complex, Pair, Spectrum

LEADING = 8
"""Multipliers that are kept of many."""

AMONG = 1.02
"""Multipliers larger than the least leading one by this factor are surely among the leading ones."""

LIGHT = 0.8
"""Modulus below which a pair of multipliers makes no narrow peak."""

LASTING = 0.6
"""Modulus below which the error of a multiplier does not count: its motion is gone in a few periods."""

ALONE = 1e-6
"""Distance of a number from a multiplier of the uncoupled modes below which it is taken as equal to it."""

ALL_KEPT_UP_TO = 64
"""Up to this number of coordinates all multipliers are computed and kept."""


@dataclass(frozen=True)
class ModalFloquet:
    """Free motion about an orbit, in the real coordinates (Re z, Im z, s), redundant ones left out.

    Parameters
    ----------
    given : SplitLinearisation
        The system about its orbit.
    steps : ndarray, shape (N, c, c), optional
        Coordinates at the end of an interval by those at its beginning, where they are known.
    """

    given: SplitLinearisation
    steps: Array | None = None

    @cached_property
    def kept(self) -> NDArray[np.int_]:
        """The coordinates: modes that do not oscillate have no imaginary part."""
        oscillates = self.given.response.modes.exponents.imag != 0
        own = np.ones(len(self.given.others), dtype=bool)
        return np.flatnonzero(np.concatenate([np.ones(len(oscillates), dtype=bool), oscillates, own]))

    @cached_property
    def _system(self) -> Coupled:
        return Coupled(self.given, self.given.from_rest, wraps=0.0)

    @cached_property
    def chain(self) -> IntervalRecursion | None:
        """The equations interval by interval, where that is cheaper or forces jump."""
        given = self.given.saltations
        if not given and not pays(self._system, min(len(self.kept), ALL_KEPT_UP_TO)):
            return None
        return IntervalRecursion(self._system, given)

    @cached_property
    def free(self) -> tuple[Array, Array]:
        """Unknowns (P ka + P o, coordinates) and coordinates at the end, per unit of those at the beginning.

        Only where motion is followed interval by interval.
        """
        return self.driven(None, np.eye(len(self.kept)))

    def driven(self, right: Array | None, basis: Array, passed: Added | None = None) -> tuple[Array, Array]:
        """Return unknowns, and coordinates at the end, of motions from a basis with right-hand sides (., r).

        `passed` as in `IntervalRecursion.run`.
        """
        assert self.chain is not None
        begun = basis[len(basis) - len(self.given.others) :]
        found, modes, own = self.chain.run(right, self.modes(basis), begun, passed)
        return found, np.concatenate([modes.real, modes.imag, own])[self.kept]

    @cached_property
    def _factors(self) -> Any:
        matrix = self._system.assembled()
        if not np.isfinite(matrix).all():
            raise FloatingPointError("the equations of free motion are not finite")
        return scipy.linalg.lu_factor(matrix, check_finite=False)

    @cached_property
    def _excited(self) -> Array:
        """Right-hand sides of forces and own states due to free motion, (P ka + P o, coordinates)."""
        given, system = self.given, self._system
        n, modes = system.n, 2 * len(given.response.modes.exponents)
        right = np.zeros((system.size, modes + len(system.others)))
        right[: system.count, :modes] = system.asked(self._ahead(system.held))
        if len(system.others):
            shown = self._ahead(np.arange(system.intervals))
            places = [1 + n + k for k in system.places]
            own = given.local.own
            right[system.count :, :modes] = -(own[:, :, places] @ shown).reshape(-1, modes)
            right[system.count :, modes:] = -self._begun(own[:, :, 1 + system.others])
        return right[:, self.kept]

    def _ahead(self, intervals: NDArray[np.int_]) -> Array:
        """States at the points of some intervals per unit of the initial modes, (R, s, 2 J)."""
        shown = self.given.response.ahead(intervals)
        shown = shown.reshape(-1, *shown.shape[2:])
        return np.concatenate([shown.real, -shown.imag], axis=2)

    @cached_property
    def _left(self) -> Array:
        """Coordinates at the end of the period per unit of forces and own states, (., P ka + P o)."""
        system = self._system
        count = len(self.given.response.modes.exponents)
        final = self.given.response.left(system.held)[..., system.active].reshape(count, system.count)
        modes, own = 2 * count, len(system.others)
        found = np.zeros((modes + own, system.size))
        found[:modes, : system.count] = np.concatenate([final.real, final.imag])
        found[np.arange(own) + modes, np.arange(own) + system.size - own] = 1.0
        return found[self.kept]

    @cached_property
    def _grown(self) -> tuple[Array, Array, NDArray[np.int_]]:
        """Growth of uncoupled modes over a period: factors of coordinates and of partners, the partners."""
        growth, own = self.given.response.growth[-1], np.zeros(len(self.given.others))
        count = len(growth)
        factor = np.concatenate([growth.real, growth.real, own])[self.kept]
        cross = np.concatenate([-growth.imag, growth.imag, own])[self.kept]
        place = np.zeros(2 * count + len(own), dtype=int)
        place[self.kept] = np.arange(len(self.kept))
        swapped = np.concatenate([np.arange(count) + count, np.arange(count), np.zeros(len(own), dtype=int)])
        return factor[:, None], cross[:, None], place[swapped[self.kept]]

    @property
    def light(self) -> int:
        """Number of coordinates of the uncoupled modes that are lightly damped."""
        return int((np.abs(self.given.response.growth[-1]) > LIGHT).sum() * 2)

    def lightest(self, count: int) -> NDArray[np.int_]:
        """Return the coordinates of the uncoupled modes that are damped least."""
        factor, cross, _ = self._grown
        return np.argsort(-np.hypot(factor, cross)[:, 0], kind="stable")[:count]

    def apart(self, values: Complex, vectors: Complex) -> Complex:
        """Return (value - E)^-1 vector of each column, E = exp(lambda T) of the uncoupled modes.

        Where a value is an eigenvalue of E, the vector's components there are unchanged.
        """
        factor, cross, partner = self._grown
        beside = values - factor
        size = beside**2 + cross**2
        found = beside * vectors + cross * vectors[partner]
        alone = np.abs(size) < ALONE**2
        return np.where(alone, vectors, found / np.where(alone, 1.0, size))

    def answers(self, basis: Array) -> Array:
        """Return forces and own states at the points in free motion from the columns of a basis."""
        if self.chain is not None:
            return self.driven(None, basis, {})[0]
        return np.asarray(scipy.linalg.lu_solve(self._factors, self._excited @ basis, check_finite=False))

    def modes(self, basis: Array) -> Complex:
        """Return the columns of a basis as modes, (J, r)."""
        count = len(self.given.response.modes.exponents)
        whole = np.zeros((2 * count + len(self.given.others), basis.shape[1]))
        whole[self.kept] = basis
        return whole[:count] + 1j * whole[count : 2 * count]

    def left(self, states: Array, modes: Complex) -> Array:
        """Return the coordinates at the end of the period, (coordinates, r), due to a disturbed motion.

        Of systems without own states. The disturbances are `states` (N, a, s, r) at the points, and `modes`
        (J, r) at the end.
        """
        system = self._system
        flat = states.reshape(system.points, len(system.places), -1)
        asked = system.asked(flat[system.at])
        begun = np.concatenate([modes.real, modes.imag])[self.kept]
        if self.chain is not None:
            return begun + self.driven(asked, np.zeros_like(begun))[1]
        answer = scipy.linalg.lu_solve(self._factors, asked, check_finite=False)
        return np.asarray(begun + self._left @ answer)

    def once(self, basis: Array) -> Array:
        """Return M times the columns of a basis, (coordinates, r)."""
        if self.steps is not None:
            return self._stepped(self.steps, basis)[-1]
        if self.chain is not None:
            if self.given.saltations:
                return self.driven(None, basis, {})[1]
            square = basis.shape[0] == basis.shape[1]
            return self.free[1] @ basis if square or "free" in vars(self) else self.driven(None, basis)[1]
        factor, cross, partner = self._grown
        return factor * basis + cross * basis[partner] + self._left @ self.answers(basis)

    def _stepped(self, steps: Array, basis: Array) -> Array:
        """Return free motion from the columns of `basis` at the mesh points, (N+1, coordinates, r)."""
        found = np.empty((len(steps) + 1, *basis.shape))
        found[0], events = basis, dict(map(self._jump, self.given.saltations))
        for i, own in enumerate(steps):
            np.matmul(own, found[i], out=found[i + 1])
            if i in events:
                early, more = events[i]
                found[i + 1] += np.outer(more, early @ found[i + 1])
        return found

    def _jump(self, each: ModalSaltation) -> tuple[int, tuple[Array, Array]]:
        """The interval that an event ends; how early it comes by the coordinates, and what that adds."""
        given = self.given
        shown = each.row[list(given.part.states)] @ given.response.modes.outputs
        early = np.concatenate([shown.real, -shown.imag, each.row[given.others]])
        more = np.concatenate([each.modes.real, each.modes.imag, each.own])
        return each.interval, (early[self.kept], more[self.kept])

    def _begun(self, rates: Array) -> Array:
        """Coefficients of the initial own states in their rows, those of the first interval, (P o, o)."""
        orbit = self.given.orbit
        weights = orbit.mesh.scheme.stage_rates[:, 0] / orbit.grid.width[0]
        found = np.zeros_like(rates)
        found[: len(weights)] = weights[:, None, None] * rates[: len(weights)]
        return found.reshape(-1, rates.shape[2])

    def forces(self, answers: Array) -> Array:
        """Return all forces at the points, (N, b, k, r), from the active ones."""
        return self._system.forces(answers)

    @property
    def monodromy(self) -> Array:
        """M, (coordinates, coordinates)."""
        return self.once(np.eye(len(self.kept)))

    @cached_property
    def eigen(self) -> tuple[Complex, Complex]:
        """Eigenvalues and eigenvectors of M."""
        values, vectors = np.linalg.eig(self.monodromy)
        return values.astype(np.complex128), vectors.astype(np.complex128)

    def motion(self, basis: Array) -> Array:
        """Return free motion from the columns of `basis` at the mesh points, (N+1, coordinates, r)."""
        if self.steps is not None:
            return self._stepped(self.steps, basis)
        growth, own, modes = self.given.response.growth, len(self.given.others), self.modes(basis)
        passed: Added = {}
        answers = self.answers(basis) if self.chain is None else self.driven(None, basis, passed)[0]
        moved = growth[:, :, None] * modes + self.given.response.driven(self.forces(answers))
        for interval, (more, _) in passed.items():
            moved[interval + 1 :] += self.given.response.grown_since(interval + 1)[:, :, None] * more
        parts = [moved.real, moved.imag]
        if own:
            count, points, _ = self.given.orbit.stages.shape
            ends = answers[-count * points * own :].reshape(count, points, own, -1)[:, -1]
            whole = np.concatenate([basis[None, -own:], ends])
            for interval, (_, jumped) in passed.items():
                whole[interval + 1] += jumped
            parts.append(whole)
        return np.concatenate(parts, axis=1)[:, self.kept]


@dataclass(frozen=True)
class Leading:
    """Free motion in the invariant subspace of the leading multipliers.

    Parameters
    ----------
    floquet : ModalFloquet
        Free motion about the orbit.
    """

    floquet: ModalFloquet

    @cached_property
    def basis(self) -> Array:
        """Orthonormal basis of the subspace, (coordinates, r)."""
        size = len(self.floquet.kept)
        return np.eye(size) if self._all else invariant(self.floquet, LEADING, LIGHT)

    @property
    def _all(self) -> bool:
        """Whether it is the whole space, in its own coordinates."""
        return len(self.floquet.kept) <= ALL_KEPT_UP_TO

    @property
    def monodromy(self) -> Array:
        """M in the subspace, (r, r)."""
        return np.asarray(self.basis.T @ self.floquet.once(self.basis))

    @cached_property
    def _motion(self) -> Array:
        return self.floquet.motion(self.basis)

    @cached_property
    def fundamental(self) -> Array:
        """The motion that begins with the basis, in that basis: (N+1, r, r)."""
        return self._motion if self._all else np.asarray(self.basis.T @ self._motion)

    @cached_property
    def states(self) -> Array:
        """The motion that begins with the basis, as states of the system, (N+1, n, r)."""
        given, kept = self.floquet.given, self.floquet.kept
        outputs = given.response.modes.outputs
        shown = np.concatenate([outputs.real, -outputs.imag], axis=1)
        found = np.zeros((len(self._motion), given.orbit.nodes.shape[1], self.basis.shape[1]))
        own = len(given.others)
        modes = len(kept) - own
        found[:, list(given.part.states)] = shown[:, kept[:modes]] @ self._motion[:, :modes]
        found[:, given.others] = self._motion[:, modes:]
        return found

    def start(self, change: Increment) -> Array:
        """Return the change at the beginning of the period that a change of the orbit makes, (r,)."""
        given = self.floquet.given
        forces = change.algebraic[:, :, list(given.part.forces)]
        modes = given.response.history(forces)[0]
        modes = modes + given.begun @ np.append(change.phases, change.parameters)
        whole = np.concatenate([modes.real, modes.imag, change.nodes[0, given.others]])
        return np.asarray(self.basis.T @ whole[self.floquet.kept])


@dataclass(frozen=True, eq=False)
class LeadingSpectrum(Spectrum):
    """The leading multipliers of a split system; see `Spectrum`. leading: their invariant subspace."""

    leading: Leading | None = None

    @cached_property
    def pairs(self) -> list[Pair]:
        """The pairs that are damped so little that they matter to the course of the branch."""
        return [pair for pair in super().pairs if pair.modulus > LIGHT]

    @property
    def frame(self) -> Array | None:
        """The basis of the subspace."""
        return None if self.leading is None else self.leading.basis

    def _sizes(self, solutions: Complex, chosen: NDArray[np.int_]) -> Array:
        if self.leading is None:
            return super()._sizes(solutions, chosen)
        return np.asarray(np.abs(self.leading.states @ self.vectors[:, chosen]).max(axis=(0, 1), initial=0.0))

    def apart(self, monodromy: Array, operator: object = None) -> float:
        """Distance of the multipliers that are not strongly damped from those of another monodromy matrix.

        Where all are known it is that of the sums of their powers, else of each from the nearest.
        """
        both = (self.multipliers, np.linalg.eigvals(monodromy))
        if self.leading is None or len(self.leading.floquet.kept) <= max(
            ALL_KEPT_UP_TO, len(self.multipliers)
        ):
            count = int((np.abs(self.multipliers) > LASTING).sum())
            largest = [values[np.argsort(-np.abs(values))[:count]] for values in both]
            sums = [[(values**power).sum() for power in (1, 2)] for values in largest]
            first, second = (abs(complex(a - b)) for a, b in zip(*sums, strict=True))
            return float(max(first / self.radius, second / (2 * self.radius**2)))
        # Of multipliers about as large as the least leading one, rounding decides which are leading.
        least = np.abs(self.multipliers).min() * AMONG
        sure = self.multipliers[np.abs(self.multipliers) > max(LASTING, least)]
        apart = np.abs(sure[:, None] - both[1]).min(axis=1, initial=np.inf)
        return float(apart.max(initial=0.0) / self.radius)

    def start(self, change: Increment) -> Array:
        """Return the change at the beginning of the period that a change of the orbit makes, (r,)."""
        if self.leading is None:
            return np.zeros(len(self.multipliers))
        return self.leading.start(change)
