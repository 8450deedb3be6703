"""Time integration of a compiled system from event to event, independent of collocation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from symbolic.arrays import Array
from symbolic.checks import finite
from symbolic.integration.follower import Follower
from symbolic.integration.modes import Event, Modes, Switched, Switching, modes_along
from symbolic.interrupts import interruptible


@dataclass(frozen=True)
class Trajectory:
    """Phases (N,), scaled states (N, n) and unknowns (N, m); the events on the way, and the modes at its end.

    The modes are those of the system's surfaces: a motion goes on in them.
    """

    phase: Array
    state: Array
    algebraic: Array
    events: tuple[Event, ...] = ()
    modes: Modes = ()


@dataclass(frozen=True, eq=False)
class Flow:
    """Integrates `system` with relative and absolute tolerance `tolerance` (scaled variables)."""

    system: Switched
    tolerance: float = 1e-8

    def __post_init__(self) -> None:
        if not 1e-13 <= finite("tolerance", self.tolerance) <= 1e-2:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-13 and 0.01")

    @interruptible()
    def run(
        self,
        state: Array,
        algebraic: Array,
        parameter: Array,
        phase: Array,
        modes: Modes | None = None,
        earlier: Modes | None = None,
    ) -> Trajectory:
        """Integrate from phase[0] and return the solution at all of `phase`, and at each impact twice.

        modes: those at the beginning, by default as the state has them; earlier: those before it, of which
        relays and friction that sticks keep theirs. Raises IntegrationError where the integrators fail.
        """
        n, phase = self.system.expressions.state.numel(), np.asarray(phase, dtype=float)
        switching, field = Switching(self.system, parameter, self.tolerance), self.system.field

        @cache
        def given(modes: Modes) -> Array:
            return np.concatenate([parameter, switching.side(modes)])

        def settle(y: Array, tau: float) -> Array:
            return field.on_constraints(y, tau, parameter)

        follower = Follower(
            switching,
            lambda modes, y, along: field.sweep(y, along, given(modes), self.tolerance),
            lambda modes, values, along: field.guards(values, along, given(modes)),
            settle,
            n,
        )
        start = field.begun(np.concatenate([state, algebraic]), float(phase[0]), parameter)
        found = follower.run(start, phase, modes, earlier)
        tau, values = found.with_impacts(phase)
        return Trajectory(tau, values[:, :n], values[:, n:], found.events, found.modes)

    def rates(self, trajectory: Trajectory, parameter: Array) -> Array:
        """Return (x', z') along a trajectory, shape (N, n+m), in the modes that its events tell."""
        values = np.concatenate([trajectory.state, trajectory.algebraic], axis=1)
        switching, count = Switching(self.system, parameter, self.tolerance), len(values)
        modes = [(0,) * len(self.system.surfaces)] * count  # the state decides
        if trajectory.modes:
            modes = modes_along(trajectory.phase, trajectory.events, trajectory.modes)
        sides = np.array([switching.side(own) for own in modes]).reshape(count, -1)
        given = np.column_stack([np.repeat(parameter[None], count, axis=0), sides])
        return self.system.field.along(values, trajectory.phase, given.T)
