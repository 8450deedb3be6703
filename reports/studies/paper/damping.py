"""Linear damping: ratios from the Jacobian, from multipliers, and as the paper reads them off transients."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.optimize import brentq

from reports.studies.pages.content import Found, Section, Tell
from reports.studies.paper.branches import causes
from reports.studies.paper.branches.causes import PAPER_B
from reports.studies.paper.branches.resonance import natural_speed
from reports.studies.paper.common.discs import MICRO, OIL_A, OIL_B, RPM_SHOWN
from reports.studies.paper.common.scenes import at_paper_speed, system
from reports.studies.paper.damping_figures import amplitudes, responses, transients
from reports.studies.paper.marching import equivalent
from reports.studies.paper.marching.transients import (
    READ,
    Decay,
    Window,
    decay,
    free_decay_of,
    level,
    read_off,
    record,
    stepped_decay,
)
from symbolic.motion.frequencyresponse import response
from symbolic.scenes.axes import RPM

STEP, STABLE_STEP = 1e-4, 8e-5
"""The paper's time step, s, and one with which the film of oil B is still stable in Runge-Kutta steps."""

STEADY: Window = (0.1, 0.14)
"""Part of oil A's record that the paper shows as steady (Fig. 6b), s."""

LATE: Window = (0.95, 1.0)
"""Part of oil B's record that the paper shows (Fig. 7), s."""

AXIS = -3.0e-6
"""Lowest label of the axis of Fig. 7, m."""

ENDS = (100 * RPM, 500 * RPM)


def compute(tell: Tell) -> Found:
    """Compute both oils' ratios, and what could make oil B's ten times larger."""
    for name in (OIL_A, OIL_B):
        tell(f"transients and orbits of {name}")
        ratios(name)
    tell("causes")
    numbers = key_numbers()
    tell("figures")
    figures = {
        "damping-transients": transients(),
        "damping-amplitude": amplitudes(),
        "damping-response": responses(),
    }
    return Found(numbers=numbers, figures=figures)


SECTION = Section(title="Linear damping", compute=compute)


@cache
def ratios(name: str) -> dict[str, float]:
    """Return the damping ratios of an oil at 360 rev/min, 810 N, by how they are found.

    orbit and transient with the paper's waviness, small and double with parts of it. read: from the record as
    the paper reads it, with the mean and with the highest of the late crests taken as the steady amplitude.
    """
    rest, run = at_paper_speed(name), record(name)
    late, frequency = level(run, STEADY), float(rest.frequencies[0])
    return {
        "jacobian": float(rest.damping_ratios[0]),
        "orbit_vanishing": equivalent.ratio(equivalent.orbit_exponents(name)[0][1]),
        "orbit": equivalent.orbit_ratio(name, equivalent.ONE),
        "orbit_double": equivalent.orbit_ratio(name, equivalent.LARGE),
        "transient_small": free_decay_of(name, equivalent.SMALL).ratio,
        "transient": free_decay_of(name).ratio,
        "transient_double": free_decay_of(name, equivalent.LARGE).ratio,
        "read_mean": read_off(run, float(late.mean()), READ, frequency),
        "read_highest": read_off(run, float(late.max()), READ, frequency),
        "rk3": equivalent.stepped_ratio(name, 3, STEP),
        "rk4": equivalent.stepped_ratio(name, 4, STEP),
    }


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


@cache
def tension(name: str) -> tuple[float, float]:
    """Return the speeds (rad/s) between which the linear load would be negative in a part of each period."""
    chosen, meeting = system(name), natural_speed(system(name)) * RPM

    def excess(speed: float) -> float:
        found = response(chosen, "speed", [speed])
        return float(found.peak_to_peak("load")[0] / 2 / found.at_rest("load")[0] - 1)

    low, high = (brentq(excess, end, meeting, xtol=1e-9) for end in ENDS)
    return float(low), float(high)


def key_numbers() -> dict[str, float]:
    """Return the key numbers of the section."""
    numbers: dict[str, float] = {}
    for short, name in (("oil_a", OIL_A), ("oil_b", OIL_B)):
        linear = float(response(system(name), "speed", [RPM_SHOWN * RPM]).peak_to_peak("x")[0])
        numbers |= {f"{short}_zeta_{way}": value for way, value in ratios(name).items()}
        numbers |= {
            f"{short}_film_growth_rk4": equivalent.film_growth(name, 4, STEP),
            f"{short}_film_growth_rk3": equivalent.film_growth(name, 3, STEP),
            f"{short}_resonance_rpm": natural_speed(system(name)),
            f"{short}_tension_begin_rpm": tension(name)[0] / RPM,
            f"{short}_tension_end_rpm": tension(name)[1] / RPM,
            f"{short}_x_linear_um": linear / MICRO,
            f"{short}_x_um": equivalent.orbit_at(name, equivalent.ONE).peak_to_peak("x") / MICRO,
        }
    return numbers | _of_the_motion() | _of_the_step() | _of_the_film()


def _of_the_motion() -> dict[str, float]:
    """Return the numbers of the causes that lie in the size of oil B's motion and in how it was read."""
    run, fit, frequency = record(OIL_B), free_decay_of(OIL_B), float(at_paper_speed(OIL_B).frequencies[0])
    level_needed, true = causes.level_needed(run, READ)
    second = decay(run.time, run.free, (0.0, 1.0)).ratio
    # What is left of oil A's free motion where the paper takes its record for steady.
    allowed = float(free_decay_of(OIL_A).envelope(np.array([STEADY[0]]))[0])
    lowest = float((run.x - run.free).min())

    def left(value: float) -> float:
        """What damping `value` leaves of oil B's free motion at 0.95 s, in m."""
        return float(fit.size * np.exp(-value * frequency * LATE[0]))

    return {
        "oil_b_zeta_second": second,
        "oil_b_zeta_second_read": read_off(run, float(level(run, LATE).max()), (0.0, LATE[0]), frequency),
        "oil_b_x_needed_um": causes.swing_needed() / MICRO,
        "oil_b_x_transient_um": float(np.ptp(run.x)) / MICRO,
        "oil_b_level_needed_um": level_needed / MICRO,
        "oil_b_level_um": true / MICRO,
        # Not yet steady at 0.95 s; and with the record of the last 50 ms above AXIS.
        "oil_b_zeta_unsteady_bound": causes.ratio_between(allowed, fit.size, LATE[0]),
        "oil_b_zeta_axis_bound": causes.ratio_between(lowest - AXIS, fit.size, LATE[0]),
        "oil_a_free_taken_for_steady_um": allowed / MICRO,
        "oil_b_free_left_paper_um": left(PAPER_B) / MICRO,
        "oil_b_free_left_um": left(second) / MICRO,
    }


def _of_the_step() -> dict[str, float]:
    """Return the numbers of the causes that lie in the steps, and of what they would do to oil A."""
    return {
        "oil_a_zeta_transient_rk4": measured_step(OIL_A, STEP),
        "oil_b_zeta_transient_rk4_80us": measured_step(OIL_B, STABLE_STEP),
        "oil_b_failing_step_rk4": failing_step(),
        "oil_b_zeta_rk2": equivalent.stepped_ratio(OIL_B, 2, STEP),
        "oil_a_zeta_linear_acceleration": equivalent.accelerated_ratio(OIL_A, STEP, 1.0),
        "oil_b_zeta_linear_acceleration": equivalent.accelerated_ratio(OIL_B, STEP, 1.0),
        "oil_b_zeta_linear_acceleration_mean": equivalent.accelerated_ratio(OIL_B, STEP, 0.5),
    }


def _of_the_film() -> dict[str, float]:
    """Return the numbers of the causes that lie in the film's law, and of what they would do to oil A."""
    film, (squeeze_ratio, squeeze) = causes.film_needed(), causes.most_from_squeeze()
    (both, ripple), beta = causes.both_oils(), causes.beta_needed()
    return {
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
    }
