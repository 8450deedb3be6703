"""Meshes: one period cut into segments at the anchors, each segment cut into intervals.

In segment s the phase is tau = phi_s + sigma (phi_{s+1} - phi_s), sigma in [0, 1]; the anchors' phases phi
are unknowns of the orbit, so that the mesh moves with them. Without anchors there is one segment from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.scheme import Array, Scheme


@dataclass(frozen=True)
class Anchor:
    """What the mesh is tied to: a switch passing a level, falling (-1) or rising (+1).

    Level 0 is the kink itself; other levels mark one that lies close by.
    """

    switch: int
    direction: int
    level: float = 0.0


@dataclass(frozen=True)
class Grid:
    """Where the intervals of a mesh lie for given anchor phases: left ends, widths, and derivatives.

    left, width (N,); left_gradient, width_gradient (N, k) in the k anchor phases.
    """

    left: Array
    width: Array
    left_gradient: Array
    width_gradient: Array


@dataclass(frozen=True, eq=False)
class Mesh:
    """Segments' breaks in sigma (each from 0 to 1), the anchors they start at, and the period in tau."""

    scheme: Scheme
    breaks: tuple[Array, ...]
    anchors: tuple[Anchor, ...] = ()
    period: float = 2 * np.pi

    @property
    def ntst(self) -> int:
        """The number of intervals."""
        return sum(len(b) - 1 for b in self.breaks)

    @cached_property
    def starts(self) -> Array:
        """Index of each anchored segment's first node, shape (k,)."""
        counts = [len(b) - 1 for b in self.breaks]
        return np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(int)[: len(self.anchors)]

    @cached_property
    def exact_ends(self) -> NDArray[np.int_]:
        """Intervals that end at an anchor of level 0, where derivatives of the equations may jump."""
        ends = np.append(self.starts[1:], self.ntst) - 1 if self.anchors else np.zeros(0, dtype=int)
        following = self.anchors[1:] + self.anchors[:1]
        return np.array([j for j, a in zip(ends, following, strict=True) if a.level == 0.0], dtype=int)

    @cached_property
    def _layout(self) -> tuple[Array, Array, Array]:
        segment = np.concatenate([np.full(len(b) - 1, s) for s, b in enumerate(self.breaks)])
        left = np.concatenate([b[:-1] for b in self.breaks])
        width = np.concatenate([np.diff(b) for b in self.breaks])
        return segment, left, width

    @cached_property
    def _gradients(self) -> tuple[Array, Array]:
        segment, left, width = self._layout
        k = len(self.anchors)
        starts = segment[:, None] == np.arange(k)
        ends = (segment[:, None] + 1) % max(k, 1) == np.arange(k)
        return (
            starts * (1 - left[:, None]) + ends * left[:, None],
            (1.0 * ends - 1.0 * starts) * width[:, None],
        )

    def segment_lengths(self, phases: Array) -> Array:
        """Length of each segment in tau; the anchors are in order where all are positive."""
        if not self.anchors:
            return np.array([self.period])
        return np.diff(np.append(phases, phases[0] + self.period))

    def grid(self, phases: Array) -> Grid:
        """Return the intervals for given anchor phases, shape (k,)."""
        segment, left, width = self._layout
        lengths = self.segment_lengths(phases)
        begin = phases if self.anchors else np.zeros(1)
        return Grid(begin[segment] + lengths[segment] * left, lengths[segment] * width, *self._gradients)

    def nodes(self, phases: Array) -> Array:
        """Phases of the mesh points, both ends included, shape (N+1,)."""
        grid = self.grid(phases)
        return np.append(grid.left, grid.left[0] + self.period)

    def matches(self, other: Mesh) -> bool:
        """Whether another mesh has the same breaks and anchors."""
        same = len(self.breaks) == len(other.breaks) and self.anchors == other.anchors
        return same and all(np.array_equal(a, b) for a, b in zip(self.breaks, other.breaks, strict=True))

    def bisected(self) -> Mesh:
        """Return the mesh with every interval halved."""
        halves = tuple(np.sort(np.concatenate([b, (b[1:] + b[:-1]) / 2])) for b in self.breaks)
        return Mesh(self.scheme, halves, self.anchors, self.period)


def uniform(scheme: Scheme, ntst: int, period: float = 2 * np.pi) -> Mesh:
    """Return an unanchored mesh of equal intervals. Raises ValueError for ntst < 1."""
    if ntst < 1:
        raise ValueError(f"ntst is {ntst}; it must be a whole number of at least 1")
    return Mesh(scheme, (np.linspace(0, 1, ntst + 1),), (), period)
