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
from periodic.continuation import Run
from periodic.methods.collocation import Collocation
from periodic.methods.protocol import Method
from periodic.orbit import Orbit
from periodic.point import Point
from periodic.scheme import Array
from periodic.settings import Accuracy, Settings
from periodic.solve import Task
from periodic.stop import Reason, Stop
from periodic.system import System, VariableLike, index_of

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
    progress: Progress | None = None,
) -> Branch:
    """Trace the branch of periodic orbits through `start` within `bounds`.

    From a start at a bound the branch is followed towards the other, from one inside both ways. `at`
    are values that get a point of their own (UZ) on every sheet. `guess` is an orbit to start from (default:
    rest): one of an earlier branch, `sampled` from a simulation, or from `doubled` or `branched`, of one
    excitation period or several; it brings its parameters and a start of its own (default: the system's
    nominal ones and bounds[0]), which `values` (SI, by name) and `start` replace. `determined` are further
    free parameters with the conditions that determine them: {"omega": PhaseCondition()} for an autonomous
    system with a parameter omega = 2 pi / period. An interrupt (Ctrl-C) returns the branch so far. A
    numerical failure is the branch's `stop`. Raises ValueError, in one sentence, for a parameter, bound or
    value that is not allowed.
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
    task = Task(
        system,
        index,
        Metric(high - low),
        settings or accuracy.settings(),
        method or Collocation(),
        others=tuple(index_of(system, name) for name in determined),
        conditions=tuple(determined.values()),
    )
    clock = time.perf_counter()
    fixed = _parameters(system, base, {**(values or {}), parameter: begin})
    orbit = _start(task, guess, fixed)
    signs = [sign for sign, end in ((-1, low), (1, high)) if begin != end]
    runs = [Run(task, (low, high), user, search=guess is None) for _ in signs]
    halves: list[list[Point]] = []
    with threadpool_limits(limits=1, user_api="blas"):  # threads only slow these small matrices down
        for run, sign in zip(runs, signs, strict=True):
            halves.append(_collect(run, run.points(orbit, sign), progress))
            if run.stop is not None and run.stop.reason in (Reason.INTERRUPTED, Reason.CLOSED):
                break
    return _joined(system, parameter, runs, halves, time.perf_counter() - clock)


def _collect(run: Run, points: Iterator[Point], progress: Progress | None) -> list[Point]:
    collected: list[Point] = []
    try:
        for point in points:
            collected.append(point)
            if progress is not None:
                progress(point)
    except KeyboardInterrupt:
        run.stop = Stop(Reason.INTERRUPTED, f"after {len(collected)} points")
    return collected


def _joined(
    system: System, parameter: str, runs: list[Run], halves: list[list[Point]], elapsed: float
) -> Branch:
    """One branch out of one or two runs from the same start."""
    two = len(halves) == 2 and len(halves[1]) > 0
    points = [*_reversed(halves[0]), *halves[1]] if two else halves[0]
    stop, backwards = (runs[1].stop, runs[0].stop) if two else (runs[0].stop, None)
    assert stop is not None
    return Branch(
        parameter=parameter,
        layout=layout_of(system),
        points=tuple(points),
        stop=stop,
        stop_backwards=backwards,
        newton_iterations=runs[0].task.work.iterations,
        elapsed=elapsed,
        versions=_versions("orbitrace", "numpy", "scipy"),
    )


def _reversed(half: list[Point]) -> list[Point]:
    """A half run backwards as the first part of a branch, without its start."""
    start = half[0].parameter
    away = [p for i, p in enumerate(half) if i > 1 or p.parameter != start]
    return [replace(point, slope=-point.slope) for point in reversed(away)]


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
