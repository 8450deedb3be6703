"""What values a part's number may have; its parameter keeps it, through traces and maps too."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symbolic.checks import refusal


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
