"""A cylindrical roller bearing of a catalogue under a light load, its rollers touched and left many times."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.drawn.machines.machine import Array, Machine
from survey.machines.judge import judged

import periodic as per
import symbolic as sym

COUNT, INNER, OUTER = 12, 26.5e-3, 41.5e-3
LOAD, MASS, DAMPING, GAP, STIFFNESS = 18.0, 1.35, 240.0, 10e-6, 4.82e8
SPEED = 100.0


def bearing() -> Machine:
    """An NU205 that carries 18 N at 955 rev/min."""
    x, y = sym.coordinate("x", scale=1e-6), sym.coordinate("y", scale=1e-6)
    speed = sym.parameter("speed", SPEED, "rad/s")
    races = {"clearance": GAP, "speed": speed, "inner": INNER, "outer": OUTER}
    parts = [part for q in (x, y) for part in (sym.Mass(q, MASS), sym.Damper(q, DAMPING))]
    parts.append(sym.RollingBearing(x, y, COUNT, sym.HertzLaw(STIFFNESS, 10 / 9), **races))  # type: ignore[arg-type]
    model = sym.combine([*parts, sym.ConstantForce(x, LOAD)])

    def accelerations(tau: float, q: Array, rate: Array, omega: float) -> Array:
        angle = (tau + 2 * math.pi * np.arange(COUNT)) / COUNT
        toward = np.array([np.cos(angle), np.sin(angle)])
        force = STIFFNESS * np.maximum(toward.T @ q - GAP, 0.0) ** (10 / 9)
        return np.asarray((np.array([[LOAD], [0.0]]) - toward @ force - DAMPING * rate) / MASS)

    pace = COUNT * INNER / (INNER + OUTER)
    return Machine(model, "speed", (SPEED, 2 * SPEED), "NU205", accelerations, pace)


def test_multipliers_of_light_contacts() -> None:
    """Assert that they are known to 1e-6, as said, beside a stiffness d^(1/9), and to 1e-3 by DOP853.

    Rounding of d at event nodes had left them at 1e-2, on meshes of as many intervals as allowed.
    """
    drawn = bearing()
    few = per.ArclengthControl(max_points=1)
    point = per.trace(sym.compile(drawn.model), "speed", drawn.bounds, start=SPEED, control=few, tol=1e-6)[0]
    assert len(point.orbit.phases) > 5
    assert point.error.multiplier <= 1e-6
    verdict = judged(drawn, np.array([1e-6, 1e-6]), point, 1e-6)
    assert verdict.wrong(point, 1e-6) == ""
    assert verdict.orbit < 1e-5
    assert np.abs(point.multipliers).max() == pytest.approx(np.abs(point.multipliers[0]))
