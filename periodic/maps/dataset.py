"""A map as an xarray Dataset: numbers of branches over the parameters that are varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.maps.cell import Cell, Outcome
from periodic.maps.grid import Plan
from periodic.maps.task import Task
from periodic.results.signals import deferred

if TYPE_CHECKING:
    import xarray as xr

RECORDED = ("status", "reason", "points", "newton", "seconds")
"""Variables that a map has for each cell besides its numbers."""

NONE = Outcome(())
"""Stands for a cell that is not computed yet."""


def dataset(task: Task, plan: Plan, found: Mapping[Cell, Outcome]) -> xr.Dataset:
    """Return what is known of a map.

    Numbers of a branch that has several, one for each sheet, fold or range, have a further dimension, filled
    up with NaN. status is done, failed (with a reason), lost (with its worker) or not done.
    """
    with deferred():  # interrupted half-way, it raises anything
        import xarray as xr

    laid = plan.arranged(found)
    outcomes = [found.get(cell, NONE) for cell in laid.cells]
    over, shape = tuple(laid.dimensions), tuple(laid.dimensions.values())
    units, data = task.units, {}
    for name in dict.fromkeys(name for outcome in outcomes for name in outcome.numbers):
        further, values = _column(_owner(task, name), [outcome.numbers.get(name) for outcome in outcomes])
        values = values.reshape(*shape, *values.shape[1:])
        data[name] = ((*over, *further), values, {"units": units.get(name, "")})
    statements: dict[str, Any] = {
        "status": np.array([_status(outcome) for outcome in outcomes], dtype=object),
        "reason": np.array([outcome.reason for outcome in outcomes], dtype=object),
        **{name: np.array([getattr(outcome, name) for outcome in outcomes]) for name in RECORDED[2:]},
    }
    data |= {name: (over, values.reshape(shape), {}) for name, values in statements.items()}
    data["seconds"][2]["units"] = "s"
    known = {p.name: p.unit for p in task.system.parameters}
    axes = {name: (dim, np.array(v), {"units": known[name]}) for name, (dim, v) in laid.coordinates.items()}
    return xr.Dataset(data, axes, {"parameter": task.parameter, "bounds": [float(b) for b in task.bounds]})


def check_numbers(task: Task, names: Sequence[str]) -> None:
    """Raise ValueError for numbers whose names the result uses otherwise."""
    taken = {*RECORDED, *names, "cell"}
    for name in task.numbers:
        if name in taken:
            raise ValueError(f"numbers has {name!r}, which a map has already; it must be another name")


def _owner(task: Task, column: str) -> str:
    """The number that a column comes from: "peak" of "peak at"."""
    return max((name for name in task.numbers if f"{column} ".startswith(f"{name} ")), key=len)


def _column(name: str, given: Sequence[Any]) -> tuple[tuple[str, ...], np.ndarray]:
    """A number over all cells, with a further dimension if any cell has several."""
    several = [value for value in given if isinstance(value, Sequence)]
    if not several:
        return (), np.array([np.nan if value is None else value for value in given], dtype=float)
    width = max(map(len, several))
    values = np.full((len(given), width), np.nan)
    for row, value in zip(values, given, strict=True):
        some = value if isinstance(value, Sequence) else [value]
        if value is not None:
            row[: len(some)] = some
    return (f"{name} number",), values


def _status(outcome: Outcome) -> str:
    if outcome is NONE:
        return "not done"
    if outcome.lost:
        return "lost"
    return "failed" if outcome.reason else "done"
