"""Boxes of states from which motions start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.checks import named, two
from periodic.orbit.layout import layout_of
from periodic.orbit.scheme import Array
from periodic.system import System, resets_of

DRAWS = 100
"""How many times as many states as are wanted are drawn at the most."""


@dataclass(frozen=True, eq=False)
class Box:
    """Ranges of all states, scaled as in the system, low and high (n,); names and units (n,) in SI."""

    names: tuple[str, ...]
    unit: Array
    low: Array
    high: Array

    @property
    def width(self) -> Array:
        """Of the ranges, (n,)."""
        return self.high - self.low

    def draw(self, count: int, seed: int, system: System, parameter: Array) -> Array:
        """Return states (count, n), independent of each other and equally likely wherever motions can be.

        Raises ValueError where the box is behind a wall.
        """
        random, found = np.random.default_rng(seed), np.zeros((0, len(self.low)))
        for _ in range(DRAWS):
            drawn = random.uniform(self.low, self.high, (count, len(self.low)))
            found = np.concatenate([found, drawn[ahead(system, drawn, parameter)]])
            if len(found) >= count:
                return found[:count]
        raise ValueError(f"box is {self.ranges}; less than one in {DRAWS} of its states is before all walls")

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The ranges in SI, by name."""
        each = zip(self.names, self.unit * self.low, self.unit * self.high, strict=True)
        return {name: (float(low), float(high)) for name, low, high in each}


def ahead(system: System, states: Array, parameter: Array) -> NDArray[np.bool_]:
    """Return which states (S, n) are behind no rigid wall at phase 0."""
    values = system.switch(states, np.zeros(len(states)), parameter)
    walls = resets_of(system)
    found = np.ones(len(states), dtype=bool)
    for k in walls:
        found &= -system.switches[k].direction * values[:, k] >= 0
    return found


def units(system: System, parameter: Array) -> Array:
    """Return the SI values of one internal unit of each state, (n,)."""
    return np.array(list(layout_of(system).units(parameter).values()))


def box_of(
    system: System, parameter: Array, given: Mapping[str, tuple[float, float]] | None, around: Array
) -> Box:
    """Return the box of given ranges (SI), of other states those `around`, (2, n) scaled.

    Raises ValueError for names that are no states, and ranges that are no two rising finite numbers.
    """
    names = tuple(state.name for state in system.states)
    unit, (low, high) = units(system, parameter), around.copy()
    for name, ends in named("box", {} if given is None else given, "ranges of states").items():
        if name not in names:
            raise ValueError(f"box has {name!r}; it must be one of {', '.join(names)}")
        k = names.index(name)
        low[k], high[k] = np.array(two(f"box[{name!r}]", ends)) / unit[k]
    return Box(names, unit, low, high)
