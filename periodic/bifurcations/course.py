"""The course of test functions over two steps: whether one may change its sign twice within the second.

A parabola through its values at the begin of the step before and at both ends of this one tells how near to 0
it comes in between, also where it is the same at both ends.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from periodic.bifurcations.testfunction import LEFT, TestFunction
from periodic.correction.solution import Solution


def margins(solution: Solution, tests: Sequence[TestFunction]) -> dict[str, float]:
    """Return how far a solution is from each kind of special points, by label and name."""
    return {test.key: test.margin(solution) for test in tests}


@dataclass(frozen=True)
class Course:
    """What the margins were at a solution before the base of a step, `gone` before it.

    Parameters
    ----------
    gone : float
        Length of the step before; infinite where there was none.
    margins : mapping of str to float
        As from `margins`.
    """

    gone: float = np.inf
    margins: Mapping[str, float] = field(default_factory=dict)

    def returns(self, test: TestFunction, base: Solution, new: Solution, ds: float) -> bool:
        """Whether a margin of one sign may come to 0 and go back between two solutions `ds` apart."""
        before = self.margins.get(test.key, np.nan)
        ends = test.margin(base), test.margin(new)
        if not (np.isfinite([before, *ends]).all() and ends[0] * ends[1] > 0):
            return False
        begin, end = np.abs(ends)
        rise = (end - begin) / ds
        bend = (rise - (begin - np.sign(ends[0]) * before) / self.gone) / (ds + self.gone)
        place = (ds - rise / bend) / 2 if bend > 0 else np.inf
        least = begin + place * (rise + bend * (place - ds)) if 0 < place < ds else np.inf
        return bool(least < LEFT * min(begin, end))
