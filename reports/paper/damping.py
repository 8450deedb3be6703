"""Linear damping: ratios from the Jacobian, from multipliers, and as the paper reads them off transients."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.optimize import brentq

from reports.pages.section import Section, Tell
from reports.paper import causes
from reports.paper.causes import OIL_A, OIL_B, PAPER_A, PAPER_B
from reports.paper.equivalent import (
    LARGE,
    ONE,
    SMALL,
    accelerated_ratio,
    at_paper_speed,
    film_growth,
    orbit_at,
    orbit_exponents,
    orbit_ratio,
    ratio,
    stepped_ratio,
)
from reports.paper.resonance import natural_speed
from reports.paper.rows import Row, compared
from reports.paper.scenes import system
from reports.paper.transients import Decay, Window, decay, level, read_off, record, stepped_decay
from reports.view import MICRO, RPM
from symbolic.response import response

OILS = {OIL_A: "oil A (Vitrea 79)", OIL_B: "oil B (Turbo 33)"}
PARTS = (SMALL, ONE, LARGE)
STEP = 1e-4
"""The paper's time step, s: 10 000 of them are 1 s (P7)."""

STABLE_STEP = 8e-5
"""A step with which the film of oil B is still stable in Runge-Kutta steps, s."""

READ: Window = (0.0, 0.09)
STEADY: Window = (0.1, 0.14)
"""Parts of oil A's record that the paper shows as transient (Fig. 6a) and as steady (Fig. 6b)."""

LATE: Window = (0.95, 1.0)
"""Part of oil B's record that the paper shows (Fig. 7)."""

AXIS = -3.0e-6
"""Lowest label of the axis of Fig. 7, m."""

SPEEDS = (100 * RPM, 500 * RPM)


@dataclass(frozen=True, kw_only=True)
class Ratios:
    """Damping ratios of one oil at 360 rev/min, 810 N; where several, by part of the paper's waviness.

    read: from the record as the paper reads it, with the mean and with the highest of the late crests taken
    as the steady amplitude.
    """

    jacobian: float
    vanishing: float
    orbit: dict[float, float]
    transient: dict[float, float]
    read: tuple[float, float]


@cache
def ratios(name: str) -> Ratios:
    """Return all damping ratios of an oil."""
    rest = at_paper_speed(name)
    runs = {part: record(name, part) for part in PARTS}
    late = level(runs[ONE], STEADY)
    frequency = float(rest.frequencies[0])
    read = [read_off(runs[ONE], float(steady), READ, frequency) for steady in (late.mean(), late.max())]
    return Ratios(
        jacobian=float(rest.damping_ratios[0]),
        vanishing=ratio(orbit_exponents(name)[0][1]),
        orbit={part: orbit_ratio(name, part) for part in PARTS},
        transient={part: decay(run.time, run.free, READ).ratio for part, run in runs.items()},
        read=(read[0], read[1]),
    )


@cache
def over_a_second() -> float:
    """Return oil B's damping ratio from a whole second of its free motion."""
    run = record(OIL_B)
    return decay(run.time, run.free, (0.0, 1.0)).ratio


def measured_step(name: str, step: float) -> float:
    """Return the ratio read off a record that is stepped by the paper's method, NaN where that fails."""
    found = stepped_decay(name, step, READ)
    return found.ratio if isinstance(found, Decay) else math.nan


def failing_step() -> int:
    """Return the number of the paper's step that fails for oil B."""
    found = stepped_decay(OIL_B, STEP, READ)
    if isinstance(found, Decay):
        raise ArithmeticError("oil B was stepped without a failure")
    return found


def second_read_with_its_end() -> float:
    """Return oil B's ratio read off a second less the highest crest of its last 50 ms."""
    run = record(OIL_B)
    frequency = float(at_paper_speed(OIL_B).frequencies[0])
    return read_off(run, float(level(run, LATE).max()), (0.0, LATE[0]), frequency)


@cache
def unsteady_bound() -> tuple[float, float]:
    """Return the largest ratio with which oil B is not yet steady at 0.95 s, and the free motion allowed (m).

    Allowed is what oil A's free motion still is where the paper takes its record for steady.
    """
    thick, thin = (decay(run.time, run.free, READ) for run in (record(OIL_A), record(OIL_B)))
    allowed = float(thick.envelope(np.array([STEADY[0]]))[0])
    return causes.ratio_between(allowed, thin.size, LATE[0]), allowed


@cache
def axis_bound() -> float:
    """Return the least ratio with which oil B's record of the last 50 ms stays above AXIS."""
    run = record(OIL_B)
    steady = float((run.x - run.free).min())
    start = decay(run.time, run.free, READ).size
    return causes.ratio_between(steady - AXIS, start, LATE[0])


def left_at_the_end(value: float) -> float:
    """Return what damping `value` leaves of oil B's free motion at 0.95 s, in m."""
    run = record(OIL_B)
    size = decay(run.time, run.free, READ).size
    return float(size * np.exp(-value * at_paper_speed(OIL_B).frequencies[0] * LATE[0]))


@cache
def tension(name: str) -> tuple[float, float]:
    """Return the speeds (rad/s) between which the linear load would be negative in a part of each period."""
    chosen, meeting = system(name), natural_speed(system(name)) * RPM

    def excess(speed: float) -> float:
        found = response(chosen, "speed", [speed])
        return float(found.peak_to_peak("load")[0] / 2 / found.at_rest("load")[0] - 1)

    low, high = (brentq(excess, end, meeting, xtol=1e-9) for end in SPEEDS)
    return float(low), float(high)


def section(tell: Tell) -> Section:
    """Return the section on linear damping, rows P10 and P11."""
    from reports.paper import damping_figures, damping_text

    for name, oil in OILS.items():
        tell(f"transients and orbits of {oil}")
        ratios(name)
    tell("causes")
    numbers = key_numbers()
    tell("figures")
    return Section(
        title="Linear damping",
        text=damping_text.text(numbers),
        numbers=numbers,
        rows=rows(),
        figures={
            "damping-transients": damping_figures.transients(),
            "damping-amplitude": damping_figures.amplitudes(),
            "damping-response": damping_figures.responses(),
        },
    )


def key_numbers() -> dict[str, float]:
    """Return the key numbers of the section."""
    numbers: dict[str, float] = {}
    for short, name in (("oil_a", OIL_A), ("oil_b", OIL_B)):
        found = ratios(name)
        numbers |= {
            f"{short}_zeta_jacobian": found.jacobian,
            f"{short}_zeta_orbit_vanishing": found.vanishing,
            f"{short}_zeta_orbit": found.orbit[ONE],
            f"{short}_zeta_orbit_double": found.orbit[LARGE],
            f"{short}_zeta_transient_small": found.transient[SMALL],
            f"{short}_zeta_transient": found.transient[ONE],
            f"{short}_zeta_transient_double": found.transient[LARGE],
            f"{short}_zeta_read_mean": found.read[0],
            f"{short}_zeta_read_highest": found.read[1],
            f"{short}_zeta_rk3": stepped_ratio(name, 3, STEP),
            f"{short}_zeta_rk4": stepped_ratio(name, 4, STEP),
            f"{short}_film_growth_rk4": film_growth(name, 4, STEP),
            f"{short}_film_growth_rk3": film_growth(name, 3, STEP),
            f"{short}_resonance_rpm": natural_speed(system(name)),
            f"{short}_tension_begin_rpm": tension(name)[0] / RPM,
            f"{short}_tension_end_rpm": tension(name)[1] / RPM,
            f"{short}_x_linear_um": _linear_swing(name) / MICRO,
            f"{short}_x_um": orbit_at(name, ONE).peak_to_peak("x") / MICRO,
        }
    return numbers | _cause_numbers()


def _cause_numbers() -> dict[str, float]:
    """Return the numbers of the causes considered for oil B, and of what they would do to oil A."""
    film, (squeeze_ratio, squeeze) = causes.film_needed(), causes.most_from_squeeze()
    both, ripple = causes.both_oils()
    steady, true = causes.level_needed(record(OIL_B), READ)
    beta, (bound, allowed) = causes.beta_needed(), unsteady_bound()
    return {
        "oil_b_zeta_second": over_a_second(),
        "oil_b_zeta_second_read": second_read_with_its_end(),
        "oil_a_zeta_transient_rk4": measured_step(OIL_A, STEP),
        "oil_b_zeta_transient_rk4_80us": measured_step(OIL_B, STABLE_STEP),
        "oil_b_failing_step_rk4": failing_step(),
        "oil_b_zeta_rk2": stepped_ratio(OIL_B, 2, STEP),
        "oil_a_zeta_linear_acceleration": accelerated_ratio(OIL_A, STEP, 1.0),
        "oil_b_zeta_linear_acceleration": accelerated_ratio(OIL_B, STEP, 1.0),
        "oil_b_zeta_linear_acceleration_mean": accelerated_ratio(OIL_B, STEP, 0.5),
        "oil_b_film_um": film.given / MICRO,
        "oil_b_film_needed_um": film.needed / MICRO,
        "viscosity_exponent_needed": film.exponent,
        "beta_needed": beta,
        "oil_a_zeta_at_that_beta": causes.jacobian_ratio(OIL_A, {"beta": beta}),
        "oil_b_zeta_most_from_squeeze": squeeze_ratio,
        "squeeze_of_most": squeeze,
        "beta_for_both": both["beta"],
        "squeeze_for_both": both["squeeze"],
        "oil_a_film_ripple_for_both_um": ripple / MICRO,
        "oil_b_x_needed_um": causes.swing_needed() / MICRO,
        "oil_b_x_transient_um": float(np.ptp(record(OIL_B).x)) / MICRO,
        "oil_b_level_needed_um": steady / MICRO,
        "oil_b_level_um": true / MICRO,
        "oil_b_zeta_unsteady_bound": bound,
        "oil_b_zeta_axis_bound": axis_bound(),
        "oil_a_free_taken_for_steady_um": allowed / MICRO,
        "oil_b_free_left_paper_um": left_at_the_end(PAPER_B) / MICRO,
        "oil_b_free_left_um": left_at_the_end(over_a_second()) / MICRO,
    }


def _linear_swing(name: str) -> float:
    return float(response(system(name), "speed", [360 * RPM]).peak_to_peak("x")[0])


def rows() -> tuple[Row, ...]:
    """Return the rows P10 and P11 of the first table; ours is the Jacobian's damping ratio in both."""
    thin = ratios(OIL_B)
    remark = f"causes of the factor of {PAPER_B / thin.jacobian:.0f} in the section on linear damping"
    return _row("P10", "oil A", PAPER_A, ratios(OIL_A)), _row("P11", "oil B", PAPER_B, thin, remark)


def _row(key: str, oil: str, paper: float, found: Ratios, *remarks: str) -> Row:
    """Return the row of an oil; the check names what other measures give and how far from the paper."""

    def away(value: float) -> str:
        return f"{value:.3g} ({100 * (value / paper - 1):+.1f} %)"

    checks = (
        f"from the Jacobian; the multipliers at vanishing waviness differ by "
        f"{abs(found.vanishing / found.jacobian - 1):.0e} of it",
        f"about the orbit of the paper's size they give {away(found.orbit[ONE])}",
        f"read off the transient it is {away(found.transient[ONE])}",
        *remarks,
    )
    what = f"equivalent linear damping factor, {oil}"
    return compared(key, what, paper, found.jacobian, "", "; ".join(checks))
