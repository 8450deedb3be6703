"""Data sets of the universal file: which there are, and what stands in each."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from periodic.results.export import uff
from periodic.results.export.content import Content
from periodic.results.export.uff import (
    GENERAL,
    KINDS,
    TIME,
    TIME_RESPONSE,
    UNKNOWN,
    _amplitudes,
    _orbits,
    _text,
)


def content(points: int = 2) -> Content:
    """A branch in the speed of two outputs, one of them with a peak to peak, and a signal of its own."""
    numbers: Any = {
        "speed": ("rad/s", np.arange(1.0, 1.0 + points)),
        "x p-p": ("m", 10.0 * np.arange(points)),
        "ratio": ("", 5.0 + np.arange(points)),
    }
    times = np.outer(1.0 + np.arange(points), [0.0, 0.5])
    signals: Any = {"x": ("m", times + 1), "force": ("N", times + 2), "ratio": ("", times + 3)}
    return Content(
        parameter="speed",
        outputs=("x", "ratio"),
        stop="",
        program="",
        numbers=numbers,
        labels=("", "LP", "", "")[:points],
        stable=np.ones(points, dtype=bool),
        multipliers=np.zeros((points, 0), dtype=complex),
        times=times,
        signals=signals,
    )


def test_amplitudes_along_a_branch() -> None:
    """Assert a set for each output, numbered from 1, of its peak to peak where there is one."""
    first, second = _amplitudes(content())
    for node, found, column, up in ((1, first, "x p-p", [0.0, 10.0]), (2, second, "ratio", [5.0, 6.0])):
        assert (found["type"], found["rsp_node"], found["id1"], found["func_type"]) == (
            58,
            node,
            column,
            GENERAL,
        )
        assert (found["id2"], found["abscissa_axis_units_lab"]) == ("over speed", "rad/s")
        assert found["x"].tolist() == [1.0, 2.0] and found["data"].tolist() == up
    assert (first["ordinate_spec_data_type"], first["ordinate_axis_units_lab"]) == (KINDS["m"], "m")
    assert (second["ordinate_spec_data_type"], second["ordinate_axis_units_lab"]) == (UNKNOWN, "NONE")
    assert list(_amplitudes(content(1))) == []


def test_signals_of_orbits() -> None:
    """Assert a set for each signal of each point, numbered from 1 again, with its parameter and label."""
    sets = list(_orbits(content()))
    assert [found["rsp_node"] for found in sets] == [1, 2, 3, 1, 2, 3]
    assert [found["load_case_id"] for found in sets] == [0, 0, 0, 1, 1, 1]
    assert [found["id2"] for found in sets[2:4]] == ["speed = 1 rad/s", "speed = 2 rad/s LP"]
    last = sets[4]
    assert (last["id1"], last["z_axis_value"], last["func_type"]) == ("force", 2.0, TIME_RESPONSE)
    assert (last["abscissa_spec_data_type"], last["ordinate_spec_data_type"]) == (TIME, KINDS["N"])
    assert last["x"].tolist() == [0.0, 1.0] and last["data"].tolist() == [2.0, 3.0]


@pytest.mark.parametrize(
    ("field", "text", "found"),
    [
        ("id1", "x" * 99, "x" * 80),
        ("rsp_ent_name", "x" * 99, "x" * 10),
        ("ordinate_axis_lab", "x" * 99, "x" * 20),
        ("id1", " a \n    -1  b ", "a -1 b"),
    ],
)
def test_texts_that_fields_take(field: str, text: str, found: str) -> None:
    """Assert their widths, and that no text ends a data set."""
    assert _text(field, text) == found and uff.SI == 1
