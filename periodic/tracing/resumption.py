"""Branches that were interrupted: the settings they are made with, and how they are resumed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from periodic.orbit.layout import layout_of
from periodic.results.branch import Branch
from periodic.results.described import described, differences
from periodic.results.halves import reversed_run
from periodic.results.point import Point
from periodic.tracing.continuation import Continuation
from periodic.tracing.setup import Setup

MAY_GROW = ("control.max_points", "control.max_newton")
"""Settings that may be larger when a branch is resumed."""

WATCHED = ("columns", "events", "limits", "stop", "special")
"""Fields of `Watch` that affect a branch."""

FROM_REST = "from rest"
"""Key in `Branch.made` that says whether a branch was begun without a guess."""


class ResumeError(ValueError):
    """The branch to resume was made by another trace."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a trace; `branch` is what was traced until then, for `guess=` to take up."""

    def __init__(self, branch: Branch) -> None:
        super().__init__(
            f"interrupted after {len(branch)} points, which are the `branch` of this exception: "
            f"`import sys; sys.last_value.branch` where nothing caught it"
        )
        self.branch = branch


def made_with(setup: Setup) -> dict[str, Any]:
    """Return the settings that a branch is made with, by value: they must be the same when it is resumed."""
    problem, method = setup.problem, setup.method
    names = [p.name for p in problem.system.parameters]
    held = {
        n: float(v)
        for k, (n, v) in enumerate(zip(names, setup.parameter, strict=True))
        if k not in problem.free
    }
    return {
        "bounds": described((problem.low, problem.high)),
        "at": described(setup.user),
        "tolerance": described(method.tolerance),
        "method": described(method.discretisation),
        "control": described(method.control),
        "values": held,
        "determined": described(problem.determined),
        **{name: described(getattr(method.watch, name)) for name in WATCHED},
        **({} if method.watch.peaks is None else {"peaks": described(method.watch.peaks)}),  # as older files
        FROM_REST: setup.search,
    }


def check(branch: Branch, setup: Setup) -> None:
    """Raise ResumeError for a branch of another system, or made with other settings."""
    parameter, layout = setup.problem.parameter, layout_of(setup.problem.full)
    if (branch.parameter, branch.layout) != (parameter, layout) or not branch.points:
        raise ResumeError(
            f"guess is a branch in {branch.parameter} with {len(branch)} points; it must be one in "
            f"{parameter} of this system, with points"
        )
    if setup.begin != start_of(branch).parameter:
        raise ResumeError("guess is a branch with another start; start and bounds must be as before")
    found = differences(branch.made, made_with(setup), MAY_GROW)
    if found:
        raise ResumeError(f"guess is a branch made with {'; and with '.join(found)}")


def taken_up(runs: list[Continuation], branch: Branch) -> list[Iterator[Point]]:
    """Return the points that follow of each run. Raises ResumeError for a branch with another start."""
    begun = {c.sign: c for c in branch.checkpoints}
    if not set(begun) <= {run.sign for run in runs}:
        raise ResumeError("guess is a branch with another start; start and bounds must be as before")
    own = [[*branch.points[branch.backwards :]]]
    if branch.stop_backwards is not None:
        own.insert(0, [start_of(branch), *reversed_run(branch.points[: branch.backwards])])
    stops = [branch.stop_backwards or branch.stop, branch.stop]
    generators: list[Iterator[Point]] = []
    for run, stop in zip(runs, stops, strict=False):
        checkpoint = begun.get(run.sign)
        if checkpoint is None:
            generators.append(iter(run))
            continue
        run.collected, run.stop, run.ended = own.pop(0), stop, checkpoint
        going = run.resumed(run.collected, checkpoint)
        generators.append(iter(()) if checkpoint.done else going)
    return generators


def start_of(branch: Branch) -> Point:
    """Return the point that a branch was begun at."""
    return branch.points[branch.backwards]


def begun_from_rest(branch: Branch) -> bool:
    """Return whether a branch was begun without a guess, or not at all."""
    return not branch.points or bool(branch.made.get(FROM_REST, True))
