"""One trace of a scene, from a validated task to files on disk."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path

import numpy as np

import periodic as per
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.schema import Scene

from ..files import INCOMPLETE, unwritable, writable, write
from ..request import Task
from ..sweep import Settled, sweep
from ..trace.html import write_page
from ..trace.picture import Settlements, draw
from ..trace.summary import csv_text, json_text
from ..view import view_of

BRANCH = "branch.nc"
"""File of a branch in its directory."""

JOURNAL = "branch.journal"
"""File that keeps each step of a trace under way; what is left of it was killed."""

METHODS: dict[str, Callable[[], per.extend.Discretisation]] = {
    "collocation": per.Collocation,
    "shooting": per.Shooting,
    "harmonic-balance": per.HarmonicBalance,
}
"""Discretisations by the names that they have on the command line."""


@dataclass(frozen=True, kw_only=True)
class Effort:
    """How a branch is traced: names of accuracy and method, most steps and Newton iterations (None: any)."""

    accuracy: str
    method: str
    max_points: int | None = None
    max_newton: int | None = None

    @property
    def control(self) -> per.ArclengthControl:
        """The engine's step control."""
        usual = per.ArclengthControl()
        return per.ArclengthControl(
            max_points=usual.max_points if self.max_points is None else self.max_points,
            max_newton=usual.max_newton if self.max_newton is None else self.max_newton,
        )


def interrupted(task: Task, folder: Path) -> per.Branch:
    """Return the interrupted branch that a directory holds, to be resumed.

    Raises InputError where there is none, or one of another scene.
    """
    incomplete = sorted(folder.glob(f"{INCOMPLETE}*/{BRANCH}"))
    places = [folder / JOURNAL, *incomplete, folder / BRANCH]
    # A journal is empty until the first step.
    there = [place for place in places if place.is_file() and place.stat().st_size]
    path = max(there, key=lambda place: (place.name == JOURNAL, place.stat().st_mtime), default=None)
    if path is None:
        raise refused("--resume", str(folder), "a directory with the branch.nc of an interrupted trace")
    try:
        branch = per.recovered(path) if path.name == JOURNAL else per.Branch.load(path)
    except per.BranchFileError as error:
        raise refused("--resume", str(path), f"a branch that can be read ({error})") from error
    _check_values(task, branch, path)
    return branch


def _check_values(task: Task, branch: per.Branch, path: Path) -> None:
    """Raise InputError where a branch of the same model has another value of a parameter."""
    parameter, system = view_of(task.scene).parameter, build(task.scene)
    known = [quantity.name for quantity in branch.layout.parameters]
    for k, wanted in enumerate(system.parameters) if known == [p.name for p in system.parameters] else ():
        own = float(branch.points[0].orbit.parameter[k]) if len(branch) else wanted.value
        if wanted.name != parameter and own != wanted.value:
            allowed = f"one traced with {wanted.name} = {wanted.value:g}, as now (it has {own:g})"
            raise refused("--resume", str(path), allowed)


def trace(
    task: Task,
    effort: Effort,
    folder: Path,
    resume: per.Branch | None = None,
    progress: Callable[[per.Point], None] | None = None,
) -> per.Branch:
    """Build the system of a scene and trace its branch over its range, with a journal in `folder`.

    Raises InputError for a branch to resume that is another's, or a directory in use.
    """
    view = view_of(task.scene)
    begin, end = task.scene.trace.bounds
    try:
        return per.trace(
            build(task.scene),
            view.parameter,
            (min(begin, end), max(begin, end)),
            start=begin,
            at=[value * view.unit for value in task.at],
            tol=per.Accuracy[effort.accuracy],
            control=effort.control,
            method=METHODS[effort.method](),
            guess=resume,
            watch=per.Watch(journal=folder / JOURNAL, progress=progress),
        )
    except per.Interrupted as interrupted:
        return interrupted.branch
    except per.JournalError as error:
        allowed = "it must be one that no other trace is writing to"
        raise InputError("--out", f'is "{folder}"', allowed) from error
    except OSError as error:
        raise unwritable(folder, error) from error
    except per.ResumeError as error:
        raise refused("--resume", "another branch", f"one of this scene ({error})") from error


SPEEDS = 33
"""Values at which a sweep in time lets the motion settle, each way."""


def swept(task: Task, progress: Callable[[Settled], None] | None = None) -> Settlements:
    """Return what time integration settles to over the scene's range, rising and falling, as shown.

    Where it has not settled there is no point.
    """
    view, system = view_of(task.scene), build(task.scene)
    low, high = sorted(task.scene.trace.bounds)
    values = list(np.linspace(low, high, SPEEDS))
    ways = [sweep(system, view.parameter, way, progress=progress) for way in (values, values[::-1])]
    below, above = ([(m.parameter / view.unit, view.settled(m)) for m in way if m.steady] for way in ways)
    return below, above


def place(branch: per.Branch, folder: Path) -> Path:
    """Return where a branch goes: one that is cut short in place of none but a shorter one cut short."""
    cut = any(s.reason.numerical or s.reason is per.Reason.INTERRUPTED for s in branch.stops)
    if not cut or not (folder / BRANCH).exists():
        return folder
    others = (folder / f"{INCOMPLETE}-{number}" for number in count(2))
    places = chain([folder / INCOMPLETE], others)
    return writable(next(place for place in places if _length(place / BRANCH) <= len(branch)))


def _length(path: Path) -> int:
    """How many points a branch file has; 0 of none that can be read."""
    try:
        return len(per.Branch.load(path))
    except per.BranchFileError:
        return 0


@dataclass(frozen=True, kw_only=True)
class Result:
    """A branch of a scene, and what time integration settles to where that was asked for."""

    name: str
    scene: Scene
    branch: per.Branch
    integrated: Settlements | None = None


def save(folder: Path, result: Result, *, html: bool = False) -> list[Path]:
    """Write the files of a branch and return them. Raises InputError if one cannot be written."""
    name, scene, branch = result.name, result.scene, result.branch
    writers: dict[str, Callable[[Path], object]] = {
        BRANCH: branch.save,
        "branch.csv": lambda path: path.write_text(csv_text(scene, branch), "utf-8"),
        "branch.json": lambda path: path.write_text(json_text(name, scene, branch), "utf-8"),
        "branch.png": lambda path: draw(path, scene, branch, result.integrated),
    }
    if html and len(branch):
        writers["branch.html"] = lambda path: write_page(path, scene, branch)
    return write(folder, writers)
