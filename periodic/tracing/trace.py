"""Entry points: `trace` follows a branch between two parameter values, `continuation` yields its points."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, overload

from threadpoolctl import ThreadpoolController

from periodic.correction.condition import Condition
from periodic.correction.discretisation import Discretisation
from periodic.correction.problem import Problem
from periodic.correction.tolerance import Accuracy, Tolerance
from periodic.display.meter import Advance, meter
from periodic.orbit.construction import standing_at
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import Orbit
from periodic.results.branch import Branch
from periodic.results.halves import Half, joined
from periodic.results.identity import versions
from periodic.results.journal import Journal
from periodic.results.point import Point
from periodic.results.stop import Reason, Stop
from periodic.system import System
from periodic.tracing.continuation import Continuation
from periodic.tracing.resumption import (
    Interrupted,
    begun_from_rest,
    check,
    made_with,
    start_of,
    taken_up,
)
from periodic.tracing.setup import Method, Setup, setup
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.traceable import R_co, Traceable, alone
from periodic.tracing.watch import Watch

ENDS_ALL = (Reason.CLOSED, Reason.MAX_NEWTON)
"""Reasons for which the other direction is not traced either."""


def continuation(
    problem: Problem,
    start: Orbit | float | None = None,
    *,
    sign: int | None = None,
    at: float | Sequence[float] = (),
    tol: float | Tolerance = Accuracy.STANDARD,
    values: Mapping[str, float] | None = None,
    method: Discretisation | None = None,
    control: ArclengthControl | None = None,
    watch: Watch | None = None,
) -> Continuation:
    """Return the continuation of a problem one way from a start, to iterate for its points.

    Parameters
    ----------
    problem : Problem
        System, parameter, bounds, and what determines further free parameters.
    start : Orbit or float, optional
        An orbit near the first one, or the parameter (SI) at which it is looked for from rest; default the
        lower bound.
    sign : int, optional
        The way to go, 1 or -1 times the parameter; default into the bounds.
    at, tol, values, method, control, watch
        As in `trace`.

    Returns
    -------
    Continuation
        Iterate it for its points; stop when you like. When it ends of itself `stop` says why.

    Raises
    ------
    ValueError
        For what is not allowed, in one sentence.
    """
    if not isinstance(problem, Problem):
        raise ValueError(f"problem is {problem!r}; it must be a Problem(system, parameter, bounds)")
    guess, place = (start, None) if isinstance(start, Orbit) else (None, start)
    problem, chosen = Method.of(problem, tol, method, control, watch)
    if chosen.watch.journal is not None:
        raise ValueError(f"watch.journal is {str(chosen.watch.journal)!r}; only trace keeps a journal")
    ready = setup(problem, chosen, start=place, at=at, guess=guess, values=values)
    if sign is not None and sign not in ready.signs:
        ways = " or ".join(map(str, ready.signs))
        raise ValueError(f"sign is {sign!r}; from {ready.begin:g} it must be {ways} to stay in the bounds")
    return ready.run(ready.first(), sign or ready.signs[-1])


@overload
def trace(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    guess: Traceable[R_co],
    values: Mapping[str, float] | None = None,
) -> R_co: ...


@overload
def trace(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    tol: float | Tolerance = Accuracy.STANDARD,
    guess: Orbit | Branch | Mapping[str, float] | None = None,
    values: Mapping[str, float] | None = None,
    determined: Mapping[str, Condition] | None = None,
    method: Discretisation | None = None,
    control: ArclengthControl | None = None,
    watch: Watch | None = None,
) -> Branch: ...


def trace(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    tol: float | Tolerance = Accuracy.STANDARD,
    guess: Orbit | Branch | Mapping[str, float] | Traceable[Any] | None = None,
    values: Mapping[str, float] | None = None,
    determined: Mapping[str, Condition] | None = None,
    method: Discretisation | None = None,
    control: ArclengthControl | None = None,
    watch: Watch | None = None,
) -> Any:
    """Trace the branch of periodic orbits, or of equilibria, through `start` within `bounds`.

    From a start at a bound the branch is followed towards the other, from one inside both ways. A numerical
    failure is the branch's `stop`.

    Parameters
    ----------
    system : System
        The equations.
    parameter : str
        Name of the parameter that is continued in.
    bounds : tuple of float
        Its range (SI); the first is where the branch starts by default.
    start : float, optional
        Where the branch starts; default where the guess lies, else bounds[0].
    at : float or sequence of float
        Values that get a point of their own (UZ) wherever the branch passes them.
    tol : float or Tolerance
        From 1e-11 to 1e-2: bounds the relative errors of the motion, of the places of folds and of
        multipliers (relative to the largest where that exceeds 1).
    guess : Orbit, Branch or mapping of str to float, optional
        An orbit to start from (default: rest): one of an earlier branch, `sampled` from a simulation, or from
        `doubled`, `branched` or `hopf`, of one excitation period or several; it brings its parameters and a
        start of its own. An interrupted branch is taken up where it stands, all other arguments as before but
        for `control.max_points` and `control.max_newton`. Or constant values of states (SI) and unknowns by
        name, the others being at rest: of several orbits the one near these is found. Or a Torus, whose
        family is traced, with `start`, `at` and `values` alone: the result is a `per.tori.TorusBranch`.
    values : mapping of str to float, optional
        Other parameters (SI) by name, in place of the guess's or the system's nominal ones.
    determined : mapping of str to Condition, optional
        Further free parameters with the conditions that determine them: {"omega": PhaseCondition()} for an
        autonomous system with a parameter omega = 2 pi / period, {"preload": FoldCondition()} for the curve
        that a fold traces in two parameters, {"preload": Level(PeakToPeak("x"), 1e-5)} for a constant peak
        to peak.
    method : Discretisation, optional
        `Collocation()` by default, or `Shooting()`, `HarmonicBalance()`, with their settings. `Equilibrium()`
        traces equilibria 0 = R(0, x, z, p), labelled LP, HB (Hopf) and BP; its multipliers are the
        eigenvalues of small motion in 1/s.
    control : ArclengthControl, optional
        Step control, and bounds on the work.
    watch : Watch, optional
        Columns, events, limits, when to stop, progress, journal.

    Returns
    -------
    Branch
        The points in order, and why the branch ends.

    Raises
    ------
    ValueError
        In one sentence, for a parameter, bound or value that is not allowed; for equilibria of a system that
        is excited.
    ResumeError
        For a branch that is not one of this trace.
    Interrupted
        A KeyboardInterrupt (Ctrl-C) with the branch so far as `branch`.
    """
    if isinstance(guess, Traceable):
        alone(guess, tol=tol, determined=determined, method=method, control=control, watch=watch)
        return guess.traced(system, parameter, bounds, start=start, at=at, values=values)
    problem = Problem(system, parameter, bounds, {} if determined is None else determined)
    problem, chosen = Method.of(problem, tol, method, control, watch)
    before = None
    if isinstance(guess, Mapping):
        guess, start = standing_at(system, guess), problem.begin if start is None else start
    if isinstance(guess, Branch):
        before = guess
        guess = None if begun_from_rest(before) else start_of(before).orbit
    ready = setup(problem, chosen, start=start, at=at, guess=guess, values=values)
    onwards = partial(
        trace, system, parameter, tol=tol, determined=determined, method=method, watch=Watch(peaks={})
    )
    empty = replace(joined(parameter, layout_of(system), [], made_with(ready)), onwards=onwards)
    if before is not None:
        check(before, ready)
        ready.work.iterations = before.newton_iterations
    first = ready.first() if before is None else problem.restrict(start_of(before).orbit)
    runs = [ready.run(first, sign) for sign in ready.signs]
    generators: list[Iterator[Point]] = [*runs] if before is None else taken_up(runs, before)
    return _collected(ready, runs, generators, empty, before)


def _collected(
    ready: Setup,
    runs: list[Continuation],
    generators: list[Iterator[Point]],
    empty: Branch,
    before: Branch | None,
) -> Branch:
    """Let runs go on to their ends, one after the other. Raises Interrupted."""
    journal, clock = ready.method.watch.journal, time.perf_counter()
    keeping = nullcontext() if journal is None else Journal(Path(journal), empty)
    interrupted = False
    with keeping as kept, _one_thread(), _shown(ready, empty) as show:
        for run, points in zip(runs, generators, strict=True):
            interrupted = _exhaust(run, _each(points, show), kept)
            if interrupted or (run.stop is not None and run.stop.reason in ENDS_ALL):
                break
    branch = _joined(empty, runs, time.perf_counter() - clock, before)
    if interrupted:
        raise Interrupted(branch)
    return branch


def _one_thread() -> AbstractContextManager[object]:
    """BLAS in one thread: others cost more than they save."""
    return _libraries(len(sys.modules)).limit(limits=1, user_api="blas")


@lru_cache(maxsize=1)
def _libraries(modules: int) -> ThreadpoolController:
    """The thread pools of libraries, found anew where modules have been imported."""
    return ThreadpoolController()


def _shown(ready: Setup, empty: Branch) -> AbstractContextManager[Advance]:
    """A progress meter; none where the user has given `watch.progress`."""
    if ready.method.watch.progress is not None:
        return nullcontext(lambda steps, said: None)
    return meter(f"tracing over {empty.parameter}", "points")


def _each(points: Iterator[Point], show: Advance) -> Iterator[Point]:
    for point in points:
        show(1, f"at {point.parameter:.6g}")
        yield point


def _exhaust(run: Continuation, points: Iterator[Point], journal: Journal | None) -> bool:
    """Let a run go on to its end or be cut short, each step kept in a journal; whether it was interrupted."""
    written, interrupted = 0, False

    def keep(end: int) -> None:
        nonlocal written
        begin, written = written, end
        if journal is not None:
            journal.add(run.collected[begin:end], run.stop or _interrupted(run), run.checkpoint)

    try:
        for _ in points:
            if run.state is not None and run.state.kept > written:
                keep(run.state.kept)
    except KeyboardInterrupt:
        interrupted = True
        run.cut(_interrupted(run))
    try:
        keep(len(run.collected))
    except KeyboardInterrupt:  # it was written before that was heard
        interrupted = True
    return interrupted


def _interrupted(run: Continuation) -> Stop:
    return Stop.after(Reason.INTERRUPTED, run.kept)


def _joined(empty: Branch, runs: list[Continuation], elapsed: float, before: Branch | None) -> Branch:
    """One branch out of one or two runs from the same start, and what was spent on it before."""
    halves = [Half(run.collected, run.stop, run.checkpoint) for run in runs if run.stop is not None]
    return replace(
        joined(empty.parameter, empty.layout, halves, empty.made),
        newton_iterations=runs[0].solver.work.iterations,
        elapsed=elapsed + (before.elapsed if before else 0.0),
        versions=versions(),
        onwards=empty.onwards,
    )
