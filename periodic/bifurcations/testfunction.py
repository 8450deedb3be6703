"""The boundary to special points: a function of a solution that changes sign where there is one.

A new kind of point is one file: a label, a `TestFunction`, and where there are such a condition that holds it
(`periodic.correction.condition.Condition`) and a function that switches to the branch that begins there;
`per.Watch(special=...)` looks for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from periodic.bifurcations.label import Label
from periodic.correction.solution import Solution

PRECISION = 1e-10
"""Of places along the branch, in steps."""

LEFT = 0.5
"""A function that is as a parabola predicts, and keeps this part of its least value, does not change sign."""


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
        Whether the function may change sign twice between two solutions at which it has the same.
    dips : callable
        Where it may do so, as parts of the step, and what it is there if it does not; by default where a
        parabola would touch 0.
    local : callable, optional
        A function of the same sign that is to be followed there, smooth about a change of sign.
    touches : callable
        Whether a turn of the branch, between a base and a new solution, is of that kind.
    name : str
        The user's name of an event or limit.
    """

    label: Label
    value: Callable[[Solution], float]
    precision: float = PRECISION
    genuine: Callable[[Solution], bool] = lambda solution: True
    twice: Callable[[Solution, Solution], bool] = lambda base, new: False
    dips: Callable[[Solution, Solution], list[tuple[float, float]]] = lambda base, new: []
    local: Callable[[Solution], float] | None = None
    touches: Callable[[Solution, Solution, Solution], bool] = lambda turn, base, new: False
    name: str = ""

    @property
    def key(self) -> str:
        """What tells it from others along a branch."""
        return f"{self.label} {self.name}"

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
        return (self.local or self.value)(solution)
