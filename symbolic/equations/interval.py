"""What values a part's number may have; its parameter keeps it, through traces and maps too."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symbolic.checks import refusal

EXTREME = 1e100
"""Largest magnitude of a number of a model; its cube is finite, and so is the reciprocal of its cube."""


def usual(value: float) -> bool:
    """Return whether a number can be reckoned with: what is not 0 has squares and reciprocals in doubles."""
    return not math.isfinite(value) or value == 0 or 1 / EXTREME <= abs(value) <= EXTREME


@dataclass(frozen=True)
class Interval:
    """Values from `low` to `high`, where `positive` without 0 itself."""

    low: float = -math.inf
    high: float = math.inf
    positive: bool = False

    def check(self, field: str, value: float) -> None:
        """Refuse a value outside, calling it `field`. Raises ValueError."""
        if not self.low <= value <= self.high or (self.positive and value == 0):
            raise refusal(field, value, self._words)
        if not usual(value):
            raise refusal(field, value, f"0, or of a magnitude from {1 / EXTREME:g} to {EXTREME:g}")

    def within(self, other: Interval) -> Interval:
        """Return the values that both have."""
        low, high = max(self.low, other.low), min(self.high, other.high)
        return Interval(low, high, self.positive or other.positive)

    @property
    def _words(self) -> str:
        if self.positive and self.low == 0:
            return "a positive number"
        if math.isinf(self.high):
            return f"a number of at least {self.low:g}"
        return f"a number from {self.low:g} to {self.high:g}"


ANY = Interval()
NOT_NEGATIVE = Interval(0.0)
POSITIVE = Interval(0.0, positive=True)
