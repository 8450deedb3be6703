"""How failures of the step-by-step method begin: with the loss of contact, or with the step itself."""

from __future__ import annotations

from enum import Enum

import numpy as np

from reports.studies.paper.common.discs import LOST
from reports.studies.paper.common.scenes import nominal
from reports.studies.paper.marching.breakdown import Band, Outcome, film_rate, real_limit
from reports.studies.paper.marching.histories import trusted
from reports.studies.paper.marching.rungekutta import march
from reports.studies.paper.marching.started import runs
from symbolic.arrays import Array
from symbolic.motion.explicit import rates

SAMPLES = 960
"""Per period, of the trusted histories: they place the loss of contact to a fifth of the shortest step."""

SHOWN = 0.02
"""s within which nearly all failures come: the trusted histories go on for that long at least."""


class Beginning(Enum):
    """What comes first in a run that fails."""

    CONTACT = "contact is lost"
    STEP = "a step is unstable while there is contact"
    EARLY = "the run fails before contact is lost in the exact motion"


def beginnings(band: Band) -> list[Beginning]:
    """Return how each failure of a band began whose step was stable at rest.

    STEP: a step began with film rate times step beyond the real limit of stability, before the run's own load
    had fallen below LOST. CONTACT: not so, and the exact motion (CVODES) from the same start loses contact by
    the end of the step after the failing one. EARLY: it does not.
    """
    motion = [o.failure and o is not Outcome.UNSTABLE for o in band.outcome]
    speeds, times = band.speeds[motion], band.time[motion]
    if len(speeds) == 0:
        return []
    numbers = np.rint(times / band.step).astype(np.int64)
    steps = unstable_first(band, speeds, numbers)
    lost = [loss(band.name, rpm, time + band.step) for rpm, time in zip(speeds, times, strict=True)]
    late = times + band.step < np.array(lost)
    return [
        Beginning.STEP if step else Beginning.EARLY if early else Beginning.CONTACT
        for step, early in zip(steps, late, strict=True)
    ]


def unstable_first(band: Band, speeds: Array, numbers: np.ndarray) -> list[bool]:
    """Return whether a step of each run was unstable before its load fell below LOST or it failed.

    speeds (N,) in rev/min; numbers (N,): of the steps that failed.
    """
    cases = runs(band.form, [(band.name, float(rpm)) for rpm in speeds])
    size, keep = cases.omega * band.step, np.arange(numbers.max())
    done = march(rates(cases.system), cases.state, cases.phase, cases.parameter, size, keep)
    with np.errstate(all="ignore"):
        out = cases.outputs(done.phase, done.state)
        measure = film_rate(band.name, out["film"], out["deflection"], speeds) * band.step
    lost = (out["load"] < LOST * cases.named["preload"]) | (out["deflection"] < 0)
    over = ~(measure < real_limit())
    return [_first(over[:number, k]) < _first(lost[:number, k]) for k, number in enumerate(numbers)]


def loss(name: str, rpm: float, until: float) -> float:
    """Return when (s) the exact motion from the paper's start first loses contact, inf if not by `until`."""
    history = trusted(name, max(SHOWN, 1.1 * until), float(rpm), SAMPLES)
    lost = history.time[history.load < LOST * nominal(name)["preload"]]
    return float(lost[0]) if len(lost) else np.inf


def _first(which: np.ndarray) -> float:
    """Return the number of the first that holds, inf for none."""
    places = np.flatnonzero(which)
    return float(places[0]) if len(places) else np.inf
