"""Parts of the motions that are followed together: what one worker gets, and what comes back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from periodic.orbit.scheme import Array
from periodic.results.files import digest
from periodic.system.ensembles import EnsembleLike, FollowedLike

ARRAYS = ("ends", "modes", "outcome", "label", "growth", "tangents", "changes")
"""What is known of motions, by name; and sections, where they are wanted."""

Targets = tuple[Array, Sequence[int], Array, float]


@dataclass(frozen=True, eq=False)
class Each:
    """What became of motions: see `periodic.system.ensembles.FollowedLike`."""

    ends: Array
    modes: Any
    outcome: Any
    label: Any
    sections: Array | None
    growth: Array
    tangents: Array
    changes: Any


@dataclass(frozen=True, eq=False)
class Part:
    """Motions that are to be followed: see `periodic.system.ensembles.EnsembleLike`."""

    start: Array
    count: int
    stretch: float
    modes: Any = None
    tangents: Array | None = None
    keep: bool = False
    raw: bool = False
    targets: Targets | None = None

    def cut(self, most: int) -> list[Part]:
        """Return the motions in their order, no more than so many in each part."""
        return list(self._pieces(most))

    def _pieces(self, most: int) -> Iterator[Part]:
        for k in range(0, len(self.start), most):
            own = slice(k, k + most)
            modes = None if self.modes is None else self.modes[own]
            tangents = None if self.tangents is None else self.tangents[own]
            how = self.count, self.stretch
            yield Part(self.start[own], *how, modes, tangents, self.keep, self.raw, self.targets)

    def followed(self, ensemble: EnsembleLike) -> FollowedLike:
        """Return what becomes of them."""
        return ensemble.run(
            self.start,
            self.count,
            self.stretch,
            modes=self.modes,
            keep=self.keep,
            tangents=self.tangents,
            raw=self.raw,
            targets=self.targets,
        )

    def key(self, whose: str) -> str:
        """Return what tells it from all other parts, of whatever system."""
        places, of, unit, radius = self.targets or ((), (), (), 0.0)
        how = self.count, self.stretch, self.keep, self.raw, self.tangents is None, radius
        arrays = self.start, self.modes, self.tangents, places, of, unit
        held = [b"" if each is None else np.asarray(each, dtype=float).tobytes() for each in arrays]
        return digest(whose.encode(), repr((self.start.shape, how)).encode(), *held)


def arrays_of(found: FollowedLike) -> dict[str, Any]:
    """Return what became of motions as arrays by name."""
    sections = {} if found.sections is None else {"sections": found.sections}
    return {name: getattr(found, name) for name in ARRAYS} | sections


def of_arrays(arrays: dict[str, Any]) -> Each:
    """Return what became of motions from such arrays."""
    return Each(**{name: arrays[name] for name in ARRAYS}, sections=arrays.get("sections"))


def joined(parts: Sequence[FollowedLike]) -> FollowedLike:
    """Return all motions of some parts in one."""
    if len(parts) == 1:
        return parts[0]
    kept = [part.sections for part in parts if part.sections is not None]
    first = {name: np.concatenate([getattr(part, name) for part in parts]) for name in ARRAYS}
    return Each(**first, sections=np.concatenate(kept) if kept else None)
