"""Where a disc resonates: by its linear motion, and by the highest point of its branch."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from periodic import ArclengthControl, Branch
from reports.studies.paper.common.scenes import nominal, system
from reports.studies.paper.common.tracing import branch, traced
from symbolic import CompiledSystem
from symbolic.motion.frequencyresponse import peak
from symbolic.motion.linear import resonance
from symbolic.scenes.axes import RPM

RANGE = (100.0, 500.0)
"""Speeds of the paper's frequency plots, rev/min."""

RANGE_ABOUT = 0.01
"""How far about the highest point the branch is traced more closely, as a part of its speed."""


def natural_speed(disc: CompiledSystem) -> float:
    """Return where in RANGE (rev/min) the corrugations meet the natural frequency at rest.

    Raises ArithmeticError where they do not.
    """
    found = resonance(disc, "speed", (RANGE[0] * RPM, RANGE[1] * RPM))
    if found is None:
        raise ArithmeticError(f"the disc has no linear resonance from {RANGE[0]:g} to {RANGE[1]:g} rev/min")
    return found / RPM


def linear_peak(name: str) -> float:
    """Return the speed (rev/min) of the linear response's peak."""
    natural = natural_speed(system(name)) * RPM
    return peak(system(name), "x", "speed", (0.97 * natural, 1.03 * natural))[0] / RPM


def highest(disc: CompiledSystem, found: Branch) -> tuple[float, float]:
    """Return speed (rev/min) and x peak to peak (m) where the latter is largest along a branch.

    A cubic spline in the chord length runs through the points of a closer trace about the highest one.
    """
    top = max(found, key=lambda point: point.maximum["x"] - point.minimum["x"])
    around = (
        max(found.values.min(), (1 - RANGE_ABOUT) * top.parameter) / RPM,
        (1 + RANGE_ABOUT) * top.parameter / RPM,
    )
    closer = traced(disc, "speed", around, guess=top.orbit, step=ArclengthControl(ds_max=0.05))
    speed, swing = closer.values / RPM, closer.peak_to_peak("x")
    steps = np.hypot(np.diff(speed) / np.ptp(speed), np.diff(swing) / np.ptp(swing))
    apart = np.append(True, steps > 1e-9)
    length = np.append(0.0, np.cumsum(steps))[apart]
    curve = CubicSpline(length, np.column_stack([speed, swing])[apart])
    fine = curve(np.linspace(0, length[-1], 20001))
    best = fine[np.argmax(fine[:, 1])]
    return float(best[0]), float(best[1])


def backbone(name: str, parts: tuple[float, ...]) -> list[tuple[float, float]]:
    """Return the highest points of the branches with parts of the paper's waviness, as `highest`.

    They begin at the natural speed, where the motion vanishes.
    """
    natural = natural_speed(system(name))
    ends = (round(1.15 * natural), round(0.6 * natural))
    waves = [("waviness.amplitude", repr(k * nominal(name)["amplitude"])) for k in parts]
    found = [highest(system(name, wave), branch(name, *ends, overrides=(wave,))) for wave in waves]
    return [(natural, 0.0), *found]
