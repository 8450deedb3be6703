"""Many motions at once, on all cores: compiled code leaves Python's lock to others while it runs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import numpy as np

from periodic.checks import between
from periodic.orbit.scheme import Array
from periodic.phasespace.onebyone import Each, OneByOne
from periodic.system import Ensembling, Moving, System
from periodic.system.ensembles import EnsembleLike, FollowedLike

AT_ONCE = 64
"""Motions that one call follows: few enough that Ctrl-C is heard soon."""

DIVERGED = 1e8
"""States so many times larger than their scales have diverged."""

LEAST, MOST = 1e-13, 1e-3
"""Tolerances of an integration that are allowed."""


@dataclass(frozen=True, eq=False)
class Crowd:
    """Motions of a system at parameters (p,), integrated to a tolerance in scaled variables."""

    system: System
    parameter: Array
    tolerance: float = 1e-8

    def __post_init__(self) -> None:
        between("tol", self.tolerance, LEAST, MOST)

    @cached_property
    def ensemble(self) -> EnsembleLike:
        """What follows them. Raises ValueError for a system that cannot be integrated in time."""
        given = self.parameter, self.tolerance, DIVERGED
        compiled = (
            cast(Ensembling, self.system).ensemble(*given) if hasattr(self.system, "ensemble") else None
        )
        if compiled is not None:
            return compiled
        if not hasattr(self.system, "motion"):
            raise ValueError(
                f"system is a {type(self.system).__name__} without motion; it must integrate itself in time, "
                f"as those of symbolic.compile do"
            )
        return OneByOne(cast(Moving, self.system), *given)

    def begin(self, state: Array) -> Array:
        """Return y of states (S, n) at phase 0: see `EnsembleLike`."""
        return self.ensemble.begin(state)

    def tangents(self, y: Array) -> Array:
        """Return tangents (S, n, w) at y, the changes with one state at a time: see `EnsembleLike`."""
        return self.ensemble.tangents_at(y)

    def run(
        self,
        start: Array,
        count: int,
        stretch: float,
        *,
        modes: Any = None,
        tangents: Array | None = None,
        keep: bool = False,
        raw: bool = False,
        targets: tuple[Array, Sequence[int], Array, float] | None = None,
    ) -> FollowedLike:
        """Follow motions, see `EnsembleLike`: those of S rows are followed in parts, in their order."""
        if not len(start):
            return self.ensemble.run(start, 0, stretch, keep=keep, tangents=tangents)
        parts = [slice(k, k + AT_ONCE) for k in range(0, len(start), AT_ONCE)]

        def one(part: slice) -> FollowedLike:
            return self.ensemble.run(
                start[part],
                count,
                stretch,
                modes=None if modes is None else modes[part],
                keep=keep,
                tangents=None if tangents is None else tangents[part],
                raw=raw,
                targets=targets,
            )

        if len(parts) == 1 or cores() == 1 or isinstance(self.ensemble, OneByOne):
            return _joined([one(part) for part in parts])
        with ThreadPoolExecutor(cores()) as pool:
            return _joined(list(pool.map(one, parts)))


def cores() -> int:
    """Return how many cores this process may use."""
    allowed = getattr(os, "sched_getaffinity", None)
    return len(allowed(0)) if allowed else os.cpu_count() or 1


def _joined(parts: Sequence[FollowedLike]) -> FollowedLike:
    """All motions in one."""
    if len(parts) == 1:
        return parts[0]
    kept = [part.sections for part in parts if part.sections is not None]
    names = ("ends", "modes", "outcome", "label", "changes")
    first = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    return Each(
        **first,
        sections=np.concatenate(kept) if kept else None,
        growth=np.concatenate([part.growth for part in parts]),
        tangents=np.concatenate([part.tangents for part in parts]),
    )
