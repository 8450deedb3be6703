"""Damped Newton on the equations of an orbit, those of collocation by default, and their closures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from periodic import bordered, collocation
from periodic.closure import Closure, Direction, Event, node_phase_gradient
from periodic.orbit import Orbit
from periodic.scheme import Array
from periodic.system import System

Condense = Callable[[System, Orbit, tuple[int, ...]], bordered.Condensed]
"""Linearises the equations at an orbit, free parameters included, and eliminates what is local."""

MAX_CHANGE = 2.0
"""Largest relative change in one iteration; longer Newton steps are cut to it."""


SHORT = 1e-3
"""Width (rad) of intervals below which their unknowns count less in damping."""


NEGLIGIBLE = 1e-3
"""Change of the scaled states that a parameter about zero is compared with."""

TINY = 1e-3
"""Nominal value that a parameter of 0 is given for this."""


class Outcome(Enum):
    """How a Newton iteration ended; the value says it in words."""

    CONVERGED = "converged"
    TOO_MANY = "Newton did not converge within its iterations"
    NOT_FINITE = "the equations were not finite near the iterate"
    SINGULAR = "the linear system was singular"
    NOT_INTEGRATED = "time integration failed near the iterate"
    ANCHORS_CROSSED = "two anchors of the mesh met"
    COLLAPSED = "the orbit shrank to an equilibrium"
    MOVED = "the orbit became another one on a new mesh"


@dataclass(frozen=True, kw_only=True)
class NewtonSettings:
    """tolerance: largest relative increment of the last step, which is still taken.

    close: increment, in tolerances, up to which a linearisation has the multipliers and the tangent of the
    orbit that it leads to; they take another one else.
    """

    tolerance: float = 1e-8
    close: float = 1e-4
    max_iterations: int = 12
    max_halvings: int = 6

    def __post_init__(self) -> None:
        if not 0 < self.tolerance < 1:
            raise ValueError(f"Newton tolerance is {self.tolerance}; it must lie between 0 and 1")
        if not 0 <= self.close <= 1:
            raise ValueError(f"close is {self.close}; it must lie from 0 to 1")
        if self.max_iterations < 1:
            raise ValueError(f"max_iterations is {self.max_iterations}; it must be at least 1")


@dataclass(frozen=True)
class Correction:
    """Result of a Newton iteration: the last orbit, how it ended, and what the last linearisation gave.

    fundamental: fundamental matrices at the mesh points, shape (N+1, n, n). unit: how many multipliers are 1
    whatever the parameters.
    """

    orbit: Orbit
    outcome: Outcome
    iterations: int
    increment: float
    residual: float
    fundamental: Array
    kernel: Direction | None
    unit: int = 0

    @property
    def monodromy(self) -> Array:
        """The monodromy matrix, shape (n, n)."""
        return self.fundamental[-1]


@dataclass(frozen=True)
class Step:
    """One Newton increment from `orbit`, with the kernel direction of the same linearisation."""

    orbit: Orbit
    nodes: Array
    stages: Array
    algebraic: Array
    outer: Array
    size: float
    length: float
    residual: float
    fundamental: Array
    kernel: Direction | None


LinearStep = Callable[[System, Orbit, tuple[int, ...], Sequence[Closure]], Step | Outcome]
"""What linearises the equations at an orbit: one Newton increment, or why there is none."""


def correct(
    system: System,
    guess: Orbit,
    free: tuple[int, ...] = (),
    closures: Sequence[Closure] = (),
    settings: NewtonSettings | None = None,
    increment: LinearStep | None = None,
) -> Correction:
    """Solve for the orbit near `guess`, with the parameters `free` closed by as many closures.

    `increment` linearises the equations (default: those of collocation). The outcome is on the result;
    nothing is raised for a numerical failure.
    """
    settings, increment = settings or NewtonSettings(), increment or linear_step
    orbit, outcome, step, iterations = guess, Outcome.TOO_MANY, None, 0
    base: Step | None = None
    factor = 1.0
    while iterations < settings.max_iterations:
        iterations += 1
        trial = increment(system, orbit, free, closures)
        worse = isinstance(trial, Outcome) or (base is not None and trial.length > 2 * base.length)
        if worse and base is not None and factor > 0.5**settings.max_halvings:
            factor /= 4
            orbit = advance(system, base, free, factor)
            continue
        if isinstance(trial, Outcome):
            outcome = trial
            break
        step = base = trial
        factor = min(1.0, MAX_CHANGE / max(step.length, np.finfo(float).tiny))
        orbit = advance(system, step, free, factor)
        if step.size < settings.tolerance:
            outcome = Outcome.CONVERGED
            break
    if outcome is Outcome.CONVERGED and (orbit.mesh.segment_lengths(orbit.phases) <= 0).any():
        outcome = Outcome.ANCHORS_CROSSED
    if step is None:
        n = orbit.nodes.shape[1]
        empty = np.full((1, n, n), np.nan)
        return Correction(orbit, outcome, iterations, np.inf, np.inf, empty, None)
    if outcome is Outcome.CONVERGED and step.length > settings.close * settings.tolerance:
        last = increment(system, orbit, free, closures)
        if isinstance(last, Outcome):
            outcome = last
        else:
            orbit, step = last.orbit, replace(last, size=step.size)
    return Correction(orbit, outcome, iterations, step.size, step.residual, step.fundamental, step.kernel)


def linear_step(
    system: System,
    orbit: Orbit,
    free: tuple[int, ...],
    closures: Sequence[Closure],
    condense: Condense = collocation.condense,
) -> Step | Outcome:
    """Return one Newton increment, or why there is none."""
    if (orbit.mesh.segment_lengths(orbit.phases) <= 0).any():
        return Outcome.ANCHORS_CROSSED
    events = [Event(i) for i in range(len(orbit.phases))]
    try:
        condensed = condense(system, orbit, free)
        orbit = condensed.orbit
        every = (c.linearise(system, orbit, free) for c in (*events, *closures))
        rows = [condensed.reduced(row) for row in every]
        gap = orbit.nodes[-1] - orbit.nodes[0]
        solution = bordered.solve(condensed, gap, rows, with_kernel=bool(closures))
    except FloatingPointError:
        return Outcome.NOT_FINITE
    except ArithmeticError:
        return Outcome.NOT_INTEGRATED
    except np.linalg.LinAlgError:
        return Outcome.SINGULAR
    stages, algebraic = condensed.recover(solution.nodes, solution.outer, 1.0)
    change = moved(system, orbit.algebraic, algebraic) - orbit.algebraic
    effect = _effect(condensed)
    moves = (solution.nodes, stages, change, solution.outer)
    size, length = sizes(orbit, *moves, free, effect, system.nominal)
    kernel = _direction(condensed, solution) if closures else None
    return Step(
        orbit,
        solution.nodes,
        stages,
        algebraic,
        solution.outer,
        size,
        length,
        condensed.residual,
        solution.fundamental,
        kernel,
    )


def sizes(
    orbit: Orbit,
    nodes: Array,
    stages: Array,
    algebraic: Array,
    outer: Array,
    free: tuple[int, ...],
    effect: Array,
    nominal: Array,
) -> tuple[float, float]:
    """Largest relative increment, for the convergence test and for damping.

    States count relative to the largest peak to peak where that exceeds 1. For convergence the unknowns
    count with their square: that is what the last step leaves of them, and rounding in the rates of very
    short intervals keeps their own increments from falling further. For damping they count the less in short
    intervals, over whose width they hardly act on the states. Free parameters count relative to their values,
    or where these are about zero to what changes the states by
    NEGLIGIBLE, at most the `nominal` value; effect (q,) is the states' change with each of y.
    """
    k = len(orbit.phases)
    large = max(1.0, orbit.span())
    sizes = [np.abs(nodes).max() / large, np.abs(stages).max() / large, np.abs(outer[:k]).max(initial=0.0)]
    chosen = list(free)
    least = np.minimum(NEGLIGIBLE / np.maximum(effect[k:], 1e-300), np.maximum(np.abs(nominal[chosen]), TINY))
    sizes += list(np.abs(outer[k:]) / np.maximum(np.abs(orbit.parameter[chosen]), least))
    regular = float(max(sizes))
    unknowns = (np.abs(algebraic) / (1 + np.abs(orbit.algebraic))).max(axis=(1, 2), initial=0.0)
    width = orbit.grid.width
    left = float(unknowns.max()) ** 2
    change = float((np.minimum(1.0, width / SHORT) * unknowns).max())
    if not np.isfinite(regular + left + change):
        return np.inf, np.inf
    return max(regular, left), max(regular, change)


def _effect(condensed: bordered.Condensed) -> Array:
    """How much the states change with each of y over a period, about; shape (q,)."""
    n = condensed.step.shape[1]
    intervals = np.count_nonzero(np.bincount(condensed.origin))
    return intervals * np.abs(condensed.step[:, :, 1 + n :]).max(axis=(0, 1), initial=0.0)


def moved(system: System, algebraic: Array, increment: Array) -> Array:
    """Return unknowns of shape (N, ncol, m) after an increment."""
    flat = (algebraic.shape[0] * algebraic.shape[1], algebraic.shape[2])
    if algebraic.shape[2] == 0:
        return algebraic
    return system.move(algebraic.reshape(flat), increment.reshape(flat)).reshape(algebraic.shape)


def advance(system: System, step: Step, free: tuple[int, ...], factor: float) -> Orbit:
    """Return the orbit after a part of a Newton increment."""
    orbit, k = step.orbit, len(step.orbit.phases)
    parameter = orbit.parameter.copy()
    parameter[list(free)] += factor * step.outer[k:]
    return replace(
        orbit,
        nodes=orbit.nodes + factor * step.nodes,
        stages=orbit.stages + factor * step.stages,
        algebraic=moved(system, orbit.algebraic, factor * step.algebraic),
        phases=orbit.phases + factor * step.outer[:k],
        parameter=parameter,
    )


def _direction(condensed: bordered.Condensed, solution: bordered.BorderedSolution) -> Direction:
    """The kernel direction with stages and unknowns recovered; not yet of unit length."""
    assert solution.kernel_nodes is not None and solution.kernel_outer is not None
    orbit, k = condensed.orbit, len(condensed.orbit.phases)
    nodes, outer = solution.kernel_nodes, solution.kernel_outer
    stages, algebraic = condensed.recover(nodes, outer, 0.0)
    profile = at_fixed_phase(orbit, nodes, outer[:k])
    return Direction(nodes, stages, algebraic, outer[:k], profile, float(outer[k]), outer[k + 1 :])


def at_fixed_phase(orbit: Orbit, nodes: Array, phases: Array) -> Array:
    """Turn increments of mesh-point states that move with the mesh into increments at fixed tau."""
    return nodes - orbit.node_rates * (node_phase_gradient(orbit) @ phases)[:, None]
