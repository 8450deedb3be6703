"""The command `orbitrace map`: options, sentences and exit codes around a map.

What is imported here is small, so that --help is quick.
"""

from __future__ import annotations

import warnings
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..options import (
    DONE,
    INTERRUPTED,
    STOPPED_EARLY,
    Changes,
    Out,
    Source,
    count,
    pairs,
    say,
    tell,
    tell_written,
)
from ..trace.command import Accuracy, Dial, From, To

if TYPE_CHECKING:
    import xarray as xr

    from ..map.run import How
    from ..request import Task

Over = Annotated[
    list[str],
    typer.Option(
        "--over", metavar="KEY=FROM:TO:COUNT", help="A parameter and its values, as preload=100:2000:40."
    ),
]
Jobs = Annotated[str | None, typer.Option("--jobs", metavar="N", help="Processes. [default: one each core]")]
Cells = Annotated[
    str | None,
    typer.Option("--adaptive", metavar="N", help="N cells where the peak changes most, instead of a grid."),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the map in DIR; all else as it was.")]


def map_(
    scene: Source,
    over: Over,
    begin: From = None,
    end: To = None,
    changes: Changes = None,
    accuracy: Dial = Accuracy.STANDARD,
    adaptive: Cells = None,
    jobs: Jobs = None,
    out: Out = None,
    resume: Resume = False,
) -> int:
    """Trace the branch of a scene for every combination of some parameters: peaks, folds, stable ranges.

    Writes map.nc and, over one or two parameters, map.png. Exit code 0: done; 2: bad input; 3: some cells
    have no numbers, each with its reason. Ctrl-C keeps what is there.
    """
    from symbolic.scenes.errors import InputError
    from symbolic.scenes.names import short_name

    from ..map.axes import axes
    from ..request import Request, validated
    from ..settings import folder_for, settings

    overrides = pairs(changes)
    task = validated(Request(source=scene, begin=begin, end=end, overrides=overrides))
    values, keys = axes(scene, overrides, over)
    cells, processes = count("--adaptive", adaptive), count("--jobs", jobs)
    name, asked = short_name(scene), {"over": values, "cells": cells, "accuracy": accuracy.value}
    from ..map.run import How

    if cells is not None and find_spec("adaptive") is None:
        missing = "needs the package adaptive"
        raise InputError("--adaptive", missing, "pip install 'orbitrace[adaptive]' installs it")
    how = How(accuracy=accuracy.name, jobs=processes, adaptive=cells, resume=resume)
    with folder_for(out, settings(name, task.scene, "map", **asked), resume) as folder:
        return _run(name, task, values, keys, how, folder)


def _run(
    name: str, task: Task, values: dict[str, list[float]], keys: dict[str, str], how: How, folder: Path
) -> int:
    """Compute, draw and tell; return the exit code."""
    from ..console import status
    from ..interrupts import interrupting_once
    from ..map import run

    try:
        with interrupting_once(), status(f"mapping {name}") as update, warnings.catch_warnings():
            warnings.showwarning = lambda message, *_, **__: say(str(message))
            show = None if update is None else lambda progress: update(f"mapping {name}: {progress}")
            data = run.computed(task, values, how, folder, show)
    except KeyboardInterrupt as interrupted:  # with a sentence once there are cells
        say((str(interrupted).partition(", which")[0] or "interrupted") + "; --resume goes on")
        return INTERRUPTED
    _told(task, data, keys, folder)
    return _verdict(data)


def _told(task: Task, data: xr.Dataset, keys: dict[str, str], folder: Path) -> None:
    """Draw, and print what there is in short."""
    from ..files import write
    from ..map.picture import draw, drawable
    from ..map.run import MAP

    files = [folder / MAP]
    if drawable(keys, data):
        files += write(folder, {"map.png": lambda path: draw(path, task.scene.title, data, keys)})
    tell(task.scene.title)
    if "peak" in data:
        peak = data["peak"]
        tell(f"peak from {float(peak.min()):.6g} to {float(peak.max()):.6g} {peak.attrs.get('units', '')}")
    done = int((data["status"] == "done").sum())
    tell(f"{done} of {data['status'].size} cells, {float(data['seconds'].sum()):.1f} s of work")
    tell_written(files)


def _verdict(data: xr.Dataset) -> int:
    """Return the exit code, and say on standard error which reasons cells without numbers have."""
    reasons = [str(reason) for reason in data["reason"].values.ravel() if reason]
    if not reasons:
        return DONE
    say(f"{len(reasons)} of {data['reason'].size} cells have no numbers; the first: {reasons[0]}")
    return STOPPED_EARLY
