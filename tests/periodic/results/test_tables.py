"""Branches as tables of numbers with names and units, and what is said of names that there are not."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import BrokenOscillator
from support.traces import DUFFING_A, duffing_system

import periodic as per


@cache
def branch() -> per.Branch:
    """The Duffing oscillator with a column and an event."""
    return per.trace(
        duffing_system(*DUFFING_A),
        "Omega",
        (0.3, 3.0),
        watch=per.Watch(
            columns={"third": per.Amplitude("x", 3.0)},
            events={
                "three": per.Level(per.PeakToPeak("x"), 3.0),
                "never": per.Level(per.PeakToPeak("x"), 99.0),
            },
        ),
    )


@cache
def empty() -> per.Branch:
    """A branch without a point."""
    return per.trace(BrokenOscillator(), "Omega", (0.4, 1.2))


def test_xarray() -> None:
    """Assert that every number of a branch is in the dataset, with units."""
    data = branch().to_xarray()
    assert data.sizes == {"point": len(branch()), "multiplier": 2}
    assert data["Omega"].values.tolist() == branch().values.tolist()
    assert data["x p-p"].values.tolist() == branch().peak_to_peak("x").tolist()
    assert (data["x max"] - data["x min"]).values.tolist() == branch().peak_to_peak("x").tolist()
    assert data["third"].values.tolist() == [p.columns["third"] for p in branch()]
    assert data["multipliers"].values.tolist() == [p.multipliers.tolist() for p in branch()]
    assert data["label"].values.tolist() == [p.label for p in branch()]
    assert data["event"].values.tolist() == [p.event for p in branch()]
    assert data["stable"].values.tolist() == branch().stable.tolist()
    assert [data[name].attrs["units"] for name in ("Omega", "x p-p", "F")] == ["rad/s", "m", "N"]
    assert data.attrs["parameter"] == "Omega"


def test_pandas() -> None:
    """Assert that the table has a row for each point and the columns of the dataset."""
    frame, data = branch().to_pandas(), branch().to_xarray()
    assert len(frame) == len(branch()) and frame.attrs["units"]["x p-p"] == "m"
    assert set(frame.columns) >= {*map(str, data.data_vars)} - {"multipliers"}
    assert frame["multiplier 1"].tolist() == [p.multipliers[0] for p in branch()]
    folds = frame[frame["label"] == "LP"]
    assert folds["Omega"].tolist() == [p.parameter for p in branch().labelled("LP")]


def test_columns_by_the_names_of_the_table() -> None:
    """Assert that a column can be asked for by what stands above it in tables."""
    assert branch().column("x p-p").tolist() == branch().peak_to_peak("x").tolist()
    assert branch().column("F").tolist() == [0.5] * len(branch())
    assert branch().column("third").tolist() == [p.columns["third"] for p in branch()]


def test_tables_of_nothing() -> None:
    """Assert that a branch without points is a table without rows, and says why where a point is wanted."""
    assert len(empty().to_pandas()) == 0 and empty().to_xarray().sizes["point"] == 0
    assert empty().column("x p-p").shape == (0,) and "x p-p" in empty().table()
    with pytest.raises(IndexError, match="^branch has no points; it ended with: no orbit found at the start"):
        empty()[0]


REFUSED: dict[str, tuple[Callable[[], Any], str]] = {
    "label": (
        lambda: branch().labelled("XX"),
        "label is 'XX'; it must be one of EP, LP, PD, .*, three, never, peak of x$",
    ),
    "output": (lambda: branch().peak_to_peak("y"), "output is 'y'; it must be one of x$"),
    "of a point": (lambda: branch()[0].peak_to_peak("y"), "output is 'y'; it must be one of x$"),
    "column": (lambda: branch().column("y"), "column is 'y'; it must be one of .*Omega, x min, .*, third, "),
}


@pytest.mark.parametrize("what", list(REFUSED))
def test_unknown_names(what: str) -> None:
    """Assert that a name that is none is refused with those there are."""
    ask, told = REFUSED[what]
    with pytest.raises(ValueError, match=f"^{told}"):
        ask()


def test_events_by_name() -> None:
    """Assert that events are found by name, and one that was never met is no mistake."""
    assert len(branch().labelled("three")) == 2 and branch().labelled("never") == ()
    assert branch().labelled("UZ") == branch().labelled("three") == branch().labelled(per.Label.USER)


def test_new_labels_survive_a_file(tmp_path: Path) -> None:
    """Assert that a label registered by a user is read again, also where nobody has registered it."""
    mine = per.Label.register("Q9", critical=True)
    first, *others = branch().points
    replace(branch(), points=(replace(first, label=mine), *others)).save(tmp_path / "branch.nc")
    assert per.Branch.load(tmp_path / "branch.nc").labelled("Q9")[0].label is mine
    program = (
        "import sys, periodic as per; (p,) = per.Branch.load(sys.argv[1]).labelled('Q9'); "
        "print(p.label, p.label.critical, p.stable)"
    )
    line = [sys.executable, "-c", program, str(tmp_path / "branch.nc")]
    said = subprocess.run(line, capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "Q9 True False"


def test_libraries_for_files_and_tables_are_imported_when_needed() -> None:
    """Assert that `import periodic` brings none of the slow ones."""
    program = "import sys, periodic; print([m for m in sys.argv[1:] if m in sys.modules])"
    line = [sys.executable, "-c", program, "xarray", "h5py", "h5netcdf", "pandas", "matplotlib"]
    assert subprocess.run(line, capture_output=True, text=True, check=True).stdout.strip() == "[]"


def test_orbits_of_a_file_can_be_read(tmp_path: Path) -> None:
    """Assert that names, scales and frequency of orbits survive a file."""
    branch().save(tmp_path / "branch.nc")
    orbit = per.Branch.load(tmp_path / "branch.nc")[3].orbit
    t = np.linspace(0, orbit.period, 20)
    assert orbit["x'"](t).tolist() == branch()[3].orbit["x'"](t).tolist()
    assert re.fullmatch("x, x'", ", ".join(orbit.names))
