"""The boundary to special points: a function of a solution that changes sign where there is one.

A new kind of point is one file: a label and a `TestFunction`, and possibly a condition that holds the point
(`periodic.correction.condition.Condition`) and a function that switches to the branch that begins there.
`per.Watch(special=...)` looks for it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from periodic.bifurcations.label import Label
from periodic.correction.solution import Solution

PRECISION = 1e-10
"""Error to which a place along the branch is located, in steps."""

PARABOLA_LEFT = 0.5
"""A function is taken to keep its sign in a step if its parabola keeps this part of the smaller end value."""


@dataclass(frozen=True, kw_only=True)
class TestFunction:
    """A function of a solution that changes sign at special points of one kind.

    Parameters
    ----------
    label : Label
        What the points are called.
    value : callable
        The function; 0 where it is not known.
    precision : float
        Of a point's place along the branch, in steps.
    genuine : callable
        Whether the zero found is of that kind.
    twice : callable
        Whether the function may change sign twice between two solutions at which its signs are equal.
    dips : callable
        Places, as parts of the step, about which it may do so, and the values expected there if it does not;
        by default where a parabola would touch 0.
    confined : callable
        Whether two solutions tell that it does not, of what is expected at dips.
    local : callable, optional
        A function of the same sign to be used near a zero, as it is smooth there.
    sharp : callable, optional
        The same function without the threshold below which `value` is set to 0; it locates a change of sign
        that is certain.
    touches : callable
        Whether a fold of the branch, between a base and a new solution, is of that kind.
    singular : bool
        Whether branches cross where it vanishes, so that the equations are singular there.
    name : str
        The user's name of an event or limit.
    """

    label: Label
    value: Callable[[Solution], float]
    precision: float = PRECISION
    genuine: Callable[[Solution], bool] = lambda solution: True
    twice: Callable[[Solution, Solution], bool] = lambda base, new: False
    dips: Callable[[Solution, Solution], list[tuple[float, float]]] = lambda base, new: []
    confined: Callable[[Solution, Solution], bool] = lambda base, new: False
    local: Callable[[Solution], float] | None = None
    sharp: Callable[[Solution], float] | None = None
    touches: Callable[[Solution, Solution, Solution], bool] = lambda fold, base, new: False
    singular: bool = False
    name: str = ""

    @property
    def key(self) -> str:
        """Its name among the test functions of a branch."""
        return f"{self.label} {self.name}"

    @property
    def placed(self) -> Callable[[Solution], float]:
        """The function whose zero is located."""
        return self.sharp or self.value

    def margin(self, solution: Solution) -> float:
        """Return how far a solution is from such a point.

        Parameters
        ----------
        solution : Solution
            An orbit.

        Returns
        -------
        float
            `local`, or the function itself.
        """
        return solution.once(self.local or self.value)


def margins(solution: Solution, tests: Sequence[TestFunction]) -> dict[str, float]:
    """Return how far a solution is from each kind of special points, by label and name."""
    return {test.key: test.margin(solution) for test in tests}


@dataclass(frozen=True)
class Course:
    """The margins at the solution before the base of a step, at a distance `gone`.

    A parabola through the values there and at both ends of the step tells how near to 0 a function comes in
    between, also where it has the same sign at both ends.

    Parameters
    ----------
    gone : float
        Length of the step before; infinite where there was none.
    margins : mapping of str to float
        As from `margins`.
    """

    gone: float = math.inf
    margins: Mapping[str, float] = field(default_factory=dict)

    def returns(self, test: TestFunction, base: Solution, new: Solution, ds: float) -> bool:
        """Whether a margin of one sign may come to 0 and go back between two solutions `ds` apart."""
        before, begin, end = self.margins.get(test.key, math.nan), test.margin(base), test.margin(new)
        if not (all(map(math.isfinite, (before, begin, end))) and begin * end > 0):
            return False
        before = math.copysign(1.0, begin) * before
        begin, end = abs(begin), abs(end)
        rise = (end - begin) / ds
        bend = (rise - (begin - before) / self.gone) / (ds + self.gone)
        place = (ds - rise / bend) / 2 if bend > 0 else math.inf
        least = begin + place * (rise + bend * (place - ds)) if 0 < place < ds else math.inf
        return least < PARABOLA_LEFT * min(begin, end)
