"""The rows of a split system at the collocation points, and its linear part on the orbit's mesh."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.collocation.residual import eliminate, evaluated, rows_of
from periodic.condensed.modal.flexibility import Flexibility
from periodic.condensed.modal.moments import Complex
from periodic.condensed.modal.quasistatic import reduced, reduced_slope, retained_modes
from periodic.condensed.modal.response import Response
from periodic.condensed.modal.slopes import slopes, slopes_within
from periodic.condensed.modalsaltation import ModalSaltation, saltations
from periodic.condensed.native.nativepoints import eliminated
from periodic.condensed.native.nativeresponse import response_of
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import LinearPart, ModesLike, System, jumps_of, linear_of

GREATEST = 0.5 * float(np.log(np.finfo(float).max))
"""Exponent of growth in a period beyond which products of two such numbers overflow."""


@dataclass(frozen=True)
class Local:
    """The rows at the points, each a map of (1, d rate, d state, dy) with y the event phases and parameters.

    forces (P, k, w): the increments of the forces; own (P, o, w): rows of the own states; unknowns (P, m, w):
    increments of all unknowns; residual: the largest one; rows (o,): which rows are those of own states.
    tied: of the event nodes' phases only the columns of those that bound the interval's segment, `Mesh.ties`.
    """

    forces: Array
    own: Array
    unknowns: Array
    residual: float
    rows: NDArray[np.int_]
    tied: bool = False

    def untied(self, orbit: Orbit) -> Local:
        """Return the rows with columns for all event nodes."""
        if not self.tied:
            return self
        k, ties = len(orbit.phases), np.repeat(orbit.mesh.ties, orbit.mesh.scheme.ncol, axis=0)
        first = 1 + 2 * orbit.nodes.shape[1]
        forces, own, unknowns = (
            _spread(rows, first, ties, k) for rows in (self.forces, self.own, self.unknowns)
        )
        return Local(forces, own, unknowns, self.residual, self.rows)


def _spread(rows: Array, first: int, ties: NDArray[np.int_], k: int) -> Array:
    """Rows (P, r, w) whose columns from `first` on are those of `ties` (P, e), with columns for all k."""
    points, each, width = rows.shape
    last = first + ties.shape[1]
    found = np.zeros((points, each, width + k - ties.shape[1]))
    found[:, :, :first], found[:, :, first + k :] = rows[:, :, :first], rows[:, :, last:]
    found[np.arange(points)[:, None], :, first + ties] = np.swapaxes(rows[:, :, first:last], 1, 2)
    return found


def exempt(system: System) -> tuple[int, ...]:
    """Return the states of the linear part whose interpolation errors between mesh points do not count.

    They are the velocities, to which all modes contribute, without those on which a jump's switch depends.
    """
    part, jumps = linear_of(system), list(jumps_of(system))
    if part is None or not jumps:
        return () if part is None else part.velocities
    state, _ = system.rest(system.nominal)
    slopes = system.switch_gradient(state[None], np.zeros(1), system.nominal)[0][0, jumps]
    return tuple(k for k in part.velocities if not slopes[:, k].any())


def local_rows(
    system: System, part: LinearPart, orbit: Orbit, free: tuple[int, ...], *, tied: bool = False
) -> Local:
    """Linearise and eliminate the unknowns point by point.

    Raises FloatingPointError where the equations are not finite, numpy.linalg.LinAlgError where they do not
    determine the unknowns or rows are missing, and ValueError where forces depend on accelerations.
    """
    n, line = orbit.nodes.shape[1], evaluated(system, orbit, free)
    fast = eliminated(system, part, orbit, line) if tied else None
    if fast is not None:
        k, every = list(part.forces), fast.unknowns
        forces = every if k == list(range(every.shape[1])) else every[:, k]
        return Local(forces, fast.own, every, fast.residual, fast.filled, tied)
    rows = rows_of(orbit, line, tied)
    reduced, unknowns = eliminate(rows, n)
    filled = np.abs(reduced).max(axis=0).max(axis=1) > 0
    own = reduced[:, filled]
    states = list(part.states)
    if own.shape[1] != n - len(states):
        raise np.linalg.LinAlgError(
            f"the system has {own.shape[1]} rows for its {n - len(states)} own states; each needs one"
        )
    rates = [1 + k for k in states]
    forces = unknowns[:, list(part.forces)]
    if forces[:, :, rates].any() or own[:, :, rates].any():
        raise ValueError("forces at the places depend on accelerations there; a condensed system has none")
    return Local(-forces, own, -unknowns, rows.residual, np.flatnonzero(filled), tied)


def answer(
    system: System, orbit: Orbit, parameter: Array, free: tuple[int, ...], tolerance: float = 0.0
) -> tuple[Response, list[ModesLike | None]]:
    """Return the response of the retained modes on an orbit's mesh, and the derivatives of these modes.

    Modes too weak to matter at the tolerance follow the forces quasi-statically, see `retained_modes`. Raises
    ValueError for a system without a linear part, and FloatingPointError where modes grow beyond all numbers
    in a period, as at a negative frequency that Newton's method has tried.
    """
    part, mesh = linear_of(system), orbit.mesh
    if part is None:
        raise ValueError("the system has no linear part; condensation needs one")
    whole = part.modes(parameter)
    if not float(whole.exponents.real.max(initial=0.0)) * mesh.period < GREATEST:
        raise FloatingPointError("modes of the linear part grow beyond all numbers in a period")
    displacements = [k for k, state in enumerate(part.states) if state not in part.velocities]
    # where forces jump, modes that follow them at once would make the motion jump
    kept = retained_modes(whole, displacements, mesh.period, 0.0 if jumps_of(system) else tolerance)
    changes = [reduced_slope(whole, part.slope(parameter, k), kept) for k in free]
    return response_of(system, reduced(whole, kept), mesh.scheme, orbit.grid, mesh.period), changes


@dataclass(frozen=True)
class SplitLinearisation:
    """A split system about an orbit.

    Parameters
    ----------
    orbit : Orbit
        The orbit about which it is linearised.
    part : LinearPart
        The linear part.
    response : Response
        Its modes on the orbit's mesh.
    changes : list of ModesLike or None
        Their derivatives in the free parameters.
    rows : Local
        The system's own rows.
    system : System
        The system.
    """

    orbit: Orbit
    part: LinearPart
    response: Response
    changes: list[ModesLike | None]
    rows: Local
    system: System

    @classmethod
    def about(
        cls, system: System, orbit: Orbit, free: tuple[int, ...], tolerance: float = 0.0
    ) -> SplitLinearisation:
        """Linearise about an orbit, with the modes that matter at a tolerance, by default with all of them.

        Raises ValueError for a system without a linear part, and what `local_rows` raises.
        """
        response, changes = answer(system, orbit, orbit.parameter, free, tolerance)
        part = linear_of(system)
        assert part is not None
        rows = local_rows(system, part, orbit, free, tied=True)
        return cls(orbit, part, response, changes, rows, system)

    @cached_property
    def local(self) -> Local:
        """The system's own rows, with columns for all event nodes."""
        return self.rows.untied(self.orbit)

    @cached_property
    def saltations(self) -> list[ModalSaltation]:
        """The events at which forces jump. Raises numpy.linalg.LinAlgError."""
        return saltations(self.system, self.part, self.orbit, self.response)

    @cached_property
    def others(self) -> NDArray[np.int_]:
        """Indices of the own states."""
        own = np.ones(self.orbit.nodes.shape[1], dtype=bool)
        own[list(self.part.states)] = False
        return np.flatnonzero(own)

    @cached_property
    def flexibility(self) -> Flexibility:
        """The map from forces to the linear part's states in periodic motion."""
        return Flexibility.repeating(self.response)

    @cached_property
    def from_rest(self) -> Flexibility:
        """The same map for modes that begin at rest, z(0) = 0."""
        return Flexibility(self.response)

    @cached_property
    def forces(self) -> Array:
        """The forces at the points, (N, b, k)."""
        return np.ascontiguousarray(self.orbit.algebraic[:, :, list(self.part.forces)])

    @cached_property
    def _motion(self) -> tuple[Complex, Array]:
        """The modes' periodic motion under the forces, (N+1, J), and the states in it, (N, a, s)."""
        return self.response.motion(self.forces)

    @cached_property
    def _slopes(self) -> tuple[Array, Complex]:
        given = self.response, self.forces, self.orbit.grid.width_gradient, self.changes
        return slopes(*given, history=self._motion[0])

    @property
    def begun(self) -> Complex:
        """Derivative of z(0), the modes at the beginning of the period, in y, the forces fixed: (J, q)."""
        return self._slopes[1]

    @cached_property
    def affine(self) -> Array:
        """Increments of the linear part's states as a map of (1, dy), the forces held: (P, s, 1+q)."""
        count, points, s = self.missing.shape
        found = np.concatenate([self.missing[..., None], self._slopes[0]], axis=3)
        return found.reshape(count * points, s, -1)

    @cached_property
    def missing(self) -> Array:
        """The linear part's periodic motion under the forces less its states at the points, (N, a, s)."""
        return np.asarray(self._motion[1] - self.orbit.stages[:, :, list(self.part.states)])

    @cached_property
    def within(self) -> tuple[Array, Complex]:
        """Derivatives of states at the points, (N, a, s, 1+q), and of modes at the ends, (N, J, 1+q).

        In an interval's width and the free parameters, the forces and the modes at its beginning held.
        """
        return slopes_within(self.response, self.forces, self.changes, self._motion[0])
