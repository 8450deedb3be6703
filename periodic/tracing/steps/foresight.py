"""The change of the pattern of events that is foreseen along the tangent of a base, read once in a step."""

from __future__ import annotations

from dataclasses import dataclass, field

from periodic.correction.change import Change
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver


@dataclass
class Foresight:
    """What is foreseen at a distance along the tangent of a base; the last answer is kept for who asks next.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    """

    solver: Solver
    _asked: tuple[Solution, float] | None = field(default=None, init=False)
    _change: Change | None = field(default=None, init=False)

    def change(self, base: Solution, ds: float) -> Change | None:
        """Return the first change of pattern on the way, if there is one.

        Parameters
        ----------
        base : Solution
            Where the step begins, with its tangent.
        ds : float
            Its length in arclength.

        Returns
        -------
        Change or None
            None where the pattern at the end of the step is that of the base.
        """
        if self._asked is None or self._asked[0] is not base or self._asked[1] != ds:
            problem = self.solver.problem
            guess = tangent(problem, base, ds)
            self._change = self.solver.discretisation.change(problem.system, base.orbit, guess)
            self._asked = base, ds
        return self._change
