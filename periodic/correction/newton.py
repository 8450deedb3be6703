"""Damped Newton on the equations of an orbit and its side conditions, whatever the discretisation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from periodic.checks import between, number, positive, whole
from periodic.correction.condition import SideCondition
from periodic.correction.outcome import FAILURES, Outcome, outcome_of
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import System

Linearise = Callable[[System, Orbit, tuple[int, ...]], Operator]
"""Linearises the equations at an orbit, in its unknowns and some free parameters; raises FAILURES."""


@dataclass(frozen=True, kw_only=True)
class NewtonSettings:
    """When Newton's iteration is converged, and how it is damped.

    Parameters
    ----------
    tolerance : float
        Largest relative increment of the last step, which is still taken.
    close : float
        Last increment, in tolerances, up to which its linearisation also gives multipliers and tangent of the
        orbit; beyond it the equations are linearised again at the orbit.
    max_iterations, max_halvings : int
        Bounds on iterations, and on how often a step that makes things worse is cut (to a quarter each time).
    max_change : float
        Largest relative change in one iteration; longer steps are cut to it.
    short : float
        Width (rad) of intervals below which their unknowns count less in damping.
    negligible : float
        Change of the scaled states that sets the scale of a parameter about zero.
    tiny : float
        Least nominal value of a parameter in this comparison.
    """

    tolerance: float = 1e-8
    close: float = 1e-4
    max_iterations: int = 12
    max_halvings: int = 6
    max_change: float = 2.0
    short: float = 1e-3
    negligible: float = 1e-3
    tiny: float = 1e-3

    def __post_init__(self) -> None:
        between("Newton tolerance", self.tolerance, 0, 1)
        if not 0 <= number("close", self.close) <= 1:
            raise ValueError(f"close is {self.close}; it must lie from 0 to 1")
        whole("max_iterations", self.max_iterations)
        whole("max_halvings", self.max_halvings, 0)
        for name in ("max_change", "short", "negligible", "tiny"):
            positive(name, getattr(self, name))

    @cached_property
    def closest(self) -> NewtonSettings:
        """The settings with which equations are always linearised again at the converged orbit."""
        return replace(self, close=0.0)


USUAL = NewtonSettings()
"""Default settings, also those of single steps."""


@dataclass(frozen=True)
class Correction:
    """Result of a Newton iteration: the last orbit, how it ended, and what the last linearisation gave.

    Parameters
    ----------
    orbit : Orbit
        The last orbit.
    outcome : Outcome
        How the iteration ended.
    iterations : int
        How many there were.
    increment : float
        Size of the last increment, relative.
    residual : float
        The largest residual of the last linearisation.
    fundamental : ndarray, shape (N+1, n, n)
        Fundamental matrices at the mesh points.
    kernel : Increment or None
        The tangent of the branch, of any length; None where no side condition closes the equations.
    operator : Operator, optional
        The last linearisation.
    gentle : bool
        Whether it is known that perturbations do not grow fast within an interval.
    """

    orbit: Orbit
    outcome: Outcome
    iterations: int
    increment: float
    residual: float
    fundamental: Array
    kernel: Increment | None
    operator: Operator | None = field(default=None, repr=False, compare=False)
    gentle: bool = field(default=False, repr=False, compare=False)

    @property
    def ok(self) -> bool:
        """Whether it converged."""
        return self.outcome is Outcome.CONVERGED

    @property
    def monodromy(self) -> Array:
        """The monodromy matrix, shape (n, n)."""
        return self.fundamental[-1]


@dataclass(frozen=True)
class Way:
    """One Newton increment from an orbit, with the kernel of the same linearisation.

    residual is the largest one at that orbit, size the largest relative increment for the convergence test,
    length that for damping, and stretch the largest change of the distance between two event nodes, relative
    to it where that is less than 1 rad. depth estimates the change of such a length, relative, due to the
    states' increment: beside a grazing the square of a contact's length changes in proportion to them.
    """

    orbit: Orbit
    residual: float
    increment: Increment
    kernel: Increment | None
    size: float
    length: float
    stretch: float
    depth: float

    @property
    def unknown(self) -> float:
        """Relative error that lengths of contacts may have."""
        return max(self.stretch, self.depth)


@dataclass(frozen=True)
class Step(Way):
    """A `Way` with the linearised equations, which take much memory where systems are large."""

    operator: Operator

    @property
    def way(self) -> Way:
        """The step without its linearised equations."""
        known = (self.orbit, self.residual, self.increment, self.kernel)
        return Way(*known, self.size, self.length, self.stretch, self.depth)


def correct(
    linearise: Linearise,
    system: System,
    guess: Orbit,
    free: tuple[int, ...] = (),
    conditions: Sequence[SideCondition] = (),
    settings: NewtonSettings | None = None,
) -> Correction:
    """Solve for the orbit near `guess`, with the parameters `free` closed by as many side conditions.

    The outcome is on the result; nothing is raised for a numerical failure.
    """
    equations = Equations(linearise, system, free, conditions, settings or USUAL)
    found = equations.iterated(guess)
    orbit, outcome, last = found.orbit, found.outcome, found.last
    n = orbit.nodes.shape[1]
    nothing = np.full((1, n, n), np.nan)
    if last is None:
        return Correction(orbit, outcome, found.iterations, np.inf, np.inf, nothing, None)
    size, fundamental, operator = last.size, nothing, None
    if outcome is Outcome.CONVERGED:
        try:
            orbit, last, operator = equations.closer(orbit, last, found.operator)
            fundamental = operator.fundamental
        except FAILURES as error:
            outcome = outcome_of(error)
    ended = (outcome, found.iterations, size, last.residual, fundamental, last.kernel, operator)
    return Correction(orbit, *ended)


@dataclass(frozen=True)
class _Iterated:
    """The last iterate, how the iteration ended, the last step taken, and its equations if they will do."""

    orbit: Orbit
    outcome: Outcome
    iterations: int
    last: Way | None
    operator: Operator | None = None


@dataclass(frozen=True)
class Equations:
    """The equations of orbits, as many conditions as free parameters, and how they are solved."""

    linearise: Linearise
    system: System
    free: tuple[int, ...] = ()
    conditions: Sequence[SideCondition] = ()
    settings: NewtonSettings = USUAL

    def step(self, orbit: Orbit) -> Step:
        """Return one Newton increment from an orbit. Raises FAILURES."""
        operator = self.linearise(self.system, orbit, self.free)
        orbit = operator.orbit
        rows = [condition.linearise(self.system, orbit, self.free) for condition in self.conditions]
        right = np.eye(1 + len(rows))[:, [0, -1]] if rows else np.ones((1, 1))
        found = operator.solve(rows, right)
        size, length = self._sizes(operator, found[0])
        kernel, stretch = found[1] if rows else None, stretched(orbit, found[0])
        depth = size / briefest(orbit) ** 2 if orbit.mesh.events else 0.0
        size = max(size, stretch**2)
        return Step(orbit, operator.residual, found[0], kernel, size, length, stretch, depth, operator)

    def solved(self, orbit: Orbit) -> LinearisedEquations:
        """Return the equations linearised at an orbit, and solved. Raises FAILURES."""
        step = self.step(orbit)
        kernel = step.increment.scaled(0.0) if step.kernel is None else step.kernel
        operator = step.operator
        return LinearisedEquations(operator.orbit, step.increment, kernel, operator.fundamental, operator)

    def iterated(self, guess: Orbit) -> _Iterated:
        """Iterate until an increment is small, in steps that are cut where they make things worse."""
        orbit, factor, settings = guess, 1.0, self.settings
        last: Way | None = None
        failure = Outcome.TOO_MANY
        for iteration in range(1, settings.max_iterations + 1):
            trial: Step | None = None  # frees the last equations before the next are set up
            try:
                trial = self.step(orbit)
            except FAILURES as error:
                failure = outcome_of(error)
            worse = last is not None and (trial is None or trial.length > 2 * last.length)
            if worse and last is not None and factor > 0.5**settings.max_halvings:
                factor /= 4
                orbit = self._moved(last, factor)
                continue
            if trial is None:
                return _Iterated(orbit, failure, iteration, last)
            last, factor = trial.way, settings.max_change / max(trial.length, settings.max_change)
            orbit = self._moved(last, factor)
            if last.size < settings.tolerance:
                outcome = Outcome.CONVERGED if in_order(orbit) else Outcome.EVENTS_CROSSED
                close = max(last.length, last.unknown) <= settings.close * settings.tolerance
                return _Iterated(orbit, outcome, iteration, last, trial.operator if close else None)
        return _Iterated(orbit, Outcome.TOO_MANY, settings.max_iterations, last)

    def closer(self, orbit: Orbit, last: Way, operator: Operator | None) -> tuple[Orbit, Way, Operator]:
        """Return the linearisation at an orbit, or the one that led to it, `operator`, if it is given.

        Newton's iteration goes on where a contact is so short that its length is not known well enough.
        """
        if operator is not None:
            return orbit, last, operator
        close = self.settings.close * self.settings.tolerance
        step = self.step(orbit)
        while close < step.unknown < last.unknown / 4:
            last, step = step.way, self.step(self._moved(step, 1.0))
        return step.orbit, step.way, step.operator

    def _sizes(self, operator: Operator, increment: Increment) -> tuple[float, float]:
        """Largest relative increment, for the convergence test and for damping.

        States count relative to the largest peak to peak where that exceeds 1. For convergence the unknowns
        count with their square: that is what the last step leaves of them, and rounding in the rates of very
        short intervals keeps their own increments from falling further. For damping they count the less in
        short intervals, over whose width they hardly act on the states. Free parameters count relative to
        their values, or where these are about zero to what changes the states by `negligible`, at most the
        nominal value.
        """
        orbit, chosen = operator.orbit, list(self.free)
        large = max(1.0, orbit.span())
        parts = [np.abs(increment.nodes).max() / large, np.abs(increment.stages).max() / large]
        parts.append(np.abs(increment.phases).max(initial=0.0))
        nominal = np.maximum(np.abs(self.system.nominal[chosen]), self.settings.tiny)
        compared = np.abs(orbit.parameter[chosen])
        if (compared < nominal).any():
            least = np.minimum(self.settings.negligible / np.maximum(operator.effect, 1e-300), nominal)
            compared = np.maximum(compared, least)
        parts += list(np.abs(increment.parameters) / compared)
        regular = float(np.max(parts))  # NaN wherever it is
        change = moved_unknowns(self.system, orbit.algebraic, increment.algebraic) - orbit.algebraic
        unknowns = (np.abs(change) / (1 + np.abs(orbit.algebraic))).max(axis=(1, 2), initial=0.0)
        left = float(unknowns.max()) ** 2
        weighted = float((np.minimum(1.0, orbit.grid.width / self.settings.short) * unknowns).max())
        if not np.isfinite(regular + left + weighted):
            return np.inf, np.inf
        return max(regular, left), max(regular, weighted)

    def _moved(self, way: Way, factor: float) -> Orbit:
        return moved(self.system, self.free, way.orbit, way.increment, factor)


def stretched(orbit: Orbit, increment: Increment) -> float:
    """Return the largest change of a segment's length, relative to it where it is less than 1 rad.

    Multipliers depend on a contact's length. For convergence the change counts squared, as the error left.
    """
    if len(increment.phases) == 0:
        return 0.0
    change = np.diff(np.append(increment.phases, increment.phases[0]))
    return float(np.abs(change / np.minimum(orbit.mesh.segment_lengths(orbit.phases), 1.0)).max())


def briefest(orbit: Orbit) -> float:
    """Return the least distance between two event nodes, at most 1 rad."""
    return min(1.0, float(np.abs(orbit.mesh.segment_lengths(orbit.phases)).min()))


@dataclass(frozen=True)
class LinearisedEquations:
    """The equations at an orbit: Newton increment from there, kernel, fundamental matrices (N+1, n, n).

    operator: the equations themselves, where they are kept.
    """

    orbit: Orbit
    increment: Increment
    kernel: Increment
    fundamental: Array
    operator: Operator | None = field(default=None, repr=False, compare=False)


def in_order(orbit: Orbit) -> bool:
    """Whether the event nodes of an orbit's mesh follow each other."""
    return bool((orbit.mesh.segment_lengths(orbit.phases) > 0).all())


def moved_unknowns(system: System, algebraic: Array, increment: Array) -> Array:
    """Return unknowns of shape (N, ncol, m) after an increment."""
    flat = (algebraic.shape[0] * algebraic.shape[1], algebraic.shape[2])
    if algebraic.shape[2] == 0:
        return algebraic
    return system.move(algebraic.reshape(flat), increment.reshape(flat)).reshape(algebraic.shape)


def moved(
    system: System, free: tuple[int, ...], orbit: Orbit, increment: Increment, factor: float = 1.0
) -> Orbit:
    """Return an orbit and its free parameters after a part of an increment."""
    parameter = orbit.parameter.copy()
    parameter[list(free)] += factor * increment.parameters
    return replace(
        orbit,
        nodes=orbit.nodes + factor * increment.nodes,
        stages=orbit.stages + factor * increment.stages,
        algebraic=moved_unknowns(system, orbit.algebraic, factor * increment.algebraic),
        phases=orbit.phases + factor * increment.phases,
        parameter=parameter,
    )
