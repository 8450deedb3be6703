"""Where the tangent of a base leads, and the change of pattern on the way, both found once in a step."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from periodic.correction.change import Change
from periodic.correction.predictor import tangent
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.unknowns import E_FOLD, excursion_lengths
from periodic.orbit.orbit import Orbit

LOOKED = 1.5 * E_FOLD
"""Most arclength in which a tangent leads to the end of a brief excursion where the metric is that of
the logarithm of its length: one e-fold where nothing else changes. Steps as long see the end by
themselves."""

BEYOND = 1.01
"""Factor from the way to where a length vanishes to how far is looked."""


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

    def reach(self, base: Solution, ds: float) -> float:
        """Return how far ahead changes are looked for: a step, or to where a brief excursion vanishes.

        The metric of continuation counts the logarithm of its length (`periodic.linear.unknowns`), so that
        it falls by the same factor in each step, however near the grazing is, and a tangent shorter than an
        e-fold does not show it. What is left of the way goes as the square of the length: it is gone at once
        where that is less than the tolerance.

        Parameters
        ----------
        base : Solution
            Where the step begins, with its tangent.
        ds : float
            Its length in arclength.

        Returns
        -------
        float
            A length in arclength, not less than that of the step.
        """
        if not base.orbit.mesh.excursions:
            return ds
        lengths, shifts = excursion_lengths(base.orbit), base.tangent.phases
        falls = np.array([shifts[i] - shifts[j] for i, j in base.orbit.mesh.excursions])
        brief = (lengths < np.sqrt(self.solver.tolerance.orbit)) & (falls > 0)
        ends = lengths[brief] / falls[brief]
        ends = ends[ends < LOOKED]
        return max(ds, BEYOND * float(ends.min())) if len(ends) else ds

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
