"""Many motions at once."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

from periodic.checks import between
from periodic.orbit.scheme import Array
from periodic.phasespace.following.onebyone import OneByOne
from periodic.phasespace.following.parts import Part, Targets, joined
from periodic.phasespace.following.shared import followed
from periodic.results.files import digest
from periodic.results.identity import identity, versions
from periodic.system import Ensembling, Moving, System
from periodic.system.ensembles import EnsembleLike, FollowedLike
from periodic.workers.parcel import packed

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

    @cached_property
    def identity(self) -> str:
        """What tells its motions from those of others: system, parameters, tolerance and what computes."""
        system = identity(self.system), versions(), type(self.ensemble).__name__
        said = json.dumps([*system, self.parameter.tolist(), self.tolerance])
        return digest(said.encode())

    def parcel(self) -> bytes:
        """What travels to other processes. Raises ValueError for a system that cannot."""
        return packed("system", replace(self))

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
        targets: Targets | None = None,
    ) -> FollowedLike:
        """Follow motions, see `EnsembleLike`: those of S rows are followed in parts, in their order."""
        if not len(start):
            return self.ensemble.run(start, 0, stretch, keep=keep, tangents=tangents)
        every = Part(start, count, stretch, modes, tangents, keep, raw, targets)
        return joined(followed(self, every.cut(AT_ONCE)))
