"""Designs that a search asks for, each followed from the nearest one that it asked for before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, Protocol, Self, TypeVar

import numpy as np

from periodic.decisions.responses.box import Box
from periodic.orbit.scheme import Array


class Movable(Protocol):
    """What is known at one design, and can be followed to others."""

    @property
    def values(self) -> Mapping[str, float]:
        """The free parameters (SI)."""

    def at(self, values: Mapping[str, float]) -> Self:
        """Return the same at another design. Raises LostError."""


M = TypeVar("M", bound=Movable)


@dataclass
class Follow(Generic[M]):
    """What is known at the designs asked for so far."""

    box: Box
    first: M
    known: dict[bytes, M] = field(default_factory=dict)

    def at(self, scaled: Array) -> M:
        """Return what is known at a design, in parts of the ranges. Raises LostError."""
        key = np.ascontiguousarray(scaled).tobytes()
        if key not in self.known:
            near = min(
                self.all, key=lambda each: float(np.linalg.norm(self.box.scaled(each.values) - scaled))
            )
            return self.keep(scaled, near.at(self.box.values(scaled)))
        return self.known[key]

    def keep(self, scaled: Array, found: M) -> M:
        """Note what is known at a design, and return it."""
        self.known[np.ascontiguousarray(scaled).tobytes()] = found
        return found

    @property
    def all(self) -> list[M]:
        """All that is known."""
        return [self.first, *self.known.values()]

    def best(self, merit: Callable[[M], Any]) -> M:
        """Return what has the least merit."""
        return min(self.all, key=merit)
