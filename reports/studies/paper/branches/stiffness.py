"""Where supports of finite stiffness put the resonance, and the stiffness that puts it at a given speed.

Each side, of mass m, is a disc f m and a housing (1 - f) m joined by a bearing of stiffness k and damping c.
Without damping, with k_c the stiffness of the contact, mu = m/2 and r = (omega/omega0)^2, omega0^2 = k_c/mu,

    k/2 = k_c (1 - f) r (1 - f r)/(1 - r),   so that f -> 0 gives mu omega^2 = 1/(1/k_c + 2/k)
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.optimize import brentq

from reports.studies.paper.common.discs import OIL_A
from reports.studies.paper.common.scenes import nominal, static_deflection, system
from symbolic import CompiledSystem
from symbolic.motion.linear import Modes, modes, resonance
from symbolic.scenes.axes import RPM
from symbolic.scenes.errors import InputError

SCENE, RIGID = "supports-810N", OIL_A
"""The scene with supports, and the same without them."""

WAVES = 120
"""Corrugations of the disc: so many periods of the excitation in a revolution."""

SOFTEST, STIFFEST = 1e5, 1e15
"""Bearing stiffnesses between which one is looked for, in N/m."""

SLOWEST, FASTEST = 1.0, 2000.0
"""Speeds between which a resonance is looked for, in rev/min."""


@cache
def supported(share: float) -> CompiledSystem:
    """Return the scene with supports at a disc share f, without damping in the bearings.

    Soft bearings with damping have no oscillating first mode; the resonance is that of the stiffness alone.
    """
    return system(SCENE, ("support.disc_share", repr(share)), ("support.damping", "0.0"))


def rigid_resonance() -> float:
    """Return the speed in rev/min at which the linear disc on rigid supports resonates."""
    return _met(system(RIGID), {})


def resonance_speed(stiffness: float, share: float) -> float:
    """Return the speed in rev/min at which the first mode resonates; stiffness k of each bearing in N/m."""
    return _met(supported(share), {"bearing_stiffness": stiffness})


def _met(disc: CompiledSystem, values: dict[str, float]) -> float:
    found = resonance(disc, "speed", (SLOWEST * RPM, FASTEST * RPM), values)
    if found is None:
        raise InputError(
            "support.stiffness",
            f"puts no resonance between {SLOWEST:g} and {FASTEST:g} rev/min ({values or 'rigid'})",
            "it must be greater",
        )
    return found / RPM


def supported_modes(stiffness: float, share: float, rpm: float) -> Modes:
    """Return the linear modes at a speed in rev/min, with bearings of `stiffness` (N/m)."""
    return modes(supported(share), {"bearing_stiffness": stiffness, "speed": rpm * RPM})


def second_speed(stiffness: float, share: float) -> float:
    """Return the speed in rev/min at which the corrugations meet the second natural frequency."""

    def excess(rpm: float) -> float:
        return float(supported_modes(stiffness, share, rpm).frequencies[1] / (WAVES * rpm * RPM)) - 1

    return float(brentq(excess, SLOWEST, 100 * FASTEST, rtol=1e-12))


def antiresonance_speed() -> float:
    """Return the speed in rev/min at which housing and bearing of the scene absorb the discs' motion.

    There omega^2 = k/((1 - f) m), without damping: the housing's own frequency on the bearing.
    """
    values = nominal(SCENE)
    return math.sqrt(values["bearing_stiffness"] / values["housing_mass"]) / (WAVES * RPM)


def stiffness_for(rpm: float, share: float) -> float:
    """Return the bearing stiffness in N/m that makes the first mode resonate at `rpm` (rev/min).

    The film is the one of that speed. Raises InputError where no stiffness does: the resonance lies below
    that on rigid supports whatever the bearings are.
    """
    excited = WAVES * rpm * RPM

    def excess(log_stiffness: float) -> float:
        found = supported_modes(math.exp(log_stiffness), share, rpm)
        return float(found.frequencies[0]) / excited - 1

    ends = math.log(SOFTEST), math.log(STIFFEST)
    if not excess(ends[0]) < 0 < excess(ends[1]):
        low, high = (resonance_speed(math.exp(end), share) for end in ends)
        raise InputError(
            "resonance",
            f"is {rpm:g} rev/min, which no stiffness of the bearings gives",
            f"it must lie between {low:.6g} (bearings of {SOFTEST:g} N/m) and {high:.6g} (rigid)",
        )
    return math.exp(brentq(excess, *ends, xtol=1e-14, rtol=8.9e-16))


def contact_stiffness() -> float:
    """Return the linear stiffness n Q/delta0 of the dry Hertz contact under the preload, in N/m."""
    values = nominal(RIGID)
    return values["exponent"] * values["preload"] / static_deflection(values)


def with_leaf_springs(stiffness: float) -> float:
    """Return the speed in rev/min of the first resonance with leaf springs of `stiffness` (N/m) added."""
    return _met(system(SCENE, ("support.leaf", repr(stiffness)), ("support.damping", "0.0")), {})


def speeds(stiffnesses: np.ndarray, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the speeds of first and second resonance in rev/min at bearing stiffnesses (N/m)."""
    first = [resonance_speed(float(k), share) for k in stiffnesses]
    second = [second_speed(float(k), share) for k in stiffnesses]
    return np.array(first), np.array(second)
