"""Motions that come back, completed to orbits with multipliers and an error estimate."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np

from periodic.conditions.phase import PhaseCondition
from periodic.correction.condition import Condition
from periodic.correction.outcome import FAILURES
from periodic.equilibrium.equilibrium import Equilibrium
from periodic.orbit.construction import constant
from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import uniform
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import sampled
from periodic.orbit.scheme import Array, Scheme
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.traced import traced
from periodic.results.point import Point
from periodic.system import Moving, System, check_value
from periodic.tracing.continuation import RepeatsError
from periodic.tracing.steps.stepsize import ArclengthControl

SAMPLES = 193
"""Phases of a motion in a period of the excitation,"""

MOST_SAMPLES = 4 * (SAMPLES - 1) + 1
"""... and in a period of its own."""

MOST_ROUNDS, SAME = 8, 1e-4
"""How often a cycle may go round in what was taken for its period, and how near its states then are."""

INTERVALS = 20
"""Intervals of the mesh of an orbit that is looked for about a state at rest."""

FINER = (1, 100, 10_000)
"""How many times finer tolerances are with which an orbit is looked for, one after the other."""

ROUNDED = 1e-9
"""Relative difference of a parameter from itself, in other units and back."""

BESIDE = 1e-3
"""How wide the range of a parameter is in which one orbit is found, as a part of its value."""


@dataclass(frozen=True, eq=False)
class Completion:
    """Completes motions of a system at parameters (p,) to orbits, to a relative tolerance.

    frequency: the parameter omega = 2 pi / period of a system that is not excited, else "".
    """

    crowd: Crowd
    tolerance: float
    frequency: str = ""

    def forced(self, y: Array, modes: Sequence[int], periods: int) -> Point | None:
        """Return the orbit of a number of excitation periods near a motion from y (w,), None without one.

        One that repeats itself sooner is completed as it does.
        """
        for count in (k for k in range(periods, 0, -1) if periods % k == 0):
            with contextlib.suppress(RepeatsError):
                return self._forced(y, modes, count)
        return None

    def _forced(self, y: Array, modes: Sequence[int], periods: int) -> Point | None:
        """The orbit of a number of periods near a motion. Raises RepeatsError."""
        system, parameter, n = cast(Moving, self.system), self.crowd.parameter, len(self.system.states)
        count = min((SAMPLES - 1) * periods, MOST_SAMPLES - 1)
        phase = np.linspace(0, FORCED * periods, count + 1)
        try:
            path = system.motion(y[:n], y[n:], parameter, phase, self.crowd.tolerance, modes or None)
            guess = sampled(
                path.phase, path.state, path.algebraic, parameter, system=system, modes=path.modes
            )
        except FAILURES:
            return None
        return self.point(guess)

    def free(self, y: Array, modes: Sequence[int], period: float) -> Point | None:
        """Return the orbit of about a period (rad in tau) of a system that is not excited, near a motion.

        One that goes round several times in that is completed as it goes round once.
        """
        point = self._free(y, modes, period)
        times = 1 if point is None else _rounds(point.orbit)
        once = self._free(y, modes, period / times) if times > 1 else None
        return once or point

    def _free(self, y: Array, modes: Sequence[int], period: float) -> Point | None:
        """The orbit of about a period near a motion."""
        system, n, k = cast(Moving, self.system), len(self.system.states), self._place
        given = self.crowd.parameter
        phase = np.linspace(0, period, MOST_SAMPLES)
        try:
            path = system.motion(y[:n], y[n:], given, phase, self.crowd.tolerance, modes or None)
        except FAILURES:
            return None
        parameter, factor = given.copy(), FORCED / period
        parameter[k] *= factor
        state = path.state / factor**self._orders
        state[-1] = state[0]
        tau = path.phase * factor
        tau[-1] = FORCED
        return self.point(sampled(tau, state, path.algebraic, parameter))

    def period(self, orbit: Orbit) -> float:
        """Return the period (rad in tau) of a free orbit at the system's own omega."""
        return FORCED * float(self.crowd.parameter[self._place] / orbit.parameter[self._place])

    def unscaled(self, orbit: Orbit, phase: Array) -> Array:
        """Return the states (K, n) of a free orbit as the system has them at its own omega."""
        k = self._place
        factor = float(orbit.parameter[k] / self.crowd.parameter[k])
        return np.asarray(orbit.state(phase) * factor**self._orders)

    def point(self, guess: Orbit) -> Point | None:
        """Return the orbit near a guess, at the guess's parameters; None where Newton's method finds none."""
        determined: Mapping[str, Condition] = {self.frequency: PhaseCondition()} if self.frequency else {}
        return self._first(guess, determined, None)

    def about(self, state: Array, algebraic: Array) -> Point | None:
        """Return the orbit of one period of the excitation near states (n,) and unknowns (m,) that rest."""
        return self.point(constant(uniform(Scheme(), INTERVALS), state, algebraic, self.crowd.parameter))

    def equilibrium(self, state: Array, algebraic: Array) -> Point | None:
        """Return the equilibrium near states (n,) and unknowns (m,); None where there is none."""
        at = constant(uniform(Scheme(), 1), state, algebraic, self.crowd.parameter)
        return self._first(at, {}, Equilibrium())

    def _first(
        self, guess: Orbit, determined: Mapping[str, Condition], method: Equilibrium | None
    ) -> Point | None:
        """The orbit near a guess, on finer first meshes where others lead nowhere or to one of fewer periods.

        Raises RepeatsError where all that lead anywhere lead there.
        """
        repeats: RepeatsError | None = None
        for finer in FINER:
            try:
                point = self._tried(guess, determined, method, self.tolerance / finer)
            except RepeatsError as error:
                repeats = error
                continue
            if point is not None:
                return point
        if repeats is not None:
            raise repeats
        return None

    def _tried(
        self, guess: Orbit, determined: Mapping[str, Condition], method: Equilibrium | None, tol: float
    ) -> Point | None:
        """The first point of a branch from a guess, where it is at the guess's parameters."""
        name, bounds = self._beside()
        with contextlib.suppress(*FAILURES):
            branch = traced(
                self.crowd,
                name,
                (min(bounds), max(bounds)),
                start=bounds[0],
                guess=guess,
                tol=tol,
                determined=determined,
                method=method,
                control=ArclengthControl(max_points=1),
            )
            if len(branch) and math.isclose(branch[0].parameter, bounds[0], rel_tol=ROUNDED):
                return branch[0]
        return None

    @property
    def system(self) -> System:
        """The system."""
        return self.crowd.system

    @property
    def _orders(self) -> Array:
        """How many derivatives in time each state is away from a quantity of a unit of its own, (n,)."""
        layout = layout_of(self.system)
        return np.array([float(layout.column(q.name).order) for q in layout.states])

    @property
    def _place(self) -> int:
        return [p.name for p in self.system.parameters].index(self.frequency)

    def _beside(self) -> tuple[str, tuple[float, float]]:
        """A parameter, and a small range of it that begins at its value and is allowed."""
        for variable, value in zip(self.system.parameters, self.crowd.parameter, strict=True):
            si = float(value * variable.scale)
            for way in (1, -1):
                other = si * (1 + way * BESIDE) if si else way * BESIDE
                with contextlib.suppress(ValueError):
                    check_value(variable, other)
                    if variable.name != self.frequency:
                        return variable.name, (si, other)
        raise ValueError(
            "the system has no parameter but its omega; orbits need one more, which need not do anything"
        )


def _rounds(orbit: Orbit) -> int:
    """How often an orbit repeats itself in its period."""
    phase = np.linspace(0, FORCED, SAMPLES)
    states = orbit.state(phase)
    size = np.maximum(np.ptp(states, axis=0).max(), np.finfo(float).tiny)
    for times in range(MOST_ROUNDS, 1, -1):
        if np.abs(orbit.state(np.mod(phase + FORCED / times, FORCED)) - states).max() < SAME * size:
            return times
    return 1
