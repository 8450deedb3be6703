"""Transients at 360 rev/min from the paper's start, and the damping read off them.

The paper's start (its eqs. 18 to 20) leads the wave up to its crest so slowly that the contact follows
without inertia: at tau = pi/2 the discs rest at X = a, with the steady film and load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from reports.studies.paper.common.scenes import PAPER_SPEED, at_paper_speed, system
from reports.studies.paper.marching.equivalent import WAVINESS, orbit_at
from reports.studies.paper.marching.histories import stepped
from symbolic.arrays import Array
from symbolic.integration.flow import Flow
from symbolic.motion.linear import RestFinder
from symbolic.system.compiled import with_values

PER_PERIOD = 64
"""Samples in a period of the excitation: a parabola through three of them gives a crest to 1e-5."""

TOLERANCE = 1e-10
"""Of the time integration, scaled. At 1e-8 the damping ratios differ by less than 1e-6."""

Window = tuple[float, float]
"""Begin and end of a part of a record, in s."""


READ: Window = (0.0, 0.09)
"""Part of oil A's record that the paper shows as transient (Fig. 6a), s."""


@dataclass(frozen=True, kw_only=True)
class Record:
    """time (N,) in s from the start; x (N,) in m and what is left of it without the steady motion."""

    time: Array
    x: Array
    free: Array


@dataclass(frozen=True, kw_only=True)
class Decay:
    """An exponential fit: damping ratio, angular frequency in rad/s, size (m) at time 0."""

    ratio: float
    frequency: float
    size: float

    def envelope(self, time: Array) -> Array:
        """Return size * exp(-zeta omega0 t), omega0 the undamped frequency, in m."""
        undamped = self.frequency / math.sqrt(1 - self.ratio**2)
        return self.size * np.exp(-self.ratio * undamped * time)


@cache
def record(name: str, part: float = 1.0, duration: float = 1.0) -> Record:
    """Return the transient of a scene at 360 rev/min from the paper's start.

    `part` is the waviness in parts of the paper's, one of those compared; duration in s.
    """
    chosen, waviness = system(name, PAPER_SPEED), part * WAVINESS
    parameter = with_values(chosen, {"amplitude": waviness})
    rest = RestFinder(chosen).modes(parameter)
    periods = math.ceil(duration * rest.omega / (2 * math.pi))
    tau = math.pi / 2 + 2 * math.pi * np.arange(periods * PER_PERIOD + 1) / PER_PERIOD
    scale, start = chosen.states[0].scale, rest.state.copy()
    start[0] = waviness / scale
    found = Flow(chosen, TOLERANCE).run(start, rest.algebraic, parameter, tau)
    x = found.state[:, 0] * scale
    steady = orbit_at(name, part).orbit.state(tau)[:, 0] * scale
    return Record(time=(tau - math.pi / 2) / rest.omega, x=x, free=x - steady)


def crests(time: Array, values: Array) -> tuple[Array, Array]:
    """Return times and heights of the local maxima, by parabolas through three samples (even in time)."""
    middle = values[1:-1]
    i = np.flatnonzero((middle > values[:-2]) & (middle >= values[2:])) + 1
    rise = values[i - 1] - values[i + 1]
    shift = rise / (2 * (values[i - 1] - 2 * values[i] + values[i + 1]))
    return time[i] + shift * (time[1] - time[0]), values[i] - rise * shift / 4


def within(window: Window, time: Array) -> np.ndarray:
    """Return which times lie in a window."""
    return (time >= window[0]) & (time <= window[1])


def decay(time: Array, free: Array, window: Window) -> Decay:
    """Fit ln |free| at its crests and troughs by a line: a free motion size * exp(-zeta omega0 t) cos(...).

    The frequency is that of the crests. Raises ValueError for a window with fewer than four of them.
    """
    chosen = within(window, time)
    at, heights = crests(time[chosen], np.abs(free[chosen]))
    if len(at) < 4:
        raise ValueError(f"window is {window} s; it must hold at least four crests and troughs")
    slope, offset = np.polyfit(at, np.log(heights), 1)
    frequency = math.pi * (len(at) - 1) / (at[-1] - at[0])
    return Decay(
        ratio=float(-slope / math.hypot(slope, frequency)), frequency=frequency, size=math.exp(offset)
    )


@cache
def free_decay_of(name: str, part: float = 1.0) -> Decay:
    """Return the decay of a record over the first 90 ms; see `record`."""
    run = record(name, part)
    return decay(run.time, run.free, READ)


def beat_crests(found: Record) -> tuple[Array, Array]:
    """Return times and heights of x where its crests are highest, once in every beat; x in m."""
    at, heights = crests(found.time, found.x)
    place, highest = crests(np.arange(len(heights), dtype=float), heights)
    return np.interp(place, np.arange(len(at)), at), highest


def level(found: Record, window: Window) -> Array:
    """Return the heights (m) of the crests of x in a window, from which a steady amplitude is read."""
    at, heights = crests(found.time, found.x)
    return heights[within(window, at)]


def read_off(found: Record, steady: float, window: Window, frequency: float) -> float:
    """Return the damping ratio that a steady amplitude (m) subtracted from the beats' crests leads to.

    This is the reading that the paper describes: amplitudes of a record less that of the steady motion. Beats
    that do not rise above `steady` have no logarithm and are left out. NaN for fewer than three beats.
    """
    at, heights = beat_crests(found)
    chosen = within(window, at) & (heights > steady)
    if chosen.sum() < 3:
        return math.nan
    slope = np.polyfit(at[chosen], np.log(heights[chosen] - steady), 1)[0]
    return float(-slope / math.hypot(slope, frequency))


def free_decay(name: str, compression: float, cycles: int = 3) -> tuple[float, float]:
    """Return x p-p (m) and damping ratio of free motion on smooth discs at 360 rev/min.

    The discs are let go `compression` m closer than at rest. From successive swings s, geometric means:
    delta = ln(s_0/s_k)/k and zeta = delta/sqrt(4 pi^2 + delta^2), k = `cycles`.
    """
    chosen = system(name, PAPER_SPEED)
    parameter = with_values(chosen, {"amplitude": 0.0})
    rest = RestFinder(chosen).modes(parameter)
    scale, start = chosen.states[0].scale, rest.state.copy()
    start[0] = -compression / scale
    # The deflection takes up all of it: softplus(xi) = 1 + compression / delta0, and delta0 is the scale.
    unknown = np.array([math.log(math.expm1(1 + compression / scale))])
    tau = 2 * math.pi * np.arange(4 * (cycles + 2) * PER_PERIOD) / PER_PERIOD
    x = Flow(chosen, TOLERANCE).run(start, unknown, parameter, tau).state[:, 0] * scale
    swings = crests(tau, x)[1][: cycles + 1] + crests(tau, -x)[1][: cycles + 1]
    decrement = math.log(swings[0] / swings[cycles]) / cycles
    return math.sqrt(swings[0] * swings[cycles]), decrement / math.hypot(2 * math.pi, decrement)


def stepped_decay(name: str, step: float, window: Window) -> Decay | int:
    """Return the decay in a record by the paper's method: classical Runge-Kutta steps (s) of its eq. (17).

    The exact orbit is subtracted. Where a step fails before the window ends, its number is returned.
    """
    run = stepped(name, window[1], step=step)
    if len(run.time) < round(window[1] / step):
        return len(run.time)
    chosen, omega = system(name, PAPER_SPEED), at_paper_speed(name).omega
    # The sinusoid takes over from the paper's exp(t/1 s) where both have the same slope.
    tau = math.atan(omega) + omega * run.time
    steady = orbit_at(name, 1.0).orbit.state(tau)[:, 0] * chosen.states[0].scale
    return decay(run.time, run.x - steady, window)
