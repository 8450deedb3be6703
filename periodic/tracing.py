"""The usual way in: trace a branch between two values of a parameter."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from periodic.branch import Branch, Layout, Quantity
from periodic.closure import Condition, Metric
from periodic.conditions import Level
from periodic.continuation import Run
from periodic.functionals import Functional
from periodic.halves import Half, joined, turned
from periodic.journal import Journal
from periodic.methods.collocation import Collocation
from periodic.methods.protocol import Method
from periodic.orbit import Orbit
from periodic.point import Point
from periodic.scheme import Array
from periodic.settings import Accuracy, Settings
from periodic.solve import Task
from periodic.stop import Reason, Stop
from periodic.system import System, VariableLike, index_of
from periodic.watch import Watch

Progress = Callable[[Point], None]


class ResumeError(ValueError):
    """A branch that is not one of the trace that it shall resume."""


def trace(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    *,
    start: float | None = None,
    at: float | Sequence[float] = (),
    accuracy: Accuracy = Accuracy.STANDARD,
    settings: Settings | None = None,
    method: Method | None = None,
    values: Mapping[str, float] | None = None,
    determined: Mapping[str, Condition] | None = None,
    guess: Orbit | None = None,
    columns: Mapping[str, Functional] | None = None,
    events: Mapping[str, Level] | None = None,
    limits: Mapping[str, tuple[float, float]] | None = None,
    stop: Mapping[str, int] | None = None,
    resume: Branch | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> Branch:
    """Trace the branch of periodic orbits through `start` within `bounds`.

    From a start at a bound the branch is followed towards the other, from one inside both ways. `at`
    are values that get a point of their own (UZ) on every sheet. `guess` is an orbit to start from (default:
    rest): one of an earlier branch, `sampled` from a simulation, or from `doubled` or `branched`, of one
    excitation period or several; it brings its parameters and a start of its own (default: the system's
    nominal ones and bounds[0]), which `values` (SI, by name) and `start` replace. `determined` are further
    free parameters with the conditions that determine them: {"omega": PhaseCondition()} for an autonomous
    system with a parameter omega = 2 pi / period, {"preload": FoldCondition()} for the curve that a fold
    traces in two parameters, {"preload": Level(PeakToPeak("x"), 1e-5)} for orbits of constant ripple.

    `columns` are functionals of the orbit kept at each point; `events` levels of functionals that get a point
    (UZ); `limits` ranges of other parameters that end the branch; `stop` ends it at the n-th point of a label
    or event, {"LP": 2}, counted from the start in each direction. `method` is the discretisation (default:
    Collocation()).

    An interrupt (Ctrl-C) returns the branch so far; `resume` takes such a branch up where it stands, with all
    other arguments as before. `journal` is a file that keeps every step as it is done, for
    `periodic.recovered` if the process is killed. A numerical failure is the branch's `stop`. Raises
    ValueError, in one sentence, for a parameter, bound or value that is not allowed.
    """
    _checked(system, accuracy)
    index = index_of(system, parameter)
    low, high = _range(parameter, bounds)
    if values and parameter in values:
        raise ValueError(f"values has {parameter!r}, which is continued in; give it as start")
    base = _base(system, guess)
    begin = _begin(bounds, start, None if guess is None else float(base[index]))
    if not low <= begin <= high:
        raise ValueError(f"start is {begin}; it must lie within the bounds {low} to {high}")
    user = tuple(sorted({float(value) for value in np.atleast_1d(np.asarray(at, dtype=float))}))
    for value in user:
        if not low <= value <= high:
            raise ValueError(f"at is {value}; it must lie within the bounds {low} to {high}")
    determined = determined or {}
    for name, condition in determined.items():
        if isinstance(condition, type) or not hasattr(condition, "at"):
            raise ValueError(
                f"determined has {condition!r} for {name}; it must be a condition, as FoldCondition() is"
            )
        if name == parameter or (guess is not None and name in (values or {})):
            place = "the parameter continued in" if name == parameter else "in values"
            raise ValueError(f"determined has {name!r}, which is also {place}; it must be one or the other")
    if method is not None and (isinstance(method, type) or not hasattr(method, "correct")):
        raise ValueError(f"method is {method!r}; it must be Collocation(), Shooting() or HarmonicBalance()")
    watch = Watch(columns or {}, events or {}, limits or {}, stop or {})
    task = Task(
        system,
        index,
        Metric(high - low),
        settings or accuracy.settings(),
        method or Collocation(),
        others=tuple(index_of(system, name) for name in determined),
        conditions=tuple(determined.values()),
        watch=watch,
    )
    clock = time.perf_counter()
    signs = [sign for sign, end in ((-1, low), (1, high)) if begin != end]
    runs = [Run(task, (low, high), user, search=guess is None) for _ in signs]
    first = _parameters(system, base, {**(values or {}), parameter: begin})
    made = _made(task, (low, high), user, first)
    if resume is None:
        orbit = _start(task, guess, first)
        generators = [run.points(orbit, sign) for run, sign in zip(runs, signs, strict=True)]
    else:
        _check_made(resume, parameter, layout_of(system), made)
        generators = _taken_up(runs, signs, resume)
    empty = joined(parameter, layout_of(system), [], made)
    keeping = nullcontext() if journal is None else Journal(Path(journal), empty)
    with keeping as kept, threadpool_limits(limits=1, user_api="blas"):
        for run, points in zip(runs, generators, strict=True):
            _collect(run, points, progress, kept)
            if run.stop is not None and run.stop.reason in (Reason.INTERRUPTED, Reason.CLOSED):
                break
    return _joined(empty, runs, time.perf_counter() - clock, resume)


def _collect(run: Run, points: Iterator[Point], progress: Progress | None, journal: Journal | None) -> None:
    """Let a run go on to its end, or to an interrupt: then what its last step began is left out."""
    written = 0
    try:
        for point in points:
            if journal is not None and run.state is not None and run.state.kept > written:
                journal.add(run, run.collected[written : run.state.kept])
                written = run.state.kept
            if progress is not None:
                progress(point)
    except KeyboardInterrupt:
        if run.state is not None:
            del run.collected[run.state.kept :]
        run.stop = Stop(Reason.INTERRUPTED, f"after {len(run.collected)} points")
    if journal is not None:
        journal.add(run, run.collected[written:])


def _joined(empty: Branch, runs: list[Run], elapsed: float, before: Branch | None) -> Branch:
    """One branch out of one or two runs from the same start, and what was spent on it before."""
    halves = [Half(run.collected, run.stop, run.checkpoint) for run in runs if run.stop is not None]
    return replace(
        joined(empty.parameter, empty.layout, halves, empty.made),
        newton_iterations=runs[0].task.work.iterations + (before.newton_iterations if before else 0),
        elapsed=elapsed + (before.elapsed if before else 0.0),
        versions=_versions("orbitrace", "numpy", "scipy"),
    )


def _made(task: Task, bounds: tuple[float, float], user: Sequence[float], parameter: Array) -> dict[str, str]:
    """What a branch is made with, in words: whoever resumes it must ask for the same."""
    free, names = task.free, [p.name for p in task.system.parameters]
    values = {
        name: float(v) for k, (name, v) in enumerate(zip(names, parameter, strict=True)) if k not in free
    }
    determined = {names[k]: condition for k, condition in zip(task.others, task.conditions, strict=True)}
    return {
        "bounds": repr(bounds),
        "at": repr(tuple(user)),
        "settings": repr(task.settings),
        "method": repr(task.method),
        "values": repr(values),
        "determined": repr(determined),
        "columns": repr(sorted(task.watch.columns)),
        "events": repr(sorted(task.watch.events)),
    }


def _check_made(branch: Branch, parameter: str, layout: Layout, made: dict[str, str]) -> None:
    """Raise ResumeError for a branch of another system, or made with anything else."""
    if (branch.parameter, branch.layout) != (parameter, layout) or not branch.points:
        raise ResumeError(
            f"resume is a branch in {branch.parameter} with {len(branch)} points; it must be one in "
            f"{parameter} of this system, with points"
        )
    for name, now in made.items():
        before = branch.made.get(name)
        if before != now and not (name == "settings" and _more_points(before, now)):
            raise ResumeError(f"resume is a branch made with {name} {before}; now they are {now}")


def _more_points(before: str | None, now: str) -> bool:
    """Whether settings differ in the largest number of points alone."""
    plain = [re.sub(r"max_points=\d+", "", text or "") for text in (before, now)]
    return plain[0] == plain[1]


def _taken_up(runs: list[Run], signs: list[int], branch: Branch) -> list[Iterator[Point]]:
    """The runs of an interrupted branch, each from where it stands. Raises ResumeError for another start."""
    begun = {c.sign: c for c in branch.checkpoints}
    if not set(begun) <= set(signs):
        raise ResumeError("resume is a branch with another start; start and bounds must be as before")
    start = branch.points[branch.backwards]
    own = [[*branch.points[branch.backwards :]]]
    if branch.stop_backwards is not None:
        own.insert(0, [start, *turned(branch.points[: branch.backwards])])
    stops = [branch.stop_backwards or branch.stop, branch.stop]
    generators: list[Iterator[Point]] = []
    for run, sign, stop in zip(runs, signs, stops, strict=False):
        checkpoint = begun.get(sign)
        if checkpoint is None:
            generators.append(run.points(start.orbit, sign))
            continue
        run.collected, run.stop, run.ended = own.pop(0), stop, checkpoint
        going = run.resumed(start.orbit, run.collected, checkpoint)
        generators.append(iter(()) if checkpoint.done else going)
    return generators


def _versions(*names: str) -> dict[str, str]:
    def version(name: str) -> str:
        try:
            return metadata.version(name)
        except metadata.PackageNotFoundError:
            return "not installed"

    return {name: version(name) for name in names}


def layout_of(system: System) -> Layout:
    """Return names, units and scales of a system's quantities."""

    def quantities(variables: Sequence[VariableLike]) -> tuple[Quantity, ...]:
        return tuple(Quantity(v.name, v.unit, float(v.scale)) for v in variables)

    return Layout(
        quantities(system.states),
        quantities(system.algebraics),
        quantities(system.outputs),
        quantities(system.parameters),
    )


def _checked(system: System, accuracy: Accuracy) -> None:
    """Refuse what Python's types do not: a model that is not compiled, an accuracy by its name."""
    missing = [name for name in ("states", "parameters", "linearise", "rest") if not hasattr(system, name)]
    if missing:
        raise ValueError(
            f"system is a {type(system).__name__} without {', '.join(missing)}; it must be a System "
            f"(symbolic.compile makes one of a model)"
        )
    if not isinstance(accuracy, Accuracy):
        raise ValueError(f"accuracy is {accuracy!r}; it must be Accuracy.DRAFT, .STANDARD or .FINE")


def _range(parameter: str, bounds: tuple[float, float]) -> tuple[float, float]:
    ends = np.sort(np.atleast_1d(np.asarray(bounds, dtype=float)))
    low, high = float(ends[0]), float(ends[-1])
    if len(ends) != 2 or not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ValueError(f"bounds of {parameter} are {bounds}; they must be two different finite numbers")
    return low, high


def _base(system: System, guess: Orbit | None) -> Array:
    """The parameters that values are put into: the guess's, else the nominal ones."""
    nominal = np.array(system.nominal, dtype=float)
    if guess is None:
        return nominal
    if not isinstance(guess, Orbit):
        raise ValueError(f"guess is a {type(guess).__name__}; it must be an Orbit, as point.orbit is")
    counts = {
        "states": (guess.nodes.shape[1], len(system.states)),
        "algebraic unknowns": (guess.algebraic.shape[2], len(system.algebraics)),
        "parameters": (len(guess.parameter), len(nominal)),
    }
    for kind, (given, wanted) in counts.items():
        if given != wanted:
            raise ValueError(f"guess has {given} {kind}; it must have the {wanted} of the system")
    if not all(np.isfinite(a).all() for a in (guess.nodes, guess.stages, guess.algebraic, guess.parameter)):
        raise ValueError("guess has values that are not finite; all of its numbers must be")
    return guess.parameter.copy()


def _begin(bounds: tuple[float, float], start: float | None, own: float | None) -> float:
    """Where to start: as asked for, else at the guess's own value, else at the first bound."""
    return next(float(value) for value in (start, own, bounds[0]) if value is not None)


def _parameters(system: System, base: Array, values: Mapping[str, float]) -> Array:
    """Parameters with some values replaced, by name."""
    parameter = base.copy()
    for name, value in values.items():
        if not (isinstance(value, int | float | np.number) and math.isfinite(value)):
            raise ValueError(f"value of {name} is {value!r}; it must be a finite number")
        parameter[index_of(system, name)] = value
    return parameter


def _start(task: Task, guess: Orbit | None, parameter: Array) -> Orbit:
    """The first guess: at rest, or the one given at the given parameters, determined ones apart."""
    system, mesh = task.system, task.settings.mesh
    if guess is None:
        return task.method.rest(system, mesh, parameter)
    parameter[list(task.others)] = guess.parameter[list(task.others)]
    return task.method.adopted(system, mesh, guess, parameter)
