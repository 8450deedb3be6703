"""The chain of intervals and its border: an orbit's linearised equations once the stages are eliminated.

Intervals are chained to affine maps of (1, dx_0, dy); periodicity dx_N = dx_0 and the side conditions then
give a dense system of size n + q for (dx_0, dy). The chain's linear part is the monodromy matrix.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from periodic.linear import bordered
from periodic.linear.pairwise import reduce
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array
from periodic.system.precision import LARGEST

GROWTH = 1e6
"""Growth of motions within a period above which mesh points are not computed from the first one alone."""

PLACES = 16
"""Largest number of places between which growth is computed."""

LARGEST_FUNDAMENTAL = float(np.sqrt(LARGEST))
"""Largest fundamental matrices that are given: products of two are finite."""

PAIRED_UP_TO = 16
"""Up to so many states, neighbouring maps are multiplied in pairs: more products, but far fewer calls."""


class Compiled(Protocol):
    """Compiled routines of a system, where it has some."""

    def chain(self, step: Array) -> Array:
        """Return the affine maps from the first mesh point to all."""


class Eliminated(Protocol):
    """Linearised equations with what is local eliminated: each mesh point follows from an earlier one.

        dx_{j+1} = step[j] (1, dx_origin[j], dy),   step (N, n, 1+n+q), origin (N,)

    orbit is the one linearised at, residual the largest of its equations; compiled chains in C. It
    may have `jumps`, where the state or its rates jump, and `perturbed` (N, n, n+q), the steps of
    perturbations at fixed tau there.
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
    def compiled(self) -> Compiled | None: ...

    def reduced(self, row: Row) -> Row:
        """Return a row in mesh-point states and y alone, its stages eliminated."""

    def recover(self, nodes: Array, outer: Array, constant: float) -> tuple[Array, Array]:
        """Return the increments of stages and unknowns that go with node increments and dy = `outer`.

        constant is 1 for a Newton step, 0 for a direction along the solution set.
        """


@dataclass(frozen=True)
class Chain:
    """Equations with what is local eliminated, as an operator, see `periodic.linear.operator.Operator`.

    Parameters
    ----------
    eliminated : Eliminated
        The equations between the mesh points, see `Eliminated`.
    own : sequence of Row
        The rows of its event nodes, one for each phase of the orbit.
    """

    eliminated: Eliminated
    own: Sequence[Row] = ()

    @property
    def orbit(self) -> Orbit:
        """The orbit that the equations are linearised at."""
        return self.eliminated.orbit

    @property
    def residual(self) -> float:
        """The largest residual."""
        return self.eliminated.residual

    @cached_property
    def maps(self) -> Array:
        """The affine maps (1, dx_0, dy) -> dx_j, (N+1, n, 1+n+q); not finite where too large."""
        with np.errstate(over="ignore", invalid="ignore"):
            return chain(self.eliminated)

    @property
    def flow(self) -> Array | None:
        """dx/dtau at the joints, shape (N+1, n); None where states or equations jump."""
        jumping = getattr(self.eliminated, "perturbed", None) is not None
        return None if jumping else self.orbit.end_rates[self._joints]

    @property
    def _joints(self) -> NDArray[np.int_]:
        """The mesh points that others follow from, and the last one."""
        return np.append(np.unique(self.eliminated.origin), len(self.eliminated.origin))

    @property
    def steps(self) -> Array:
        """How perturbations pass from joint to joint, each interval as a rule, shape (N, n, n)."""
        perturbed: Array | None = getattr(self.eliminated, "perturbed", None)
        return self._held if perturbed is None else perturbed[:, :, : perturbed.shape[1]]

    @cached_property
    def fundamental(self) -> Array:
        """Fundamental matrices at the mesh points, (N+1, n, n), scaled to LARGEST_FUNDAMENTAL if larger."""
        if getattr(self.eliminated, "perturbed", None) is None:
            found = self.maps[:, :, 1 : 1 + self.maps.shape[1]]
            if self.growth <= LARGEST_FUNDAMENTAL:
                return found
        return np.array(list(accumulate(self.steps, after_bounded, initial=np.eye(self.steps.shape[1]))))

    @cached_property
    def growth(self) -> float:
        """How much motions grow at the most from one joint to another; of large systems from the first."""
        return self._growing(self.steps)

    def _growing(self, steps: Array) -> float:
        """The largest growth by steps (N, n, n) from joint to joint; of large systems from the first."""
        if self.maps.shape[1] <= PAIRED_UP_TO:
            return between_any(steps)
        found = float(np.abs(self.maps[:, :, 1 : 1 + self.maps.shape[1]]).max())
        return found if np.isfinite(found) else np.inf

    @cached_property
    def _spread(self) -> float:
        """How much increments grow at the most from joint to joint, event nodes held."""
        if getattr(self.eliminated, "jumps", ()):
            return self._growing(self._held)
        return self.growth

    @property
    def _held(self) -> Array:
        """How mesh points follow from joint to joint, event nodes held, shape (N, n, n)."""
        return self.eliminated.step[self._joints[1:] - 1, :, 1 : 1 + self.eliminated.step.shape[1]]

    @property
    def effect(self) -> Array:
        """About how much the states change with each free parameter over a period, shape (q,)."""
        step, k = self.eliminated.step, len(self.orbit.phases)
        intervals = np.count_nonzero(np.bincount(self.eliminated.origin))
        first = 1 + step.shape[1] + k
        return intervals * np.abs(step[:, :, first:]).max(axis=(0, 1), initial=0.0)

    def solve(self, rows: Sequence[Row], right: Array) -> tuple[Increment, ...]:
        """Return an increment for each column of `right`, shape (1 + len(rows), columns).

        Raises numpy.linalg.LinAlgError where the bordered matrix is singular.
        """
        orbit, n = self.orbit, self.maps.shape[1]
        if self._spread > GROWTH:
            maps, top = self._from_both_ends()
        else:
            maps, top = self.maps, self.maps[-1].copy()
            top[:, 1 : 1 + n] -= np.eye(n)
            top[:, 0] += orbit.nodes[-1] - orbit.nodes[0]
        every = [self.eliminated.reduced(row) for row in (*self.own, *rows)]
        border = np.array([onto_start(row, maps) for row in every]).reshape(len(every), maps.shape[2])
        found = bordered.solve(np.concatenate([top, border]), right)
        return tuple(self._recovered(maps, *pair) for pair in zip(right[0], found.T, strict=True))

    def _from_both_ends(self) -> tuple[Array, Array]:
        """The mesh points from both ends, and the equations of the ends: the reduced chain, periodicity."""
        joints, step, origin, orbit = self._joints, self.eliminated.step, self.eliminated.origin, self.orbit
        reduced, n = reduce(step[joints[1:] - 1]), orbit.nodes.shape[1]
        maps = np.empty((len(step) + 1, *reduced.maps.shape[1:]))
        maps[joints] = reduced.maps
        inner = np.setdiff1d(np.arange(1, len(step)), joints)
        maps[inner] = step[inner - 1, :, 1 : 1 + n] @ maps[origin[inner - 1]]
        maps[inner, :, 0] += step[inner - 1, :, 0]
        maps[inner, :, 1 + 2 * n :] += step[inner - 1, :, 1 + n :]
        closed = np.zeros((n, reduced.maps.shape[2]))
        closed[:, 0] = orbit.nodes[-1] - orbit.nodes[0]
        closed[:, 1 : 1 + n], closed[:, 1 + n : 1 + 2 * n] = -np.eye(n), np.eye(n)
        return maps, np.concatenate([reduced.ends, closed])

    def _recovered(self, maps: Array, constant: float, found: Array) -> Increment:
        """The increment that follows from the ends and dy, `found`."""
        k, width = len(self.orbit.phases), self.eliminated.step.shape[2] - 1 - maps.shape[1]
        nodes, outer = constant * maps[:, :, 0] + maps[:, :, 1:] @ found, found[len(found) - width :]
        stages, algebraic = self.eliminated.recover(nodes, outer, constant)
        return Increment.of(self.orbit, nodes, stages, algebraic, outer[:k], outer[k:])


def chain(eliminated: Eliminated) -> Array:
    """Return the affine maps (1, dx_0, dy) -> dx_j, shape (N+1, n, 1+n+q)."""
    count, n, width = eliminated.step.shape
    if eliminated.compiled is not None and n <= PAIRED_UP_TO:
        return eliminated.compiled.chain(eliminated.step)
    first = np.zeros((1, n, width))
    first[0, :, 1 : 1 + n] = np.eye(n)
    if n <= PAIRED_UP_TO and np.array_equal(eliminated.origin, np.arange(count)):
        return np.concatenate([first, _chained(eliminated.step)])
    own = np.ascontiguousarray(eliminated.step[:, :, 1 : 1 + n])
    maps = np.concatenate([first, eliminated.step])
    maps[1:, :, 1 : 1 + n] = 0.0
    for j, origin in enumerate(eliminated.origin):
        maps[j + 1] += own[j] @ maps[origin]
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


def between_any(steps: Array) -> float:
    """Return the largest element of the products of consecutive steps (N, n, n): of most of them at least.

    They are joined in pairs until few are left.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        while len(steps) > PLACES:
            even = len(steps) // 2 * 2
            steps = np.concatenate([steps[1:even:2] @ steps[:even:2], steps[even:]])
        products = np.broadcast_to(np.eye(steps.shape[1]), steps.shape).copy()
        largest = 1.0
        for j, step in enumerate(steps):
            products[: j + 1] = step @ products[: j + 1]
            largest = max(largest, float(np.abs(products[: j + 1]).max()))
            if not np.isfinite(products[: j + 1]).all():
                return np.inf
    return largest


def after_bounded(before: Array, step: Array) -> Array:
    """Return the product of two matrices, scaled down to LARGEST_FUNDAMENTAL if it is larger."""
    product = step @ before
    size = float(np.abs(product).max())
    return product if size <= LARGEST_FUNDAMENTAL else product * (LARGEST_FUNDAMENTAL / size)


def onto_start(row: Row, maps: Array) -> Array:
    """Return a row, its stages eliminated, as one in (1, dx_0, dy)."""
    held = row.nodes.any(axis=1)
    onto = np.einsum("jn,jnw->w", row.nodes[held], maps[held])
    onto[0] += row.value
    onto[len(onto) - len(row.outer) :] += row.outer
    return onto
