"""Where the paper's step-by-step method fails, and why: a map over discs, speeds and step sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from periodic import Branch, Point
from reports.studies.paper.common.discs import LOST
from reports.studies.paper.common.scenes import nominal, system
from reports.studies.paper.marching.rungekutta import Marched, growth, march, stages
from reports.studies.paper.marching.started import Form, Runs, runs
from symbolic.arrays import Array
from symbolic.motion.explicit import Rates, rates
from symbolic.motion.linear import RestFinder
from symbolic.scenes.axes import RPM
from symbolic.system.compiled import with_values

DURATION, WINDOW = 1.0, 0.05
"""s of a run (the paper's), and s over which an amplitude is taken at its end."""

SETTLED = 0.01
"""Relative difference up to which a run counts as settled, and as settled to an orbit of the branch."""


class Outcome(Enum):
    """What becomes of a run."""

    SETTLED = "settles to the branch"
    UNSETTLED = "not settled after 1 s"
    WRONG = "settles more than 1 % off the branch"
    UNLOADED = "fails: load below 0.001 Q in the last steps"
    DEFLECTION = "fails: deflection not positive"
    FILM = "fails: film thickness not positive"
    LOAD = "fails: load overflows"
    UNSTABLE = "step unstable at rest"

    @property
    def failure(self) -> bool:
        """Whether the run ends early, or grows from the smallest disturbance."""
        return self not in (Outcome.SETTLED, Outcome.UNSETTLED, Outcome.WRONG)


@dataclass(frozen=True, kw_only=True)
class Band:
    """One disc and step size (s) at speeds (rev/min, (N,)).

    swing (N,): x p-p in m over the end of the run, nan where it failed. time (N,): s from the start of the
    sinusoid to the failure, nan where there is none. growth (N,): of the fastest mode at rest, per step.
    """

    name: str
    form: Form
    step: float
    speeds: Array
    outcome: tuple[Outcome, ...]
    swing: Array
    time: Array
    growth: Array

    @property
    def failed(self) -> Array:
        """Speeds at which the run failed in the motion, its step being stable at rest, in rev/min."""
        motion = [o.failure and o is not Outcome.UNSTABLE for o in self.outcome]
        return self.speeds[np.array(motion)]


def bands(
    form: Form, names: Sequence[str], speeds: Sequence[float], step: float, branches: Sequence[Branch]
) -> list[Band]:
    """Run all discs at all speeds (rev/min) from the paper's start, for DURATION with one step (s).

    branches: of the same discs, with a point at each speed; they tell which amplitudes are right.
    """
    cases = runs(form, [(name, float(rpm)) for name in names for rpm in speeds])
    grown = np.array([rest_growth(name, rpm, step) for name in names for rpm in speeds])
    outcome, swings, time = judged(cases, step, grown, _known(branches, speeds))
    found = []
    for i, name in enumerate(names):
        part = slice(i * len(speeds), (i + 1) * len(speeds))
        found.append(
            Band(
                name=name,
                form=form,
                step=step,
                speeds=np.array(speeds, dtype=float),
                outcome=tuple(outcome[part]),
                swing=swings[part],
                time=time[part],
                growth=grown[part],
            )
        )
    return found


def judged(
    cases: Runs, step: float, grown: Array, known: Sequence[Sequence[float]]
) -> tuple[list[Outcome], Array, Array]:
    """Return what becomes of N runs, their x p-p at the end (m) and the times of failure (s).

    grown (N,): growth of the fastest mode at rest; known: the amplitudes (m) to which each may settle.
    """
    f, size = rates(cases.system), cases.omega * step
    ends = (round(DURATION / 2 / step), round(DURATION / step))
    keep = np.concatenate([np.arange(end - round(WINDOW / step), end + 1) for end in ends])
    done = march(f, cases.state, cases.phase, cases.parameter, size, keep)
    halves = np.split(cases.outputs(done.phase, done.state)["x"], 2)
    earlier, later = (swing(half) for half in halves)
    reasons = failures(cases, f, done, size)
    outcome = [
        Outcome.UNSTABLE if grown[k] > 1 else reason or _ending(earlier[k], later[k], known[k])
        for k, reason in enumerate(reasons)
    ]
    return outcome, later, np.where(done.failed >= 0, done.failed * step, np.nan)


def on_orbits(name: str, points: Sequence[Point], step: float) -> list[Outcome]:
    """Run the three-state form from points of the branch of a disc, each on its own periodic orbit."""
    speeds = [point.parameter / RPM for point in points]
    cases = runs(Form.THREE_STATE, [(name, rpm) for rpm in speeds])
    units = system(name).states[0].scale / cases.system.states[0].scale
    state = [p.orbit.state(np.array([tau]))[0] * units for p, tau in zip(points, cases.phase, strict=True)]
    grown = np.array([rest_growth(name, rpm, step) for rpm in speeds])
    known = [[point.peak_to_peak("x")] for point in points]
    return judged(replace(cases, state=np.array(state)), step, grown, known)[0]


def _known(branches: Sequence[Branch], speeds: Sequence[float]) -> list[list[float]]:
    """x p-p (m) of the stable orbits of each branch at each speed."""
    return [
        [p.peak_to_peak("x") for p in branch if p.stable and abs(p.parameter / RPM - rpm) < 1e-6]
        for branch in branches
        for rpm in speeds
    ]


def _ending(earlier: float, later: float, known: Sequence[float]) -> Outcome:
    """What a run that lasted has come to, from its amplitudes at half time and at the end."""
    if any(abs(later / orbit - 1) <= SETTLED for orbit in known):
        return Outcome.SETTLED
    return Outcome.UNSETTLED if abs(later / earlier - 1) > SETTLED else Outcome.WRONG


def swing(x: Array) -> Array:
    """Return maximum minus minimum of samples (K, N) along the first axis, by parabolas through the peaks."""
    return _highest(x) + _highest(-x)


def _highest(x: Array) -> Array:
    left, middle, right = x[:-2], x[1:-1], x[2:]
    with np.errstate(all="ignore"):
        vertex = middle - (right - left) ** 2 / (8 * (right - 2 * middle + left))
        peak = (middle > left) & (middle >= right)
    ends = np.maximum(x[0], x[-1])
    return np.asarray(np.maximum(ends, np.max(np.where(peak, vertex, -np.inf), axis=0)))


def rest_growth(name: str, rpm: float, step: float) -> float:
    """Return the largest |R(lambda dt)| over the eigenvalues lambda at rest: above 1 any error grows."""
    return float(growth(_eigenvalues(name, rpm) * step).max())


def step_limit(name: str, rpm: float) -> float:
    """Return the longest step in s that is stable at rest: largest |R(lambda dt)| = 1."""
    guess = real_limit() / fastest(name, rpm)
    return float(brentq(lambda step: rest_growth(name, rpm, step) - 1, 0.5 * guess, 1.5 * guess))


def fastest(name: str, rpm: float) -> float:
    """Return the largest |lambda| at rest in 1/s."""
    return float(np.abs(_eigenvalues(name, rpm)).max())


def film_rate(name: str, h: float | Array, deflection: float | Array, rpm: float | Array) -> Array:
    """Return the film's own rate (beta/h + n/delta)/gamma in 1/s: how fast it fills or empties at fixed x.

    h and deflection in m. From the derivative in h of dh/dt = -(beta ln(h/h0) + n ln(delta/delta0))/gamma.
    """
    named = nominal(name)
    gamma = named["squeeze"] / (named["radius"] * np.asarray(rpm) * RPM)
    return np.asarray((named["beta"] / h + named["exponent"] / deflection) / gamma)


def real_limit() -> float:
    """Return z in R(-z) = 1, the end of the real interval of stability (2.785)."""
    return float(brentq(lambda z: float(growth(np.array([-z + 0j]))[0]) - 1, 2.0, 3.5))


@cache
def _eigenvalues(name: str, rpm: float) -> NDArray[np.complex128]:
    return _finder(name).modes(with_values(system(name), {"speed": rpm * RPM})).eigenvalues


@cache
def _finder(name: str) -> RestFinder:
    return RestFinder(system(name))


def failures(cases: Runs, f: Rates, done: Marched, size: Array) -> list[Outcome | None]:
    """Return why each run failed: what was first amiss in its last two steps; None if it lasted."""
    found: list[Outcome | None] = [None] * len(done.failed)
    lost = np.flatnonzero(done.failed >= 0)
    part, size = cases.chosen(lost), size[lost]
    for steps_before, state in zip((2, 1), done.last[:, lost], strict=True):
        begin = part.phase + np.maximum(done.failed[lost] - steps_before, 0) * size
        with np.errstate(all="ignore"):
            visited = stages(f, state, begin, part.parameter, size)
        for place, fraction in zip(visited, (0, 0.5, 0.5, 1, 1), strict=True):
            for k, reason in zip(lost, _amiss(part, f, begin + fraction * size, place), strict=True):
                found[k] = found[k] or reason
    return found


def _amiss(part: Runs, f: Rates, phase: Array, state: Array) -> list[Outcome | None]:
    """Return what is first wrong with each of N states, if anything."""
    out = part.outputs(phase, state)
    preload = part.named["preload"]
    with np.errstate(all="ignore"):
        conditions: dict[Outcome, NDArray[np.bool_]] = {
            Outcome.FILM: ~(out["film"] > 0),
            Outcome.DEFLECTION: out["deflection"] < 0,
            Outcome.UNLOADED: np.logical_and(out["load"] < LOST * preload, part.form is Form.THIRD_ORDER),
            Outcome.LOAD: ~np.asarray(np.isfinite(f(state, phase, part.parameter)).all(axis=1)),
        }
    return [next((o for o, holds in conditions.items() if holds[k]), None) for k in range(len(phase))]
