"""A branch as a table: one row a point, with the columns' names and units."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from periodic.orbit.layout import Layout
from periodic.results.point import Point, multipliers_of
from periodic.results.record import Record

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

SAID = ("error_estimate", "multiplier_error", "parameter_error", "residual", "iterations", "slope")
"""What is said of each solution."""


MARKS = ("label", "event", "stable", "point", "multiplier", "multipliers")
"""Names that a table has besides its columns of numbers."""


def reserved(layout: Layout) -> set[str]:
    """Return the names that a column of the user's cannot have."""
    outputs = [name for output in layout.outputs for name in (output.name, *_measures(output.name))]
    return {*(p.name for p in layout.parameters), *outputs, *SAID, *MARKS}


def units(record: Record) -> dict[str, str]:
    """Return the columns of numbers that a branch has, with their units in SI.

    They are its parameters, of each output x the columns "x min", "x max" and "x p-p" (of equilibria "x"
    itself), the functionals asked for, and what is said of each solution.

    Parameters
    ----------
    record : Record
        The branch, perhaps without points.

    Returns
    -------
    dict
        Unit by name, in the order of a table.
    """
    still = any(point.equilibrium for point in record.points)
    asked = record.points[0].columns if record.points else record.made.get("columns", {})
    found = {q.name: q.unit for q in record.layout.parameters}
    for q in record.layout.outputs:
        found |= {name: q.unit for name in ([q.name] if still else _measures(q.name))}
    return {**found, **{name: "" for name in (*asked, *SAID) if name not in found}}


def _measures(output: str) -> tuple[str, str, str]:
    return f"{output} min", f"{output} max", f"{output} p-p"


def row(record: Record, point: Point) -> dict[str, float]:
    """Return the numbers of a point.

    Parameters
    ----------
    record : Record
        Its branch.
    point : Point
        The point.

    Returns
    -------
    dict
        SI values by the names of `units`, whatever their order.
    """
    error = point.error
    said = (error.orbit, error.multiplier, error.parameter, point.residual, point.iterations, point.slope)
    found = {**dict(zip(SAID, said, strict=True)), **point.columns}
    for name, low in point.minimum.items():
        high = point.maximum[name]
        found |= {name: high, **dict(zip(_measures(name), (low, high, high - low), strict=True))}
    both = zip(record.layout.parameters, point.orbit.parameter, strict=True)
    return found | {q.name: q.scale * float(value) for q, value in both}


def to_xarray(record: Record) -> xr.Dataset:
    """Return what `Branch.to_xarray` does."""
    import xarray as xr

    rows = [row(record, point) for point in record.points]
    data = {
        name: xr.Variable("point", np.array([found[name] for found in rows], dtype=float), {"units": unit})
        for name, unit in units(record).items()
    }
    multipliers = multipliers_of(record.points, len(record.layout.states))
    unit = "1/s" if any(point.equilibrium for point in record.points) else ""
    data["multipliers"] = xr.Variable(("point", "multiplier"), multipliers, {"units": unit})
    marks = {
        "label": np.array([p.label.value for p in record.points], dtype=object),
        "event": np.array([p.event for p in record.points], dtype=object),
        "stable": np.array([p.stable for p in record.points], dtype=bool),
    }
    coordinates = {name: ("point", values) for name, values in marks.items()}
    return xr.Dataset(data, coordinates, {"parameter": record.parameter, "stop": str(record.stop)})


def to_pandas(record: Record) -> pd.DataFrame:
    """Return what `Branch.to_pandas` does."""
    import pandas as pd

    data = to_xarray(record)
    marks = {name: data[name].values for name in ("label", "event", "stable")}
    numbers = {name: data[name].values for name in units(record)}
    multipliers = {f"multiplier {k + 1}": column for k, column in enumerate(data["multipliers"].values.T)}
    frame = pd.DataFrame(
        {**marks, **numbers, **multipliers}, index=pd.RangeIndex(len(record.points), name="point")
    )
    named = {name: data[name].attrs["units"] for name in numbers}
    frame.attrs = {
        **data.attrs,
        "units": named | dict.fromkeys(multipliers, data["multipliers"].attrs["units"]),
    }
    return frame
