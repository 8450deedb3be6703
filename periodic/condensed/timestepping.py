"""A motion of a split system in time: modes exact over each step, forces constant in it.

At the end of a step a joint sticks, held by a fraction of its jump between -1 and 1, or slips on the side of
its speed: a linear complementarity problem. Murty's least-index rule solves it, and terminates where the
mobility of the joints is a P-matrix (Murty, Linear Complementarity, 1988, 4). An elastic slider that is
carried along ends the step at its limit, also where friction stops the motion: there it counts as held.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from periodic.condensed.heldjoints import Joint, joints_of, stops
from periodic.condensed.modal.moments import Complex
from periodic.condensed.native.nativestep import NativeSteps, native_steps
from periodic.condensed.timestep import Holding, Step
from periodic.events.modes import linearise
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.system import (
    STUCK,
    LinearisationLike,
    ModesLike,
    System,
    guards,
    guards_gradient,
    jumps_of,
    linear_of,
)
from periodic.system.precision import CONVERGED, MOST_ITERATIONS

PARTS = 8
"""Number of shorter steps that replace one in which a mode changes."""

PIVOTS = 200
"""Most changes of a mode until all are consistent."""


@dataclass(frozen=True)
class Changed:
    """A change of mode: of which surface, by its index, at about which phase, in which step of a motion."""

    surface: int
    before: int
    after: int
    phase: float
    step: int


@dataclass
class Motion:
    """A motion in time.

    Parameters
    ----------
    system : System
        A system with a linear part.
    parameter : ndarray, shape (p,)
        Its parameters.
    state, unknown : ndarray
        States to begin with (n,), and guesses of the unknowns (m,).
    modes : ModesLike
        Modes of the linear part.
    z : ndarray of complex, shape (J,)
        Modal coordinates to begin with.
    side : ndarray, shape (columns,)
        The surfaces' modes to begin with.
    begin : float
        Phase to begin with.
    """

    system: System
    parameter: Array
    state: Array
    unknown: Array
    modes: ModesLike
    z: Complex
    side: Array
    begin: float = 0.0
    phases: list[float] = field(default_factory=list, init=False)
    states: list[Array] = field(default_factory=list, init=False)
    unknowns: list[Array] = field(default_factory=list, init=False)
    sides: list[Array] = field(default_factory=list, init=False)
    events: list[Changed] = field(default_factory=list, init=False)
    holding: Holding = field(init=False)
    _known: dict[float, Step] = field(default_factory=dict, init=False)
    _native: NativeSteps | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        part = linear_of(self.system)
        assert part is not None
        self.places, self.forces = list(part.states), list(part.forces)
        self.own = np.setdiff1d(np.arange(len(self.state)), self.places)
        self.joints = joints_of(self.system)
        self.holding = Holding(1.0, np.full(len(self.side), np.nan))
        self.sliders = {joint.column: self._slider(joint) for joint in self.joints if not joint.slides}

    @classmethod
    def at_rest(cls, system: System, parameter: Array, state: Array, unknown: Array) -> Motion:
        """Return the motion from rest of the linear part, own states and guesses of the unknowns given.

        Joints begin as held: along a jump of 0 the equations have no side.
        """
        part = linear_of(system)
        assert part is not None
        modes = part.modes(parameter)
        rest = np.zeros(len(modes.exponents), dtype=complex)
        side = np.zeros(len(jumps_of(system)))
        side[[joint.column for joint in joints_of(system)]] = STUCK
        return cls(system, parameter, state, unknown, modes, rest, side)

    def _slider(self, joint: Joint) -> tuple[int, int]:
        """The row of a slider, which differs where it is carried, and the state that is its position."""
        points = np.zeros((1, len(self.state))), self.state[None], self.unknown[None]
        given = *points, np.array([self.begin]), self.parameter
        columns = np.arange(len(self.side)) == joint.column
        held, carried = (
            linearise(self.system, given, np.where(columns, mode, 1.0)[None]).d_state[0]
            for mode in (STUCK, 1)
        )
        row = int(np.abs(held - carried).max(axis=1).argmax())
        moved = linearise(self.system, given, np.where(columns, STUCK, 1.0)[None]).d_rate[0]
        return row, int(np.abs(moved[row]).argmax())

    def pace(self, steps: int, shortest: float = np.inf) -> None:
        """Set the steps in a period, and the width (rad) down to which changes of mode divide them."""
        self.steps, self.shortest = steps, shortest

    @property
    def phase(self) -> Array:
        """The phases of the states that are kept."""
        return np.array(self.phases)

    def period(self) -> None:
        """Advance the motion by a period, and keep its phases, states, unknowns, modes and events.

        Raises FloatingPointError.
        """
        self.events = []
        native = self._steps_in_c()
        if native is not None:
            self._followed(native)
        else:
            self.phases, self.states = [self.begin], [self.state]
            self.unknowns, self.sides = [self.unknown], [self.shown]
            for k in range(self.steps):
                begin, end = (self.begin + FORCED * i / self.steps for i in (k, k + 1))
                self._advance(begin, end, self._levels)
        sides = np.array(self.sides)
        for k in np.flatnonzero((sides[1:] != sides[:-1]).any(axis=1)).tolist():
            self._noted(k)

    def _steps_in_c(self) -> NativeSteps | None:
        """Steps in C, as soon as the system's kernels are compiled; None before, and where they never are."""
        if self._native is None:
            self._native = native_steps(self, PIVOTS)
        return self._native

    @property
    def _levels(self) -> list[float]:
        """Widths of steps: of all of them, then of those that these are divided into where a mode changes."""
        found = [FORCED / self.steps]
        while found[-1] > self.shortest:
            found.append(found[-1] / PARTS)
        return found

    def _followed(self, native: NativeSteps) -> None:
        """Advance the motion by a period in C."""
        begun = {"state": self.state, "unknown": self.unknown, "side": self.side, "z": self.z}
        for name, value in (*begun.items(), ("parts", self.holding.parts)):
            native.moved[name][...] = value
        levels = [self._over(width) for width in self._levels]
        path = native.period(self.steps, PARTS, levels, self.begin, self.holding.width)
        self.state, self.unknown, self.side, self.z = (native.moved[name].copy() for name in begun)
        self.holding = Holding(path.width, native.moved["parts"].copy())
        self.phases, self.states = path.phases.tolist(), list(path.states)
        self.unknowns, self.sides = list(path.unknowns), list(path.sides)

    def _advance(self, begin: float, end: float, widths: list[float]) -> None:
        """Take a step, or several shorter ones where a mode changes. Raises FloatingPointError."""
        before = self.z, self.state, self.unknown, self.side, self.holding
        self._step(end, widths[0])
        changes = not np.array_equal(before[3], self.side) or self.holding.gives_way(before[4])
        if len(widths) > 1 and changes:
            self.z, self.state, self.unknown, self.side, self.holding = before
            for first, last in pairwise(np.linspace(begin, end, PARTS + 1).tolist()):
                self._advance(first, last, widths[1:])
            return
        self.phases.append(end)
        self.states.append(self.state)
        self.unknowns.append(self.unknown)
        self.sides.append(self.shown)

    def _step(self, tau: float, width: float) -> None:
        """Take a step to a phase. Raises FloatingPointError."""
        step = self._over(width)
        for _ in range(PIVOTS):
            x, unknown, parts = self._solved(tau, step)
            wrong = self._wrong(x, parts, tau)
            if wrong is None:
                break
            column, mode = wrong
            self.side = np.where(np.arange(len(self.side)) == column, mode, self.side)
        if wrong is not None or not np.isfinite(x).all():
            raise FloatingPointError("a motion in time is not finite, or no modes are consistent")
        self.z = step.grown * self.z + step.kicked @ unknown[self.forces]
        self.state, self.unknown = x, unknown
        self.holding = Holding(width, np.where(np.isin(np.arange(len(parts)), self._stuck[0]), parts, np.nan))

    def _over(self, width: float) -> Step:
        """The step of a width, computed once."""
        if width not in self._known:
            self._known[width] = Step.over(width, self.modes)
        return self._known[width]

    def _wrong(self, x: Array, parts: Array, tau: float) -> tuple[int, int] | None:
        """The first column whose mode is not that at the end of a step, and the mode that it should have.

        A slider that friction stops stays in its mode: its strain is the limit, or is not, to rounding.
        """
        values = self.values(x, tau, self.side)
        for joint in self.joints:
            i, mode = joint.column, self.side[joint.column]
            up, down, ahead = values[joint.up], values[joint.down], values[joint.switch] * mode
            if not joint.slides:
                if stops(self.system, joint, self._stuck[1]):
                    continue
                place = self.sliders[i][1]
                ahead = (x[place] - self.state[place]) * mode
            if mode != STUCK and (ahead < 0 or mode == 0):
                return i, STUCK
            if mode == STUCK and joint.slides and abs(parts[i]) > 1:
                return i, int(np.sign(parts[i]))
            if mode == STUCK and not joint.slides and not up <= 0 <= down:
                return i, 1 if up > 0 else -1
        return None

    @property
    def shown(self) -> Array:
        """The surfaces' modes, those of sliders that friction stops held."""
        stuck = self._stuck[1]
        stopped = [each.column for each in self.joints if stuck and stops(self.system, each, stuck)]
        return (
            np.where(np.isin(np.arange(len(self.side)), stopped), STUCK, self.side) if stopped else self.side
        )

    def values(self, x: Array, tau: float, side: Array) -> Array:
        """Return the guards at a state in given modes."""
        return np.asarray(guards(self.system, x[None], np.array([tau]), self.parameter, side[None])[0])

    @property
    def _stuck(self) -> tuple[NDArray[np.int_], list[int]]:
        """The columns and the guards of the sliding joints that stick."""
        kept = [joint for joint in self.joints if joint.slides and self.side[joint.column] == STUCK]
        return np.array([joint.column for joint in kept], dtype=int), [joint.switch for joint in kept]

    def _solved(self, tau: float, step: Step) -> tuple[Array, Array, Array]:
        """States and unknowns at the end of a step, and fractions of the jumps that hold sticking joints."""
        x, unknown, parts = self.state.copy(), self.unknown.copy(), np.zeros(len(self.side))
        shown, own = (self.modes.outputs @ (step.grown * self.z)).real, len(self.own)
        for _ in range(MOST_ITERATIONS):
            x[self.places] = shown + step.local @ unknown[self.forces]
            change = -np.linalg.solve(*self._equations(x, unknown, parts, tau, step)).astype(float)
            x[self.own] += change[:own]
            unknown = self.system.move(unknown[None], change[None, own : own + len(unknown)])[0]
            parts[self._stuck[0]] += change[own + len(unknown) :]
            if np.abs(change).max() < CONVERGED * (1 + np.abs(unknown).max()):
                break
        x[self.places] = shown + step.local @ unknown[self.forces]
        return x, unknown, parts

    def _equations(
        self, x: Array, unknown: Array, parts: Array, tau: float, step: Step
    ) -> tuple[Array, Array]:
        """Rows and residual amid a step, in own states, unknowns and fractions of jumps at its end.

        Forces are constant in a step: those of its middle are right to second order. At its end the switch of
        a sticking joint is 0; its equations are interpolated between those of its two sides.
        """
        system, at, (stuck, switches) = self.system, np.array([tau]), self._stuck
        amid = (x + self.state)[None] / 2, unknown[None], at - step.width / 2, self.parameter
        given = ((x - self.state) / step.width)[None], *amid
        columns = np.arange(len(self.side))
        upper = np.where(np.isin(columns, stuck), 1.0, self.side)
        line, left = linearise(system, given, upper[None]), []
        line.d_state[0] /= 2
        line = self._carried(line, x, tau)
        for i in stuck:
            lower = np.where(columns == i, -1.0, upper)
            left.append(self._carried(linearise(system, given, lower[None]), x, tau).residual[0])
        halves = (line.residual[0] - np.array(left).reshape(len(stuck), len(line.residual[0]))).T / 2
        residual = line.residual[0] + halves @ (parts[stuck] - 1)
        driven = np.concatenate([line.d_rate[0], line.d_state[0]], axis=1)[: len(x)]
        given_rows = np.append(driven.any(axis=1), np.ones(len(unknown), dtype=bool))
        held = self.values(x, tau, self.side)[switches]
        gradient = guards_gradient(system, x[None], at, self.parameter, self.side[None])[0][0, switches]
        states = np.concatenate([(line.d_state[0] + line.d_rate[0] / step.width)[given_rows], gradient])
        unknowns = np.zeros((len(states), len(unknown)))
        unknowns[: given_rows.sum()] = line.d_algebraic[0][given_rows]
        unknowns[:, self.forces] += states[:, self.places] @ step.local
        across = np.concatenate([halves[given_rows], np.zeros((len(stuck), len(stuck)))])
        rows = np.concatenate([states[:, self.own], unknowns, across], axis=1)
        return rows, np.concatenate([residual[given_rows], held])

    def _carried(self, line: LinearisationLike, x: Array, tau: float) -> LinearisationLike:
        """Put the limits of sliders that are carried along in the place of their rows."""
        for joint in self.joints:
            mode = self.side[joint.column]
            if joint.slides or mode not in (-1, 1):
                continue
            row, switch = self.sliders[joint.column][0], joint.up if mode > 0 else joint.down
            at = x[None], np.array([tau]), self.parameter, self.side[None]
            line.residual[0, row] = guards(self.system, *at)[0, switch]
            line.d_rate[0, row], line.d_algebraic[0, row] = 0.0, 0.0
            line.d_state[0, row] = guards_gradient(self.system, *at)[0][0, switch]
        return line

    def _noted(self, k: int) -> None:
        """Keep the changes of mode of a step; a joint whose mode before it is 0 has none."""
        old, new = self.sides[k], self.sides[k + 1]
        for joint in self.joints:
            before, after = int(old[joint.column]), int(new[joint.column])
            if before and before != after:
                begin, end = self.phases[k : k + 2]
                phase = begin + (end - begin) * self._share(k, joint, before, after)
                self.events.append(Changed(joint.index, before, after, phase, k))

    def _share(self, k: int, joint: Joint, before: int, after: int) -> float:
        """Fraction of a step after which a joint changes its mode, by its guards in the mode before."""
        first, last = (self.values(self.states[i], self.phases[i], self.sides[k]) for i in (k, k + 1))
        if before == STUCK:
            switch = joint.up if after > 0 else joint.down
            begun, ended = first[switch], last[switch]
        elif joint.slides:  # its releases are the rates of the guard on its two sides
            begun = first[joint.switch]
            width = self.phases[k + 1] - self.phases[k]
            ended = begun + width * first[joint.up if before > 0 else joint.down]
        else:
            begun, ended = first[joint.switch], last[joint.switch]
        return float(begun / (begun - ended)) if begun * ended < 0 else 0.5
