"""Orbits found as the end of a transient: the paper's Runge-Kutta method and CVODES.

An oracle stops them: a run is charged up to the first of its periods that lies as near to where it ends up as
that lies to the truth. No user knows that moment, so no stop test does better.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from periodic.orbit.scheme import Array
from reports.studies.paper.marching.rungekutta import march
from reports.studies.trade.methods.direct import FailedError
from reports.studies.trade.methods.problems import Problem, nearby
from symbolic.integration.flow import Flow
from symbolic.motion.explicit import rates

BLOCK = 10
"""Periods that are timed together."""

TURN = 2 * np.pi


@dataclass(frozen=True, kw_only=True)
class Settled:
    """What a run settles to: states (K, n) at phases (K,) of its last period; and on the way there.

    ends (B, n): states after each block of periods; seconds (B,): processor time up to there, from which the
    last period's own, `dense`, is left out.
    """

    phase: Array
    state: Array
    ends: Array
    seconds: Array
    dense: float

    def cost(self, error: float) -> float:
        """Return the seconds until the run lies as near to its end as `error`, its last period included."""
        away = np.abs(self.ends - self.ends[-1]).max(axis=1)
        return float(self.seconds[np.argmax(away <= error)] + self.dense)

    def periods(self, error: float) -> int:
        """Return how many periods that takes."""
        away = np.abs(self.ends - self.ends[-1]).max(axis=1)
        return BLOCK * (1 + int(np.argmax(away <= error)))


@dataclass(frozen=True)
class RungeKutta:
    """The classical method with `steps` equal steps a period."""

    steps: int

    def settle(self, problem: Problem, blocks: int) -> Settled:
        """Run for so many blocks of periods from the neighbouring orbit. Raises FailedError."""
        f, parameter = rates(problem.explicit), problem.explicit_values[:, None]
        size, n = np.array([TURN / self.steps]), len(problem.explicit.states)
        state, ends, seconds = nearby(problem).state(np.zeros(1))[:, :n], [], []
        keep, clock = np.array([0, BLOCK * self.steps]), time.process_time()
        for _ in range(blocks):
            state = self._checked(march(f, state, np.zeros(1), parameter, size, keep).state)[-1]
            ends.append(state[0])
            seconds.append(time.process_time() - clock)
        clock = time.process_time()
        last = self._checked(march(f, state, np.zeros(1), parameter, size, np.arange(self.steps + 1)).state)
        dense, phase = time.process_time() - clock, size * np.arange(self.steps + 1.0)
        return Settled(
            phase=phase, state=last[:, 0], ends=np.array(ends), seconds=np.array(seconds), dense=dense
        )

    def _checked(self, state: Array) -> Array:
        if not np.isfinite(state[-1]).all():
            raise FailedError("the steps blow up")
        return state


@dataclass(frozen=True)
class Integrated:
    """CVODES with a relative and absolute tolerance."""

    tolerance: float
    samples: int = 128

    def settle(self, problem: Problem, blocks: int) -> Settled:
        """Run for so many blocks of periods from the neighbouring orbit. Raises IntegrationError."""
        flow, parameter, start = Flow(problem.system, self.tolerance), problem.values, nearby(problem)
        state, unknown = start.state(np.zeros(1))[0], start.algebraic_guess(np.zeros(1))[0]
        block: Array = TURN * np.arange(BLOCK + 1.0)
        once: Array = TURN * np.arange(self.samples + 1.0) / self.samples
        flow.run(state, unknown, parameter, block[:2])  # builds the integrator's functions
        ends, seconds, clock = [], [], time.process_time()
        for _ in range(blocks):
            path = flow.run(state, unknown, parameter, block)
            state, unknown = path.state[-1], path.algebraic[-1]
            ends.append(state)
            seconds.append(time.process_time() - clock)
        clock = time.process_time()
        last = flow.run(state, unknown, parameter, once)
        dense = time.process_time() - clock
        return Settled(
            phase=once, state=last.state, ends=np.array(ends), seconds=np.array(seconds), dense=dense
        )
