"""One cell of a map: a model at an extreme value, its branch traced and its orbits confirmed."""

from __future__ import annotations

import math
import signal
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from enum import Enum
from typing import Any

from threadpoolctl import threadpool_limits

import periodic as per
import symbolic as sym
from reports.studies.extremes.confirm import Checked, confirmed
from symbolic.scenes.errors import InputError

POINTS = 250
"""Most points of a branch; one that goes on is cut there."""

SECONDS = 15.0
"""Processor time (s) that a branch may take."""

ENDED = (per.Reason.BOUND, per.Reason.CLOSED, per.Reason.EQUILIBRIUM, per.Reason.ASKED)

Trace = Callable[[sym.CompiledSystem, per.ArclengthControl], per.Branch]


class Outcome(Enum):
    """What came of a cell."""

    TRACED = "traced"
    CUT = "cut short"
    STOPPED = "stopped"
    REFUSED = "refused"
    UNCONFIRMED = "unconfirmed"
    WRONG = "wrong"


@dataclass(frozen=True, kw_only=True)
class Case:
    """A cell: its value on the axis, the model, the branch, and how the branch is confirmed.

    way: by which model or path, where an axis has several. name: what stands for both on the page. at_end:
    whether the branch reaches the value only at its end. instead: what is done in place of tracing.
    """

    value: float
    system: Callable[[], sym.CompiledSystem]
    trace: Trace
    way: str = ""
    name: str = ""
    at_end: bool = False
    confirm: Callable[[sym.CompiledSystem, per.Branch], Checked] = confirmed
    points: int = POINTS
    seconds: float = SECONDS
    instead: Callable[[Case], Row] | None = None


@dataclass(frozen=True, kw_only=True)
class Row:
    """What was found: see `introduction.md.j2` for each column."""

    value: float
    way: str
    name: str
    outcome: str
    detail: str
    points: int = 0
    iterations: int = 0
    seconds: float = 0.0
    specials: str = ""
    estimate: float | None = None
    error: float | None = None
    multiplier_error: float | None = None
    largest: float | None = None
    smallest: float | None = None
    floor: float | None = None
    checked: int = 0
    check: str = ""
    at_end: bool = False

    @property
    def well(self) -> bool:
        """Whether the branch was traced, or was at the value and going on when it was cut short."""
        return self.outcome == Outcome.TRACED.value or (self.outcome == Outcome.CUT.value and not self.at_end)

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it."""
        return asdict(self)


AGAIN = 5.0
"""Seconds at the least until an interrupt is repeated: a trace takes less to end."""


class _TimeUpError(KeyboardInterrupt):
    """The time of a cell is up; a trace takes it for Ctrl-C."""


def survey(case: Case) -> Row:
    """Trace a cell and confirm its orbits. Whatever is not a branch or a refusal is recorded as wrong."""
    if case.instead is not None:
        return case.instead(case)
    control = per.ArclengthControl(max_points=case.points)
    clock = time.process_time()
    try:
        with warnings.catch_warnings(), within(case.seconds), threadpool_limits(limits=1, user_api="blas"):
            warnings.simplefilter("error")
            system = case.system()
            branch = _as_far(case, system, control)
    except _TimeUpError:
        message = "its time used up before there was a branch"
        return Row(value=case.value, way=case.way, name=case.name, outcome=Outcome.CUT.value, detail=message)
    except (InputError, ValueError) as error:
        return Row(
            value=case.value, way=case.way, name=case.name, outcome=Outcome.REFUSED.value, detail=str(error)
        )
    except (Warning, ArithmeticError) as error:
        message = f"{type(error).__name__}: {error}"
        return Row(
            value=case.value, way=case.way, name=case.name, outcome=Outcome.WRONG.value, detail=message
        )
    return _row(case, system, branch, time.process_time() - clock)


def _as_far(case: Case, system: sym.CompiledSystem, control: per.ArclengthControl) -> per.Branch:
    """Return the branch, or what there is of it when the time is up."""
    try:
        return case.trace(system, control)
    except per.Interrupted as interrupted:
        return interrupted.branch


def _row(case: Case, system: sym.CompiledSystem, branch: per.Branch, seconds: float) -> Row:
    outcome, detail = judged(branch)
    row = Row(
        value=case.value,
        way=case.way,
        name=case.name,
        at_end=case.at_end,
        outcome=outcome.value,
        detail=detail,
        points=len(branch),
        iterations=branch.newton_iterations,
        seconds=seconds,
    )
    if not len(branch):
        return row
    found = case.confirm(system, branch)
    if not math.isfinite(found.error):
        outcome, detail = Outcome.UNCONFIRMED, f"neither CVODES nor accuracy fine gets there ({branch.stop})"
    elif not found.right:
        outcome, detail = Outcome.WRONG, f"{found.verdict} ({branch.stop})"
    strongest = max(branch, key=lambda point: float(abs(point.multipliers[0])))
    weakest = min(branch, key=lambda point: float(abs(point.multipliers[-1])))
    return replace(
        row,
        outcome=outcome.value,
        detail=detail,
        specials=specials(branch),
        estimate=max(p.error.orbit for p in branch),
        error=found.error,
        multiplier_error=found.multiplier_error,
        largest=float(abs(strongest.multipliers[0])),
        smallest=float(abs(weakest.multipliers[-1])),
        floor=weakest.floor,
        checked=found.count,
        check=found.by,
    )


def judged(branch: per.Branch) -> tuple[Outcome, str]:
    """Return whether a branch went through its range, was cut by this survey's limits, or stopped."""
    numbers = [v for p in branch for v in (p.parameter, *p.minimum.values(), *p.maximum.values())]
    if not all(map(math.isfinite, numbers)):
        return Outcome.WRONG, "a point has numbers that are not finite"
    stops = branch.stops
    for stop in stops:
        if stop.reason in (per.Reason.MAX_POINTS, per.Reason.INTERRUPTED) and len(branch):
            used = "points" if stop.reason is per.Reason.MAX_POINTS else "time"
            return Outcome.CUT, f"its {used} used up at {_place(branch)}"
        if stop.reason not in ENDED:
            at = f", at {_place(branch)}" if len(branch) else ""
            return Outcome.STOPPED, f"{stop}{at}"
    return Outcome.TRACED, str(branch.stop)


def _place(branch: per.Branch) -> str:
    """Say how far a branch got."""
    return f"{branch.parameter} = {branch[-1].parameter:.6g}"


def specials(branch: per.Branch) -> str:
    """Return how many special points of each kind there are."""
    kinds = (per.Label.END, per.Label.USER, per.Label.FAILED)
    count = Counter(p.label.value for p in branch.special_points if p.label not in kinds)
    return ", ".join(f"{n} {label}" for label, n in sorted(count.items()))


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Interrupt a trace, as Ctrl-C does, when its processor time is up.

    CasADi loses what is raised while it converts arguments, or raises something else for it: a lost interrupt
    comes again, and any error after it is taken for one.
    """
    fired = False

    def interrupt(*_: object) -> None:
        nonlocal fired
        fired = True
        raise _TimeUpError

    before = signal.signal(signal.SIGPROF, interrupt)
    signal.setitimer(signal.ITIMER_PROF, seconds, max(seconds, AGAIN))
    try:
        yield
    except Exception as error:
        if fired:
            raise _TimeUpError from error
        raise
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
