"""Readings of the paper's film law, films with a floor, and what enters of a law of thickness."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from periodic import Branch, Label, Point
from reports.studies.paper.branches import causes
from reports.studies.paper.branches.resonance import natural_speed
from reports.studies.paper.common.discs import MICRO, OIL_A, OIL_B
from reports.studies.paper.common.scenes import film_at_rest, system
from reports.studies.paper.common.tracing import at_speed, branch, traced
from symbolic import CompiledSystem
from symbolic.motion.linear import modes
from symbolic.scenes.axes import RPM
from symbolic.system.compiled import with_values

SCENE, FLOORED = OIL_A, "cavitating-film-810N"

POINT = 360.0
"""Speed in rev/min of the paper's own film thickness."""

READINGS = ("calibrated", "equation-5", "constant-one-body", "constant-two-body", "hamrock-dowson")
"""Laws of the steady thickness, as scenes name them (film.thickness)."""

EXPONENTS = (0.55, 0.58, 0.625)
"""Readings of the illegible exponent of U* in eq. (5)."""

FLOORS = (1e-1, 1e-2, 1e-4, 1e-6, 1e-7, 1e-8)
"""Floors on the load that drives the film, as parts of the preload."""

TUNED_SPEED = 260.0
"""Speed in rev/min at which two readings are brought to one h0; the contact is lost there."""


def reading(name: str) -> CompiledSystem:
    """Return the disc with one of the READINGS."""
    return system(SCENE, ("film.thickness", name))


def reading_branch(name: str) -> Branch:
    """Return its branch from 500 to 100 rev/min."""
    return branch(SCENE, overrides=(("film.thickness", name),))


def reading_numbers(name: str) -> dict[str, float]:
    """Return h0, linear resonance and damping ratio of a reading, without tracing (um, rev/min)."""
    disc = reading(name)
    return {
        f"{name} film um": film_at_rest(disc, speed=POINT * RPM) / MICRO,
        f"{name} resonance rpm": natural_speed(disc),
        f"{name} damping ratio": float(modes(disc, {"speed": POINT * RPM}).damping_ratios[0]),
    }


def fold_numbers(name: str, found: Branch) -> dict[str, float]:
    """Return speeds (rev/min) and sizes (um) of a branch's folds, in order from 500 rev/min down."""
    numbers = {}
    for i, fold in enumerate(found.labelled(Label.FOLD), 1):
        numbers[f"{name} fold {i} rpm"] = fold.parameter / RPM
        numbers[f"{name} fold {i} um"] = fold.peak_to_peak("x") / MICRO
    return numbers


def exponent_numbers() -> dict[str, float]:
    """Return h0 (um) of eq. (5) at readings of U's exponent, and the exponent that gives 3.85 um."""
    disc = reading("equation-5")

    def film(exponent: float) -> float:
        return film_at_rest(disc, speed=POINT * RPM, speed_exponent=exponent) / MICRO

    found = {f"equation-5 film with exponent {e:g} um": film(e) for e in EXPONENTS}
    found["equation-5 exponent for 3.85 um"] = float(brentq(lambda e: film(e) - 3.85, 0.4, 0.7))
    return found | {"percent of film per digit": 100 * (material_number() ** (0.1 / 22.23) - 1)}


def material_number() -> float:
    """Return G* = alpha/E_x of Vitrea 79 and steel with the one-body modulus."""
    values = {p.name: p.value for p in reading("constant-one-body").parameters}
    e_x = (1 - values["poisson"] ** 2) / (math.pi * values["modulus"])
    return values["piezoviscosity"] / e_x


def film_for_damping() -> dict[str, float]:
    """Return the steady film (um) with which oil B would have the paper's damping ratio, and its own."""
    found = causes.film_needed()
    return {
        "oil B film um": found.given / MICRO,
        "oil B damping ratio": causes.jacobian_ratio(OIL_B),
        f"oil B film for {causes.PAPER_B:g} um": found.needed / MICRO,
    }


def tuned_viscosity(name: str, rpm: float) -> float:
    """Return the viscosity (Pa s) at which a reading gives the calibrated film at a speed in rev/min."""
    disc, wanted = reading(name), film_at_rest(reading("calibrated"), speed=rpm * RPM)

    def excess(log_viscosity: float) -> float:
        found = film_at_rest(disc, speed=rpm * RPM, viscosity=math.exp(log_viscosity))
        return math.log(found / wanted)

    return math.exp(brentq(excess, math.log(1e-3), math.log(1e3), xtol=1e-15))


@cache
def tuned_orbits() -> tuple[Point, Point]:
    """Return the orbits of two readings with one h0 at TUNED_SPEED, on the upper sheet."""
    first = at_speed(branch(SCENE, at=(TUNED_SPEED,)), TUNED_SPEED)[0]
    viscosity = repr(tuned_viscosity("hamrock-dowson", TUNED_SPEED))
    other = system(SCENE, ("film.thickness", "hamrock-dowson"), ("film.viscosity", viscosity))
    # Only the states are taken over as a guess: the parameters are the other system's own.
    values = with_values(other, {"speed": TUNED_SPEED * RPM})
    guess = replace(first.orbit, parameter=values, layout=None)
    return first, traced(other, "speed", (0.999 * TUNED_SPEED, TUNED_SPEED), guess=guess)[0]


def tuned_difference() -> float:
    """Return the largest difference between the two orbits' states, as a part of the orbit's size."""
    first, second = tuned_orbits()
    tau = np.linspace(0, 2 * np.pi, 1001)
    return float(np.abs(first.orbit.state(tau) - second.orbit.state(tau)).max() / first.orbit.span())


def directions(name: str, points: int = 50) -> float:
    """Return the second singular value over the first of the residual's derivatives in the law's own numbers.

    0 says that viscosity, piezoviscosity, crown radius and elastic constants act on the equations through
    one number alone, h0. The derivatives are exact; the points are drawn around rest.
    """
    disc, random = reading(name), np.random.default_rng(1)
    names = [p.name for p in disc.parameters]
    law = ("viscosity", "piezoviscosity", "crown_radius", "modulus", "poisson")
    free = tuple(names.index(p) for p in law if p in names)
    parameter = with_values(disc, {"speed": POINT * RPM})
    state, unknown = disc.rest(parameter)
    near = state + 0.1 * random.standard_normal((points, len(state)))
    rate = random.standard_normal(near.shape)
    xi = unknown + random.standard_normal((points, len(unknown)))
    tau = random.uniform(0, 2 * np.pi, points)
    slopes = disc.linearise(rate, near, xi, tau, parameter, free).d_parameter.reshape(-1, len(free))
    values = np.linalg.svd(slopes * parameter[list(free)], compute_uv=False)
    return float(values[1] / values[0])


def floor_branch(floor: float) -> Branch:
    """Return the branch with a floor from 500 to 100 rev/min, points at 250 and 200."""
    return branch(FLOORED, at=(250.0, 200.0), overrides=(("film.floor", repr(floor)),))


def lower_branch(floor: float) -> Branch:
    """Return the branch with a floor from 150 rev/min up to its fold and some way down the unstable sheet."""
    return branch(FLOORED, 150.0, 300.0, overrides=(("film.floor", repr(floor)),))


def floor_numbers(floor: float) -> dict[str, float]:
    """Return folds, x p-p on the upper sheet and the widest cavity of a floor (rev/min, um)."""
    found = fold_numbers(f"floor {floor:g}", floor_branch(floor))
    for rpm in (250.0, 200.0):
        large = max(at_speed(floor_branch(floor), rpm), key=lambda p: p.peak_to_peak("x"))
        if large.minimum["load"] == 0 or rpm == 250.0:
            found[f"floor {floor:g} at {rpm:g} rpm um"] = large.peak_to_peak("x") / MICRO
    return found


def least_load() -> float:
    """Return ln(W/Q) at the smallest load on the squeeze film's upper fold."""
    fold = reading_branch("calibrated").labelled(Label.FOLD)[0]
    return math.log(fold.minimum["load"] / 810.0)


def ambient_share(preload: float = 810.0, pressure: float = 1e5) -> float:
    """Return the part of the preload that ambient pressure (Pa) carries over the Hertz footprint.

    Semi-axes a = (6 k^2 E R Q/(pi E'))^(1/3) and a/k, E = 1.0003 + 0.5968 R_x/R_y, by the approximations of
    Hamrock & Dowson (1977) for steel of 207 GPa.
    """
    r_x, r_y, modulus = 0.0255, 0.102, 207e9 / (1 - 0.3**2)
    k = 1.03 * (r_y / r_x) ** 0.64
    reduced, integral = r_x * r_y / (r_x + r_y), 1.0003 + 0.5968 * r_x / r_y
    a = (6 * k**2 * integral * reduced * preload / (math.pi * modulus)) ** (1 / 3)
    return pressure * math.pi * a * a / k / preload
