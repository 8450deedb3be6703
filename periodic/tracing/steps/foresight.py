"""Where the tangent of a base leads, and the change of pattern on the way, both found once in a step."""

from __future__ import annotations

from dataclasses import dataclass, field

from periodic.correction.change import Change
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.orbit.orbit import Orbit


@dataclass
class Foresight:
    """What is foreseen at a distance along the tangent of a base; who asks next is given the last answers.

    Parameters
    ----------
    solver : Solver
        The problem and how it is solved.
    """

    solver: Solver
    _asked: tuple[Solution, float] | None = field(default=None, init=False)
    _guess: Orbit = field(init=False)
    _change: list[Change | None] = field(default_factory=list, init=False)

    def guess(self, base: Solution, ds: float) -> Orbit:
        """Return where the tangent leads.

        Parameters
        ----------
        base : Solution
            Where the step begins, with its tangent.
        ds : float
            Its length in arclength.

        Returns
        -------
        Orbit
            Its event nodes may be out of order.
        """
        if self._asked is None or self._asked[0] is not base or self._asked[1] != ds:
            self._guess = tangent(self.solver.problem, base, ds)
            self._asked = base, ds
            self._change.clear()
        return self._guess

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
        guess, solver = self.guess(base, ds), self.solver
        if not self._change:
            self._change.append(solver.discretisation.change(solver.problem.system, base.orbit, guess))
        return self._change[0]
