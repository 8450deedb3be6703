"""What other programs read of a branch: each format holds the numbers of the branch and of its orbits."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.io import loadmat
from support.traces import duffing, duffing_system

import periodic as per
from periodic.results.export.matlab import identifiers

Array = NDArray[np.float64]
Read = tuple[Array, Array, Array, list[str]]
"""Parameter (points,), times and x (points, samples) and labels of a file."""

SAMPLES = 16


def from_csv(file: Path) -> Read:
    """Read the two CSV files."""
    points = list(csv.DictReader(io.StringIO(file.read_text("utf-8"))))
    beside = file.with_name(f"{file.stem}-orbits.csv")
    orbits = list(csv.DictReader(io.StringIO(beside.read_text("utf-8"))))
    shape = (len(points), SAMPLES)
    times, x = (np.array([float(row[name]) for row in orbits]).reshape(shape) for name in ("t [s]", "x [m]"))
    values = np.array([float(row["Omega [rad/s]"]) for row in points])
    return values, times, x, [row["label"] for row in points]


def from_mat(file: Path) -> Read:
    """Read MATLAB's struct."""
    branch = loadmat(file, simplify_cells=True)["branch"]
    points, orbits = branch["points"], branch["orbits"]
    assert branch["units"]["x_dot"] == "m/s" and branch["names"]["x_p_p"] == "x p-p"
    return (
        points["Omega"],
        orbits["t"],
        orbits["x"],
        [label if len(label) else "" for label in points["label"]],
    )


def from_hdf5(file: Path) -> Read:
    """Read the groups of HDF5."""
    with h5py.File(file) as found:
        assert found["orbits/x'"].attrs["units"] == "m/s" and found.attrs["parameter"] == "Omega"
        labels = [label.decode() for label in found["points/label"]]
        return found["points/Omega"][:], found["orbits/t"][:], found["orbits/x"][:], labels


def from_uff(file: Path) -> Read:
    """Read the functions of UFF58; the first is the amplitude over the parameter."""
    pyuff = pytest.importorskip("pyuff")
    sets = pyuff.UFF(str(file)).read_sets()
    assert [found["type"] for found in sets[:2]] == [164, 58]
    shown = [found for found in sets[2:] if found["id1"].strip() == "x"]
    values = [float(found["id2"].split()[2]) for found in shown]
    labels = ["".join(found["id2"].split()[4:]) for found in shown]
    times, x = (np.array([found[name] for found in shown]) for name in ("x", "data"))
    return np.array(values), times, x, labels


@pytest.mark.parametrize(
    ("ending", "read", "digits"),
    [("csv", from_csv, 1e-15), ("mat", from_mat, 1e-15), ("h5", from_hdf5, 1e-15), ("uff", from_uff, 1e-5)],
)
def test_each_format_holds_the_branch(
    ending: str, read: Callable[[Path], Read], digits: float, tmp_path: Path
) -> None:
    """Assert parameter, labels, times and motion of every point; UFF58 has times to six digits."""
    branch, file = duffing(), tmp_path / "new" / f"branch.{ending}"
    assert per.export(branch, file, samples=SAMPLES)[0] == file
    values, times, x, labels = read(file)
    assert values == pytest.approx(branch.values, rel=1e-14)
    named = [point.event or point.label.value for point in branch]
    assert "peak of x" in named
    assert [label.replace(" ", "") for label in labels] == [name.replace(" ", "") for name in named]
    for point, t, motion in zip(branch, times, x, strict=True):
        exact = np.arange(SAMPLES) * point.orbit.period / SAMPLES
        assert t == pytest.approx(exact, rel=digits, abs=digits)
        assert motion == pytest.approx(point.orbit["x"](exact), rel=1e-11, abs=1e-12)


def test_multipliers_of_csv(tmp_path: Path) -> None:
    """Assert that real and imaginary parts of all multipliers and the stability stand in named columns."""
    per.export(duffing(), tmp_path / "branch.csv", samples=4)
    rows = list(csv.DictReader(io.StringIO((tmp_path / "branch.csv").read_text("utf-8"))))
    names = [f"multiplier {k + 1}" for k in range(2)]
    assert [name for name in rows[0] if name.startswith("multiplier ")] == [
        f"{name} {part}" for name in names for part in ("re", "im")
    ]
    for point, row in zip(duffing(), rows, strict=True):
        found = [complex(float(row[f"{name} re"]), float(row[f"{name} im"])) for name in names]
        assert found == pytest.approx(point.multipliers, rel=1e-15)
        assert row["stable"] == str(point.stable).lower()


def test_amplitudes_of_uff(tmp_path: Path) -> None:
    """Assert that UFF58 has the peak to peak over the parameter, and the kinds of its quantities."""
    pyuff = pytest.importorskip("pyuff")
    per.export(duffing(), tmp_path / "branch.unv", samples=4)
    first, second = (pyuff.UFF(str(tmp_path / "branch.unv")).read_sets(k) for k in (1, 2))
    assert first["data"] == pytest.approx(duffing().peak_to_peak("x"), rel=1e-11)
    assert first["x"] == pytest.approx(duffing().values, rel=1e-5)
    assert (first["ordinate_spec_data_type"], second["abscissa_spec_data_type"]) == (8, 17)


@pytest.mark.parametrize("ending", ["csv", "mat", "h5", "uff"])
def test_branch_without_points(ending: str, tmp_path: Path) -> None:
    """Assert that a branch that has no points is exported as it is."""
    empty = per.Branch(**{**vars(duffing()), "points": ()})
    if ending == "uff":
        pytest.importorskip("pyuff")
    assert per.export(empty, tmp_path / f"branch.{ending}") == [tmp_path / f"branch.{ending}"]


def test_equilibria_have_no_orbits(tmp_path: Path) -> None:
    """Assert that a branch of equilibria is exported as its points."""
    branch = per.trace(
        duffing_system(0.1, 1.0, 0.0), "k", (0.5, 1.5), method=per.Equilibrium(frequency="Omega")
    )
    assert per.export(branch, tmp_path / "rest.csv") == [tmp_path / "rest.csv"]
    per.export(branch, tmp_path / "rest.h5")
    with h5py.File(tmp_path / "rest.h5") as found:
        assert found["points/k"][:] == pytest.approx(branch.values)
        assert list(found["orbits"]) == ["t"]


def test_names_of_matlab() -> None:
    """Assert that names are MATLAB's, and all different."""
    assert identifiers(["x p-p", "x_p_p", "x'", "1st", "t"]) == {
        "x p-p": "x_p_p", "x_p_p": "x_p_p_2", "x'": "x_dot", "1st": "q_1st", "t": "t_2",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("branch", "path", "samples", "said"),
    [
        (3, "a.csv", 8, "branch is 3; it must be a Branch"),
        (None, "a.xls", 8, "path is 'a.xls'; it must be a file that ends in .csv, .mat, .h5, .hdf5, .uff"),
        (None, "a.csv", 3, "samples is 3; it must be a whole number of at least 4"),
    ],
)
def test_bad_input(branch: object, path: str, samples: int, said: str) -> None:
    """Assert one sentence for what is no branch, another ending and too few samples."""
    with pytest.raises(ValueError, match=said):
        per.export(branch or duffing(), path, samples=samples)  # type: ignore[arg-type]
