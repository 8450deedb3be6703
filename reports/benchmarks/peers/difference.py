"""bice: periodic orbits by finite differences of eighth order, sparse, with the force as an oscillator.

Its multipliers are left out: it multiplies Jacobians, not their exponentials, for them. Folds are between
its points.
"""

from __future__ import annotations

import sys

import numpy as np
from bice import Equation, Problem
from bice.continuation import PseudoArclengthContinuation, TimePeriodicOrbitHandler
from bice.core.solvers import MyNewtonSolver

from reports.benchmarks.peers.answers import folds, median, tell

MOST_POINTS = 3000
"""Points after which a branch that does not get to its end is given up."""


class Duffing(Equation):
    """Duffing A with its force as an oscillator: x, x', sin and cos."""

    def __init__(self) -> None:
        super().__init__(shape=4)
        self.omega = 0.3

    def rhs(self, u: np.ndarray) -> np.ndarray:
        """Return the rates."""
        x, v, sine, cosine = u
        r, w = sine * sine + cosine * cosine, self.omega
        force = 0.5 * cosine - 0.1 * v - x - x**3
        return np.array([v, force, sine + w * cosine - sine * r, cosine - w * sine - cosine * r])

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        """Return their derivatives."""
        x, _, s, c = u
        w = self.omega
        return np.array(
            [
                [0, 1, 0, 0],
                [-1 - 3 * x * x, -0.1, 0, 0.5],
                [0, 0, 1 - 3 * s * s - c * c, w - 2 * s * c],
                [0, 0, -w - 2 * s * c, 1 - s * s - 3 * c * c],
            ]
        )


def begun(steps: int) -> tuple[Problem, Duffing]:
    """Return the problem at its first orbit."""
    problem, equation = Problem(), Duffing()
    period, tau = 2 * np.pi / equation.omega, 2 * np.pi * np.arange(steps) / steps
    orbit = TimePeriodicOrbitHandler(equation, period, steps)
    guess = [0.46 * np.cos(tau), -0.46 * equation.omega * np.sin(tau), np.sin(tau), np.cos(tau)]
    orbit.u = np.append(np.stack(guess, axis=1).ravel(), period)
    problem.add_equation(orbit)
    problem.newton_solver = MyNewtonSolver()
    problem.settings.neigs = 0
    problem.settings.use_sparse_matrices = True
    problem.continuation_parameter = (equation, "omega")
    problem.continuation_stepper = PseudoArclengthContinuation(ds=0.02)
    problem.newton_solve()
    return problem, equation


def run(steps: int) -> list[np.ndarray]:
    """Return the points of the branch: states at all times, period and frequency."""
    problem, equation = begun(steps)
    points: list[np.ndarray] = []
    while equation.omega < 3.0 and len(points) < MOST_POINTS:
        problem.continuation_step()
        points.append(np.append(problem.u, equation.omega))
    return points


def main(steps: int) -> None:
    """Measure the branch."""
    points: list[np.ndarray] = []
    seconds = median(lambda: points.extend(run(steps)), 1)
    tell(seconds, len(points), folds(points))


if __name__ == "__main__":
    main(int(sys.argv[1]))
