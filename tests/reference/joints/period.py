"""The map over a period, its monodromy matrix, its fixed points, and where motions settle.

Perturbations pass an event of guard g by S = I + (f+ - f-) g_z/(g_z f-) (di Bernardo et al.,
Piecewise-smooth Dynamical Systems, 2.5), also where a joint comes to stick: S takes away what it holds.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from reference.integration import TWO_PI, Array
from reference.joints.model import Jointed, Mode
from reference.joints.modes import begun, followed, placing
from reference.joints.series import Curved, Moved, Straight, at, taylor
from reference.shooting import in_order

EVENTS = 2000
"""Most events in a period."""

TRIVIAL = 1e-9
"""Of the largest singular value of M - 1: what does not change the motion, as a slider that never slips."""


@dataclass(frozen=True)
class Event:
    """At a phase (rad) a joint of the given modes changes its side."""

    phase: float
    joint: int
    before: Mode
    after: Mode


@dataclass(frozen=True)
class Period:
    """One period: where a state leads, the monodromy matrix, the largest growth on the way, the events."""

    start: Array
    end: Array
    monodromy: Array
    growth: float
    begun: Mode
    events: list[Event] = field(default_factory=list)

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        return in_order(np.linalg.eigvals(self.monodromy))

    @property
    def modes(self) -> list[Mode]:
        """The modes in turn."""
        return [self.begun, *(event.after for event in self.events)]

    def never_slip(self, system: Jointed) -> list[int]:
        """Joints that stick all along, sliders included."""
        friction = [i for i, joint in enumerate(system.joints) if hasattr(joint, "limit")]
        return [i for i in friction if not any(mode[i] for mode in self.modes)]


class Follower:
    """Follows motions of a system at one frequency (rad/s); modes met are kept."""

    def __init__(self, system: Jointed, Omega: float) -> None:
        self.system, self.Omega = system, float(Omega)
        self._pieces: dict[Mode, Straight | Curved] = {}

    def begin(self, y: ArrayLike, phase: float = 0.0) -> tuple[Array, Mode]:
        """The state (q, q', s) with its excitation, and the mode."""
        z = np.concatenate([np.asarray(y, dtype=float), [1.0, np.cos(phase), np.sin(phase)]])
        return z, begun(self.system, self.Omega, z)

    def piece(self, mode: Mode) -> Straight | Curved:
        """How a mode is followed."""
        if mode not in self._pieces:
            equations = self.system.equations(self.Omega, mode)
            kind = Curved if self.system.cubics else Straight
            self._pieces[mode] = kind(equations, self.Omega)
        return self._pieces[mode]

    def period(
        self, y: ArrayLike, phase: float = 0.0, extremes: Array | None = None, varied: bool = True
    ) -> Period:
        """Follow a state over a period from a phase Omega t on; `extremes` (2, n) take in what q reaches.

        Without the monodromy matrix where it is not to be varied.
        """
        z, mode = self.begin(y, phase)
        size, span, t = self.system.states, TWO_PI / self.Omega, 0.0
        perturbed = placing(self.system, mode)
        z = perturbed @ z
        start, first, growth, events = z[:size], mode, 1.0, list[Event]()
        while span - t > 1e-14 * span:
            piece = self.piece(mode)
            moved = piece.moved(z, span - t, varied)
            if extremes is not None:
                self._widen(extremes, piece, moved)
            perturbed, t, z = moved.matrix @ perturbed, t + moved.length, moved.z
            if moved.hit is not None:
                before, mode, z, saltation = self._passed(mode, moved)
                perturbed = saltation @ perturbed
                joint = self.system.equations(self.Omega, before).owners[moved.hit]
                events.append(Event(phase + self.Omega * t, joint, before, mode))
                if len(events) > EVENTS:
                    raise ArithmeticError("too many events")
            if varied:
                growth = max(growth, float(np.linalg.norm(perturbed[:size, :size], 2)))
        return Period(start, z[:size], perturbed[:size, :size], growth, first, events)

    def _passed(self, mode: Mode, moved: Moved) -> tuple[Mode, Mode, Array, Array]:
        assert moved.hit is not None
        equations = self.system.equations(self.Omega, mode)
        z = placing(self.system, mode) @ moved.z
        _, slope = equations.guard(moved.hit, z)
        before = equations.rate(z)
        after = followed(self.system, self.Omega, mode, moved.hit, z)
        jump = self.system.equations(self.Omega, after).rate(z) - before
        speed = float(slope @ before)
        if speed == 0:
            raise ArithmeticError("an event at rest")
        saltation = np.eye(len(z)) + np.outer(jump, slope) / speed
        return mode, after, placing(self.system, after) @ z, saltation

    def _widen(self, extremes: Array, piece: Straight | Curved, moved: Moved) -> None:
        n = self.system.freedoms
        states = np.concatenate([moved.passed, moved.z[None]])
        np.minimum(extremes[0], states[:, :n].min(axis=0), out=extremes[0])
        np.maximum(extremes[1], states[:, :n].max(axis=0), out=extremes[1])
        for k, j in np.argwhere(states[:-1, n : 2 * n] * states[1:, n : 2 * n] < 0):
            h = piece.step if isinstance(piece, Straight) else moved.length
            last = moved.length - (len(moved.passed) - 1) * h
            series = taylor(piece.equations, states[k], h if k < len(moved.passed) - 1 else last)
            speed = series[:, n + j]
            if speed[0] * speed.sum() < 0:  # else it is at rest but for rounding
                peak = float(at(series[:, j], brentq(lambda x, c=speed: float(at(c, x)), 0.0, 1.0)))
                extremes[0, j], extremes[1, j] = min(extremes[0, j], peak), max(extremes[1, j], peak)


def periodic(follower: Follower, guess: ArrayLike, phase: float = 0.0) -> Period:
    """Newton on y(T) - y(0) = 0; what does not change the motion is left as it is guessed."""
    state, best, unchanged = np.array(guess, dtype=float), np.inf, 0
    for _ in range(30):
        found = follower.period(state, phase)
        gap = found.end - found.start
        size = float(np.abs(gap / scales(follower)).max())
        if size < 1e-13 * max(1.0, found.growth):
            return found
        best, unchanged = min(best, size), unchanged + 1 if size >= best else 0
        if unchanged == 5:
            break
        state = found.start + newton(follower, found)
    if best < 1e-10 * max(1.0, found.growth):
        return found
    raise ArithmeticError(f"shooting did not converge, {best:.1e} is left")


def newton(follower: Follower, found: Period) -> Array:
    """The smallest change of the state that closes the linearised map."""
    size = scales(follower)
    matrix = (np.eye(len(size)) - found.monodromy) * size / size[:, None]
    gap = (found.end - found.start) / size
    return np.asarray(np.linalg.lstsq(matrix, gap, rcond=TRIVIAL)[0] * size)


def scales(follower: Follower) -> Array:
    """Sizes of the states."""
    system, found = follower.system, np.full(follower.system.states, follower.system.scale)
    found[system.freedoms : 2 * system.freedoms] *= follower.Omega
    return found


def settled(
    follower: Follower, y: ArrayLike, periods: int = 1000, phase: float = 0.0, close: float = 1e-12
) -> Array:
    """The state after so many periods, or where a period changes it by no more than `close`."""
    state = np.array(y, dtype=float)
    for _ in range(periods):
        found = follower.period(state, phase, varied=False)
        state = found.end
        if np.abs((found.end - found.start) / scales(follower)).max() < close:
            break
    return state


def peak_to_peak(follower: Follower, y: ArrayLike, phase: float = 0.0) -> Array:
    """Peak to peak of the coordinates over a period, shape (n,)."""
    n = follower.system.freedoms
    extremes = np.array([np.full(n, np.inf), np.full(n, -np.inf)])
    follower.period(y, phase, extremes, varied=False)
    return extremes[1] - extremes[0]
