"""An atlas of a scene, from a validated task to files on disk."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import periodic as per
from periodic.phasespace import Atlas
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError

from ..files import write
from ..motions.options import Ranges
from ..request import Task
from ..view import view_of


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What is asked for: how many values, and how thoroughly at each."""

    count: int
    box: Ranges
    periods: int
    starts: int
    jobs: int
    resume: bool


def charted(task: Task, asked: Asked, store: Path) -> Atlas:
    """Chart the scene over its range. Raises InputError, SearchInterrupted."""
    begin, end = task.scene.trace.bounds
    given: dict[str, Any] = {"count": asked.count, "periods": asked.periods, "starts": asked.starts}
    try:
        with per.working(asked.jobs, store, asked.resume):
            name, bounds = view_of(task.scene).parameter, (min(begin, end), max(begin, end))
            return per.atlas(build(task.scene), name, bounds, box=asked.box, **given)
    except ValueError as error:
        raise InputError("atlas", "cannot be made", str(error)) from error


def save(task: Task, folder: Path, atlas: Atlas, *, html: bool) -> list[Path]:
    """Write atlas.png, atlas.txt and, if asked, atlas.html, and return them. Raises InputError."""
    writers: dict[str, Callable[[Path], object]] = {
        "atlas.png": lambda path: atlas.plot().savefig(path, format="png", dpi=150),
        "atlas.txt": lambda path: path.write_text(f"{atlas}\n", "utf-8"),
    }
    if html:
        writers["atlas.html"] = lambda path: _page(task, path, atlas)
    return write(folder, writers)


def _page(task: Task, path: Path, atlas: Atlas) -> None:
    """Write the page, under a name that ends in .html."""
    per.page(atlas, path.with_suffix(".html"), title=task.scene.title).replace(path)
