"""Meshes: one period cut into segments at the event nodes, each segment cut into intervals.

In segment s the phase is tau = phi_s + sigma (phi_{s+1} - phi_s), sigma in [0, 1]; the event nodes' phases
phi are unknowns of the orbit, so that the mesh moves with them. Without any there is one segment from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array, Scheme
from periodic.orbit.shallow import shallow

MIN_INTERVALS = 4
"""Least number of intervals in a segment."""

INSIDE = 2
"""Most event nodes within a brief excursion: friction turns or holds the motion there, and lets it go."""


@dataclass(frozen=True)
class EventNode:
    """What the mesh is tied to: a switch passing a level.

    Parameters
    ----------
    switch : int
        Index of the switch.
    direction : int
        -1 for falling, +1 for rising.
    level : float
        0 for the kink itself; other levels mark one that lies close by.
    modes : tuple of (int, int)
        Surfaces, by the index of their guard, with the modes that they have from there on, where the crossing
        itself does not say so: sticking that begins, and what an impact or another's event brings about.
    """

    switch: int
    direction: int
    level: float = 0.0
    modes: tuple[tuple[int, int], ...] = ()

    def modes_beside(self, switch: int) -> tuple[tuple[int, int], ...]:
        """Return the modes of all surfaces but that of one guard, with their guards."""
        return tuple(pair for pair in self.modes if pair[0] != switch)


def wrapped(phase: float, period: float) -> float:
    """Return a difference of phases as one between minus and plus half a period (rad)."""
    return float(np.mod(phase + period / 2, period) - period / 2)


@dataclass(frozen=True)
class Grid:
    """Where the intervals of a mesh lie for given event node phases phi.

    Parameters
    ----------
    left, width : ndarray, shape (N,)
        Left ends and widths of the intervals in rad.
    left_gradient, width_gradient : ndarray, shape (N, k)
        Their derivatives in phi.
    """

    left: Array
    width: Array
    left_gradient: Array
    width_gradient: Array

    @cached_property
    def mean_weights(self) -> Array:
        """Trapezoidal weights of the mesh points over one period, shape (N+1,); their sum is 1."""
        half, weights = self.width / (2 * self.width.sum()), np.zeros(len(self.width) + 1)
        weights[:-1] = half
        weights[1:] += half
        return weights


@dataclass(frozen=True, eq=False)
class Mesh:
    """One period in segments between event nodes, each cut into intervals.

    Parameters
    ----------
    scheme : Scheme
        Collocation points within each interval.
    breaks : tuple of ndarray
        Ends of each segment's intervals in sigma, from 0 to 1.
    events : tuple of EventNode
        What the segments start at; none where there is one segment from 0.
    period : float
        Period in tau (rad), a multiple of 2 pi.
    modes : tuple of (int, int)
        Modes of surfaces that no event node changes, by the index of their guard, where the orbit does not
        say them.
    """

    scheme: Scheme
    breaks: tuple[Array, ...]
    events: tuple[EventNode, ...] = ()
    period: float = 2 * np.pi
    modes: tuple[tuple[int, int], ...] = ()

    def __getstate__(self) -> dict[str, object]:
        return shallow(self)

    @property
    def ntst(self) -> int:
        """The number of intervals."""
        return sum(len(b) - 1 for b in self.breaks)

    @cached_property
    def starts(self) -> Array:
        """Index of each tied segment's first node, shape (k,)."""
        counts = [len(b) - 1 for b in self.breaks]
        return np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(int)[: len(self.events)]

    @cached_property
    def exact_ends(self) -> NDArray[np.int_]:
        """Intervals that end at an event node of level 0, where derivatives of the equations may jump."""
        ends = np.append(self.starts[1:], self.ntst) - 1 if self.events else np.zeros(0, dtype=int)
        following = self.events[1:] + self.events[:1]
        return np.array([j for j, a in zip(ends, following, strict=True) if a.level == 0.0], dtype=int)

    @cached_property
    def excursions(self) -> list[tuple[int, int]]:
        """Event nodes at which a switch passes its level and returns, at most `INSIDE` others between."""
        k, found = len(self.events), list[tuple[int, int]]()
        for i, first in enumerate(self.events):
            ahead = ((i + m) % k for m in range(1, min(k, INSIDE + 2)))
            j = next((j for j in ahead if self.events[j].switch == first.switch), None)
            if j is not None and self.events[j].direction != first.direction:
                found.append((i, j))
        return found

    @cached_property
    def segments(self) -> tuple[NDArray[np.int_], Array, Array]:
        """Of each interval its segment, and its left end and width in sigma, shapes (N,)."""
        segment = np.repeat(np.arange(len(self.breaks)), [len(b) - 1 for b in self.breaks])
        left = np.concatenate([b[:-1] for b in self.breaks])
        width = np.concatenate([np.diff(b) for b in self.breaks])
        return segment, left, width

    @cached_property
    def gradients(self) -> tuple[Array, Array]:
        """Derivatives of the intervals' left ends and widths in the event nodes' phases, shapes (N, k)."""
        segment, left, width = self.segments
        k = len(self.events)
        starts = segment[:, None] == np.arange(k)
        ends = (segment[:, None] + 1) % max(k, 1) == np.arange(k)
        return (
            starts * (1 - left[:, None]) + ends * left[:, None],
            (1.0 * ends - 1.0 * starts) * width[:, None],
        )

    @cached_property
    def ties(self) -> NDArray[np.int_]:
        """The event nodes at the ends of each interval's segment, shape (N, min(k, 2)): no others move it."""
        segment, k = self.segments[0], len(self.events)
        return np.stack([segment, (segment + 1) % max(k, 1)], axis=1)[:, : min(k, 2)]

    @cached_property
    def tie_gradients(self) -> tuple[Array, Array]:
        """The `gradients` in the phases of these alone, shapes (N, min(k, 2))."""
        left, width = (np.take_along_axis(gradient, self.ties, axis=1) for gradient in self.gradients)
        return left, width

    def segment_lengths(self, phases: Array) -> Array:
        """Return the length of each segment; the event nodes are in order where all are positive.

        Parameters
        ----------
        phases : ndarray, shape (k,)
            The event nodes' phases in rad.

        Returns
        -------
        ndarray, shape (max(k, 1),)
            Lengths in rad.
        """
        if not self.events:
            return np.array([self.period])
        return np.diff(np.append(phases, phases[0] + self.period))

    def grid(self, phases: Array) -> Grid:
        """Return the intervals for given event node phases.

        Parameters
        ----------
        phases : ndarray, shape (k,)
            The event nodes' phases in rad.

        Returns
        -------
        Grid
            Left ends and widths, with derivatives.
        """
        if not self.events:
            return self._fixed
        segment, left, width = self.segments
        lengths = self.segment_lengths(phases)
        return Grid(phases[segment] + lengths[segment] * left, lengths[segment] * width, *self.gradients)

    @cached_property
    def _fixed(self) -> Grid:
        """The intervals of a mesh without event nodes."""
        _, left, width = self.segments
        return Grid(self.period * left, self.period * width, *self.gradients)

    def nodes(self, phases: Array) -> Array:
        """Return the phases of the mesh points, both ends included.

        Parameters
        ----------
        phases : ndarray, shape (k,)
            The event nodes' phases in rad.

        Returns
        -------
        ndarray, shape (N+1,)
            Phases in rad.
        """
        grid = self.grid(phases)
        return np.append(grid.left, grid.left[0] + self.period)

    def matches(self, other: Mesh) -> bool:
        """Return whether another mesh has the same breaks and event nodes.

        Parameters
        ----------
        other : Mesh
            The other mesh.

        Returns
        -------
        bool
            Whether it has.
        """
        same = len(self.breaks) == len(other.breaks) and self.events == other.events
        same = same and self.modes == other.modes
        return same and all(np.array_equal(a, b) for a, b in zip(self.breaks, other.breaks, strict=True))

    def bisected(self) -> Mesh:
        """Return the mesh with every interval halved.

        Returns
        -------
        Mesh
            One of 2 N intervals.
        """
        return self._bisected

    @cached_property
    def _bisected(self) -> Mesh:
        halves = tuple(np.sort(np.concatenate([b, (b[1:] + b[:-1]) / 2])) for b in self.breaks)
        return Mesh(self.scheme, halves, self.events, self.period, self.modes)


def uniform(scheme: Scheme, ntst: int, period: float = 2 * np.pi) -> Mesh:
    """Return a mesh without event nodes of equal intervals.

    Parameters
    ----------
    scheme : Scheme
        Collocation points within each interval.
    ntst : int
        Number of intervals.
    period : float
        Period in tau (rad).

    Returns
    -------
    Mesh
        The mesh.

    Raises
    ------
    ValueError
        For ntst < 1.
    """
    if ntst < 1:
        raise ValueError(f"ntst is {ntst}; it must be a whole number of at least 1")
    return Mesh(scheme, (np.linspace(0, 1, ntst + 1),), (), period)
