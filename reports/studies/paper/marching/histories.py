"""Time histories of the paper's discs from its own start: trusted, and by its method and step."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.signal import find_peaks, periodogram

from periodic import Point
from reports.studies.paper.common.discs import HEAVY, OIL_A, OIL_B, RPM_SHOWN
from reports.studies.paper.common.scenes import at_paper_speed, system
from reports.studies.paper.common.tracing import at_speed, branch
from reports.studies.paper.marching.breakdown import swing
from reports.studies.paper.marching.rungekutta import march
from reports.studies.paper.marching.started import Form, ramped, runs, started
from symbolic.arrays import Array
from symbolic.motion.explicit import rates

PAPER_STEP = 1e-4
"""s: 10 000 steps are 1 s in the paper."""

DURATION = {OIL_A: 0.5, HEAVY: 0.8, OIL_B: 12.0}
"""s of the trusted histories of the paper's discs: until the free motion has died out."""

BEATS = 0.1
"""s of x whose spectrum is taken."""

SAMPLES = 48
"""Per period, of the trusted histories."""

SHOWN = ("x", "film", "deflection", "load")


@dataclass(frozen=True, kw_only=True)
class History:
    """time (K,) in s from the start of the sinusoid; x, film, deflection, load (K,) in SI."""

    time: Array
    x: Array
    film: Array
    deflection: Array
    load: Array

    def during(self, begin: float, end: float) -> History:
        """Return the part between two times in s."""
        part = (self.time >= begin - 1e-12) & (self.time <= end + 1e-12)
        return History(**{name: values[part] for name, values in vars(self).items()})


def ripple(values: Array) -> float:
    """Return maximum minus minimum of samples (K,), by parabolas through the peaks."""
    return float(swing(values[:, None])[0])


@cache
def trusted(name: str, duration: float, rpm: float = RPM_SHOWN, samples: int = SAMPLES) -> History:
    """Integrate by CVODES from rest through the ramp and `duration` s of the sinusoid, `samples` a period."""
    flow, parameter, ramp = ramped(name, rpm)
    omega = float(runs(Form.UNKNOWN, [(name, rpm)]).omega[0])
    count = round(duration * omega / (2 * math.pi) * samples)
    time = np.linspace(0.0, 2 * math.pi * count / samples / omega, count + 1)
    path = flow.run(ramp.state[-1], ramp.algebraic[-1], parameter, ramp.phase[-1] + omega * time)
    still, system = np.zeros_like(path.state), started(Form.UNKNOWN, name)
    values = system.output(still, path.state, path.algebraic, path.phase, parameter)
    names = [output.name for output in system.outputs]
    return History(time=time, **{key: values[:, names.index(key)] for key in SHOWN})


@cache
def stepped(name: str, duration: float, rpm: float = RPM_SHOWN, step: float = PAPER_STEP) -> History:
    """Step the third-order equation by the classical Runge-Kutta method; it ends where that fails."""
    case = runs(Form.THIRD_ORDER, [(name, rpm)])
    keep = np.arange(round(duration / step) + 1)
    done = march(rates(case.system), case.state, case.phase, case.parameter, case.omega * step, keep)
    failed = int(done.failed[0])
    lasting = len(keep) if failed < 0 else failed
    with np.errstate(all="ignore"):
        values = case.outputs(done.phase[:lasting], done.state[:lasting])
    time = np.linspace(0.0, (lasting - 1) * step, lasting)
    return History(time=time, **{key: values[key][:, 0] for key in SHOWN})


@cache
def settled(name: str) -> Point:
    """Return the point of the branch at the speed of the paper's time histories."""
    (point,) = at_speed(branch(name, 500.0, 350.0, at=(RPM_SHOWN,)), RPM_SHOWN)
    return point


def orbit_decay(name: str) -> float:
    """Return how fast disturbances of the settled orbit die out, from its largest multiplier, in 1/s."""
    return -math.log(abs(settled(name).multipliers[0])) * 2 * RPM_SHOWN


@dataclass(frozen=True, kw_only=True)
class Spectrum:
    """Amplitude spectrum of x: frequency (K,) in Hz, amplitude (K,) in m; the two highest peaks in Hz."""

    frequency: Array
    amplitude: Array
    peaks: tuple[float, float]


def spectrum(history: History, duration: float) -> Spectrum:
    """Spectrum of the first `duration` s of x through a Hann window, padded eight times."""
    x = history.during(0, duration).x
    rate = 1 / (history.time[1] - history.time[0])
    frequency, power = periodogram(x, rate, window="hann", nfft=8 * len(x), scaling="spectrum")
    amplitude = np.sqrt(2 * power)
    tops, _ = find_peaks(amplitude)
    low, high = sorted(float(frequency[k]) for k in tops[np.argsort(-amplitude[tops])][:2])
    return Spectrum(frequency=frequency, amplitude=amplitude, peaks=(low, high))


def free_part(name: str, history: History) -> Array:
    """Return x less its settled motion (K,), in m: what the paper subtracts to see the damping."""
    omega = 4 * math.pi * RPM_SHOWN
    phase = math.atan(omega) + omega * history.time
    state = settled(name).orbit.state(np.mod(phase, 2 * math.pi))
    return history.x - state[:, 0] * system(name).states[0].scale


def envelope(history: History, values: Array) -> tuple[Array, Array]:
    """Return times (s) and heights of the peaks of |values|."""
    tops, _ = find_peaks(np.abs(values))
    return history.time[tops], np.abs(values)[tops]


@dataclass(frozen=True, kw_only=True)
class Decay:
    """How the free part of x dies out.

    rate (1/s): of the envelope, fitted while it falls from 0.3 to 0.003 of the settled amplitude; ratio: that
    rate over the natural frequency; time (s): from then on it stays below 1 % of the settled amplitude.
    """

    rate: float
    ratio: float
    time: float


def decay(name: str, duration: float) -> Decay:
    """Measure the decay in a trusted history of `duration` s."""
    history = trusted(name, duration)
    time, height = envelope(history, free_part(name, history))
    relative = height / (settled(name).peak_to_peak("x") / 2)
    fitted = (relative < 0.3) & (relative > 0.003)
    rate = -float(np.polyfit(time[fitted], np.log(relative[fitted]), 1)[0])
    frequency = float(at_paper_speed(name).frequencies[0])
    return Decay(rate=rate, ratio=rate / frequency, time=float(time[relative >= 0.01][-1]))
