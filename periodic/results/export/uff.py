"""Export as UFF58, functions at nodal degrees of freedom, which programs of modal analysis read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from periodic.orbit.scheme import Array
from periodic.results.export.content import Content
from periodic.results.files import replacing
from periodic.results.textcell import text_cell

GENERAL, TIME_RESPONSE = 0, 1
"""Function types of data set 58."""

TIME, UNKNOWN = 17, 0
KINDS = {"m": 8, "N": 9, "m/s": 11, "m/s^2": 12, "Pa": 15}
"""Specific data types by SI unit."""

SI = 1
"""Code of the units of data set 164."""

WIDTHS = {"id1": 80, "id2": 80, "id3": 80, "rsp_ent_name": 10}
"""Characters of fields that have another number than 20."""

EXTRA = "pip install 'orbitrace[uff]'"
"""What installs the package that writes the format."""


def write_uff(path: Path, content: Content) -> list[Path]:
    """Write the peak to peak of each output over the parameter, and each orbit's signals as time responses.

    A signal is a node, numbered from 1 in the order of the file; its name stands in the first line, and the
    parameter's value in the second and as the value of the z axis.
    """
    try:
        from pyuff import UFF, prepare_164
    except ModuleNotFoundError:
        raise ModuleNotFoundError(f"UFF58 needs the package pyuff: {EXTRA}", name="pyuff") from None
    units = prepare_164(
        units_code=SI, units_description="SI", temp_mode=1, length=1.0, force=1.0, temp=1.0, temp_offset=0.0
    )
    with replacing(path) as part:
        UFF(str(part)).write_sets([units, *_amplitudes(content), *_orbits(content)], "overwrite")
    return [path]


def _amplitudes(content: Content) -> Iterator[dict[str, Any]]:
    """Peak to peak of each output along the branch; one point is no function."""
    unit, across = content.numbers[content.parameter]
    for k, name in enumerate(content.outputs if len(across) > 1 else ()):
        column = f"{name} p-p" if f"{name} p-p" in content.numbers else name
        of, up = content.numbers[column]
        yield _set(
            k + 1, column, across, up,
            id2=f"over {content.parameter}", func_type=GENERAL, abscissa_spacing=0,
            abscissa_axis_lab=content.parameter, abscissa_axis_units_lab=unit or "NONE",
            ordinate_spec_data_type=KINDS.get(of, UNKNOWN), ordinate_axis_units_lab=of or "NONE",
        )  # fmt: skip


def _orbits(content: Content) -> Iterator[dict[str, Any]]:
    """Each signal of each point over a period."""
    unit, across = content.numbers[content.parameter]
    for point, (value, times) in enumerate(zip(across, content.times, strict=True)):
        where = " ".join(filter(None, [f"{content.parameter} = {value:.15g}", unit, content.labels[point]]))
        for k, (name, (of, values)) in enumerate(content.signals.items()):
            yield _set(
                k + 1, name, times, values[point],
                id2=where, func_type=TIME_RESPONSE, abscissa_spacing=1, z_axis_value=float(value),
                load_case_id=point, abscissa_spec_data_type=TIME, abscissa_axis_lab="time",
                abscissa_axis_units_lab="s", z_axis_axis_lab=content.parameter,
                ordinate_spec_data_type=KINDS.get(of, UNKNOWN), ordinate_axis_units_lab=of or "NONE",
            )  # fmt: skip


def _set(node: int, name: str, x: Array, y: Array, **entries: Any) -> dict[str, Any]:
    """A data set 58 of a signal."""
    labels = {"id1": name, "id3": "orbitrace", "ordinate_axis_lab": name, "rsp_ent_name": name, **entries}
    texts = {key: _text(key, item) for key, item in labels.items() if isinstance(item, str)}
    degree = {"rsp_node": node, "rsp_dir": 0, "ref_node": 0, "ref_dir": 0, "orddenom_spec_data_type": UNKNOWN}
    return {"type": 58, "binary": 0, **degree, **labels, **texts, "x": np.array(x), "data": np.array(y)}


def _text(field: str, text: str) -> str:
    """A text as a field takes it; "    -1", wherever it stands, would end the data set."""
    return text_cell(" ".join(text.split()))[: WIDTHS.get(field, 20)]
