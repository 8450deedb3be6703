"""The usual way in: trace a branch between two values of a parameter."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from importlib import metadata

import numpy as np
from threadpoolctl import threadpool_limits

from periodic.branch import Branch, Layout, Quantity
from periodic.closure import Condition, Metric
from periodic.conditions import Level
from periodic.continuation import Run
from periodic.functionals import Functional
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
    other arguments as before. A numerical failure is the branch's `stop`. Raises ValueError, in one sentence,
    for a parameter, bound or value that is not allowed.
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
    if resume is None:
        orbit = _start(task, guess, _parameters(system, base, {**(values or {}), parameter: begin}))
        generators = [run.points(orbit, sign) for run, sign in zip(runs, signs, strict=True)]
    else:
        generators = _taken_up(runs, signs, parameter, layout_of(system), resume)
    with threadpool_limits(limits=1, user_api="blas"):  # threads only slow these small matrices down
        for run, points in zip(runs, generators, strict=True):
            _collect(run, points, progress)
            if run.stop is not None and run.stop.reason in (Reason.INTERRUPTED, Reason.CLOSED):
                break
    return _joined(system, parameter, runs, time.perf_counter() - clock, resume)


def _collect(run: Run, points: Iterator[Point], progress: Progress | None) -> None:
    """Let a run go on to its end, or to an interrupt: then what its last step began is left out."""
    try:
        for point in points:
            if progress is not None:
                progress(point)
    except KeyboardInterrupt:
        del run.collected[run.state.kept if run.state else 1 :]
        run.stop = Stop(Reason.INTERRUPTED, f"after {len(run.collected)} points")


def _joined(system: System, parameter: str, runs: list[Run], elapsed: float, before: Branch | None) -> Branch:
    """One branch out of one or two runs from the same start, and what was spent on it before."""
    reached = [run for run in runs if run.stop is not None]
    last, both = reached[-1], len(reached) == 2 and bool(runs[0].collected)
    first = _reversed(runs[0].collected) if both else []
    assert last.stop is not None
    return Branch(
        parameter=parameter,
        layout=layout_of(system),
        points=(*first, *(last.collected or runs[0].collected[:1])),
        stop=last.stop,
        stop_backwards=runs[0].stop if len(reached) == 2 else None,
        newton_iterations=runs[0].task.work.iterations + (before.newton_iterations if before else 0),
        elapsed=elapsed + (before.elapsed if before else 0.0),
        versions=_versions("orbitrace", "numpy", "scipy"),
        checkpoints=tuple(run.checkpoint for run in runs if run.checkpoint is not None),
        backwards=len(first),
    )


def _taken_up(
    runs: list[Run], signs: list[int], parameter: str, layout: Layout, branch: Branch
) -> list[Iterator[Point]]:
    """The runs of an interrupted branch, each from where it stands. Raises ValueError for another one."""
    if (branch.parameter, branch.layout) != (parameter, layout) or not branch.points:
        raise ValueError(
            f"resume is a branch in {branch.parameter} with {len(branch)} points; it must be one in "
            f"{parameter} of this system, with points"
        )
    begun = {c.sign: c for c in branch.checkpoints}
    if not set(begun) <= set(signs):
        raise ValueError("resume is a branch with another start; start and bounds must be as before")
    start = branch.points[branch.backwards]
    own = [[*branch.points[branch.backwards :]]]
    if branch.backwards:
        own.insert(0, [start, *_turned(branch.points[: branch.backwards])])
    stops = [branch.stop_backwards or branch.stop, branch.stop]
    generators: list[Iterator[Point]] = []
    for run, sign, stop in zip(runs, signs, stops, strict=False):
        checkpoint = begun.get(sign)
        if checkpoint is None:
            generators.append(run.points(start.orbit, sign))
        elif checkpoint.done:
            run.collected, run.stop, run.ended = own.pop(0), stop, checkpoint
            generators.append(iter(()))
        else:
            generators.append(run.resumed(start.orbit, own.pop(0), checkpoint))
    return generators


def _reversed(half: list[Point]) -> list[Point]:
    """A half run backwards as the first part of a branch, without its start."""
    start = half[0].parameter
    return _turned([p for i, p in enumerate(half) if i > 1 or p.parameter != start])


def _turned(points: Sequence[Point]) -> list[Point]:
    """Points in the opposite order."""
    return [replace(point, slope=-point.slope) for point in reversed(points)]


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
