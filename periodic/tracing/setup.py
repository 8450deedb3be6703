"""From the user's arguments to runs that can be started: all are checked before any work is done."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from periodic.checks import named, number
from periodic.collocation.collocation import Collocation
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.correction.solver import Solver, Work
from periodic.correction.tolerance import Tolerance
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.results.frames import reserved
from periodic.system import System, check_value, index_of
from periodic.tracing.continuation import Continuation
from periodic.tracing.methodchoice import chosen_method
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.watch import Watch


@dataclass(frozen=True, kw_only=True)
class Method:
    """How a problem is solved: discretisation, tolerance, step control, and what is watched on the way."""

    discretisation: Discretisation
    tolerance: Tolerance
    control: ArclengthControl
    watch: Watch

    @classmethod
    def of(
        cls,
        problem: Problem,
        tol: float | Tolerance,
        discretisation: Discretisation | None,
        control: ArclengthControl | None,
        watch: Watch | None,
    ) -> tuple[Problem, Method]:
        """Return the problem and the method, with defaults, made for each other and for the tolerance.

        The problem's system is condensed where that pays. Raises ValueError for arguments of other types.
        """
        if discretisation is not None and (
            isinstance(discretisation, type) or not isinstance(discretisation, Discretisation)
        ):
            raise ValueError(
                f"method is {discretisation!r}; it must be Collocation(), Shooting(), HarmonicBalance() or "
                f"Equilibrium()"
            )
        for name, given, kind in (("control", control, ArclengthControl), ("watch", watch, Watch)):
            if given is not None and not isinstance(given, kind):
                raise ValueError(f"{name} is {given!r}; it must be {kind.__name__}(...)")
        tolerance = Tolerance.of(tol)
        problem, chosen = chosen_method(discretisation or Collocation(), problem)
        return problem, cls(
            discretisation=chosen.at(tolerance.orbit),
            tolerance=tolerance,
            control=control or ArclengthControl(),
            watch=watch or Watch(),
        )


@dataclass(frozen=True, kw_only=True)
class Setup:
    """Runs from one start: the problem and the method, the guess and its parameters, the user's values."""

    problem: Problem
    method: Method
    guess: Orbit | None
    parameter: Array
    user: tuple[float, ...]
    search: bool
    work: Work = field(default_factory=Work)

    @property
    def begin(self) -> float:
        """Where the branch starts."""
        return float(self.parameter[self.problem.index])

    @property
    def signs(self) -> list[int]:
        """The ways that lead from the start into the bounds."""
        ends = ((-1, self.problem.low), (1, self.problem.high))
        return [sign for sign, end in ends if self.begin != end]

    def first(self) -> Orbit:
        """Return the first guess in the method's representation: at rest, or the one given."""
        system, discretisation = self.problem.system, self.method.discretisation
        return discretisation.guess(system, self.parameter, self.guess)

    def run(self, start: Orbit, sign: int) -> Continuation:
        """Return a continuation from a start one way."""
        method = self.method
        solver = Solver(self.problem, method.discretisation, method.tolerance, self.work)
        return Continuation(solver, start, sign, method.control, method.watch, self.user, self.search)


def setup(
    problem: Problem,
    method: Method,
    *,
    start: float | None,
    at: float | Sequence[float],
    guess: Orbit | None,
    values: Mapping[str, float] | None,
) -> Setup:
    """Return the setup of the runs from one start.

    `start` is the parameter there, by default the guess's, else the problem's. Raises ValueError, in one
    sentence, for arguments that are not allowed.
    """
    system, parameter, low, high = problem.system, problem.parameter, problem.low, problem.high
    if low < 0 and parameter in layout_of(system).frequency:
        raise ValueError(f"bounds is ({low:g}, {high:g}); {parameter!r}, a frequency, must not be negative")
    for end in (low, high):
        _check_bound(system, parameter, end)
    method.discretisation.check(problem)
    named("values", {} if values is None else values, "numbers")
    for name in set(method.watch.columns) & reserved(layout_of(problem.full)):
        raise ValueError(f"columns has {name!r}, which branches have already; it must be another name")
    if values and parameter in values:
        raise ValueError(f"values has {parameter!r}, which is continued in; give it as start")
    if guess is not None:
        guess = problem.restrict(_expressed(problem.full, guess))
        for name in set(problem.determined) & set(values or {}):
            raise ValueError(f"determined has {name!r}, which is also in values; it must be one or the other")
    base = np.array(system.nominal if guess is None else guess.parameter, dtype=float)
    own = problem.begin if guess is None else float(base[problem.index])
    begin = number("start", own if start is None else start)
    if not low <= begin <= high:
        raise ValueError(f"start is {begin}; it must lie within the bounds {low} to {high}")
    places = np.atleast_1d(np.array(at, dtype=object))
    user = tuple(sorted({number("at", value) for value in places}))
    for value in user:
        if not low <= value <= high:
            raise ValueError(f"at is {value}; it must lie within the bounds {low} to {high}")
    first = _parameters(system, base, {**(values or {}), parameter: begin})
    if guess is not None:
        first[list(problem.others)] = guess.parameter[list(problem.others)]
    for condition in problem.conditions:
        if hasattr(condition, "check"):
            condition.check(system, first)
    work = Work(method.control.max_newton)
    return Setup(
        problem=problem.begun_at(first),
        method=method,
        guess=guess,
        parameter=first,
        user=user,
        search=guess is None,
        work=work,
    )


def _check_bound(system: System, parameter: str, end: float) -> None:
    try:
        check_value(system.parameters[index_of(system, parameter)], end)
    except ValueError as error:
        raise ValueError(f"bound of {error}") from None


def _expressed(system: System, guess: Orbit) -> Orbit:
    """The guess in the system's scales."""
    if not isinstance(guess, Orbit):
        raise ValueError(f"guess is a {type(guess).__name__}; it must be an Orbit, as point.orbit is")
    guess = guess.expressed_in(layout_of(system), "guess")
    if not all(np.isfinite(a).all() for a in (guess.nodes, guess.stages, guess.algebraic, guess.parameter)):
        raise ValueError("guess has values that are not finite; all of its numbers must be")
    return guess


def _parameters(system: System, base: Array, values: Mapping[str, float]) -> Array:
    """Parameters with some values replaced, by name."""
    parameter = base.copy()
    for name, value in values.items():
        if not (isinstance(value, int | float | np.number) and math.isfinite(value)):
            raise ValueError(f"value of {name} is {value!r}; it must be a finite number")
        index = index_of(system, name)
        check_value(system.parameters[index], float(value))
        parameter[index] = value
    return parameter
