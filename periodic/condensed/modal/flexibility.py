"""The flexibility matrix, from forces to states at the places: chosen columns, or its product with forces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.modal.moments import Complex
from periodic.condensed.modal.response import Response, real_product
from periodic.orbit.scheme import Array

Matrix = NDArray[Any]
"""Real or complex."""

SPREAD = 300.0
"""Largest decay (nepers) of a mode over a run of intervals whose responses one matrix product gives.

Its factors are as large as exp(SPREAD): a mode that decays faster is followed from interval to interval.
"""


@dataclass(frozen=True)
class Flexibility:
    """The linear map from forces to states at the points of N intervals, (N, a, s, N, b, k).

    It is seldom formed as a whole matrix.

    Parameters
    ----------
    response : Response
        The modes.
    closing : tuple of ndarray, optional
        Factors, (J,) each, for the modes and their conjugates: z(0) is the factor times the response at the
        end of the period of modes that begin at rest. Default 0, z(0) = 0.
    past : bool
        Whether forces act directly on states in the same period; else through `closing` alone.
    """

    response: Response
    closing: tuple[Complex, Complex] | None = None
    past: bool = True

    @classmethod
    def repeating(cls, response: Response, multiplier: complex = 1.0) -> Flexibility:
        """Return the flexibility for motions and forces that are multiplied by a number over the period."""
        return cls(response, response.closings(multiplier))

    @classmethod
    def by_multiplier(cls, response: Response, multiplier: complex) -> Flexibility:
        """Return the derivative of `repeating` in the multiplier."""
        own, other = response.closings(multiplier)
        return cls(response, (-(own**2), -(other**2)), past=False)

    @property
    def real(self) -> bool:
        """Whether real forces make real states."""
        return self.closing is None or np.array_equal(self.closing[1], self.closing[0].conj())

    @property
    def intervals(self) -> NDArray[np.int_]:
        """Indices of all intervals."""
        return np.arange(len(self.response.grid.width))

    @cached_property
    def whole(self) -> Matrix:
        """All columns, (N, a, s, N, b, k)."""
        if self._alike:
            return self._alike_between(*map(np.arange, self.response.modes.direct.shape))
        return self._block(self.intervals, self.intervals)

    @property
    def _alike(self) -> bool:
        """Whether the response between two intervals depends on their distance alone."""
        response = self.response
        begun = self.closing is None or self.closing[0] is response.closing
        return response.uniform and self.past and begun

    def _alike_between(self, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Matrix:
        """The map from some forces to some states where it is `_alike`, (N, a, s, N, b, k)."""
        return self.response.circulant(None if self.closing is None else self.closing[0], states, forces)

    def between(self, states: NDArray[np.int_], forces: NDArray[np.int_]) -> Flexibility:
        """Return the flexibility with some of the states and some of the forces alone."""
        return replace(self, response=self.response.between(states, forces))

    def part(
        self,
        states: NDArray[np.int_],
        forces: NDArray[np.int_],
        intervals: NDArray[np.int_],
        *,
        everywhere: bool,
    ) -> Matrix:
        """Return the block from some forces in some intervals, in order, to some states in these intervals.

        Shape (C, a, s, C, b, k); `everywhere`: to the states in all intervals, (N, a, s, C, b, k).
        """
        if not self._alike:
            return self.between(states, forces).block(intervals, everywhere=everywhere)
        found = self._alike_between(states, forces)
        if len(intervals) == len(self.intervals):
            return found
        return found[self.intervals if everywhere else intervals][:, :, :, intervals]

    def block(self, intervals: NDArray[np.int_], *, everywhere: bool) -> Matrix:
        """Return the block of `part` for all forces and states."""
        rows = self.intervals if everywhere else intervals
        if len(intervals) == len(self.intervals):
            return self.whole
        return self.whole[rows][:, :, :, intervals] if self.response.uniform else self._block(rows, intervals)

    @property
    def _stepped(self) -> bool:
        """Whether products are computed from interval to interval, without the matrix."""
        return self.real and self.past

    def applied(self, forces: Array) -> Matrix:
        """Return the states at the points, (N, a, s, r), by forces (N, b, k, r)."""
        response = self.response
        if not self._stepped or np.iscomplexobj(forces):
            found = self.whole.reshape(-1, forces[..., 0].size) @ forces.reshape(-1, forces.shape[3])
            return np.asarray(found.reshape(*self.whole.shape[:3], forces.shape[3]))
        return response.stages(forces, 0.0 if self.closing is None else self.closing[0])

    def pulled(self, weights: Array) -> Matrix:
        """Return the transposed product: weights of forces (N, b, k, r) from those of states (N, a, s, r)."""
        if not self._stepped or np.iscomplexobj(weights):
            found = self.whole.reshape(weights[..., 0].size, -1).T @ weights.reshape(-1, weights.shape[3])
            return np.asarray(found.reshape(*self.whole.shape[3:], weights.shape[3]))
        return self.response.pulled(weights, 0.0 if self.closing is None else self.closing[0])

    def _block(self, rows: NDArray[np.int_], intervals: NDArray[np.int_]) -> Matrix:
        points = self.response.scheme.ncol
        s, k = self.response.modes.direct.shape
        kind = float if self.real else complex
        found = np.zeros((len(rows), points, s, len(intervals), points, k), dtype=kind)
        if self.past:
            gaps = np.flatnonzero(np.diff(intervals) > 1) + 1
            for run in np.split(np.arange(len(intervals)), gaps) if len(intervals) else ():
                self._run(found[:, :, :, run[0] : run[-1] + 1], rows, intervals[run[0]])
        if self.closing is not None:
            found += self._earlier(rows, intervals, *self.closing).reshape(found.shape)
        return found

    def _earlier(
        self, at: NDArray[np.int_], intervals: NDArray[np.int_], own: Complex, other: Complex
    ) -> Matrix:
        """The response to forces in the periods before this one."""
        size = len(own)
        rows = self.response.ahead(at).reshape(-1, size)
        columns = self.response.left(intervals).reshape(size, -1)
        if self.real:
            return real_product(rows, own[:, None] * columns)
        plain, conjugate = rows @ (own[:, None] * columns), rows @ (other.conj()[:, None] * columns)
        return np.asarray((plain + conjugate.conj()) / 2)

    def _run(self, found: Matrix, rows: NDArray[np.int_], first: int) -> None:
        """Add the response, within the period, to forces in a run of intervals; `rows` hold all of these."""
        response, count = self.response, found.shape[3]
        inside, size = slice(first, first + count), len(response.modes.exponents)
        here = int(np.searchsorted(rows, first))
        own, after = slice(here, here + count), rows[here + count :]
        start, end = response.start[after], response.end[inside]
        each = np.arange(count)
        if count > 1:
            later = np.tril(np.ones((count, count), dtype=bool), -1)[:, None, None, :, None, None]
            duration = end[-1] - response.start[first]
            slow = np.abs(response.modes.exponents.real) * duration <= SPREAD
            for chosen, way in ((slow, self._spread), (~slow, self._chained)):
                if chosen.any():
                    found[own] += np.where(later, way(np.flatnonzero(chosen), inside), 0.0)
        found[here + each, :, :, each] += response.local[inside]
        if len(start):
            exponents = response.modes.exponents
            ahead = np.exp(exponents * (start - end[-1])[:, None])
            back = np.exp(exponents * (end[-1] - end)[:, None])
            outputs = (response.stage_outputs[after] * ahead[:, None, None]).reshape(-1, size)
            columns = response.impulse[inside] * back[:, :, None, None]
            columns = np.moveaxis(columns, 1, 0).reshape(size, -1)
            found[here + count :] += real_product(outputs, columns).reshape(len(start), *found.shape[1:])

    def _spread(self, chosen: NDArray[np.int_], inside: slice) -> Array:
        """Responses of some modes to forces in earlier intervals of a run, by one matrix product."""
        response = self.response
        exponents, begun = response.modes.exponents[chosen], response.start[inside.start]
        ahead = np.exp(exponents * (response.start[inside] - begun)[:, None])
        back = np.exp(-exponents * (response.end[inside] - begun)[:, None])
        outputs = response.stage_outputs[inside][..., chosen] * ahead[:, None, None]
        left = np.moveaxis(response.impulse[inside][:, chosen] * back[:, :, None, None], 1, 0)
        found = real_product(outputs.reshape(-1, len(chosen)), left.reshape(len(chosen), -1))
        return found.reshape(*outputs.shape[:3], *left.shape[1:])

    def _chained(self, chosen: NDArray[np.int_], inside: slice) -> Array:
        """Responses as in `_spread`, interval by interval, for modes that decay too fast for one product."""
        response, size = self.response, len(chosen)
        outputs = response.stage_outputs[inside][..., chosen]
        left = np.moveaxis(response.impulse[inside][:, chosen], 1, 0)
        decay = response.grown[inside][:, chosen]
        own, width, found = np.zeros_like(left).reshape(size, -1), left[0, 0].size, []
        for i, rows in enumerate(outputs):
            found.append(real_product(rows.reshape(-1, size), own))
            own = decay[i][:, None] * own
            own[:, i * width : (i + 1) * width] = left[:, i].reshape(size, -1)
        return np.array(found).reshape(*outputs.shape[:3], *left.shape[1:])
