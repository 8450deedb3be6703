"""What is measured: three speeds of the wavy disc, a Duffing oscillator, a chain of fifty."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

import periodic as per
import symbolic as sym
from periodic.correction.newton import correct
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Array
from reports.benchmarks.work import chain_model
from symbolic.integration.flow import Flow
from symbolic.scenes.axes import RPM
from symbolic.scenes.building import build, disc_model
from symbolic.scenes.reading import load
from symbolic.scenes.schema import DiscScene
from symbolic.system.compiled import with_values

DISC = "vitrea79-810N"

NEARBY = 1.005
"""Where the orbit lies that every method starts from, in units of the parameter."""

SETTLING, SAMPLES = 300, 200
"""Periods that a motion is left to settle, and samples of the last."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """One orbit of a system, at `value` of `parameter`, and its branch between `bounds` (SI).

    explicit: the same system without algebraic unknowns, for explicit steps. begin: from where the first
    sheet of the branch leads to the neighbouring orbit; None: what the motion settles to from rest is one.
    start: where the branch begins, folds: how many end it (None: the other bound does).
    """

    name: str
    system: sym.CompiledSystem
    explicit: sym.CompiledSystem
    parameter: str
    value: float
    bounds: tuple[float, float]
    begin: float | None
    start: float
    folds: int | None = None

    @property
    def values(self) -> Array:
        """The parameters of the orbit, shape (p,)."""
        return with_values(self.system, {self.parameter: self.value})

    @property
    def explicit_values(self) -> Array:
        """Those of the explicit form, shape (p,)."""
        return with_values(self.explicit, {self.parameter: self.value})

    @property
    def index(self) -> int:
        """Index of the parameter."""
        return [p.name for p in self.system.parameters].index(self.parameter)


@cache
def disc(rpm: float) -> Problem:
    """Return the wavy disc at a speed in rev/min."""
    return Problem(
        name=f"disc at {rpm:g} rev/min",
        system=_disc(),
        explicit=_explicit_disc(),
        parameter="speed",
        value=rpm * RPM,
        bounds=(100 * RPM, 500 * RPM),
        begin=500 * RPM,
        start=500 * RPM,
    )


@cache
def _disc() -> sym.CompiledSystem:
    return build(load(DISC))


@cache
def _explicit_disc() -> sym.CompiledSystem:
    """The disc with the film's rate in place of its equation: three states and no unknown."""
    scene = load(DISC)
    assert isinstance(scene, DiscScene)
    return sym.compile(sym.combine(_without_unknown(part) for part in disc_model(scene).parts))


def _without_unknown(part: sym.Part) -> sym.Part:
    if isinstance(part, sym.SqueezeFilm):
        return sym.films.ExplicitSqueezeFilm(
            part.pair, part.law, part.speed, part.radius, part.beta, part.squeeze
        )
    return part


@cache
def duffing() -> Problem:
    """Return Duffing A, x'' + 0.1 x' + x + x^3 = 0.5 cos Omega t, at Omega = 1.8 on the upper sheet."""
    system = build(load("duffing"))
    return Problem(
        name="Duffing A",
        system=system,
        explicit=system,
        parameter="Omega",
        value=1.8,
        bounds=(0.3, 3.0),
        begin=0.3,
        start=0.3,
    )


@cache
def chain(count: int = 50) -> Problem:
    """Return a chain of oscillators, forced at its first, at Omega = 1.1, before its folds."""
    system = sym.compile(chain_model(count))
    return Problem(
        name=f"chain of {count}",
        system=system,
        explicit=system,
        parameter="Omega",
        value=1.1,
        bounds=(1.1, 1.6),
        begin=None,
        start=1.6,
        folds=2,
    )


@cache
def nearby(problem: Problem) -> per.Orbit:
    """Return the orbit at NEARBY times the value. Raises ArithmeticError where it is not found."""
    value = NEARBY * problem.value
    if problem.begin is None:
        return settled(problem, value)
    bounds = (min(problem.begin, value), max(problem.begin, value))
    branch = per.trace(problem.system, problem.parameter, bounds, start=problem.begin)
    if branch.stop.reason is not per.Reason.BOUND:
        raise ArithmeticError(f"{problem.name} was not reached: {branch.stop}")
    return branch[-1].orbit


@cache
def settled(problem: Problem, value: float) -> per.Orbit:
    """Return the orbit that the motion settles to from rest. Raises ArithmeticError if there is none."""
    system, parameter = problem.system, with_values(problem.system, {problem.parameter: value})
    state, unknown = system.rest(parameter)
    flow, phase = Flow(system, 1e-6), 2 * np.pi * np.arange(SETTLING + 1.0)
    path = flow.run(state, unknown, parameter, phase)
    last = flow.run(
        path.state[-1], path.algebraic[-1], parameter, 2 * np.pi * np.arange(SAMPLES + 1.0) / SAMPLES
    )
    guess = per.sampled(last.phase, last.state, last.algebraic, parameter)
    mesh = uniform(per.Scheme(per.Family.GAUSS, 5), 16)
    found = correct(per.Collocation().linearise, system, transfer(guess, mesh, guess.phases))
    if not found.ok:
        raise ArithmeticError(f"{problem.name} was not reached: {found.outcome.value}")
    return found.orbit
