"""A solution: an orbit with its outcome, its tangent, its multipliers and its errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

from periodic.correction.discretisation import Discretisation
from periodic.correction.error import ErrorEstimate
from periodic.correction.newton import Correction
from periodic.correction.outcome import Outcome
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.stability.multipliers import Spectrum

T = TypeVar("T")


@dataclass(frozen=True)
class Solution:
    """What Newton found for a problem; `ok` tells whether it is a solution, `outcome` why not.

    Floquet multipliers, error estimate and mesh refinement are computed once, when first asked for.

    Parameters
    ----------
    problem : Problem
        What is solved.
    discretisation : Discretisation
        The method.
    correction : Correction
        Result of the Newton iteration.
    tangent : Increment
        Tangent of the branch, of unit length.
    """

    problem: Problem = field(repr=False)
    discretisation: Discretisation = field(repr=False)
    correction: Correction
    tangent: Increment

    @property
    def outcome(self) -> Outcome:
        """How the search for the solution ended."""
        return self.correction.outcome

    @property
    def ok(self) -> bool:
        """Whether it is a solution."""
        return self.correction.ok

    def failed(self, outcome: Outcome) -> Solution:
        """Return the solution as one that failed.

        Parameters
        ----------
        outcome : Outcome
            Why it failed.

        Returns
        -------
        Solution
            The same with this outcome.
        """
        return replace(self, correction=replace(self.correction, outcome=outcome))

    @property
    def orbit(self) -> Orbit:
        """The orbit itself."""
        return self.correction.orbit

    @property
    def value(self) -> float:
        """The continuation parameter (SI)."""
        return self.problem.value(self.orbit)

    def once(self, function: Callable[[Solution], T]) -> T:
        """Return a function of the solution, computed when it is first asked for.

        Parameters
        ----------
        function : callable
            The function.

        Returns
        -------
        object
            Its value.
        """
        if function not in self._values:
            self._values[function] = function(self)
        found: T = self._values[function]
        return found

    @cached_property
    def _values(self) -> dict[Callable[[Solution], Any], Any]:
        return {}

    @cached_property
    def spectrum(self) -> Spectrum:
        """The Floquet multipliers."""
        return self.discretisation.spectrum(self.correction, self.problem.trivial)

    @property
    def estimated(self) -> Solution:
        """The solution whose error estimate this one takes."""
        return self

    @cached_property
    def error(self) -> ErrorEstimate:
        """The errors of orbit and multipliers."""
        return self.discretisation.error(self.problem, self.correction, self.tangent, self.spectrum)

    @cached_property
    def refinement(self) -> Refinement:
        """What to change of the mesh."""
        return self.discretisation.refine(self.problem.system, self.orbit, self.error)


@dataclass(frozen=True)
class Between(Solution):
    """A solution where the equations are singular, from those on either side on the same mesh.

    An estimate there would show rounding, magnified without bound; the errors of a solution nearby are taken.

    Parameters
    ----------
    beside : Solution
        The solution nearby.
    """

    beside: Solution = field(repr=False)

    @property
    def estimated(self) -> Solution:
        """The one beside it."""
        return self.beside

    @property
    def error(self) -> ErrorEstimate:
        """The errors of the one beside it."""
        return self.beside.error
