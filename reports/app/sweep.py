"""What plain time integration finds: the parameter is changed step by step and the motion left to settle."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from symbolic import CompiledSystem
    from symbolic.arrays import Array
    from symbolic.integration.flow import Flow, Trajectory

log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Settled:
    """A parameter value and the extremes of the first output, a displacement (SI), over the last period.

    steady: whether the motion had settled by then.
    """

    parameter: float
    minimum: float
    maximum: float
    steady: bool


@dataclass(frozen=True, kw_only=True)
class SweepSettings:
    """Blocks of `block` periods are run until what the state still has to change by is less than `change`.

    That is estimated from how far the states at the ends of the periods lie apart, in this block and the one
    before.
    """

    tolerance: float = 1e-7
    block: int = 20
    change: float = 1e-4
    most_blocks: int = 40
    samples: int = 400


def sweep(
    system: CompiledSystem,
    parameter: str,
    values: Sequence[float],
    settings: SweepSettings | None = None,
    progress: Callable[[Settled], None] | None = None,
) -> list[Settled]:
    """Return what the motion settles to at each value in turn, starting from rest at the first.

    Each run starts where the one before it ended. Where the integrator fails the sweep ends early, and
    the log says so.
    """
    from symbolic.integration.cvodes import IntegrationError
    from symbolic.integration.flow import Flow
    from symbolic.motion.linear import modes
    from symbolic.system.compiled import with_values

    settings = settings or SweepSettings()
    rest = modes(system, {parameter: values[0]})
    flow, state, algebraic = Flow(system, settings.tolerance), rest.state, rest.algebraic
    settled: list[Settled] = []
    for value in values:
        try:
            last, steady = _settle(flow, state, algebraic, with_values(system, {parameter: value}), settings)
        except IntegrationError as error:
            log.warning("the sweep ends before %s = %g: %s", parameter, value, error)
            break
        state, algebraic = last.state[-1], last.algebraic[-1]
        low, high = _extremes(system, last, with_values(system, {parameter: value}))
        settled.append(Settled(parameter=value, minimum=low, maximum=high, steady=steady))
        if progress is not None:
            progress(settled[-1])
    return settled


def _extremes(system: CompiledSystem, motion: Trajectory, values: Array) -> tuple[float, float]:
    """Extremes of the first output, which depends on no rate."""
    still = np.zeros_like(motion.state)
    first = system.output(still, motion.state, motion.algebraic, motion.phase, values)[:, 0]
    return float(first.min()), float(first.max())


def _settle(
    flow: Flow, state: Array, algebraic: Array, values: Array, settings: SweepSettings
) -> tuple[Trajectory, bool]:
    """Run until the motion has settled; return one period more, and whether it has."""
    period = 2 * np.pi * np.array([0.0, 1.0])
    last, steady = np.inf, False
    for _ in range(settings.most_blocks):
        seen = [state]
        for _ in range(settings.block):
            end = flow.run(state, algebraic, values, period)
            state, algebraic = end.state[-1], end.algebraic[-1]
            seen.append(state)
        spread = float(np.ptp(seen, axis=0).max())
        # What falls from block to block by a ratio r has r / (1 - r) times as far to go.
        left = spread * max(1.0, spread / (last - spread)) if spread < last else np.inf
        if steady := left < settings.change:
            break
        last = spread
    return flow.run(state, algebraic, values, np.linspace(0, 2 * np.pi, settings.samples)), steady
