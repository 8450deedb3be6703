"""Ball bearings 60xx, 62xx, 63xx and roller bearings NU, their elements from lists."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

import symbolic as sym
from support.drawn.machines.machine import GRAVITY, RPM, Accelerations, Array, Machine, Random, spread

BALLS = {
    "6001": (8, 4.763, 20.0),
    "6004": (9, 6.35, 31.0),
    "6005": (10, 6.35, 36.0),
    "6006": (11, 7.144, 42.5),
    "6008": (12, 7.938, 54.0),
    "6010": (13, 8.731, 65.0),
    "6012": (13, 10.319, 77.5),
    "6203": (8, 6.747, 28.5),
    "6204": (8, 7.938, 33.5),
    "6205": (9, 7.938, 38.5),
    "6206": (9, 9.525, 46.0),
    "6208": (9, 11.906, 60.0),
    "6210": (10, 12.7, 70.0),
    "6306": (8, 12.303, 51.0),
}
"""Elements, their diameter and the pitch diameter in mm."""

ROLLERS = {
    "NU204": (11, 7.5, 34.0),
    "NU205": (12, 7.5, 39.0),
    "NU206": (13, 9.0, 46.5),
    "NU208": (14, 11.0, 61.0),
    "NU210": (16, 11.0, 71.0),
    "NU1008": (16, 8.0, 54.0),
}
"""The same of cylindrical rollers, as long as their diameter."""

FASTEST = 5e5
"""Largest speed times pitch diameter, rev/min mm: a grease's."""


def balls(draw: Random) -> Machine:
    """Deep groove ball bearing: K = 1e10 N/m^1.5 for a 6204, in proportion to the root of the diameter."""
    name = str(draw.choice(sorted(BALLS)))
    return _bearing(draw, name, BALLS[name], 1e10 * math.sqrt(BALLS[name][1] / 7.938), 1.5)


def rollers(draw: Random) -> Machine:
    """Cylindrical roller bearing: Palmgren's K = 8.06e10 l^(8/9) for each of two contacts in series."""
    name = str(draw.choice(sorted(ROLLERS)))
    length = ROLLERS[name][1] * 1e-3
    return _bearing(draw, name, ROLLERS[name], 8.06e10 * length ** (8 / 9) / 2 ** (10 / 9), 10 / 9)


def _bearing(
    draw: Random, name: str, sizes: tuple[int, float, float], stiffness: float, exponent: float
) -> Machine:
    """A rotor's share on one bearing: 10 N to 5 kN, damped by .5 to 10 %."""
    count, diameter, pitch = sizes
    inner, outer = (pitch - diameter) * 1e-3, (pitch + diameter) * 1e-3
    load = spread(draw, 10.0, 5000.0)
    mass = min(max(load / GRAVITY * draw.uniform(0.3, 1.2), 0.5), 150.0)
    tangent = exponent * load / (load / stiffness) ** (1 / exponent)
    damping = 2 * spread(draw, 0.005, 0.1) * math.sqrt(tangent * mass)
    clearance = float(draw.uniform(-5e-6, 30e-6))
    what = str(draw.choice(["weight", "weight", "unbalance", "waves"]))
    x, y = sym.coordinate("x", scale=1e-6), sym.coordinate("y", scale=1e-6)
    speed = sym.parameter("speed", 3000 * RPM, "rad/s")
    parts: list[sym.Part] = [part for q in (x, y) for part in (sym.Mass(q, mass), sym.Damper(q, damping))]
    parts.append(sym.ConstantForce(x, load))
    passages: Fraction | None = None
    waves, eccentricity, wave = list[sym.RaceWave](), 0.0, ("", 0, 0.0, 0.0)
    if what != "weight":
        passages = Fraction(count * inner / (inner + outer)).limit_denominator(6)
    if what == "unbalance":
        eccentricity = spread(draw, 1e-7, 1e-5)
        parts.append(sym.Unbalance(x, y, mass, eccentricity, speed))
    if what == "waves":
        surface, crests = str(draw.choice(["outer", "inner"])), int(draw.integers(2, 20))
        wave = (surface, crests, spread(draw, 5e-8, 1e-6), float(draw.uniform(0, 6)))
        waves = [sym.RaceWave(*wave)]  # type: ignore[arg-type]
    law = sym.HertzLaw(stiffness, exponent)
    places = {"speed": speed, "inner": inner, "outer": outer, "waves": waves, "passages": passages}
    parts.append(sym.RollingBearing(x, y, count, law, clearance, **places))  # type: ignore[arg-type]
    turns = 1 if passages is None else passages.denominator
    passed = 1 if passages is None else passages.numerator
    each = 2 * math.pi * np.arange(count) / count

    def accelerations(tau: float, q: Array, rate: Array, omega: float) -> Array:
        angle, shaft = passed * tau / count + each, turns * tau
        surface, crests, height, phase = wave
        toward = np.array([np.cos(angle), np.sin(angle)])
        depth = toward.T @ q - clearance
        if surface:
            turned = angle - (shaft if surface == "inner" else 0.0)
            depth = depth + height * np.cos(crests * turned + phase)[:, None]
        force = stiffness * np.maximum(depth, 0.0) ** exponent
        pull = mass * eccentricity * omega**2 * np.array([math.cos(shaft), math.sin(shaft)])
        steady = pull + np.array([load, 0.0])
        return np.asarray((steady[:, None] - toward @ force - damping * rate) / mass)

    frequency = count * inner / (inner + outer) if passages is None else 1 / turns
    told = (
        f"{name}, {load:.4g} N on {mass:.3g} kg, clearance {1e6 * clearance:.3g} um, {what}"
        f"{'' if passages is None else f', {passages} passages a turn'}"
    )
    made: Accelerations = accelerations
    bounds = 500 * RPM, min(12000.0, FASTEST / pitch) * RPM
    return Machine(sym.combine(parts), "speed", bounds, told, made, frequency)
