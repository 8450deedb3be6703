"""One map of a scene, from a validated task to files on disk."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import periodic as per
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError, refused

from ..files import unwritable
from ..request import Task
from ..view import view_of

if TYPE_CHECKING:
    import xarray as xr

MAP = "map.nc"
"""File of a map in its directory."""

CELLS = 4
"""Least number of cells of an adaptive map, for each parameter's two ends."""


@dataclass(frozen=True, kw_only=True)
class How:
    """How a map is computed: name of the accuracy, processes, cells of an adaptive map, going on or anew."""

    accuracy: str
    jobs: int | None = None
    adaptive: int | None = None
    resume: bool = False


def numbers(outputs: Sequence[str]) -> dict[str, per.maps.Number]:
    """Return what is read off each branch: of the first output and, where there is one, of the load."""
    swing = per.PeakToPeak(outputs[0])
    found: dict[str, per.maps.Number] = {
        "peak": per.maps.Highest(swing),
        "stable peak": per.maps.Highest(swing, stable=True),
        "folds": per.maps.Places("LP"),
        "doublings": per.maps.Places("PD"),
        "stable": per.maps.StableRanges(),
    }
    return found | ({"lowest load": per.maps.Lowest(per.Minimum("load"))} if "load" in outputs else {})


def computed(
    task: Task,
    over: Mapping[str, Sequence[float]],
    how: How,
    folder: Path,
    progress: Callable[[per.maps.Progress], None] | None,
) -> xr.Dataset:
    """Return the map of a scene over its range, kept in `folder`. Raises InputError, and what a map does."""
    view, system = view_of(task.scene), build(task.scene)
    begin, end = (value * view.unit for value in task.scene.trace.ends)
    try:
        given = per.maps.Task(
            system,
            view.parameter,
            (begin, end),
            numbers=numbers([output.name for output in system.outputs]),
            tol=per.Accuracy[how.accuracy],
        )
        store = folder / MAP
        return per.design_map(given, _plan(over, how), how.jobs, store, how.resume, progress=progress)
    except per.maps.MapFileError as error:
        why = str(error).partition("; choose another")[0]
        raise InputError("--out", f'is "{folder}"', f"it must be fit for this map ({why})") from error
    except OSError as error:
        raise unwritable(folder, error) from error
    except ValueError as error:
        raise refused("--over", ", ".join(over), f"what a map can be over ({error})") from error


def _plan(over: Mapping[str, Sequence[float]], how: How) -> per.maps.Grid | per.maps.Adaptive:
    """All combinations of the values, or cells of the box between the least and the largest."""
    if how.adaptive is None:
        return per.maps.Grid(over)
    ranges = {name: (min(values), max(values)) for name, values in over.items()}
    return per.maps.Adaptive(ranges, "peak", max(how.adaptive, CELLS * len(over)))


def cells(over: Mapping[str, Sequence[float]], how: How) -> int:
    """Return how many cells there will be."""
    return how.adaptive or math.prod(map(len, over.values()))
