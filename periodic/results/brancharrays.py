"""A branch as named arrays and attributes, numbers and texts only, and back."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import Course
from periodic.correction.error import ErrorEstimate
from periodic.linear.unknowns import Increment
from periodic.orbit.layout import Layout, Quantity
from periodic.orbit.orbit import Orbit
from periodic.orbit.shallow import shallow
from periodic.results.checkpoint import Checkpoint
from periodic.results.guarded import DamagedError
from periodic.results.point import Point, known_of, multipliers_of
from periodic.results.ragged import Arrays, Tables, orbit_tables, orbits_of, scheme_said
from periodic.results.record import Record
from periodic.results.stop import Reason, Stop

FORMAT = "orbitrace branch 6"

DAMAGE = (
    *(KeyError, ValueError, IndexError, TypeError, RuntimeError, AttributeError),
    *(OverflowError, MemoryError, EOFError),
)
"""What reading numbers that make no sense raises."""

BY_OUTPUT = ("minimum", "maximum", "minimum_slope", "maximum_slope")
"""Numbers of a point for each output."""

GROUPS = ("states", "algebraics", "outputs", "parameters")

TANGENT = tuple(field.name for field in fields(Increment))
"""The arrays of a tangent."""


def tables(record: Record) -> Tables:
    """Return all arrays of a branch by name, with their dimensions.

    Parameters
    ----------
    record : Record
        The branch.

    Returns
    -------
    dict
        Name: (dimensions, array).
    """
    points, layout = record.points, record.layout
    data: Tables = {name: (("point",), np.array(column)) for name, column in _per_point(points).items()}
    outputs = [q.name for q in layout.outputs]
    columns = list(points[0].columns) if points else []
    found = multipliers_of(points, len(layout.states))
    kind = "state" if found.shape[1] == len(layout.states) else "multiplier"
    wide = {
        **{
            name: (
                "output",
                [[getattr(p, name).get(o, np.nan) for o in outputs] for p in points],
                len(outputs),
            )
            for name in BY_OUTPUT
        },
        "columns": ("column", [[*p.columns.values()] for p in points], len(columns)),
        "multiplier_real": (kind, found.real, found.shape[1]),
        "multiplier_imag": (kind, found.imag, found.shape[1]),
    }
    for name, (dimension, rows, width) in wide.items():
        data[name] = (("point", dimension), np.array(rows, dtype=float).reshape(len(points), width))
    values = [part.ravel() for c in record.checkpoints for part in _parts(c)]
    data["checkpoint_values"] = (("checkpoint_value",), np.concatenate([np.zeros(0), *values]))
    return data | orbit_tables([p.orbit for p in points], layout)


def _per_point(points: Sequence[Point]) -> dict[str, list[Any]]:
    return {
        "value": [p.parameter for p in points],
        "label": [p.label.value for p in points],
        "stable": [p.stable for p in points],
        "error_estimate": [p.error.orbit for p in points],
        "multiplier_error": [p.error.multiplier for p in points],
        "parameter_error": [p.error.parameter for p in points],
        "peak_error": [p.error.peaks for p in points],
        "residual": [p.residual for p in points],
        "newton_iterations": [p.iterations for p in points],
        "slope": [p.slope for p in points],
        "conservative": [p.conservative for p in points],
        "trivial": [np.nan if p.trivial is None else p.trivial for p in points],
        "marginal": [p.marginal for p in points],
        "event": [p.event for p in points],
    }


def attributes(record: Record) -> dict[str, Any]:
    """Return what else is said of a branch: names, units, reasons.

    Parameters
    ----------
    record : Record
        The branch.

    Returns
    -------
    dict
        Texts (JSON where they are lists or dictionaries) and numbers, by name.
    """
    points = record.points
    quantities = {g: [[q.name, q.unit, q.scale] for q in getattr(record.layout, g)] for g in GROUPS}
    said = {
        "layout": {
            **quantities,
            "frequency": record.layout.frequency,
            "factor": record.layout.factor,
            "held": record.layout.held,
        },
        "labels": {p.label.value: p.label.critical for p in points},
        "stop": _said(record.stop),
        "stop_backwards": record.stop_backwards and _said(record.stop_backwards),
        "versions": record.versions,
        "columns": list(points[0].columns) if points else [],
        "checkpoints": [_progress(c) for c in record.checkpoints],
        "made": record.made,
    }
    return {
        "format": FORMAT,
        "parameter": record.parameter,
        **scheme_said([p.orbit for p in points]),
        "newton_iterations": record.newton_iterations,
        "elapsed_s": record.elapsed,
        "backwards": record.backwards,
        **{name: json.dumps(item) for name, item in said.items()},
    }


def _said(stop: Stop) -> list[str]:
    return [stop.reason.name, stop.detail]


def _parts(checkpoint: Checkpoint) -> list[np.ndarray]:
    """The arrays of a checkpoint."""
    return [*checkpoint.tangent.save().values(), checkpoint.fundamental]


def _progress(checkpoint: Checkpoint) -> dict[str, Any]:
    """A checkpoint without its arrays, but with their shapes."""
    plain = shallow(checkpoint)
    del plain["tangent"], plain["fundamental"]
    course = {"gone": checkpoint.course.gone, "margins": dict(checkpoint.course.margins)}
    return {**plain, "course": course, "shapes": [a.shape for a in _parts(checkpoint)]}


def record_of(arrays: Arrays, attributes: Mapping[str, Any]) -> Record:
    """Return the branch of arrays and attributes.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        As from `tables`, without dimensions.
    attributes : mapping
        As from `attributes`.

    Returns
    -------
    Record
        The branch.

    Raises
    ------
    Exception
        One of DAMAGE where they make no sense.
    """
    names = ("layout", "labels", "stop", "stop_backwards", "versions", "columns", "checkpoints", "made")
    said = {**attributes, **{name: json.loads(attributes[name]) for name in names}}
    layout, back = _layout(said["layout"]), said["stop_backwards"]
    _check_names(said, layout, arrays["event"])
    orbits = orbits_of(arrays, said, layout)
    labels = {text: _label(text, critical) for text, critical in said["labels"].items()}
    return Record(
        parameter=said["parameter"],
        layout=layout,
        points=tuple(_point(arrays, i, orbit, labels, said["columns"]) for i, orbit in enumerate(orbits)),
        stop=_stop(said["stop"]),
        stop_backwards=_stop(back) if back else None,
        newton_iterations=int(said["newton_iterations"]),
        elapsed=float(said["elapsed_s"]),
        versions=said["versions"],
        checkpoints=_checkpoints(arrays["checkpoint_values"], said["checkpoints"]),
        backwards=int(said["backwards"]),
        made=said["made"],
    )


def _check_names(said: Mapping[str, Any], layout: Layout, events: np.ndarray) -> None:
    """Refuse names that are none, or that a terminal would obey; those of quantities their layout refuses."""
    if not all(isinstance(said[name], dict) for name in ("labels", "versions", "made")):
        raise ValueError("labels, versions or made are not by name")
    if said["parameter"] not in [q.name for q in layout.parameters]:
        raise DamagedError("it is over a parameter that it has not")
    made = [name for group in ("events", "peaks", "columns") for name in said["made"].get(group, ())]
    versions = [text for pair in said["versions"].items() for text in pair]
    for name in (*made, *versions, *said["columns"], *map(str, events)):
        if not isinstance(name, str) or not name.isprintable():
            raise DamagedError("it has a name that is not one line of text")


def _layout(said: dict[str, Any]) -> Layout:
    groups = {name: tuple(Quantity(*q) for q in said[name]) for name in GROUPS}
    held = tuple((str(name), float(value)) for name, value in said.get("held", ()))
    factor = float(said.get("factor", 1.0))
    return Layout(**groups, frequency=tuple(said["frequency"]), factor=factor, held=held)


def _label(text: str, critical: bool) -> Label:
    """A label of this name; one that nobody has registered yet is as the file has it."""
    return Label(text) if text in Label.known() else Label.register(text, critical)


def _stop(pair: list[str]) -> Stop:
    return Stop(Reason[pair[0]], pair[1])


def _checkpoints(values: np.ndarray, said: list[dict[str, Any]]) -> tuple[Checkpoint, ...]:
    found = []
    for numbers in said:
        shapes, parts = numbers.pop("shapes"), []
        for shape in shapes:
            parts.append(values[: math.prod(shape)].reshape(shape))
            values = values[math.prod(shape) :]
        tangent = Increment(**dict(zip(TANGENT, parts[:-1], strict=True)))
        course = Course(**numbers.pop("course"))
        found.append(Checkpoint(tangent=tangent, fundamental=parts[-1], course=course, **numbers))
    return tuple(found)


def _number_or_nan(arrays: Arrays, name: str, i: int) -> float:
    """A number of a point; NaN where a file is older than it."""
    return float(arrays[name][i]) if name in arrays else np.nan


def _point(arrays: Arrays, i: int, orbit: Orbit, labels: dict[str, Label], columns: list[str]) -> Point:
    assert orbit.layout is not None
    names = [q.name for q in orbit.layout.outputs]
    known = _number_or_nan(arrays, "peak_error", i)

    def number(name: str) -> float:
        return float(arrays[name][i])

    def by_name(names: list[str], table: str) -> dict[str, float]:
        return dict(zip(names, map(float, arrays[table][i]), strict=True))

    return Point(
        orbit=orbit,
        parameter=number("value"),
        label=labels[str(arrays["label"][i])],
        multipliers=known_of(arrays["multiplier_real"][i] + 1j * arrays["multiplier_imag"][i]),
        minimum=by_name(names, "minimum"),
        maximum=by_name(names, "maximum"),
        error=ErrorEstimate(
            *map(number, ("error_estimate", "multiplier_error", "parameter_error")), peaks=known
        ),
        residual=number("residual"),
        iterations=int(number("newton_iterations")),
        slope=number("slope"),
        trivial=None if np.isnan(number("trivial")) else number("trivial"),
        conservative=bool(arrays["conservative"][i]),
        marginal=bool(arrays["marginal"][i]),
        event=str(arrays["event"][i]),
        columns=by_name(columns, "columns"),
        minimum_slope=by_name(names, "minimum_slope") if "minimum_slope" in arrays else {},
        maximum_slope=by_name(names, "maximum_slope") if "maximum_slope" in arrays else {},
    )
