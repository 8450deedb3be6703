"""The exact response of the modes to forces that are polynomials in each interval of a mesh.

    dz/dtau = lambda z + input f,   x = Re output z + direct f + direct_rate df/dtau

at the collocation points, either periodic, z(T) = z(0), or from a given start. Radau's last point is the end
of the interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.moments import Complex, Moments, Table
from periodic.orbit.mesh import Grid
from periodic.orbit.scheme import Array, Scheme
from periodic.system import ModesLike

SPREAD = 300.0
"""Decay over a period (nepers) up to which the modes' way between any two intervals is one product."""


@cache
def _moments(scheme: Scheme) -> Moments:
    return Moments(scheme)


@dataclass(frozen=True)
class Response:
    """The modes on a mesh of N intervals with a points each, k forces and s = 2k states.

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
        return _moments(self.scheme)

    @cached_property
    def _distinct(self) -> tuple[Array, NDArray[np.int_]]:
        """Widths that differ by more than rounding, and which of them each interval has."""
        rounded = np.round(self.grid.width / self.period, 13)
        _, first, which = np.unique(rounded, return_index=True, return_inverse=True)
        return self.grid.width[first], which

    @property
    def uniform(self) -> bool:
        """Whether all intervals are of one width."""
        return len(self._distinct[0]) == 1

    @cached_property
    def _table(self) -> Table:
        """Of the distinct widths, (U J, ...)."""
        return self.moments.table((self._distinct[0][:, None] * self.modes.exponents).ravel())

    @cached_property
    def table(self) -> Table:
        """Of all intervals, (N, J, ...)."""
        return self._table.take(self._distinct[1], len(self.modes.exponents))

    @cached_property
    def closing(self) -> Complex:
        """1/(1 - exp(lambda T)): how a mode's periodic motion follows from that of one period, (J,)."""
        with np.errstate(all="ignore"):
            return np.asarray(-1 / np.expm1(self.modes.exponents * self.period))

    @property
    def start(self) -> Array:
        """Phases of the intervals' left ends after that of the first, (N,)."""
        return self.grid.left - self.grid.left[0]

    @cached_property
    def local(self) -> Array:
        """States at the points of an interval by its own forces, (N, a, s, b, k)."""
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
        """What forces leave in the modes at the end of their interval, (N, J, b, k)."""
        moment = self.table.moment[:, :, -1, :, None]
        driven = moment * self.modes.inputs[:, None, :]
        return np.asarray(self.grid.width[:, None, None, None] * driven)

    @cached_property
    def periodic(self) -> Array:
        """The periodic response, (N, a, s, N, b, k)."""
        if self.uniform:
            return self._circulant(self.closing)
        return self._parts[0] + self._parts[1]

    @cached_property
    def from_rest(self) -> Array:
        """The response from z(0) = 0, (N, a, s, N, b, k)."""
        return self._circulant(None) if self.uniform else self._parts[0]

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """Responses to forces of this period, and of the periods before."""
        s, k = self.modes.direct.shape
        count, points = len(self.grid.width), self.scheme.ncol
        later = np.tril(np.ones((count, count), dtype=bool), -1)[:, None, None, :, None, None]
        past, before = np.zeros((2, count, points, s, count, points, k))
        spread = np.abs(self.modes.exponents.real) * self.period <= SPREAD
        for chosen, way in ((spread, self._spread), (~spread, self._chained)):
            if chosen.any():
                own, wrapped = way(np.flatnonzero(chosen))
                past += np.where(later, own, 0.0)
                before += wrapped
        each = np.arange(count)
        past[each, :, :, each] += self.local
        return past, before

    def _spread(self, chosen: NDArray[np.int_]) -> tuple[Array, Array]:
        """Responses to earlier intervals of this period and to the periods before, by one product each."""
        exponents = self.modes.exponents[chosen]
        ahead = np.exp(exponents * self.start[:, None])
        back = np.exp(-exponents * (self.start + self.grid.width)[:, None])
        shown = self._shown(chosen) * ahead[:, None, None]
        left = self.impulse[:, chosen] * back[:, :, None, None]
        s, k = self.modes.direct.shape
        count, points = len(self.grid.width), self.scheme.ncol
        rows, size = shown.reshape(-1, len(chosen)), len(chosen)
        columns = np.moveaxis(left, 1, 0).reshape(size, -1)
        turned = (np.exp(exponents * self.period) * self.closing[chosen])[:, None] * columns
        shape = (count, points, s, count, points, k)
        return _real_product(rows, columns).reshape(shape), _real_product(rows, turned).reshape(shape)

    def _shown(self, chosen: NDArray[np.int_]) -> Complex:
        """States at the points by the modes at the left end, (N, a, s, J)."""
        growth = np.swapaxes(self.table.growth[:, chosen], 1, 2)
        return np.asarray(growth[:, :, None, :] * self.modes.outputs[:, chosen])

    def _chained(self, chosen: NDArray[np.int_]) -> tuple[Array, Array]:
        """The same interval after interval, for modes that decay too fast for one product."""
        count, size = len(self.grid.width), len(chosen)
        shown, left = self._shown(chosen), np.moveaxis(self.impulse[:, chosen], 1, 0)
        decay = self.table.growth[:, chosen, -1]
        after = self.period - self.start - self.grid.width
        exponents = self.modes.exponents[chosen]
        held = np.exp(exponents[:, None] * after)[:, :, None, None] * left
        held = (held * self.closing[chosen][:, None, None, None]).reshape(size, -1)
        own = np.zeros_like(left).reshape(size, -1)
        found = []
        width = left[0, 0].size
        for i in range(count):
            rows = shown[i].reshape(-1, size)
            found.append([_real_product(rows, own), _real_product(rows, held)])
            own, held = decay[i][:, None] * own, decay[i][:, None] * held
            own[:, i * width : (i + 1) * width] = left[:, i].reshape(size, -1)
        both = np.array(found).reshape(count, 2, *shown.shape[1:3], count, *left.shape[2:])
        return both[:, 0], both[:, 1]

    def _circulant(self, closing: Complex | None) -> Array:
        """On a uniform mesh only how many intervals later counts; without `closing` that from rest."""
        modes, count, points = self.modes, len(self.grid.width), self.scheme.ncol
        s, k = modes.direct.shape
        width, table = self.grid.width[0], self._table
        impulse = width * table.moment[:, -1, :, None] * modes.inputs[:, None, :]
        impulse = impulse if closing is None else impulse * closing[:, None, None]
        # by falling number of intervals, as the columns of a row have it
        ahead = np.exp(modes.exponents[:, None] * (width * np.arange(count - 1.0, -1.0, -1.0)))
        moved = ahead[:, :, None] * impulse.reshape(len(ahead), 1, -1)
        shown = (table.growth.T[:, None, :] * modes.outputs).reshape(points * s, -1)
        found = _real_product(shown, moved.reshape(len(ahead), -1)).reshape(points * s, count, points * k)
        twice = np.concatenate([found, np.zeros_like(found) if closing is None else found], axis=1)
        row, column, each = twice.strides
        laid = np.lib.stride_tricks.as_strided(
            twice[:, count:], (count, *found.shape), (-column, row, column, each), writeable=False
        )
        whole = np.array(laid).reshape(count, points, s, count, points, k)
        own = np.arange(count)
        whole[own, :, :, own] += self.local
        return whole

    def history(self, forces: Array, closing: Complex | None = None) -> Complex:
        """Return the modes at the left ends and at the end in periodic motion, (N+1, J); forces (N, b, k).

        Another `closing` than the periodic one is that of `closings`.
        """
        last = self.table.moment[:, :, -1:]
        left = self._applied(last, self._driving(forces, self.modes.inputs))[..., 0]
        return self._closed(self.grid.width[:, None] * left, self.closing if closing is None else closing)

    def stages(self, forces: Array) -> Array:
        """Return the states at the points in periodic motion, (N, a, s), whatever their number."""
        history = self.history(forces)
        flat = forces.reshape(len(forces), -1, 1)
        local = self.local.reshape(len(flat), -1, flat.shape[1]) @ flat
        found = local + self._seen(history[:-1, :, None])
        return np.asarray(found.reshape(*forces.shape[:2], -1))

    def motions(self, forces: Array, begun: Complex) -> tuple[Array, Complex]:
        """Return states at the points (N, a, s, r) and modes at the end (J, r) of motions from z(0).

        Parameters
        ----------
        forces : ndarray, shape (N, b, k, r)
            Forces of r motions.
        begun : ndarray of complex, shape (J, r)
            z(0).
        """
        count, points, _, r = forces.shape
        flat, size = forces.reshape(count, -1, r), len(self.modes.exponents)
        if self.uniform:
            ended = self.impulse[0].reshape(size, -1) @ flat.transpose(1, 0, 2).reshape(-1, count * r)
            ended = np.ascontiguousarray(ended.reshape(size, count, r).transpose(1, 0, 2))
        else:
            ended = self.impulse.reshape(count, size, -1) @ flat
        driven, grown = self._chain(ended)
        at = np.concatenate([begun[None], driven + grown[:, :, None] * begun])
        local = self.local.reshape(count, -1, flat.shape[1]) @ flat
        return (local + self._seen(at[:-1])).reshape(count, points, -1, r), at[count]

    def _seen(self, at: Complex) -> Array:
        """States at the points by the modes at the left ends, (N, J, r): shape (N, a s, r)."""
        count, size, r = at.shape
        growth = np.swapaxes(self.table.growth[:1] if self.uniform else self.table.growth, 1, 2)
        rows = (growth[:, :, None] * self.modes.outputs).reshape(len(growth), -1, size)
        if self.uniform:
            found = _real_product(rows[0], at.transpose(1, 0, 2).reshape(size, -1))
            return np.asarray(found.reshape(-1, count, r).transpose(1, 0, 2))
        return np.asarray((rows @ at).real)

    def closings(self, multiplier: complex) -> tuple[Complex, Complex]:
        """Return 1/(mu - exp(lambda T)) of the modes and of their conjugates, each (J,).

        With them z(T) = mu z(0), as with `closing` z(T) = z(0).
        """
        grown = np.exp(self.modes.exponents * self.period)
        return 1 / (multiplier - grown), 1 / (multiplier - grown.conj())

    def earlier(self, closing: Complex, conjugate: Complex) -> Complex:
        """Return the response to the periods before, (P s, P k), by the closings of modes and conjugates."""
        rows = self._ahead.reshape(-1, len(self.modes.exponents))
        columns = self._left.reshape(len(self.modes.exponents), -1)
        one, other = rows @ (closing[:, None] * columns), rows @ (conjugate.conj()[:, None] * columns)
        return np.asarray((one + other.conj()) / 2)

    def _closed(self, left: Complex, closing: Complex) -> Complex:
        """The history of what each interval leaves in the modes, (N, J, ...)."""
        size = [1] * (left.ndim - 2)
        driven, grown = self._chain(left)
        found = np.zeros((len(left) + 1, *left.shape[1:]), dtype=complex)
        found[0] = closing.reshape(-1, *size) * driven[-1]
        found[1:] = driven + grown.reshape(*grown.shape, *size) * found[0]
        return found

    def _chain(self, left: Complex) -> tuple[Complex, Complex]:
        """What all intervals so far leave in modes at rest, as `left`, and how these have grown, (N, J).

        Neighbours are joined in pairs, pairs in fours, and so on.
        """
        driven, grown = left.copy(), self.table.growth[:, :, -1].copy()
        size, step = [1] * (left.ndim - 2), 1
        while step < len(left):
            driven[step:] += grown[step:].reshape(-1, left.shape[1], *size) * driven[:-step]
            grown[step:] = grown[step:] * grown[:-step]
            step *= 2
        return driven, grown

    def slopes(
        self, forces: Array, widths: Array, changes: list[ModesLike | None], multiplier: complex = 1.0
    ) -> tuple[Array, Complex]:
        """Return how the motion changes with widths and modes, forces held.

        The states at the points, (N, a, s, q), and the modes at the beginning, (J, q).

        Parameters
        ----------
        forces : ndarray, shape (N, b, k)
            The forces.
        widths : ndarray, shape (N, q1)
            Changes of the widths in the first q1 directions.
        changes : list of ModesLike or None
            Changes of the modes in further ones.
        multiplier : complex
            What forces and motion are multiplied by over the period; with a complex one the forces may be
            complex, and the modes at the beginning are left out.
        """
        count, points = len(self.grid.width), self.scheme.ncol
        s, q = self.modes.direct.shape[0], widths.shape[1] + len(changes)
        turning = np.iscomplexobj(forces)
        found = np.zeros((count, points, s, q), dtype=complex if turning else float)
        begun = np.zeros((len(self.modes.exponents), q), dtype=complex)
        active = [i for i, change in enumerate(changes) if change is not None]
        given = [change for change in changes if change is not None]
        if widths.shape[1] + len(given) == 0:
            return found, begun
        columns = [*range(widths.shape[1]), *(widths.shape[1] + i for i in active)]
        closing, conjugate = (self.closing,) * 2 if multiplier == 1.0 else self.closings(multiplier)
        shown, begun[:, columns] = self._slopes(forces, widths, given, closing)
        if turning:
            other, _ = self._slopes(forces.conj(), widths, given, conjugate.conj())
            found[..., columns] = (shown + other.conj()) / 2
        else:
            found[..., columns] = shown.real
        return found, begun

    def _slopes(
        self, forces: Array, widths: Array, changes: list[ModesLike], closing: Complex
    ) -> tuple[Complex, Complex]:
        modes, table, width = self.modes, self.table, self.grid.width
        first, q = widths.shape[1], widths.shape[1] + len(changes)
        stretch = np.zeros((len(width), q))
        stretch[:, :first] = widths
        faster = np.zeros((len(modes.exponents), q), dtype=complex)
        for i, change in enumerate(changes):
            faster[:, first + i] = change.exponents
        # x = lambda h
        shift = width[:, None, None] * faster + stretch[:, None, :] * modes.exponents[:, None]
        history = self.history(forces, closing)
        driven = self._driving(forces, modes.inputs)
        answer, steeper = self._applied(table.moment, driven), self._applied(table.slope, driven)
        inner = stretch[:, None, None, :] * answer[..., None]
        inner += (width[:, None, None] * steeper)[..., None] * shift[:, :, None, :]
        turn = self.scheme.points[:, None] * shift[:, :, None, :]
        inner += (table.growth * history[:-1, :, None])[..., None] * turn
        for i, change in enumerate(changes):
            other = self._driving(forces, change.inputs)
            inner[..., first + i] += width[:, None, None] * self._applied(table.moment, other)
        moved = self._closed(inner[:, :, -1], closing)
        states = inner + table.growth[..., None] * moved[:-1, :, None]
        count, points = len(width), len(self.scheme.points)
        flat = states.transpose(1, 0, 2, 3).reshape(len(modes.exponents), -1)
        found = (modes.outputs @ flat).reshape(-1, count, points, q).transpose(1, 2, 0, 3).copy()
        stages = table.growth * history[:-1, :, None] + width[:, None, None] * answer
        rates = np.einsum("ab,nbk->nak", self.moments.derivatives[1, 1:], forces) / width[:, None, None]
        for i, change in enumerate(changes):
            found[..., first + i] += (change.outputs @ stages).transpose(0, 2, 1)
            found[..., first + i] += forces @ change.direct.T + rates @ change.direct_rate.T
        lost = rates @ modes.direct_rate.T
        found -= lost[..., None] * (stretch / width[:, None])[:, None, None, :]
        return np.asarray(found), moved[0]

    @staticmethod
    def _driving(forces: Array, inputs: Complex) -> Complex:
        """Forces (N, b, k) as they drive the modes, (N, J, b)."""
        return np.asarray((forces @ inputs.T).transpose(0, 2, 1))

    def _applied(self, moment: Complex, driven: Complex) -> Complex:
        """Moments (N, J, a, b) of what drives the modes, (N, J, b): shape (N, J, a)."""
        if self.uniform:
            return np.asarray((moment[0] @ driven.transpose(1, 2, 0)).transpose(2, 0, 1))
        return np.asarray((moment @ driven[..., None])[..., 0])

    @property
    def growth(self) -> Complex:
        """How the modes have grown at the mesh points, (N+1, J)."""
        return np.exp(self.modes.exponents * np.append(self.start, self.period)[:, None])

    @cached_property
    def _ahead(self) -> Complex:
        """States at the points by the modes at the beginning, (N, a, s, J)."""
        return self._shown(np.arange(len(self.modes.exponents))) * self.growth[:-1, None, None]

    @cached_property
    def _left(self) -> Complex:
        """What forces leave in the modes at the end of the period, (J, N, b, k)."""
        after = self.period - self.start - self.grid.width
        left = np.exp(self.modes.exponents * after[:, None])[:, :, None, None] * self.impulse
        return np.moveaxis(left, 1, 0)

    def free(self) -> Array:
        """Return free motion: states at the points by (Re z, Im z) of the start, (N, a, s, 2J)."""
        return np.concatenate([self._ahead.real, -self._ahead.imag], axis=-1)

    def driven(self, forces: Array) -> Complex:
        """Return the modes at the mesh points from z(0) = 0, (N+1, J, r); forces (N, b, k, r)."""
        count, modes = len(self.grid.width), len(self.modes.exponents)
        left = self.impulse.reshape(count, modes, -1) @ forces.reshape(count, -1, forces.shape[3])
        return np.concatenate([np.zeros_like(left[:1]), self._chain(left)[0]])

    def final(self) -> Array:
        """Return what forces leave in (Re z, Im z) at the end of the period, (2J, N, b, k)."""
        return np.concatenate([self._left.real, self._left.imag])


def _real_product(rows: Complex, columns: Complex) -> Array:
    """Re rows @ columns."""
    left = np.concatenate([rows.real, -rows.imag], axis=1)
    return np.asarray(left @ np.concatenate([columns.real, columns.imag]))
