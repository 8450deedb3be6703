"""Maps: the same numbers wherever they are computed, laid out over the grid, kept and gone on with."""

from __future__ import annotations

import itertools
import math
import os
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from support.maps import BOUNDS, GRID, SWING, ends, height, process, task
from support.numpy_systems import LinearOscillator

import periodic as per
import symbolic as sym

NUMBERS = {"peak": height, "ends": ends}


def equal(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two maps agree bit for bit in all but the time that they took."""
    return bool(a.drop_vars("seconds").identical(b.drop_vars("seconds")))


def exact(F: float, zeta: float) -> float:
    """Peak to peak of the linear resonance."""
    return F / (zeta * math.sqrt(1 - zeta**2))


def test_grid_of_exact_peaks() -> None:
    """Assert every cell of a map of resonance peaks against the closed form to 1e-6."""
    given = per.maps.Task(LinearOscillator(), "Omega", (0.8, 1.2), numbers={"peak": per.maps.Highest(SWING)})
    found = per.design_map(given, {"F": [0.5, 2.0], "zeta": [0.1, 0.2, 0.3]}, 1, store=None)
    assert found["peak"].dims == found["peak at"].dims == ("F", "zeta")
    for F, zeta in itertools.product([0.5, 2.0], [0.1, 0.2, 0.3]):
        cell = found.sel(F=F, zeta=zeta)
        assert float(cell["peak"]) == pytest.approx(exact(F, zeta), rel=1e-6)
        assert float(cell["peak at"]) == pytest.approx(max(math.sqrt(1 - 2 * zeta**2), 0.8), rel=1e-6)
    assert (found["status"] == "done").all() and (found["reason"] == "").all()
    assert found["peak"].attrs == {"units": "m"} and found["zeta"].attrs == {"units": ""}
    assert found["F"].attrs == {"units": "N"} and found.attrs["parameter"] == "Omega"


def test_same_numbers_here_and_in_processes(tmp_path: Path) -> None:
    """Assert that this process and two others give the same bits and files, of a script's function too."""
    given = task(**NUMBERS, own=lambda task, branch: len(branch) / 2)
    here = per.design_map(given, GRID, 1, store=tmp_path / "here.nc", chunk=3)
    other = per.design_map(given, GRID, 2, store=tmp_path / "other.nc", chunk=3)
    assert equal(here, other)
    assert here["ends"].dims == ("F", "zeta", "ends number") and (here["ends"][..., 1] == 0.5).all()
    for path, data in (("here.nc", here), ("other.nc", other)):
        assert equal(xr.load_dataset(tmp_path / path).drop_attrs(deep=False), data.drop_attrs(deep=False))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["here.nc", "other.nc"]


def test_compiled_system_travels_once() -> None:
    """Assert that two processes share the work on a compiled system and agree with this one bit for bit."""
    system = sym.scene("duffing")
    given = per.maps.Task(system, "Omega", (0.5, 0.9), numbers={"peak": height, "process": process}, tol=1e-3)
    grid = {"F": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}
    found, here = (per.design_map(given, grid, executor, store=None, chunk=1) for executor in (2, 1))
    assert np.array_equal(found["peak"], here["peak"])
    assert len(np.unique(found["process"])) == 2 and os.getpid() not in found["process"]


def test_neighbours_are_walked_there_and_back() -> None:
    """Assert that each cell of the path differs from the one before by one step of one parameter."""
    grid = per.maps.Grid({"a": [1, 2, 3], "b": [1, 2], "c": [5.0, 6.0, 7.0]})
    (chunks,) = grid.rounds({}, 4)
    path = [cell for chunk in chunks for cell in chunk]
    assert sorted(path) == sorted(itertools.product([1, 2, 3], [1, 2], [5, 6, 7])) and len(path) == grid.total
    assert {len(chunk) for chunk in chunks} == {4, 2}
    for a, b in itertools.pairwise(path):
        assert sum(abs(p - q) for p, q in zip(a, b, strict=True)) == 1


def test_neighbours_spare_work() -> None:
    """Assert that a warm start gives the numbers of a cold one to 1e-6 for fewer Newton iterations."""
    system = sym.scene("vitrea79-810N")
    rpm = 2 * math.pi / 60
    given = per.maps.Task(system, "speed", (470 * rpm, 500 * rpm), start=500 * rpm, numbers={"peak": height})
    grid = {"preload": [800.0, 820.0, 840.0]}
    warm, cold = (per.design_map(given, grid, 1, store=None, chunk=size) for size in (3, 1))
    assert warm["peak"].values == pytest.approx(cold["peak"].values, rel=1e-12)
    assert int(warm["newton"].sum()) < int(cold["newton"].sum())


def test_neighbour_on_a_sheet_that_ends_misleads_nobody() -> None:
    """Assert that a branch is traced whole where its neighbour's first orbit has none beside it at the start.

    Of Duffing's oscillator at Omega = 1.3 the orbit from rest is on the lower sheet for F = 0.2; for F = 0.3
    that sheet turns at 1.324.
    """
    numbers = {"folds": per.maps.Places("LP"), "ends": ends}
    given = per.maps.Task(sym.scene("duffing"), "Omega", (1.3, 1.9), numbers=numbers, tol=1e-4)
    warm, cold = (per.design_map(given, {"F": [0.2, 0.3]}, 1, store=None, chunk=size) for size in (2, 1))
    assert warm["folds"].values == pytest.approx(cold["folds"].values, rel=1e-4, nan_ok=True)
    assert np.array_equal(warm["ends"], cold["ends"]) and (cold["ends"] == [1.3, 1.9]).all()


def test_progress_counts_and_tells_the_time_left() -> None:
    """Assert what is told after each chunk."""
    told: list[per.maps.Progress] = []
    per.design_map(task(), GRID, 1, store=None, chunk=5, progress=told.append)
    assert [p.done for p in told] == [5, 10, 12] and all(p.total == 12 and p.failed == 0 for p in told)
    assert all(p.elapsed > 0 for p in told) and told[0].left > told[1].left > told[2].left == 0
    assert str(told[-1]).startswith("12 of 12 cells, ") and "left" in str(told[0])
    assert str(per.maps.Progress(3, 9, 1, 240.0, 3 * 3600.0)) == "3 of 9 cells, 1 failed, 4 min, 3.0 h left"


def test_failed_cells_have_a_reason() -> None:
    """Assert that a number that cannot be read says so, in the cells where it cannot."""

    def fussy(task: per.maps.Task, branch: per.Branch) -> float:
        if branch[0].orbit.parameters["zeta"] > 0.3:
            raise ValueError("too much damping for me")
        return 1.0

    found = per.design_map(task(f=fussy), {"zeta": [0.1, 0.4]}, 1, store=None)
    assert found["status"].values.tolist() == ["done", "failed"]
    assert found["reason"].values.tolist() == ["", "f: too much damping for me"]
    assert np.isnan(found["f"].values).tolist() == [False, True]


def test_branch_that_is_cut_short_gives_no_numbers() -> None:
    """Assert that a branch that ends before its bound is a failed cell with the reason of its end."""
    given = per.maps.Task(
        LinearOscillator(),
        "Omega",
        BOUNDS,
        numbers={"peak": height},
        control=per.ArclengthControl(max_points=3),
    )
    found = per.design_map(given, {"F": [1.0, 2.0]}, 1, store=None)
    assert np.isnan(found["peak"]).all() if "peak" in found else True
    assert (found["reason"] == "largest number of points reached: 3 points").all()


def test_defects_are_raised() -> None:
    """Assert that a number that is none, as a defect of the user's, ends the map at once."""
    with pytest.raises(TypeError, match="number bad gave 'x'; it must give a number"):
        per.design_map(task(bad=lambda task, branch: "x"), GRID, 1, store=None)


@pytest.mark.parametrize(
    ("grid", "said"),
    [
        ({}, "grid is empty; it must give the values of at least one parameter"),
        ([1, 2], r"grid is \[1, 2\]; it must give sequences of values by their names"),
        ({"G": [1.0]}, "grid has 'G'; it must be one of the system's Omega, zeta, F"),
        ({"Omega": [1.0]}, "grid has 'Omega', which is continued in; it must be one or the other"),
        ({"F": []}, "grid has no values for F; it must have at least one"),
        ({"F": [1.0, math.nan]}, "grid has nan for F; its values must be finite"),
        (
            {"F": np.arange(40_000.0), "zeta": np.arange(40_000.0)},
            "grid has 1600000000 cells; it must have at most 1000000",
        ),
        ({"F": [1.0, 10**400]}, "value of F is a whole number of too many digits; it must be below 1e308"),
        ({"F": [1.0, 1.0]}, "grid has 1 for F twice; its values must be different"),
        ({"F": "12"}, "grid has '12' for F; it must be a sequence of numbers"),
        ({"F": 1.0}, "grid has 1.0 for F; it must be a sequence of numbers"),
        ({"F": ["a"]}, "value of F is 'a'; it must be a number"),
    ],
)
def test_grids_that_are_none(grid: Any, said: str) -> None:
    """Assert the sentence for a grid that cannot be mapped."""
    with pytest.raises(ValueError, match=f"^{said}$"):
        per.design_map(task(), grid, 1, store=None)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"executor": 0}, "executor is 0; it must be a whole number of at least 1"),
        ({"executor": "dask"}, "executor is 'dask'; it must be a number of processes or a"),
        ({"chunk": 0}, "chunk is 0; it must be a whole number"),
        ({"store": 3}, "store is 3; it must be the name of a file, or None"),
        ({"store": ""}, "store is ''; it must be the name of a file, or None"),
        ({"store": "/"}, "store is '/'; it must be the name of a file, or None"),
        ({"store": "a\0b"}, "store is 'a.*b'; it must be the name of a file, or None"),
        ({"resume": "no"}, "resume is 'no'; it must be True or False"),
        ({"progress": 3}, "progress is 3; it must be a function of a Progress"),
    ],
)
def test_arguments_that_are_none(arguments: Any, said: str) -> None:
    """Assert the sentence for other arguments."""
    with pytest.raises(ValueError, match=f"^{said}"):
        per.design_map(task(), GRID, **{"executor": 1, "store": None, **arguments})


def test_other_arguments_that_are_none() -> None:
    """Assert the sentences for a task that is none, names that are taken and what cannot travel."""
    with pytest.raises(ValueError, match=r"^task is 3; it must be a Task\("):
        per.design_map(3, GRID)
    for name in ("status", "F", "cell"):
        with pytest.raises(ValueError, match=f"^numbers has '{name}', which a map has already"):
            per.design_map(task(**{name: height}), GRID, 1, store=None)
    lock = threading.Lock()
    with pytest.raises(ValueError, match="^task cannot travel to other processes .*; its system and"):
        per.design_map(task(own=lambda task, branch: lock.locked()), GRID, 2, store=None)
    given = per.maps.Task(LinearOscillator(), "Omega", BOUNDS, numbers={"peak": height}, values={"F": 2.0})
    with pytest.raises(ValueError, match="^grid has 'F', which is in the task's values; it must be one"):
        per.design_map(given, GRID, 1, store=None)
