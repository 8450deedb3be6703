"""Export to HDF5: plain arrays in two groups, units in their attributes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from periodic.results.export.content import Content, Quantities
from periodic.results.files import replacing

if TYPE_CHECKING:
    import h5py


def write_hdf5(path: Path, content: Content) -> list[Path]:
    """Write /points/NAME (points,) and /orbits/NAME (points, samples), each with the attribute `units`.

    Multipliers stand in /points/multipliers_real and /points/multipliers_imag (points, n); times in
    /orbits/t. A name that holds a slash, which HDF5 takes for a path, has a division sign in its place, and
    one that is taken, as t or ".", an underscore more.
    """
    import h5py

    with replacing(path) as part, h5py.File(part, "w") as file:
        file.attrs.update(parameter=content.parameter, stop=content.stop, program=content.program)
        points, orbits = file.create_group("points"), file.create_group("orbits")
        text = h5py.string_dtype("utf-8")
        points.create_dataset("label", data=list(content.labels), shape=(len(content.labels),), dtype=text)
        points["stable"] = content.stable
        points["multipliers_real"] = content.multipliers.real
        points["multipliers_imag"] = content.multipliers.imag
        _add(points, content.numbers)
        _add(orbits, {"t": ("s", content.times)})
        _add(orbits, content.signals)
    return [path]


def _add(group: h5py.Group, quantities: Quantities) -> None:
    for name, (unit, values) in quantities.items():
        free = name.replace("/", "\N{DIVISION SLASH}")
        while free in group:
            free += "_"
        added = group.create_dataset(free, data=values)
        added.attrs["units"] = unit
