"""Many motions in time at once, which a search for all motions, basins and Lyapunov exponents ask for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from periodic.system.arrays import Array
from periodic.system.equations import System

FOLLOWED, SPENT, DIVERGED, PILED, LOST = range(5)
"""Outcomes of a motion: followed to its end, its work used up, states beyond all bounds, events that pile up
in a point, and steps that become too small."""


class FollowedLike(Protocol):
    """What became of S motions of y = (x, z), w variables each.

    ends (S, w) and modes (S, surfaces) at the end; outcome (S,); label (S,) of the target where each arrived,
    -1 at none; sections (S, count + 1, w) at the beginning and after each stretch, NaN where it was not
    reached, or None; growth (S, count, k) of k tangents in each stretch, orthonormal before, as logarithms,
    and tangents (S, k, w) at the end; changes (S, surfaces) of modes in the last stretch.
    """

    @property
    def ends(self) -> Array: ...
    @property
    def modes(self) -> Any: ...
    @property
    def outcome(self) -> Any: ...
    @property
    def label(self) -> Any: ...
    @property
    def sections(self) -> Array | None: ...
    @property
    def growth(self) -> Array: ...
    @property
    def tangents(self) -> Array: ...
    @property
    def changes(self) -> Any: ...


class EnsembleLike(Protocol):
    """Motions of a system at some parameters."""

    def begin(self, state: Array) -> Array:
        """Return y (S, w) of states (S, n) at phase 0, with unknowns that fulfil the constraints.

        Rows are NaN where there are none.
        """

    def tangents_at(self, y: Array) -> Array:
        """Return tangents (S, n, w) at y (S, w): one state changes by 1, unknowns as the constraints ask."""

    def run(
        self,
        start: Array,
        count: int,
        stretch: float,
        *,
        modes: Any = None,
        keep: bool = False,
        tangents: Array | None = None,
        raw: bool = False,
        targets: tuple[Array, Sequence[int], Array, float] | None = None,
    ) -> FollowedLike:
        """Follow motions from y (S, w) at phase 0 over `count` stretches (rad).

        modes: those to begin with, (S, surfaces); by default as the states have them. keep: whether there are
        sections. tangents: (S, k, w); orthonormal anew after each stretch, or, where `raw`, as they are.
        targets: places (A, n), whose each is (A,), units of the states (n,), and a radius in these: a motion
        ends where it is so near to places of one of them after two stretches, one after the other.
        """


class Ensembling(System, Protocol):
    """A system that follows many motions at once in compiled code."""

    def ensemble(self, parameter: Array, tolerance: float, largest: float) -> EnsembleLike | None:
        """Return its motions at parameters (p,), integrated to a relative and absolute tolerance.

        largest: states beyond it, scaled, have diverged. None without a compiler.

        Raises ValueError where the system cannot be integrated in time.
        """
