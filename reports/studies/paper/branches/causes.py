"""What could make oil B's damping ratio ten times larger than the equations give, each with its number."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar, root

from reports.studies.paper.common.discs import OIL_A, OIL_B, RPM_SHOWN
from reports.studies.paper.common.scenes import PAPER_SPEED, at_paper_speed, film_at_rest, nominal, system
from reports.studies.paper.marching.transients import (
    Record,
    Window,
    beat_crests,
    free_decay,
    read_off,
    within,
)
from symbolic.motion.frequencyresponse import response
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM

PAPER_A, PAPER_B = 0.007, 0.0018
"""Damping ratios that the paper prints for Shell Vitrea 79 and Shell Turbo 33."""


@dataclass(frozen=True, kw_only=True)
class FilmNeeded:
    """Steady film in m: the law's and the one needed; the exponent of the viscosity that would give it."""

    given: float
    needed: float
    exponent: float


def jacobian_ratio(name: str, values: Mapping[str, float] | None = None) -> float:
    """Return the damping ratio from the Jacobian at 360 rev/min with some values changed."""
    return float(modes(system(name, PAPER_SPEED), values).damping_ratios[0])


def film_needed() -> FilmNeeded:
    """Find the steady film at which oil B has the paper's damping ratio.

    In the equations viscosity acts on the steady film alone, so it is what is varied.
    """
    viscosity = brentq(
        lambda value: jacobian_ratio(OIL_B, {"viscosity": value}) - PAPER_B, 0.034, 0.89, xtol=1e-14
    )
    thick, given = (film_at_rest(system(name, PAPER_SPEED)) for name in (OIL_A, OIL_B))
    needed = film_at_rest(system(OIL_B, PAPER_SPEED), viscosity=viscosity)
    # h0 ~ eta^0.625 (law): the same viscosities with another exponent would have to give `needed`.
    thinner = nominal(OIL_B)["viscosity"] / nominal(OIL_A)["viscosity"]
    other_factors = given / thick / thinner**0.625
    power = math.log(needed / thick / other_factors) / math.log(thinner)
    return FilmNeeded(given=given, needed=needed, exponent=power)


def beta_needed() -> float:
    """Return the film's load exponent beta at which oil B has the paper's damping ratio."""
    return float(brentq(lambda beta: jacobian_ratio(OIL_B, {"beta": beta}) - PAPER_B, 1.0, 22.23, xtol=1e-12))


def most_from_squeeze() -> tuple[float, float]:
    """Return the largest damping ratio that any squeeze coefficient gives oil B, and that coefficient."""
    best = minimize_scalar(
        lambda log: -jacobian_ratio(OIL_B, {"squeeze": math.exp(log)}),
        bounds=(math.log(1e2), math.log(1e7)),
        method="bounded",
        options={"xatol": 1e-8},
    )
    return -float(best.fun), math.exp(best.x)


def both_oils() -> tuple[dict[str, float], float]:
    """Return beta and squeeze that give both oils the paper's ratios, and oil A's film ripple (m) then."""

    def values(logs: np.ndarray) -> dict[str, float]:
        return {"beta": math.exp(logs[0]), "squeeze": math.exp(logs[1])}

    def misses(logs: np.ndarray) -> list[float]:
        ratios = [jacobian_ratio(name, values(logs)) for name in (OIL_A, OIL_B)]
        return [ratios[0] / PAPER_A - 1, ratios[1] / PAPER_B - 1]

    found = root(misses, np.log([10.0, 5000.0]), tol=1e-12)
    if not found.success:
        raise ArithmeticError(f"no beta and squeeze give both oils the paper's damping: {found.message}")
    return values(found.x), ripple(OIL_A, values(found.x))


def ripple(name: str, values: Mapping[str, float] | None = None) -> float:
    """Return the linear film ripple p-p at 360 rev/min in m."""
    chosen = system(name, PAPER_SPEED)
    return float(response(chosen, "speed", [RPM_SHOWN * RPM], values).peak_to_peak("film")[0])


def level_needed(found: Record, window: Window) -> tuple[float, float]:
    """Return the steady amplitude (m) to subtract from oil B's beats for the paper's ratio, and the true one.

    The true one is that of the record without its free motion.
    """
    frequency = float(at_paper_speed(OIL_B).frequencies[0])
    at, heights = beat_crests(found)
    true = float((found.x - found.free).max())
    highest = heights[within(window, at)].min()

    def excess(steady: float) -> float:
        return read_off(found, steady, window, frequency) - PAPER_B

    return float(brentq(excess, true, highest - 1e-4 * (highest - true), xtol=1e-15)), true


def swing_needed() -> float:
    """Return the x p-p (m) at which free motion of oil B decays with the paper's damping ratio."""

    def excess(compression: float) -> float:
        return free_decay(OIL_B, compression)[1] - PAPER_B

    return free_decay(OIL_B, float(brentq(excess, 8e-6, 20e-6, xtol=1e-10)))[0]


def ratio_between(allowed: float, start: float, time: float) -> float:
    """Return the ratio with which oil B's free motion falls from `start` to `allowed` (m) in `time` (s)."""
    return math.log(start / allowed) / (time * float(at_paper_speed(OIL_B).frequencies[0]))
