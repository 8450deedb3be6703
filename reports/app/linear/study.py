"""The linear study of a scene: rest, Jacobian, frequencies, damping, and the response over its range."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symbolic import CompiledSystem
from symbolic.motion.frequencyresponse import FrequencyResponse, peak, response
from symbolic.motion.linear import Modes, modes, resonance
from symbolic.scenes.building import build
from symbolic.scenes.schema import Scene

from ..request import Task
from ..view import View, view_of

Array = NDArray[np.float64]

EVEN = 401
"""Values at which the response is sampled evenly over the range."""

ABOUT = np.concatenate([-np.geomspace(60, 0.05, 60), [0.0], np.geomspace(0.05, 60, 60)])
"""Further values about the resonance, in half-widths of its peak."""

UNDAMPED = 1e-12
"""Damping ratio up to which the peak of the response has no height."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """What `orbitrace linear` finds; SI units. None where there is no resonance in the range.

    `modes` are those at the values `at`, `swings` the linear peak to peak of each output there. `peak` is
    where the response of the first output is largest near the resonance, and its peak to peak.
    """

    scene: Scene
    system: CompiledSystem
    at: tuple[float, ...]
    modes: tuple[Modes, ...]
    there: FrequencyResponse
    resonance: float | None
    peak: tuple[float, float] | None
    response: FrequencyResponse


def study(task: Task) -> Study:
    """Return the linear study of a scene, at the values asked for or else at the resonance.

    Where there is no resonance in the range either, at the range's first end. Raises
    `symbolic.NoRestError`.
    """
    view, system = view_of(task.scene), build(task.scene, condense=False)
    low, high = sorted(task.scene.trace.bounds)
    met = resonance(system, view.parameter, (low, high))
    default = task.scene.trace.bounds[0] if met is None else met
    at = tuple(value * view.unit for value in task.at) or (default,)
    ratio = modes(system, {view.parameter: met}).damping_ratios[0] if met is not None else math.nan
    return Study(
        scene=task.scene,
        system=system,
        at=at,
        modes=tuple(modes(system, {view.parameter: value}) for value in at),
        there=response(system, view.parameter, at),
        resonance=met,
        peak=_peak(system, view, met, ratio, (low, high)) if met is not None else None,
        response=response(system, view.parameter, _samples(low, high, met, ratio)),
    )


def _peak(
    system: CompiledSystem, view: View, met: float, ratio: float, bounds: tuple[float, float]
) -> tuple[float, float] | None:
    if not UNDAMPED < ratio < 1:
        return None
    width = min(3 * ratio, 0.9)
    about = max(bounds[0], met * (1 - width)), min(bounds[1], met * (1 + width))
    return peak(system, system.outputs[0].name, view.parameter, about)


def _samples(low: float, high: float, met: float | None, ratio: float) -> Array:
    values = np.linspace(low, high, EVEN)
    if met is not None:
        values = np.concatenate([values, met * (1 + max(ratio, UNDAMPED) * ABOUT)])
    return np.unique(values[(values >= low) & (values <= high)])
