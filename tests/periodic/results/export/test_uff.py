"""Data sets of the universal file: which there are, and what stands in each."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.results.export import uff
from periodic.results.export.content import Content
from periodic.results.export.texts import write_csv
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


COMMON: dict[str, Any] = {
    "type": 58,
    "binary": 0,
    "rsp_dir": 0,
    "ref_node": 0,
    "ref_dir": 0,
    "orddenom_spec_data_type": 0,
    "id3": "orbitrace",
}
"""What is the same in every data set."""


def test_every_entry_of_a_data_set() -> None:
    """Assert codes and texts of an amplitude and of a signal, as the format numbers them."""
    (amplitude, _), signal = _amplitudes(content()), list(_orbits(content()))[4]
    assert {key: item for key, item in amplitude.items() if key not in ("x", "data")} == COMMON | {
        "rsp_node": 1,
        "id1": "x p-p",
        "id2": "over speed",
        "ordinate_axis_lab": "x p-p",
        "rsp_ent_name": "x p-p",
        "func_type": 0,
        "abscissa_spacing": 0,
        "abscissa_axis_lab": "speed",
        "abscissa_axis_units_lab": "rad/s",
        "ordinate_spec_data_type": 8,
        "ordinate_axis_units_lab": "m",
    }
    assert {key: item for key, item in signal.items() if key not in ("x", "data")} == COMMON | {
        "rsp_node": 2,
        "id1": "force",
        "id2": "speed = 2 rad/s LP",
        "ordinate_axis_lab": "force",
        "rsp_ent_name": "force",
        "func_type": 1,
        "abscissa_spacing": 1,
        "z_axis_value": 2.0,
        "load_case_id": 1,
        "abscissa_spec_data_type": 17,
        "abscissa_axis_lab": "time",
        "abscissa_axis_units_lab": "s",
        "z_axis_axis_lab": "speed",
        "ordinate_spec_data_type": 9,
        "ordinate_axis_units_lab": "N",
    }
    assert KINDS == {"m": 8, "N": 9, "m/s": 11, "m/s^2": 12, "Pa": 15}


def test_what_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert units in SI, then amplitudes, then orbits, given to the package that writes them."""
    written: list[Any] = []

    class Writer:
        """Writes how many sets it is given."""

        def __init__(self, name: str) -> None:
            self.name = name

        def write_sets(self, sets: list[Any], mode: str) -> None:
            written.extend([mode, *sets])
            Path(self.name).write_text(str(len(sets)), "utf-8")

    package = SimpleNamespace(UFF=Writer, prepare_164=dict)
    monkeypatch.setitem(sys.modules, "pyuff", package)
    file = tmp_path / "a.uff"
    assert uff.write_uff(file, content()) == [file] and file.read_text("utf-8") == "9"
    assert written[0] == "overwrite"
    assert written[1] == {
        "units_code": 1,
        "units_description": "SI",
        "temp_mode": 1,
        "length": 1.0,
        "force": 1.0,
        "temp": 1.0,
        "temp_offset": 0.0,
    }
    assert [found["func_type"] for found in written[2:]] == [0, 0, 1, 1, 1, 1, 1, 1]
    monkeypatch.setitem(sys.modules, "pyuff", None)
    with pytest.raises(ModuleNotFoundError, match="^UFF58 needs the package pyuff: pip install ") as found:
        uff.write_uff(file, content())
    assert found.value.name == "pyuff"


def test_tables_of_text(tmp_path: Path) -> None:
    """Assert every cell of both files of CSV."""
    file = tmp_path / "a.csv"
    of = replace(
        content(), multipliers=np.array([[0.5 + 0.25j], [-1.0 - 0.5j]]), stable=np.array([True, False])
    )
    beside = tmp_path / "a-orbits.csv"
    assert write_csv(file, of) == [file, beside]
    assert file.read_text("utf-8").split("\n") == [
        "point,label,stable,speed [rad/s],x p-p [m],ratio,multiplier 1 re,multiplier 1 im",
        "0,,true,1.0,0.0,5.0,0.5,0.25",
        "1,LP,false,2.0,10.0,6.0,-1.0,-0.5",
        "",
    ]
    assert beside.read_text("utf-8").split("\n") == [
        "point,t [s],x [m],force [N],ratio",
        "0,0.0,1.0,2.0,3.0",
        "0,0.5,1.5,2.5,3.5",
        "1,0.0,1.0,2.0,3.0",
        "1,1.0,2.0,3.0,4.0",
        "",
    ]
    assert write_csv(tmp_path / "b.csv", replace(of, signals={})) == [tmp_path / "b.csv"]


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
