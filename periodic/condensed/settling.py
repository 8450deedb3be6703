"""A motion of a split system that is left to settle: modes exact over each step, forces constant in it.

It gives guesses of orbits that stick and slip, with their event nodes.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from periodic.correction.outcome import FAILURES
from periodic.events.modes import linearise
from periodic.events.rewrites.sites import ordered
from periodic.events.sticking import stop
from periodic.events.tying import exact_crossings
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import sampled
from periodic.orbit.scheme import Array
from periodic.refinement.equidistribution import redistribute
from periodic.system import STUCK, System, jumps_of, linear_of, slides_of

STEPS = 512
"""Steps in a period that settles."""

FINE = 4096
"""Steps in the period that is kept."""

BRIEF = 0.01
"""Length (rad) of slips between two stretches of sticking that may be none."""

PERIODS = 60
"""Most periods that a motion is given to settle."""

STILL = 1e-3
"""A motion has settled that changes by less than this part of its peak to peak from period to period."""

STEP_ITERATIONS = 8
"""Newton steps in a step in time."""

STEP_INCREMENT = 1e-10
"""Increment at which a step in time is solved."""

INTERVALS = 192
"""Intervals of the guess."""

SHORTEST = 1e-6
"""Least width (rad) of these."""


def settled(system: System, start: Orbit) -> Orbit | None:
    """Return the motion to which a system with sliding jumps settles from rest, at an orbit's parameters.

    None where it does not settle within PERIODS, or cannot be followed.
    """
    motion = Motion(system, start.parameter, start.nodes[0], start.algebraic[0, 0])
    try:
        for _ in range(PERIODS):
            side = motion.side.copy()
            motion.period()
            states, same = np.array(motion.states), np.array_equal(side, motion.side)
            if same and np.abs(states[-1] - states[0]).max() <= STILL * np.ptp(states, axis=0).max():
                motion.pace(FINE)
                motion.period()
                return motion.orbit()
    except FAILURES:
        return None
    return None


@dataclass
class Motion:
    """A motion in time from rest.

    Parameters
    ----------
    system : System
        A system with a linear part.
    parameter : ndarray, shape (p,)
        Its parameters.
    state, unknown : ndarray
        Own states to begin with (n,), and guesses of the unknowns (m,).
    """

    system: System
    parameter: Array
    state: Array
    unknown: Array
    states: list[Array] = field(default_factory=list, init=False)
    unknowns: list[Array] = field(default_factory=list, init=False)
    events: list[tuple[EventNode, float]] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        part = linear_of(self.system)
        assert part is not None
        self.places, self.forces = list(part.states), list(part.forces)
        self.own = np.setdiff1d(np.arange(len(self.state)), self.places)
        self.z = np.zeros(len(part.modes(self.parameter).exponents), dtype=complex)
        self.side = np.zeros(len(jumps_of(self.system)))
        self.pace(STEPS)

    def pace(self, steps: int) -> None:
        """Take so many steps in a period from now on."""
        part = linear_of(self.system)
        assert part is not None
        modes, self.width, self.steps = part.modes(self.parameter), FORCED / steps, steps
        turned = modes.exponents * self.width
        with np.errstate(all="ignore"):
            mean = np.where(turned == 0, 1.0, np.expm1(turned) / turned)
        self.grown, self.kicked = np.exp(turned), (self.width * mean)[:, None] * modes.inputs
        self.outputs = modes.outputs
        self.local = (modes.outputs @ self.kicked).real + modes.direct

    def period(self) -> None:
        """Follow it over a period, whose states, unknowns and events are kept."""
        self.states, self.unknowns, self.events = [self.state], [self.unknown], []
        for k in range(self.steps):
            old, tau = self.side.copy(), (k + 1) * self.width
            self._step(tau)
            self._noted(old, tau - self.width / 2)

    def _step(self, tau: float) -> None:
        """Take a step to a phase: what slides goes on, or is held, or else slips where that is not enough."""
        slides = slides_of(self.system)
        for _ in range(2 * len(slides) + 1):
            x, unknown, parts = self._solved(tau)
            values = self.system.switch(x[None], np.array([tau]), self.parameter)[0]
            changed = False
            for switch in slides:
                i = jumps_of(self.system).index(switch)
                if self.side[i] != STUCK and values[switch] * self.side[i] <= 0:
                    self.side[i], changed = STUCK, True
                elif self.side[i] == STUCK and abs(parts[i]) > 1:
                    self.side[i], changed = np.sign(parts[i]), True
            if not changed:
                break
        if not np.isfinite(x).all():
            raise FloatingPointError("a motion in time is not finite")
        self.z = self.grown * self.z + self.kicked @ unknown[self.forces]
        self.state, self.unknown = x, unknown
        self.states.append(x)
        self.unknowns.append(unknown)

    def _solved(self, tau: float) -> tuple[Array, Array, Array]:
        """States and unknowns at the end of a step, and the parts of their jumps that hold what is stuck."""
        x, unknown, parts = self.state.copy(), self.unknown.copy(), np.zeros(len(self.side))
        shown, own = (self.outputs @ (self.grown * self.z)).real, len(self.own)
        for _ in range(STEP_ITERATIONS):
            x[self.places] = shown + self.local @ unknown[self.forces]
            change = -np.linalg.solve(*self._equations(x, unknown, parts, tau)).astype(float)
            x[self.own] += change[:own]
            unknown = self.system.move(unknown[None], change[None, own : own + len(unknown)])[0]
            parts[self.side == STUCK] += change[own + len(unknown) :]
            if np.abs(change).max() < STEP_INCREMENT * (1 + np.abs(unknown).max()):
                break
        x[self.places] = shown + self.local @ unknown[self.forces]
        return x, unknown, parts

    def _equations(self, x: Array, unknown: Array, parts: Array, tau: float) -> tuple[Array, Array]:
        """Rows at the end of a step by own states, unknowns and parts of jumps, and what is left of them.

        Where it is stuck a switch is 0, and the equations lie between those of its two sides.
        """
        system, at, stuck = self.system, np.array([tau]), np.flatnonzero(self.side == STUCK)
        given = ((x - self.state) / self.width)[None], x[None], unknown[None], at, self.parameter
        upper = np.where(self.side == STUCK, 1.0, self.side)
        line, left = linearise(system, *given, upper[None]), []
        for i in stuck:
            lower = np.where(np.arange(len(upper)) == i, -1.0, upper)
            left.append(linearise(system, *given, lower[None]).residual[0])
        halves = (line.residual[0] - np.array(left).reshape(len(stuck), len(line.residual[0]))).T / 2
        residual = line.residual[0] + halves @ (parts[stuck] - 1)
        driven = np.concatenate([line.d_rate[0], line.d_state[0]], axis=1)[: len(x)]
        given_rows = np.append(driven.any(axis=1), np.ones(len(unknown), dtype=bool))
        switches = [jumps_of(system)[i] for i in stuck]
        held = system.switch(x[None], at, self.parameter)[0, switches]
        gradient = system.switch_gradient(x[None], at, self.parameter)[0][0, switches]
        states = np.concatenate([(line.d_state[0] + line.d_rate[0] / self.width)[given_rows], gradient])
        unknowns = np.zeros((len(states), len(unknown)))
        unknowns[: given_rows.sum()] = line.d_algebraic[0][given_rows]
        unknowns[:, self.forces] += states[:, self.places] @ self.local
        across = np.concatenate([halves[given_rows], np.zeros((len(stuck), len(stuck)))])
        rows = np.concatenate([states[:, self.own], unknowns, across], axis=1)
        return rows, np.concatenate([residual[given_rows], held])

    def _noted(self, old: Array, tau: float) -> None:
        """Keep the events of a step that began on other sides."""
        for switch, (up, down) in slides_of(self.system).items():
            i = jumps_of(self.system).index(switch)
            if self.side[i] == old[i]:
                continue
            way = int(old[i]) if self.side[i] == STUCK else int(self.side[i])
            if old[i] == STUCK:
                event = EventNode(up if way > 0 else down, way)
            else:
                event = stop(switch, -way) if self.side[i] == STUCK else EventNode(switch, way)
            self.events.append((event, tau))

    @property
    def _lasting(self) -> list[tuple[EventNode, float]]:
        """The events without what is an error of the steps.

        Slips between two stretches of sticking that are brief, and stops of one step where rates lead on.
        """
        gone, slides = set[int](), slides_of(self.system)
        for switch, pair in slides.items():
            own = [k for k, (event, _) in enumerate(self.events) if event.switch in (switch, *pair)]
            for i, j in zip(own, own[1:] + own[:1], strict=True):
                (first, begun), (second, ended) = self.events[i], self.events[j]
                length = (ended - begun) % FORCED
                if first.switch in pair and second.switch == switch and length < BRIEF:
                    gone |= {i, j}
                elif second.switch in pair and length < 1.5 * self.width and self._leads_on(switch, begun):
                    gone |= {j} if first.direction == second.direction else {i, j}
        return [each for k, each in enumerate(self.events) if k not in gone]

    def _leads_on(self, switch: int, tau: float) -> bool:
        """Whether rates on both sides of a jump have one sign at a phase of the last period."""
        x, at = self.states[round(tau / self.width + 0.5)], np.array([tau])
        values = self.system.switch(x[None], at, self.parameter)[0]
        up, down = slides_of(self.system)[switch]
        return not values[up] < 0 < values[down]

    def orbit(self) -> Orbit:
        """Return the last period as an orbit with its event nodes."""
        phase = np.linspace(0.0, FORCED, self.steps + 1)
        guess = sampled(phase, np.array(self.states), np.array(self.unknowns), self.parameter)
        kinked = [(crossing.event, crossing.phase) for crossing in exact_crossings(self.system, guess)]
        events, phases = ordered([*self._lasting, *kinked], guess)
        return transfer(guess, redistribute(guess, INTERVALS, events, phases, SHORTEST), phases)
