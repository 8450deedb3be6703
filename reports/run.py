"""One trace of a scene, from validated input to files on disk."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from reports.errors import InputError, refused
from reports.files import INCOMPLETE, write
from reports.scene import Override, ends, load
from reports.schema import Scene
from reports.summary import csv_text, json_text
from reports.view import view_of

if TYPE_CHECKING:
    from periodic import Accuracy, Branch, Point
    from periodic.methods.protocol import Method
    from reports.sweep import Settled


BRANCH = "branch.nc"
"""File of a branch in its directory."""

JOURNAL = "branch.journal"
"""File that keeps each step of a trace under way; what is left of it was killed."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """What is asked for, as text: the range replaces the scene's own, `at` is a list with commas."""

    source: str
    begin: str | None = None
    end: str | None = None
    at: str | None = None
    overrides: tuple[Override, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Task:
    """A validated request; `at` in the units of the scene's view."""

    scene: Scene
    at: tuple[float, ...]


def validated(request: Request) -> Task:
    """Return the scene and points that a request asks for. Raises InputError, naming the option at fault."""
    scene = load(request.source, request.overrides)
    options = dict(zip(ends(scene), ("--from", "--to"), strict=True))
    given = {
        key: text for key, text in zip(options, (request.begin, request.end), strict=True) if text is not None
    }
    if given:
        try:
            scene = load(request.source, (*request.overrides, *given.items()))
        except InputError as error:
            raise error.renamed({key: options[key] for key in given}) from None
    return Task(scene=_titled(scene, request.overrides), at=_points(scene, request.at))


def _titled(scene: Scene, overrides: tuple[Override, ...]) -> Scene:
    """Return the scene with what was changed in its title."""
    changes = [f"{key} = {value or 'none'}" for key, value in overrides if key != "title"]
    return scene.model_copy(update={"title": ", ".join([scene.title, *changes])})


def _points(scene: Scene, text: str | None) -> tuple[float, ...]:
    """Return the numbers of a comma-separated list that all lie in the scene's range."""
    low, high = sorted(scene.trace.ends)
    values = [_number(item) for item in text.split(",")] if text is not None else []
    if not all(low <= value <= high for value in values):
        unit = view_of(scene).unit_name
        raise refused("--at", text, f"numbers from {low:g} to {high:g} ({unit}) with commas between them")
    return tuple(sorted(set(values)))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def interrupted(task: Task, folder: Path) -> Branch:
    """Return the interrupted branch that a directory holds, to be resumed.

    Raises InputError where there is none, or one of another scene.
    """
    from periodic import Branch, BranchFileError, recovered
    from reports.build import build

    places = [folder / JOURNAL, folder / INCOMPLETE / BRANCH, folder / BRANCH]
    there = [place for place in places if place.is_file()]
    path = max(there, key=lambda place: (place.name == JOURNAL, place.stat().st_mtime), default=None)
    if path is None:
        raise refused("--resume", str(folder), "a directory with the branch.nc of an interrupted trace")
    try:
        branch = recovered(path) if path.name == JOURNAL else Branch.load(path)
    except BranchFileError as error:
        raise refused("--resume", str(path), f"a branch that can be read ({error})") from error
    parameter, system = view_of(task.scene).parameter, build(task.scene)
    known = [quantity.name for quantity in branch.layout.parameters]
    for k, wanted in enumerate(system.parameters) if known == [p.name for p in system.parameters] else ():
        own = float(branch.points[0].orbit.parameter[k]) if len(branch) else wanted.value
        if wanted.name != parameter and own != wanted.value:
            allowed = f"one traced with {wanted.name} = {wanted.value:g}, as now (it has {own:g})"
            raise refused("--resume", str(path), allowed)
    return branch


def trace(
    task: Task,
    accuracy: Accuracy,
    progress: Callable[[Point], None] | None = None,
    method: Method | None = None,
    resume: Branch | None = None,
    folder: Path | None = None,
) -> Branch:
    """Build the system of a scene and trace its branch over its range, with a journal in `folder`.

    Raises InputError for a branch to resume that is another's, or a directory in use.
    """
    import periodic
    from reports.build import build

    view = view_of(task.scene)
    begin, end = (value * view.unit for value in task.scene.trace.ends)
    try:
        return periodic.trace(
            build(task.scene),
            view.parameter,
            (min(begin, end), max(begin, end)),
            start=begin,
            at=[value * view.unit for value in task.at],
            accuracy=accuracy,
            method=method,
            resume=resume,
            journal=None if folder is None else folder / JOURNAL,
            progress=progress,
        )
    except periodic.JournalError as error:
        allowed = "it must be one that no other trace is writing to"
        raise InputError("--out", f'is "{folder}"', allowed) from error
    except periodic.ResumeError as error:
        raise refused("--resume", "another branch", f"one of this scene ({error})") from error


SPEEDS = 33
"""Values at which a sweep in time lets the motion settle, each way."""

Settlements = tuple[list[tuple[float, float]], list[tuple[float, float]]]


def swept(task: Task, progress: Callable[[Settled], None] | None = None) -> Settlements:
    """Return what time integration settles to over the scene's range, rising and falling, as shown.

    Where it has not settled there is no point.
    """
    import numpy as np

    from reports.build import build
    from reports.sweep import sweep

    view, system = view_of(task.scene), build(task.scene)
    low, high = sorted(value * view.unit for value in task.scene.trace.ends)
    values = list(np.linspace(low, high, SPEEDS))
    ways = [sweep(system, view.parameter, way, progress=progress) for way in (values, values[::-1])]
    below, above = ([(m.parameter / view.unit, view.settled(m)) for m in way if m.steady] for way in ways)
    return below, above


def save(
    folder: Path, name: str, scene: Scene, branch: Branch, integrated: Settlements | None = None
) -> list[Path]:
    """Write the four files of a branch and return them. Raises InputError if one cannot be written."""
    from reports.picture import draw

    writers: dict[str, Callable[[Path], object]] = {
        BRANCH: branch.save,
        "branch.csv": lambda path: path.write_text(csv_text(scene, branch), "utf-8"),
        "branch.json": lambda path: path.write_text(json_text(name, scene, branch), "utf-8"),
        "branch.png": lambda path: draw(path, scene, branch, integrated),
    }
    return write(folder, writers)
