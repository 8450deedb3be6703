"""Time integration through events: pieces in the same modes, from one zero of a guard to the next."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy

from symbolic.arrays import Array
from symbolic.integration.cvodes import IntegrationError
from symbolic.integration.interrupts import heard
from symbolic.integration.lsoda import EVALUATIONS, Counted, Rates
from symbolic.integration.modes import Event, Guard, Modes, Switching

MOST_EVENTS = 1000
"""Most events in a period of the excitation, 2 pi in tau: after more they pile up in a point."""

LONGEST_STEP = 0.05
"""Longest step in tau, so that no event is passed over."""

LOOKS = 4
"""At how many places of a step the guards are looked at."""

CLOSER = 32
"""At how many, where the polynomials through these fall below 0."""

COARSE, FINE = np.linspace(0, 1, LOOKS + 1), np.linspace(0, 1, CLOSER + 1)

BETWEEN = np.vander(FINE, LOOKS + 1) @ np.linalg.inv(np.vander(COARSE, LOOKS + 1))
"""Values of such a polynomial at these places."""

STIFF = 10.0
"""Modes that turn by so many rad within the longest step are not followed."""

LOOSE = 1e-6
"""Tolerance from which on they need not be; to a finer one LSODA takes as few steps."""

SHARP = 1e-3
"""How far past its zero a guard that ends a piece is, in tolerances: it may begin there."""

SHORT = 1e-12
"""Phases (rad) that are so near to each other are one."""


@dataclass(frozen=True)
class Pieces:
    """Phases (N,) and values (N, w), each impact twice; what happened, and the modes at the end."""

    phase: Array
    values: Array
    events: tuple[Event, ...]
    modes: Modes


@dataclass(eq=False)
class Follower:
    """Follows one motion of y = (x, z).

    Parameters
    ----------
    switching : Switching
        The modes of its system.
    rates, jacobian : callable
        Of some modes: (tau, y) to y', and to its derivatives.
    settle : callable
        (y, tau) to the nearest y that fulfils the constraints.
    states : int
        How many of y are states.
    """

    switching: Switching
    rates: Callable[[Modes], Rates]
    jacobian: Callable[[Modes], Rates]
    settle: Callable[[Array, float], Array]
    states: int
    _found: list[tuple[Array, Array]] = field(default_factory=list, init=False)
    _events: list[Event] = field(default_factory=list, init=False)

    def run(self, start: Array, phase: Array, modes: Modes | None = None) -> Pieces:
        """Integrate from phase[0] to all of `phase`. Raises IntegrationError."""
        at, y = float(phase[0]), start
        if modes is None:
            state, modes = self.switching.begin(at, y[: self.states])
            y = self._with(y, state, at)
        self._found.append((phase[:1], y[None]))
        periods = math.ceil((phase[-1] - phase[0]) / (2 * math.pi))
        method, left, work = self._method(y, at, modes), MOST_EVENTS * periods, EVALUATIONS * periods
        with heard() as raised:
            while phase[-1] - at > SHORT:
                counted = Counted(self.rates(modes), work, raised)
                piece = _Piece(self, modes, method, counted, phase)
                at, y, fallen = piece.run(at, y, raised)
                work, left = work - counted.count, left - 1
                if not fallen:
                    break
                if left < 0:
                    raise IntegrationError(f"events pile up at tau = {at:.6g}", at)
                y, modes = self._passed(at, y, modes, fallen)
        late = phase[phase > at]
        self._found.append((late, np.repeat(y[None], len(late), axis=0)))
        both = [np.concatenate(each) for each in zip(*self._found, strict=True)]
        return Pieces(both[0], both[1], tuple(self._events), modes)

    def _passed(self, at: float, y: Array, modes: Modes, fallen: Sequence[Guard]) -> tuple[Array, Modes]:
        """What an event makes of a motion."""
        state, after = self.switching.passed(fallen, modes, at, y[: self.states])
        found, events = self._with(y, state, at), self.switching.events(modes, after, fallen, at)
        if any(self.switching.struck(guard) for guard in fallen):
            self._found.append((np.array([at, at]), np.array([y, found])))
        self._events += events
        return found, after

    def _with(self, y: Array, state: Array, at: float) -> Array:
        if np.array_equal(state, y[: self.states]):
            return y
        return self.settle(np.concatenate([state, y[self.states :]]), at)

    def _method(self, y: Array, at: float, modes: Modes) -> str:
        """Radau for modes far faster than the steps, which ring and die away: LSODA's worst case."""
        slope = self.jacobian(modes)(at, y)
        fastest = float(np.abs(np.linalg.eigvals(slope)).max()) if np.isfinite(slope).all() else 0.0
        return "Radau" if fastest * LONGEST_STEP > STIFF and self.switching.tolerance >= LOOSE else "LSODA"


@dataclass(frozen=True)
class _Piece:
    """The motion in some modes, until a guard falls to 0."""

    follower: Follower
    modes: Modes
    method: str
    rates: Counted
    phase: Array

    def run(self, at: float, y: Array, raised: list[BaseException]) -> tuple[float, Array, list[Guard]]:
        """Return where it ends, and the guards that end it; none at the last phase."""
        switching, tolerance = self.follower.switching, self.follower.switching.tolerance
        guards = switching.guards(self.modes)
        given = {"rtol": tolerance, "atol": tolerance, "max_step": LONGEST_STEP}
        kind = getattr(scipy.integrate, self.method)
        solver = kind(self.rates, at, y, self.phase[-1], jac=self.follower.jacobian(self.modes), **given)
        floor = np.minimum(self._values(guards, np.array([at]), y[None])[0], 0.0) - SHARP * tolerance
        while solver.status == "running":
            solver.step()
            if raised:
                raise raised[0]
            if solver.status == "failed" or not np.isfinite(solver.y).all():
                raise IntegrationError(f"{self.method} failed after tau = {solver.t:.6g}", solver.t)
            dense, before = solver.dense_output(), float(solver.t_old)
            end, fallen = self._fallen(guards, floor, dense, before, float(solver.t))
            late = self.phase[(self.phase > before) & (self.phase <= end)]
            self.follower._found.append((late, dense(late).T))
            if fallen:
                return end, np.asarray(dense(end)), fallen
        return float(solver.t), solver.y, []

    def _values(self, guards: list[Guard], phase: Array, y: Array) -> Array:
        return self.follower.switching.values(guards, self.modes, phase, y[:, : self.follower.states])

    def _fallen(
        self, guards: list[Guard], floor: Array, dense: Callable[..., Array], begin: float, end: float
    ) -> tuple[float, list[Guard]]:
        """Return the first phase of a step where guards fall below their floor, and these."""
        phase = begin + (end - begin) * COARSE
        values = self._values(guards, phase, dense(phase).T) - floor
        if (BETWEEN @ values < 0).any():
            phase = begin + (end - begin) * FINE
            values = self._values(guards, phase, dense(phase).T) - floor
        below = values[1:] < 0
        if not below.any():
            return end, []
        j = int(below.any(axis=1).argmax())
        low, high = float(phase[j]), float(phase[j + 1])

        def root(k: int) -> float:
            def value(tau: float) -> float:
                at = np.array([tau])
                return float(self._values([guards[k]], at, dense(at).T)[0, 0] - floor[k])

            return scipy.optimize.brentq(value, low, high, xtol=SHORT) if value(low) > 0 else low

        roots = {int(k): root(int(k)) for k in below[j].nonzero()[0]}
        first = min(roots.values())
        return first, [guards[k] for k, at in roots.items() if at - first <= 2 * SHORT]
