"""Free parameters and their ranges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from periodic.checks import named, number, one_of, shown
from periodic.orbit.scheme import Array
from periodic.system import System, check_value, index_of

AT_END = 1e-9
"""Part of a range within which a value is at its end."""


@dataclass(frozen=True)
class Box:
    """Ranges (SI) of free parameters, which inside are counted in parts of them.

    Parameters
    ----------
    names : tuple of str
        The parameters.
    low, high : ndarray, shape (n,)
        Ends of their ranges (SI).
    nominal : ndarray, shape (n,)
        Their values in the system (SI).
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    nominal: Array

    @classmethod
    def of(cls, system: System, free: Any) -> Self:
        """Return the box that a user describes. Raises ValueError, in one sentence."""
        for name, ends in named("free", free, "ranges").items():
            one_of("a name in free", name, [p.name for p in system.parameters])
            if not (isinstance(ends, Sequence | np.ndarray) and not isinstance(ends, str) and len(ends) == 2):
                raise ValueError(
                    f"range of {name} is {shown(ends)}; it must be two numbers, the smaller first"
                )
            low, high = (number(f"end of the range of {name}", end) for end in ends)
            if not (np.isfinite([low, high]).all() and low < high):
                raise ValueError(f"range of {name} is {shown(ends)}; it must be two rising finite numbers")
            for end in (low, high):
                check_value(system.parameters[index_of(system, name)], end)
        if not free:
            raise ValueError("free is empty; it must name the parameters that may change, with their ranges")
        names = tuple(free)
        nominal = [float(system.nominal[index_of(system, name)]) for name in names]
        low, high = np.array([free[name] for name in names], dtype=float).T
        return cls(names, low, high, np.array(nominal))

    def joined(self, name: str, low: float, high: float, nominal: float) -> Box:
        """Return the box with one more number that is sought."""
        ends = (np.append(self.low, low), np.append(self.high, high), np.append(self.nominal, nominal))
        return Box((*self.names, name), *ends)

    @property
    def widths(self) -> Array:
        """The lengths of the ranges (SI)."""
        return self.high - self.low

    def start(self, given: Mapping[str, float] | None) -> dict[str, float]:
        """Return values to begin with: those given, else the system's, moved into their ranges."""
        found = dict(zip(self.names, np.clip(self.nominal, self.low, self.high).tolist(), strict=True))
        for name, value in named("start", given or {}, "numbers").items():
            one_of("a name in start", name, self.names)
            k = self.names.index(name)
            if not self.low[k] <= number(f"start of {name}", value) <= self.high[k]:
                raise ValueError(
                    f"start of {name} is {value:g}; it must lie in its range {self.low[k]:g} to "
                    f"{self.high[k]:g}"
                )
            found[name] = float(value)
        return found

    def scaled(self, values: Mapping[str, float]) -> Array:
        """Return values (SI) in parts of their ranges, from 0 to 1."""
        return (np.array([values[name] for name in self.names]) - self.low) / self.widths

    def values(self, scaled: Array) -> dict[str, float]:
        """Return values (SI) of parts of the ranges; ends are met exactly."""
        inside = self.low + np.clip(scaled, 0.0, 1.0) * self.widths
        ends = np.where(scaled >= 1 - AT_END, self.high, np.where(scaled <= AT_END, self.low, np.nan))
        found = np.where(np.isnan(ends), inside, ends)
        return dict(zip(self.names, found.tolist(), strict=True))

    def at_ends(self, values: Mapping[str, float]) -> tuple[str, ...]:
        """Return the names of those that are at an end of their range."""
        scaled = self.scaled(values)
        return tuple(n for n, x in zip(self.names, scaled, strict=True) if not AT_END < x < 1 - AT_END)
