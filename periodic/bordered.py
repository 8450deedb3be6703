"""The bordered system that is left after condensation: chain of intervals, periodicity, closures.

Intervals are chained to affine maps of (1, dx_0, dy); periodicity dx_N = dx_0 and the closures then give a
dense system of size n + q for (dx_0, dy). The chain's linear part is the monodromy matrix.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.closure import Row
from periodic.native import Routines
from periodic.orbit import Orbit
from periodic.scheme import Array


class Condensed(Protocol):
    """Linearised equations with what is local eliminated: each mesh point follows from an earlier one.

        dx_{j+1} = step[j] (1, dx_origin[j], dy),   step (N, n, 1+n+q), origin (N,)

    orbit is the one linearised at, residual the largest of its equations; compiled chains in C.
    """

    @property
    def orbit(self) -> Orbit: ...
    @property
    def step(self) -> Array: ...
    @property
    def origin(self) -> NDArray[np.int_]: ...
    @property
    def residual(self) -> float: ...
    @property
    def compiled(self) -> Routines | None: ...

    def reduced(self, row: Row) -> Row:
        """Return a closure in mesh-point states and y alone, its stages eliminated."""

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns that go with node increments and dy = `outer`.

        constant is 1 for a Newton step, 0 for a direction along the solution set.
        """


@dataclass(frozen=True)
class BorderedSolution:
    """Newton increments of mesh-point states (N+1, n) and y (q,), the kernel direction, the fundamental
    matrices at the mesh points (N+1, n, n), the last of which is the monodromy matrix.

    The kernel direction solves the homogeneous equations with right-hand side 1 in the last closure; it is
    None where there is no closure beyond the events.
    """

    nodes: Array
    outer: Array
    kernel_nodes: Array | None
    kernel_outer: Array | None
    fundamental: Array


SMALL = 16
"""Up to so many states, neighbouring maps are multiplied in pairs: more products, but far fewer calls."""


def chain(condensed: Condensed) -> Array:
    """Return the affine maps (1, dx_0, dy) -> dx_j, shape (N+1, n, 1+n+q)."""
    if condensed.compiled is not None:
        return condensed.compiled.chain(condensed.step)
    count, n, width = condensed.step.shape
    first = np.zeros((1, n, width))
    first[0, :, 1 : 1 + n] = np.eye(n)
    if n <= SMALL and np.array_equal(condensed.origin, np.arange(count)):
        return np.concatenate([first, _chained(condensed.step)])
    maps = np.concatenate([first, np.empty((count, n, width))])
    for j in range(count):
        maps[j + 1 : j + 2] = _after(condensed.step[j : j + 1], maps[condensed.origin[j]][None])
    return maps


def _chained(step: Array) -> Array:
    """The maps from the first mesh point to all others, from those of every second one."""
    if len(step) == 1:
        return step
    even = len(step) // 2 * 2
    maps = np.empty_like(step)
    maps[0] = step[0]
    maps[1::2] = _chained(_after(step[1:even:2], step[0:even:2]))
    maps[2::2] = _after(step[2::2], maps[1:-1:2])
    return maps


def _after(later: Array, earlier: Array) -> Array:
    """Affine maps of (1, dx, dy), one after the other."""
    n = later.shape[1]
    both = later[:, :, 1 : 1 + n] @ earlier
    both[:, :, 0] += later[:, :, 0]
    both[:, :, 1 + n :] += later[:, :, 1 + n :]
    return both


def solve(condensed: Condensed, gap: Array, rows: Sequence[Row], with_kernel: bool) -> BorderedSolution:
    """Solve for the increments; `gap` (n,) is x_N - x_0 of the present orbit, which shall become zero.

    Raises numpy.linalg.LinAlgError where the bordered matrix is singular.
    """
    maps = chain(condensed)
    n = maps.shape[1]
    top = maps[-1].copy()
    top[:, 1 : 1 + n] -= np.eye(n)
    top[:, 0] += gap
    border = np.array([reduced(row, maps) for row in rows]).reshape(len(rows), maps.shape[2])
    system = np.concatenate([top, border])
    right = np.zeros((len(system), 2))
    right[:, 0] = -system[:, 0]
    right[-1, 1] = 1.0
    both = np.linalg.solve(system[:, 1:], right)
    if not np.isfinite(both).all():
        raise np.linalg.LinAlgError("the bordered matrix is singular")
    outer = both[n:]
    nodes = maps[:, :, 0] + maps[:, :, 1:] @ both[:, 0]
    kernel = maps[:, :, 1:] @ both[:, 1] if with_kernel else None
    return BorderedSolution(
        nodes, outer[:, 0], kernel, outer[:, 1] if with_kernel else None, maps[:, :, 1 : 1 + n]
    )


def reduced(row: Row, maps: Array) -> Array:
    """A closure as a row in (1, dx_0, dy)."""
    reduced = np.einsum("jn,jnw->w", row.nodes, maps)
    reduced[0] += row.value
    reduced[len(reduced) - len(row.outer) :] += row.outer
    return reduced
