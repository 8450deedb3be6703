"""What a trace has spent, and what it may spend in all."""

from __future__ import annotations

from dataclasses import dataclass


class SpentError(Exception):
    """All the Newton iterations that a trace was allowed are spent."""


@dataclass
class Work:
    """Newton iterations so far, failed and rejected ones included, of at most `most`."""

    most: float = float("inf")
    iterations: int = 0

    def add(self, iterations: int) -> None:
        """Count what was spent. Raises SpentError if that is more than there was."""
        self.iterations += iterations
        if self.iterations > self.most:
            raise SpentError
