"""The command line as a user meets it: help, files, tables and JSON."""

import csv
import io
import json
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import periodic as per
from reports.app.cli import main
from reports.app.trace.picture import draw
from symbolic.scenes.names import scene_names
from symbolic.scenes.reading import load

FILES = {"branch.nc", "branch.csv", "branch.json", "branch.png"}
HELD = FILES | {"settings.json"}
"""What a directory holds then."""
DISC_COLUMNS = (
    "speed_rpm,x_pp_um,film_pp_um,film_min_um,deflection_pp_um,load_min_N,load_max_N,"
    "multiplier_max,stable,label,error_estimate"
)
REFERENCE = {450.0: 1.615395, 360.0: 3.865414}
"""x p-p in um of vitrea79-810N by stiff integration."""

Row = dict[str, str]
Capture = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What a traced scene left behind."""

    folder: Path
    summary: dict[str, Any]
    rows: list[Row]


def traced(folder: Path, *arguments: str) -> Outcome:
    """Trace a scene into a folder and read what it wrote."""
    assert main(["trace", *arguments, "--out", str(folder)]) == 0
    text = (folder / "branch.csv").read_text("utf-8")
    summary = json.loads((folder / "branch.json").read_text("utf-8"))
    return Outcome(folder=folder, summary=summary, rows=list(csv.DictReader(io.StringIO(text))))


@pytest.fixture(scope="module")
def duffing(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """The Duffing scene as it is."""
    return traced(tmp_path_factory.mktemp("duffing"), "duffing")


@pytest.fixture(scope="module")
def disc(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """The squeeze-film disc where the contact holds, with two points asked for."""
    folder = tmp_path_factory.mktemp("disc") / "new" / "folder"
    return traced(folder, "vitrea79-810N", "--to", "350", "--at", "360,450", "--accuracy", "draft")


def test_help(capsys: Capture) -> None:
    """Assert that help names both commands, also where nothing is asked for."""
    assert main(["--help"]) == main([]) == 0
    first, second = capsys.readouterr().out.split("Usage:")[1:]
    assert first == second
    assert re.search(r"^  scenes .*^  trace ", first, re.DOTALL | re.MULTILINE)


def test_help_is_quick() -> None:
    """Assert that help imports none of the large libraries."""
    code = "import sys; from reports.app.cli import main; main(['trace', '--help']); print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True
    )
    assert "--accuracy" in run.stdout
    assert not {"numpy", "casadi", "xarray", "matplotlib", "rich"} & set(run.stdout.split())


def test_scenes(capsys: Capture) -> None:
    """Assert that every built-in scene is listed on a line of its own."""
    assert main(["scenes"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == scene_names()


def test_files(duffing: Outcome) -> None:
    """Assert that the files are written and nothing else is left."""
    assert {file.name for file in duffing.folder.iterdir()} == HELD
    assert (duffing.folder / "branch.png").read_bytes().startswith(b"\x89PNG")


def test_branch_file_agrees(disc: Outcome) -> None:
    """Assert that the branch file holds the points of the CSV file."""
    branch = per.Branch.load(disc.folder / "branch.nc")
    assert [f"{p.peak_to_peak('x') * 1e6:.9g}" for p in branch] == [
        f"{float(row['x_pp_um']):.9g}" for row in disc.rows
    ]


def test_disc_columns(disc: Outcome) -> None:
    """Assert the columns of the disc's CSV file."""
    assert ",".join(disc.rows[0]) == DISC_COLUMNS


def test_disc_numbers_are_finite(disc: Outcome) -> None:
    """Assert that every number of a lubricated disc is there, in its unit."""
    for row in disc.rows:
        assert all(row[name] for name in DISC_COLUMNS.split(",") if name != "label")
        assert 0 < float(row["load_min_N"]) < 810 < float(row["load_max_N"]) < 1300
        assert 3 < float(row["film_min_um"]) < 5
        assert row["stable"] == "true" and 0.9 < float(row["multiplier_max"]) < 1


def test_disc_range(disc: Outcome) -> None:
    """Assert that the trace starts at 500 and ends at --to, both exactly."""
    assert [row["speed_rpm"] for row in disc.rows if row["label"] == "EP"] == ["500", "350"]
    assert (disc.rows[0]["label"], disc.rows[-1]["label"]) == ("EP", "EP")


def test_points_asked_for(disc: Outcome) -> None:
    """Assert that --at gives converged points at just these speeds."""
    found = {float(r["speed_rpm"]): float(r["x_pp_um"]) for r in disc.rows if r["label"] == "UZ"}
    assert found == pytest.approx(REFERENCE, rel=1e-4)
    assert found.keys() == REFERENCE.keys()


def test_disc_summary(disc: Outcome) -> None:
    """Assert what the JSON object says of a disc."""
    said = disc.summary
    assert said["scene"] == "vitrea79-810N"
    assert said["parameters"]["trace"] == {"from_rpm": 500.0, "to_rpm": 350.0}
    assert said["parameters"]["film"]["viscosity"] == 0.89
    assert said["points"] == len(disc.rows)
    assert said["newton_iterations"] > 0 and said["elapsed_s"] > 0
    assert said["stop"] == "bound reached"
    assert {"orbitrace", "casadi", "numpy", "scipy", "python"} <= said["versions"].keys()


def test_special_points_of_disc(disc: Outcome) -> None:
    """Assert what the JSON object says of a special point."""
    points = disc.summary["special_points"]
    assert [point["label"] for point in points] == ["EP", "UZ", "UZ", "EP"]
    for point in points:
        assert list(point) == [
            "label", "speed_rpm", "x_pp_um", "film_pp_um", "load_max_N", "stable", "multipliers",
            "parameter", "x_pp", "film_pp", "deflection_pp", "load_pp",
        ]  # fmt: skip
        assert point["parameter"] == pytest.approx(point["speed_rpm"] * math.pi / 30, rel=1e-13)
        assert point["x_pp"] == pytest.approx(point["x_pp_um"] * 1e-6, rel=1e-13)
        assert len(point["multipliers"]) == 3 and all(len(pair) == 2 for pair in point["multipliers"])


def test_duffing_folds(duffing: Outcome) -> None:
    """Assert that the Duffing scene gives its folds under `frequency` and `x_max`."""
    folds = [p for p in duffing.summary["special_points"] if p["label"] == "LP"]
    assert [p["frequency"] for p in folds] == pytest.approx([2.211935317020, 1.438670145514], rel=1e-7)
    assert [p["x_max"] for p in folds] == pytest.approx([2.315979798728, 0.699671897403], rel=1e-6)


def test_duffing_columns(duffing: Outcome) -> None:
    """Assert the columns of an oscillator's CSV file."""
    assert ",".join(duffing.rows[0]) == "frequency,x_max,multiplier_max,stable,label,error_estimate"


def test_dry_disc_has_no_film(tmp_path: Path) -> None:
    """Assert that the film columns of a dry disc are empty, and null in JSON."""
    dry = traced(tmp_path, "dry-810N", "--to", "480", "--accuracy", "draft")
    assert {row["film_pp_um"] + row["film_min_um"] for row in dry.rows} == {""}
    assert {point["film_pp_um"] for point in dry.summary["special_points"]} == {None}


def test_json_on_standard_output(tmp_path: Path, capsys: Capture) -> None:
    """Assert that --json prints just what branch.json holds, and is silent on standard error."""
    traced(tmp_path, "duffing", "--to", "0.4", "--json")
    told = capsys.readouterr()
    assert told.out == (tmp_path / "branch.json").read_text("utf-8")
    assert told.err == ""


def test_table(tmp_path: Path, capsys: Capture) -> None:
    """Assert that without --json special points, stop and files are printed as plain text when piped."""
    traced(tmp_path, "duffing", "--to", "0.4", "--at", "0.35")
    told = capsys.readouterr()
    assert told.err == ""
    assert re.search(r"^ +UZ +0\.35 +[0-9.]+ +yes$", told.out, re.MULTILINE)
    assert "stop: bound reached" in told.out
    assert all(str(tmp_path / file) in told.out for file in FILES)
    assert "\x1b" not in told.out


def test_default_folder(tmp_path: Path, monkeypatch: Patch) -> None:
    """Assert that the files go to orbitrace-out/SCENE unless told otherwise."""
    monkeypatch.chdir(tmp_path)
    assert main(["trace", "duffing", "--to", "0.31", "--accuracy", "draft"]) == 0
    assert {file.name for file in Path("orbitrace-out", "duffing").iterdir()} == HELD


def test_own_scene(tmp_path: Path) -> None:
    """Assert that a scene file is traced under its own name, with --set applied."""
    source = tmp_path / "mine.toml"
    text = (Path(__file__).parents[3] / "symbolic" / "scenes" / "data" / "duffing.toml").read_text("utf-8")
    source.write_text(text, "utf-8")
    said = traced(tmp_path, str(source), "--to", "0.31", "--set", "force=0.4", "--set", "cubic=").summary
    assert said["scene"] == "mine"
    assert said["parameters"]["oscillator"] == {"mass": 1.0, "damping": 0.1, "stiffness": 1.0, "force": 0.4}


def test_picture_with_time_integration(disc: Outcome, tmp_path: Path) -> None:
    """Assert that the picture takes the points that time integration reaches."""
    branch = per.Branch.load(disc.folder / "branch.nc")
    plain, dressed = tmp_path / "plain.png", tmp_path / "dressed.png"
    draw(plain, load("vitrea79-810N"), branch)
    draw(
        dressed,
        load("vitrea79-810N"),
        branch,
        integrated=([(360.0, 3.865)], [(450.0, 1.615), (360.0, 3.865)]),
    )
    assert plain.read_bytes() == (disc.folder / "branch.png").read_bytes() != dressed.read_bytes()
