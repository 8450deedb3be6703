"""The exact response of the modes to forces that are polynomials in each interval of a mesh.

    dz/dtau = lambda z + input f,   x = Re output z + direct f + direct_rate df/dtau

at the collocation points, either periodic, z(T) = z(0), or from a given start. Radau's last point is the end
of the interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.modal.moments import Complex, Moments, Table
from periodic.condensed.modal.quasistatic import Modes
from periodic.orbit.mesh import Grid
from periodic.orbit.scheme import Array, Scheme
from periodic.system import ModesLike


@cache
def moments_of(scheme: Scheme) -> Moments:
    """Return the moments of a scheme."""
    return Moments(scheme)


@dataclass(frozen=True)
class Response:
    """The modes on a mesh of N intervals with a points each, k forces and s states.

    Parameters
    ----------
    modes : ModesLike
        J modes.
    scheme : Scheme
        Collocation points.
    grid : Grid
        The intervals.
    period : float
        Period in rad.
    """

    modes: ModesLike
    scheme: Scheme
    grid: Grid
    period: float

    @property
    def moments(self) -> Moments:
        """The scheme's moments."""
        return moments_of(self.scheme)

    @cached_property
    def _distinct(self) -> tuple[Array, NDArray[np.int_]]:
        """Widths that differ by more than rounding, and which of them each interval has."""
        rounded = np.round(self.grid.width / self.period, 13)
        if (rounded == rounded[0]).all():
            return self.grid.width[:1], np.zeros(len(rounded), dtype=int)
        _, first, which = np.unique(rounded, return_index=True, return_inverse=True)
        return self.grid.width[first], which

    def between(self, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Response:
        """Return the response of some of the states to some of the forces."""
        modes = self.modes
        chosen = Modes(
            modes.exponents,
            modes.inputs[:, forces],
            modes.outputs[states],
            modes.direct[states][:, forces],
            modes.direct_rate[states][:, forces],
        )
        found = replace(self, modes=chosen)
        vars(found).update({name: getattr(self, name) for name in self._shared})
        return found

    @property
    def _shared(self) -> Sequence[str]:
        """Names of cached values that depend on mesh and exponents alone."""
        return "_distinct", "_table", "closing"

    @property
    def uniform(self) -> bool:
        """Whether all intervals are of one width."""
        return len(self._distinct[0]) == 1

    @cached_property
    def _table(self) -> Table:
        """Moments for the distinct widths, (U J, ...)."""
        return self.moments.table((self._distinct[0][:, None] * self.modes.exponents).ravel())

    @cached_property
    def table(self) -> Table:
        """Moments for all intervals, (N, J, ...)."""
        return self._table.take(self._distinct[1], len(self.modes.exponents))

    @cached_property
    def grown(self) -> Complex:
        """Growth factors of the modes over each interval, (N, J)."""
        growth = self._table.growth[:, -1].reshape(-1, len(self.modes.exponents))
        return np.asarray(growth[self._distinct[1]])

    @cached_property
    def closing(self) -> Complex:
        """1/(1 - exp(lambda T)), (J,): periodic z(0) over the z(T) that the same forces reach from rest."""
        with np.errstate(all="ignore"):
            return np.asarray(-1 / np.expm1(self.modes.exponents * self.period))

    @property
    def start(self) -> Array:
        """Phases of the intervals' left ends after that of the first, (N,)."""
        return self.grid.left - self.grid.left[0]

    @cached_property
    def end(self) -> Array:
        """Phases of the intervals' right ends after the first left end, (N,)."""
        return self.start + self.grid.width

    @cached_property
    def local(self) -> Array:
        """States at the points of an interval per unit of its own forces, (N, a, s, b, k)."""
        widths, which = self._distinct
        modes, count = self.modes, self.scheme.ncol
        s, k = modes.direct.shape
        weights = (modes.outputs.T[:, :, None] * modes.inputs[:, None, :]).reshape(-1, s * k)
        moment = self._table.moment.reshape(len(widths), len(modes.exponents), -1)
        found = (np.swapaxes(moment, 1, 2) @ weights).real.reshape(len(widths), count, count, s, k)
        found = widths[:, None, None, None, None] * found.transpose(0, 1, 3, 2, 4)
        each = np.arange(count)
        found[:, each, :, each] += modes.direct
        slope = self.moments.derivatives[1, 1:] if count > 1 else np.zeros((count, count))
        rates = slope[None, :, None, :, None] * modes.direct_rate[:, None, :]
        found += rates / widths[:, None, None, None, None]
        return np.asarray(found[which])

    @cached_property
    def impulse(self) -> Complex:
        """Modes at the end of an interval per unit of the forces in it, from rest before: (N, J, b, k)."""
        widths, which = self._distinct
        moment = self._table.moment[:, -1].reshape(len(widths), len(self.modes.exponents), -1, 1)
        return np.asarray((widths[:, None, None, None] * moment * self.modes.inputs[:, None, :])[which])

    @cached_property
    def stage_outputs(self) -> Complex:
        """States at the points per unit of the modes at the left end, (N, a, s, J)."""
        widths, which = self._distinct
        growth = np.swapaxes(self._table.growth.reshape(len(widths), len(self.modes.exponents), -1), 1, 2)
        return np.asarray((growth[:, :, None, :] * self.modes.outputs)[which])

    def history(self, forces: Array, closing: Complex | None = None) -> Complex:
        """Return the modes at the mesh points in periodic motion, (N+1, J, ...); forces (N, b, k, ...).

        With one of `closings` as `closing`, the motion is multiplied by a number over the period.
        """
        found = self.closed(self._kicks(forces), self.closing if closing is None else closing)
        return found.reshape(*found.shape[:2], *forces.shape[3:])

    def motion(self, forces: Array) -> tuple[Complex, Array]:
        """Return periodic motion: modes as `history` has them, states as `stages`; forces (N, b, k)."""
        history = self.history(forces)
        return history, self._states(forces, history[:-1, :, None])

    def stages(self, forces: Array, closing: Complex | float | None = None) -> Array:
        """Return the states at the points in periodic motion, (N, a, s, ...); forces (N, b, k, ...).

        With a `closing` of 0 the modes begin at rest.
        """
        history = self.closed(self._kicks(forces), self.closing if closing is None else np.asarray(closing))
        return self._states(forces, history[:-1])

    def pulled(self, weights: Array, closing: Complex | float) -> Array:
        """Return the adjoint of `stages`: weights of states to weights of forces, (N, b, k, r).

        It goes backwards from interval to interval.
        """
        count, points, s, r = weights.shape
        flat = weights.reshape(count, points * s, r)
        size = len(self.modes.exponents)
        transposed = np.swapaxes(self.stage_outputs.reshape(count, -1, size), 1, 2) @ flat
        driven, grown = _joined(transposed[::-1].copy(), self.grown[::-1].copy())
        ends = np.zeros_like(driven)
        # adjoint of z(0) = closing z(T): the weight of z(0) goes to the end of the period
        ends[0] = np.asarray(closing).reshape(-1, 1) * driven[-1]
        ends[1:] = driven[:-1] + grown[:-1, :, None] * ends[0]
        impulse = np.swapaxes(self.impulse.reshape(count, size, -1), 1, 2)
        own = np.swapaxes(self.local.reshape(count, points * s, -1), 1, 2) @ flat
        found = own + (impulse @ ends[::-1]).real
        return np.asarray(found.reshape(count, points, -1, r))

    def motions(self, forces: Array, begun: Complex) -> tuple[Array, Complex]:
        """Return states at the points (N, a, s, r) and modes at the end (J, r) of r motions.

        They begin with z(0) = `begun`, (J, r), under forces (N, b, k, r).
        """
        driven, grown = self._chain(self._kicks(forces))
        at = np.concatenate([begun[None], driven + grown[:, :, None] * begun])
        return self._states(forces, at[:-1]), at[-1]

    def driven(self, forces: Array) -> Complex:
        """Return the modes at the mesh points from z(0) = 0, (N+1, J, r); forces (N, b, k, r)."""
        left = self._kicks(forces)
        return np.concatenate([np.zeros_like(left[:1]), self._chain(left)[0]])

    def _kicks(self, forces: Array) -> Complex:
        """Modes at the end of each interval due to forces (N, b, k, ...) in it, from rest: (N, J, r)."""
        count, size = len(forces), len(self.modes.exponents)
        flat = forces.reshape(count, forces.shape[1] * forces.shape[2], -1)
        if not self.uniform:
            return np.asarray(self.impulse.reshape(count, size, -1) @ flat)
        found = self.impulse[0].reshape(size, -1) @ flat.transpose(1, 0, 2).reshape(flat.shape[1], -1)
        return np.ascontiguousarray(found.reshape(size, count, -1).transpose(1, 0, 2))

    def _states(self, forces: Array, at: Complex) -> Array:
        """States at the points (N, a, s, ...) from forces (N, b, k, ...), modes at left ends (N, J, r)."""
        count, points = forces.shape[:2]
        flat = forces.reshape(count, points * forces.shape[2], -1)
        own = self.local.reshape(count, -1, flat.shape[1]) @ flat
        shape = (count, points, len(self.modes.direct), *forces.shape[3:])
        return np.asarray((own + self._driven_states(at)).reshape(shape))

    def _driven_states(self, at: Complex) -> Array:
        """States at the points due to modes at the left ends, (N, J, r): shape (N, a s, r)."""
        count, size, r = at.shape
        rows = self.stage_outputs.reshape(count, -1, size)
        if not self.uniform:
            return np.asarray((rows @ at).real)
        found = real_product(rows[0], at.transpose(1, 0, 2).reshape(size, -1))
        return np.asarray(found.reshape(-1, count, r).transpose(1, 0, 2))

    def closings(self, multiplier: complex) -> tuple[Complex, Complex]:
        """Return 1/(mu - exp(lambda T)) of the modes and of their conjugates, each (J,).

        With them z(T) = mu z(0), as with `closing` z(T) = z(0).
        """
        if multiplier == 1.0:
            return self.closing, self.closing.conj()
        grown = np.exp(self.modes.exponents * self.period)
        return 1 / (multiplier - grown), 1 / (multiplier - grown.conj())

    def sloped(
        self,
        forces: Array,
        widths: Array,
        changes: Sequence[ModesLike],
        closing: Complex,
        history: Complex | None = None,
    ) -> tuple[NDArray[Any], Complex]:
        """Return the derivatives of states at the points, (N, a, s, q), and modes at the beginning, (J, q).

        The first directions change the intervals' widths, further ones the modes. States are complex here;
        `slopes` takes their real parts, and allows for modes that do not change and for complex forces.
        """
        history = self.history(forces, closing) if history is None else history
        inner = self._inner(forces, widths, changes, history)
        moved = self.closed(inner[:, :, -1], closing)
        states = inner + self.table.growth[..., None] * moved[:-1, :, None]
        return self._sloped_states(states, forces, widths, changes, history), moved[0]

    def sloped_within(
        self, forces: Array, changes: Sequence[ModesLike], history: Complex
    ) -> tuple[Array, Complex]:
        """Return derivatives of states at the points, (N, a, s, q), and of modes at the ends, (N, J, q).

        As in `sloped`, but in the width of the interval alone, in which modes begin as they are.
        """
        own = np.ones((len(self.grid.width), 1))
        inner = self._inner(forces, own, changes, history)
        return self._sloped_states(inner, forces, own, changes, history).real, inner[:, :, -1]

    def _inner(self, forces: Array, widths: Array, changes: Sequence[ModesLike], history: Complex) -> Complex:
        """Derivatives of the modes at the points, (N, J, a, q), those at the left ends held."""
        modes, table, width = self.modes, self.table, self.grid.width
        first, q = widths.shape[1], widths.shape[1] + len(changes)
        stretch = np.zeros((len(width), q))
        stretch[:, :first] = widths
        by_exponent = np.zeros((len(modes.exponents), q), dtype=complex)
        for i, change in enumerate(changes):
            by_exponent[:, first + i] = change.exponents
        # derivative of lambda h, h the width
        shift = width[:, None, None] * by_exponent + stretch[:, None, :] * modes.exponents[:, None]
        driven = _driving(forces, modes.inputs)
        own, own_slope = _applied(self, table.moment, driven), _applied(self, table.slope, driven)
        inner = stretch[:, None, None, :] * own[..., None]
        inner += (width[:, None, None] * own_slope)[..., None] * shift[:, :, None, :]
        turn = self.scheme.points[:, None] * shift[:, :, None, :]
        inner += (table.growth * history[:-1, :, None])[..., None] * turn
        for i, change in enumerate(changes):
            other = _driving(forces, change.inputs)
            inner[..., first + i] += width[:, None, None] * _applied(self, table.moment, other)
        return np.asarray(inner)

    def _sloped_states(
        self, states: Complex, forces: Array, widths: Array, changes: Sequence[ModesLike], history: Complex
    ) -> NDArray[Any]:
        """Derivatives of states at the points, (N, a, s, q), from those of the modes, (N, J, a, q)."""
        modes, table, width = self.modes, self.table, self.grid.width
        first, q = widths.shape[1], widths.shape[1] + len(changes)
        stretch = np.zeros((len(width), q))
        stretch[:, :first] = widths
        own = _applied(self, table.moment, _driving(forces, modes.inputs))
        count, points = len(width), len(self.scheme.points)
        flat = states.transpose(1, 0, 2, 3).reshape(len(modes.exponents), -1)
        found = (modes.outputs @ flat).reshape(-1, count, points, q).transpose(1, 2, 0, 3).copy()
        stages = table.growth * history[:-1, :, None] + width[:, None, None] * own
        rates = np.einsum("ab,nbk->nak", self.moments.derivatives[1, 1:], forces) / width[:, None, None]
        for i, change in enumerate(changes):
            found[..., first + i] += (change.outputs @ stages).transpose(0, 2, 1)
            found[..., first + i] += forces @ change.direct.T + rates @ change.direct_rate.T
        lost = rates @ modes.direct_rate.T
        found -= lost[..., None] * (stretch / width[:, None])[:, None, None, :]
        return np.asarray(found)

    def circulant(self, closing: Complex | None, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Array:
        """Return the map from some forces to some states on a uniform mesh, (N, a, s, N, b, k).

        It depends on the number of intervals in between alone. Without `closing` the modes begin at rest.
        """
        modes, count, points = self.modes, len(self.grid.width), self.scheme.ncol
        s, k = len(states), len(forces)
        impulse = self.impulse[0][:, :, forces]
        impulse = impulse if closing is None else impulse * closing[:, None, None]
        # from the largest number of intervals in between to the smallest, as along a row of the map
        ahead = np.exp(modes.exponents[:, None] * (self.grid.width[0] * np.arange(count - 1.0, -1.0, -1.0)))
        moved = ahead[:, :, None] * impulse.reshape(len(ahead), 1, -1)
        stage_outputs = self.stage_outputs[0][:, states].reshape(points * s, -1)
        found = real_product(stage_outputs, moved.reshape(len(ahead), -1)).reshape(
            points * s, count, points * k
        )
        twice = np.concatenate([found, np.zeros_like(found) if closing is None else found], axis=1)
        row, column, each = twice.strides
        laid = np.lib.stride_tricks.as_strided(
            twice[:, count:], (count, *found.shape), (-column, row, column, each), writeable=False
        )
        whole = np.array(laid).reshape(count, points, s, count, points, k)
        own = np.arange(count)
        whole[own, :, :, own] += self.local[:, :, states][..., forces]
        return whole

    def closed(self, left: Complex, closing: Complex) -> Complex:
        """Return the modes at the mesh points, (N+1, J, ...); `left`: the addition of each interval."""
        size = [1] * (left.ndim - 2)
        driven, grown = self._chain(left)
        found = np.zeros((len(left) + 1, *left.shape[1:]), dtype=complex)
        found[0] = closing.reshape(-1, *size) * driven[-1]
        found[1:] = driven + grown.reshape(*grown.shape, *size) * found[0]
        return found

    def _chain(self, left: Complex) -> tuple[Complex, Complex]:
        """Modes at the right ends from z(0) = 0 with additions `left`; growth factors from tau_0, (N, J)."""
        return _joined(left.copy(), self.grown.copy())

    @cached_property
    def growth(self) -> Complex:
        """Growth factors of the modes from tau_0 to the mesh points, (N+1, J)."""
        return np.exp(self.modes.exponents * np.append(self.start, self.period)[:, None])

    def grown_since(self, node: int) -> Complex:
        """Return growth factors of the modes from a mesh point to it and the later ones, (N+1 - node, J)."""
        times = np.append(self.start, self.period)[node:]
        return np.exp(self.modes.exponents * (times - times[0])[:, None])

    def ahead(self, intervals: NDArray[np.int_]) -> Complex:
        """Return the states at points of some intervals per unit of the initial modes, (R, a, s, J)."""
        return np.asarray(self.stage_outputs[intervals] * self.growth[intervals, None, None])

    def left(self, intervals: NDArray[np.int_]) -> Complex:
        """Return the modes at the end of the period per unit of forces in some intervals, (J, C, b, k)."""
        after = self.period - self.end[intervals]
        left = np.exp(self.modes.exponents * after[:, None])[:, :, None, None] * self.impulse[intervals]
        return np.moveaxis(left, 1, 0)


def _joined(driven: Complex, grown: Complex) -> tuple[Complex, Complex]:
    """Return z_j = grown_j z_{j-1} + driven_j from z = 0, (N, J, ...), and products of the grown_j, (N, J).

    It is a parallel prefix scan, in about log2 N array operations.
    """
    size, step = [1] * (driven.ndim - 2), 1
    while step < len(driven):
        driven[step:] += grown[step:].reshape(*grown[step:].shape, *size) * driven[:-step]
        grown[step:] = grown[step:] * grown[:-step]
        step *= 2
    return driven, grown


def real_product(rows: Complex, columns: Complex) -> Array:
    """Return Re rows @ columns."""
    left = np.concatenate([rows.real, -rows.imag], axis=1)
    return np.asarray(left @ np.concatenate([columns.real, columns.imag]))


def _driving(forces: Array, inputs: Complex) -> Complex:
    """Modal forces, (N, J, b), due to forces (N, b, k)."""
    return np.asarray((forces @ inputs.T).transpose(0, 2, 1))


def _applied(response: Response, moment: Complex, driven: Complex) -> Complex:
    """Moments (N, J, a, b) times modal forces (N, J, b): shape (N, J, a)."""
    if response.uniform:
        return np.asarray((moment[0] @ driven.transpose(1, 2, 0)).transpose(2, 0, 1))
    return np.asarray((moment @ driven[..., None])[..., 0])
