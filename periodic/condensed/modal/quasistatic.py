"""Modal reduction: fast modes that contribute too little are replaced by their quasi-static response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from periodic.condensed.modal.moments import Complex
from periodic.orbit.scheme import Array
from periodic.system import ModesLike

SLOW = 20.0
"""|exponent| (per rad) below which no mode is left out."""

SHARE = 0.1
"""Part of the tolerance that all modes left out may contribute."""


@dataclass(frozen=True)
class Modes:
    """See `periodic.system.ModesLike`."""

    exponents: Complex
    inputs: Complex
    outputs: Complex
    direct: Array
    direct_rate: Array


def retained_modes(modes: ModesLike, deciding: list[int], period: float, tolerance: float) -> np.ndarray:
    """Return which modes are integrated, (J,), by their contribution to the outputs `deciding` (or all)."""
    exponents = modes.exponents
    with np.errstate(all="ignore"):
        resonance = np.maximum(1.0, np.abs(1 / np.expm1(exponents * period)))
    strength = (
        np.abs(modes.outputs[deciding or slice(None)]).max(axis=0)
        * np.abs(modes.inputs).max(axis=1)
        / np.abs(exponents)
    )
    weight = strength * resonance
    order = np.argsort(weight)
    negligible = np.cumsum(weight[order]) <= SHARE * tolerance * strength.sum()
    kept = np.ones(len(exponents), dtype=bool)
    kept[order[negligible]] = False
    return kept | (np.abs(exponents) < SLOW)


def reduced(modes: ModesLike, kept: np.ndarray) -> ModesLike:
    """Return the modes kept; the others are replaced by z = -B (f/lambda + f'/lambda^2), B their inputs."""
    if kept.all():
        return modes
    left = ~kept
    inputs = modes.inputs[left] / modes.exponents[left, None]
    direct = -(modes.outputs[:, left] @ inputs).real
    rate = -(modes.outputs[:, left] @ (inputs / modes.exponents[left, None])).real
    return Modes(
        modes.exponents[kept],
        modes.inputs[kept],
        modes.outputs[:, kept],
        modes.direct + direct,
        modes.direct_rate + rate,
    )


def reduced_slope(modes: ModesLike, slope: ModesLike | None, kept: np.ndarray) -> ModesLike | None:
    """Return the derivative of `reduced`: of the modes kept, and of the flexibility of the others."""
    if slope is None or kept.all():
        return slope
    left = ~kept
    value, out = modes.exponents[left, None], modes.outputs[:, left]
    inputs, changed, faster = modes.inputs[left], slope.inputs[left], slope.exponents[left, None]
    outputs_slope = slope.outputs[:, left]
    direct = -(outputs_slope @ (inputs / value) + out @ (changed / value - inputs * faster / value**2)).real
    rate = -(
        outputs_slope @ (inputs / value**2) + out @ (changed / value**2 - 2 * inputs * faster / value**3)
    ).real
    return Modes(
        slope.exponents[kept],
        slope.inputs[kept],
        slope.outputs[:, kept],
        slope.direct + direct,
        slope.direct_rate + rate,
    )
