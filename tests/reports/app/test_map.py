"""The command `orbitrace map`: its files, its sentences and its exit codes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from support.commands import check_sentence, refusal

import periodic as per
import symbolic as sym
from periodic.workers.executors import Workers
from reports.app.cli import main
from reports.app.map import command, picture, run

Capture = pytest.CaptureFixture[str]
QUICK = ("--from", "1.3", "--to", "1.9", "--accuracy", "draft", "--jobs", "1")


def test_map_over_two_keys(tmp_path: Path, capsys: Capture) -> None:
    """Assert the numbers of a cell against a trace of its own, the picture, and that a second call reads."""
    over = ("--over", "oscillator.force=0.2:0.3:2", "--over", "c=0.1,0.2")
    arguments = ("map", "duffing", *over, *QUICK, "--out", str(tmp_path))
    assert main(arguments) == 0
    told = capsys.readouterr()
    assert "4 of 4 cells" in told.out and told.err == ""
    data = xr.load_dataset(tmp_path / "map.nc")
    assert data["peak"].dims == ("F", "c") and (tmp_path / "map.png").read_bytes()[1:4] == b"PNG"
    branch = per.trace(
        sym.scene("duffing"), "Omega", (1.3, 1.9), values={"F": 0.3, "c": 0.1}, tol=per.Accuracy.DRAFT
    )
    cell = data.sel(F=0.3, c=0.1)
    folds = [p.parameter for p in branch.labelled("LP")]
    assert cell["folds"].values[: len(folds)] == pytest.approx(folds, rel=1e-4) and len(folds) == 2
    assert float(cell["peak"]) >= branch.peak_to_peak("x").max() * (1 - 1e-4)
    before = (tmp_path / "map.nc").read_bytes()
    assert main((*arguments, "--resume")) == 0 and (tmp_path / "map.nc").read_bytes() == before


def test_map_over_one_parameter(tmp_path: Path) -> None:
    """Assert a map over one parameter, with a picture, and of chosen cells."""
    arguments = ("map", "duffing", "--over", "F=0.05,0.1,0.15", *QUICK, "--out")
    assert main((*arguments, str(tmp_path / "grid"))) == 0
    assert (tmp_path / "grid" / "map.png").is_file()
    pytest.importorskip("adaptive")
    assert main((*arguments, str(tmp_path / "chosen"), "--adaptive", "6")) == 0
    data = xr.load_dataset(tmp_path / "chosen" / "map.nc")
    assert data.sizes["cell"] == 6 and data["F"].min() == 0.05 and data["F"].max() == 0.15


def test_cells_without_numbers(tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert exit code 3 and the first reason where some branches have no numbers."""

    def peak(task: per.maps.Task, branch: per.Branch) -> float:
        if branch[0].orbit.parameters["F"] > 0.15:
            raise ArithmeticError("too much force")
        return 1.0

    monkeypatch.setattr(run, "numbers", lambda outputs: {"peak": peak, "stable peak": peak})
    over = ("--over", "F=0.1,0.2")
    assert main(("map", "duffing", *over, *QUICK, "--out", str(tmp_path))) == 3
    said = capsys.readouterr().err
    first = "peak: ArithmeticError: too much force"
    assert said == f"orbitrace: 1 of 2 cells have no numbers; the first: {first}\n"
    assert np.isnan(xr.load_dataset(tmp_path / "map.nc")["peak"]).sum() == 1


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--over", "F"), "--over is"),
        (("--over", "F=1:2"), "--over is"),
        (("--over", "F=1:2:0"), "--over is"),
        (("--over", "F=a,b"), "--over is"),
        (("--over", "F=nan,1"), "--over is"),
        (("--over", "F=inf:1:2"), "--over is"),
        (("--over", "F=-1e308:1e308:3"), "--over is"),
        (("--over", "F=1,1"), "--over is"),
        (("--over", "nonsense=1,2"), '--over is "nonsense"; it must be one of the parameters '),
        (("--over", "F=1,2", "--over", "force=1,2"), "--over has"),
        (("--over", "Omega=1,2"), "--over is"),
        (("--over", "mass=-1,2"), "oscillator.mass is"),
        (("--over", "F=1,2", "--jobs", "0"), "--jobs is"),
        (("--over", "F=1,2", "--adaptive", "x"), "--adaptive is"),
    ],
)
def test_bad_input(given: tuple[str, ...], said: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert one sentence and exit code 2."""
    found = refusal(capsys, "map", "duffing", *given, "--out", str(tmp_path))
    assert found.startswith(said), found
    check_sentence(found)


def test_stores_of_something_else(tmp_path: Path, capsys: Capture) -> None:
    """Assert that another map and a foreign file in the folder are refused and stay."""
    arguments = ("map", "duffing", "--over", "F=0.1,0.2", *QUICK, "--out", str(tmp_path))
    assert main(arguments) == 0
    capsys.readouterr()
    other = ("map", "duffing", "--over", "F=0.1,0.3", *QUICK, "--out", str(tmp_path), "--resume")
    said = refusal(capsys, *other)
    assert "holds a map made with grid" in said and "resume=False" not in said
    (tmp_path / "map.nc").write_text("a diary")
    assert "is not written over" in refusal(capsys, *arguments)
    assert (tmp_path / "map.nc").read_text() == "a diary"


def test_adaptive_without_its_package(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the option is blamed that needs the package, and that the package is named."""
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    arguments = ("map", "duffing", "--over", "F=0.1,0.2", "--adaptive", "8", *QUICK, "--out", str(tmp_path))
    said = "--adaptive needs the package adaptive; pip install 'orbitrace[adaptive]' installs it"
    assert refusal(capsys, *arguments) == said


def test_picture_leaves_out_cells_that_failed() -> None:
    """Assert that an adaptive map with a failed cell has colours for the others only."""

    data = xr.Dataset(
        {
            "peak": ("cell", [1.0, 2.0, np.nan, 3.0]),
            "F": ("cell", [0.0, 0.0, 1.0, 1.0]),
            "c": ("cell", [0.0, 1.0, 0.0, 1.0]),
            "folds": ("cell", [np.nan] * 4),
        }
    )
    shown = picture._field(Figure().add_subplot(), data, ["F", "c"])
    assert sorted(np.unique(shown.get_array()).tolist()) == [1.0, 2.0, 3.0]


def field(forces: list[float], dampings: list[float]) -> xr.Dataset:
    """A map with folds where there is more force than damping."""
    high, units = np.subtract.outer(forces, dampings), {"units": "m"}
    folds = np.where(high > 0.0, 1.0, np.nan)[..., None]
    data = {"peak": (("F", "c"), high, units), "stable peak": (("F", "c"), high, units)}
    coordinates = {"F": ("F", forces, units), "c": ("c", dampings, units)}
    return xr.Dataset(data | {"folds": (("F", "c", "folds number"), folds)}, coordinates)


def drawn(data: xr.Dataset, path: Path, monkeypatch: pytest.MonkeyPatch) -> Axes:
    """The axes of a map's picture."""
    kept: list[Axes] = []
    monkeypatch.setattr(picture, "write", lambda path, drawn, axes, title: kept.append(axes))
    picture.draw(path, "title", data, {"F": "force", "c": "c"})
    return kept[0]


@pytest.mark.parametrize("forces", [[1.0, 2.0, 3.0], [3.0, 2.0, 1.0]])
def test_ticks_are_on_the_side_of_folds(
    forces: list[float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that folds are to the left of the line, where its ticks are, in whichever order values are."""
    axes = drawn(field(forces, [0.9, 1.9, 2.9]), tmp_path, monkeypatch)
    (line,) = (found for found in axes.collections if isinstance(found, ContourSet))
    steps = np.diff(line.get_paths()[0].vertices, axis=0)
    assert (steps[:, 1] <= 0.0).all() and (steps[:, 0] <= 0.0).all()  # down and to the left: F is on its left


def test_picture_where_one_of_two_parameters_has_one_value(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert a line over the other one, and the value beside it: a field without width shows nothing."""
    axes = drawn(field([1.0, 2.0, 3.0], [0.5]), tmp_path, monkeypatch)
    assert axes.get_xlabel() == "force (m), c = 0.5 m"
    assert axes.lines[0].get_xydata().tolist() == [[1.0, 0.5], [2.0, 1.5], [3.0, 2.5]]
    assert drawn(field([1.0], [0.5]), tmp_path, monkeypatch).lines[0].get_xydata().tolist() == [[0.5, 0.5]]


def test_interrupted_before_the_first_cell(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert one sentence too where a request to end comes while processes are made ready."""

    def ended(given: object) -> Workers:
        raise KeyboardInterrupt

    monkeypatch.setattr("periodic.maps.map.workers", ended)
    arguments = ("map", "duffing", "--over", "F=0.2:0.3:2", *QUICK, "--out", str(tmp_path))
    assert main(arguments) == 130
    assert capsys.readouterr().err == "orbitrace: interrupted; --resume goes on\n"
    monkeypatch.undo()
    assert main([*arguments, "--resume"]) == 0
