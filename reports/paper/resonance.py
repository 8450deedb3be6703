"""Where a disc resonates: by its linear motion, and by the highest point of its branch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

import periodic
from reports.paper.scenes import branch, system
from reports.view import RPM
from symbolic import CompiledSystem
from symbolic.linear import resonance
from symbolic.response import peak

RANGE = (100.0, 500.0)
"""Speeds of the paper's frequency plots, rev/min."""

NEAR = 0.01
"""How far about the highest point the branch is traced more closely, as a part of its speed."""

CLOSELY = periodic.Accuracy.STANDARD.settings(periodic.StepSettings(ds_max=0.05))


@dataclass(frozen=True, kw_only=True)
class Resonance:
    """Speeds in rev/min and x peak to peak in m.

    natural: where 120 corrugations a turn meet the undamped natural frequency at rest, which is also where
    the backbone begins. linear: the peak of the linear response. highest: that of the branch.
    """

    natural: float
    linear: tuple[float, float]
    highest: tuple[float, float]


def natural_speed(disc: CompiledSystem) -> float:
    """Return where in RANGE (rev/min) the corrugations meet the natural frequency at rest.

    Raises ArithmeticError where they do not.
    """
    found = resonance(disc, "speed", (RANGE[0] * RPM, RANGE[1] * RPM))
    if found is None:
        raise ArithmeticError(f"the disc has no linear resonance from {RANGE[0]:g} to {RANGE[1]:g} rev/min")
    return found / RPM


@cache
def of(name: str) -> Resonance:
    """Return the resonance of a built-in disc."""
    disc = system(name)
    natural = natural_speed(disc) * RPM
    speed, swing = peak(disc, "x", "speed", (0.97 * natural, 1.03 * natural))
    return Resonance(
        natural=natural / RPM, linear=(speed / RPM, float(swing)), highest=highest(disc, branch(name))
    )


def highest(disc: CompiledSystem, found: periodic.Branch) -> tuple[float, float]:
    """Return speed (rev/min) and x peak to peak (m) where the latter is largest along a branch.

    A cubic spline in the chord length runs through the points of a closer trace about the highest one.
    """
    top = max(found, key=lambda point: point.maximum["x"] - point.minimum["x"])
    around = (max(found.values.min(), (1 - NEAR) * top.parameter), (1 + NEAR) * top.parameter)
    closer = periodic.trace(disc, "speed", around, guess=top.orbit, settings=CLOSELY)
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
    amplitude = {p.name: p.value for p in system(name).parameters}["amplitude"]
    natural = of(name).natural
    ends = (round(1.15 * natural), round(0.6 * natural))
    waves = [("waviness.amplitude", repr(k * amplitude)) for k in parts]
    found = [highest(system(name, wave), branch(name, *ends, overrides=(wave,))) for wave in waves]
    return [(natural, 0.0), *found]
