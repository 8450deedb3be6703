"""The work of one chunk, in whichever process: its cells one after another, each from the one before."""

from __future__ import annotations

import pickle
from collections.abc import Mapping, Sequence
from functools import lru_cache
from time import perf_counter
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from periodic.maps.cell import Chunk, Outcome
from periodic.maps.task import Read, Task
from periodic.orbit.orbit import Orbit
from periodic.results.branch import Branch
from periodic.tracing.resumption import start_of

FAILURES = (ValueError, ArithmeticError, RuntimeError, MemoryError)
"""What an engine, a model or a number may raise in a cell; anything else is a defect and ends the map."""


@lru_cache(maxsize=4)
def opened(parcel: bytes) -> Task:
    """Return the task of a parcel, compiled once in each process."""
    task: Task = pickle.loads(parcel)
    return task


def computed(given: Task | bytes, names: Sequence[str], chunk: Chunk) -> list[Outcome]:
    """Return what becomes of the cells of a chunk, on one thread: this is what executors are given."""
    task = given if isinstance(given, Task) else opened(given)
    near: Orbit | None = None
    outcomes = []
    with threadpool_limits(limits=1):
        for cell in chunk:
            values = dict(zip(names, cell, strict=True))
            begun = perf_counter()
            branch, reason = _attempted(task, values, near)
            numbers: dict[str, Read] = {}
            if branch is not None and not reason:
                near = start_of(branch).orbit
                numbers, reason = _read(task, branch)
            points, newton = (0, 0) if branch is None else (len(branch), branch.newton_iterations)
            outcomes.append(Outcome(cell, numbers, reason, False, points, newton, perf_counter() - begun))
        return outcomes


def _attempted(task: Task, values: Mapping[str, float], near: Orbit | None) -> tuple[Branch | None, str]:
    """The branch of a cell, from a neighbour's first orbit or as the task begins, and why it is incomplete.

    Where the neighbour's sheet does not reach the start the engine may find an orbit at a fold nearby: from
    there only a part of the branch would be traced.
    """
    if near is not None:
        branch, reason = _branch(task, values, near)
        if branch is not None and not reason and start_of(branch).parameter == task.begin:
            return branch, reason
    return _branch(task, values, None)


def _branch(task: Task, values: Mapping[str, float], near: Orbit | None) -> tuple[Branch | None, str]:
    try:
        branch = task.traced(values, near)
    except FAILURES as error:
        return None, _said(error)
    return branch, next((str(stop) for stop in branch.stops if stop.reason.numerical), "")


def _read(task: Task, branch: Branch) -> tuple[dict[str, Read], str]:
    """The numbers of a branch, or why there are none."""
    found: dict[str, Read] = {}
    for name, number in task.numbers.items():
        try:
            given = number(task, branch)
            parts = given if isinstance(given, Mapping) else {"": given}
            found |= {f"{name} {key}".strip(): _number(name, value) for key, value in parts.items()}
        except FAILURES as error:
            return {}, f"{name}: {_said(error)}"
    return found, ""


def _number(name: str, value: Any) -> Read:
    """A number, or a list of them. Raises TypeError for anything else that a user's function gives."""
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty((0, 0))
    if array.ndim > 1:
        raise TypeError(f"number {name} gave {value!r}; it must give a number or a sequence of numbers")
    found: Read = array.tolist()
    return found


def _said(error: BaseException) -> str:
    """An exception as a reason: its sentence, after the name of any but those that carry one by custom."""
    said = " ".join(str(error).split())
    return said if isinstance(error, ValueError) and said else f"{type(error).__name__}: {said}"
