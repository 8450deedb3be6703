"""The commands `orbitrace motions` and `orbitrace atlas`: files, tables, interrupts, bad input."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import pytest

import periodic as per
import symbolic as sym
from periodic.phasespace.search.stages import Stages
from periodic.phasespace.search.unstable import Unstable
from reports.app.cli import main
from symbolic.kernels import native

pytestmark = pytest.mark.skipif(native.compiler() is None, reason="one by one it takes long")

BOX = ["--box", "x=-3:3", "--box", "x'=-2:2"]


@pytest.fixture(autouse=True)
def compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scenes are compiled with the kernels that a user gets."""
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")


def test_motions_at_a_value(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert both stable motions and the saddle, in words and in the file, and that the store is gone."""
    out = tmp_path / "out"
    given = ["motions", "gear-pair", "--at", "0.7", *BOX, "--starts", "64", "--periods", "2"]
    assert main([*given, "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "Gear pair" in said and "unstable, periodic" in said and "of the starts" in said
    assert sorted(file.name for file in out.iterdir()) == ["motions.csv", "settings.json"]
    rows = list(csv.DictReader((out / "motions.csv").read_text("utf-8").splitlines()))
    assert [row["motion"] for row in rows] == ["stable, periodic"] * 2 + ["unstable, periodic"]
    assert sum(int(row["starts"]) for row in rows) == 64
    branch = per.trace(sym.scene("gear-pair"), "Omega", (0.4, 1.2), start=1.2)
    known = sorted(float(point.orbit["x'"](0.0).item()) for point in branch.at(Omega=0.7))
    assert sorted(float(row["x'"]) for row in rows) == pytest.approx(known, rel=1e-5)


def test_interrupted_motions_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert the exit code of Ctrl-C with what was found, and that --resume does the rest."""
    out = tmp_path / "out"
    given = [
        "motions",
        "gear-pair",
        "--at",
        "0.7",
        *BOX,
        "--starts",
        "32",
        "--periods",
        "1",
        "--out",
        str(out),
    ]
    with monkeypatch.context() as patch:
        patch.setattr(Unstable, "run", _stop)
        assert main(given) == 130
    said = capsys.readouterr()
    assert "interrupted; --resume goes on" in said.err and "not tried, or not to the end" in said.out
    assert (out / "search.db").stat().st_size > 1000
    assert main([*given, "--resume"]) == 0
    assert "unstable, periodic" in capsys.readouterr().out and not (out / "search.db").exists()


def test_atlas(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert the files, and the fold in words."""
    pytest.importorskip("plotly")
    out = tmp_path / "out"
    given = ["atlas", "gear-pair", "--from", "0.6", "--to", "0.9", "--count", "2", *BOX, "--starts", "8"]
    assert main([*given, "--periods", "1", "--html", "--out", str(out)]) == 0
    files = ["atlas.html", "atlas.png", "atlas.txt", "settings.json"]
    assert sorted(file.name for file in out.iterdir()) == files
    text = (out / "atlas.txt").read_text("utf-8")
    assert "LP fold at 0.835837" in text and text.strip() in capsys.readouterr().out


def test_interrupted_atlas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an atlas without a value has no files but the store, and 130."""
    monkeypatch.setattr(Stages, "run", _stop)
    out = tmp_path / "out"
    assert main(["atlas", "gear-pair", "--count", "2", "--out", str(out)]) == 130
    assert sorted(file.name for file in out.iterdir()) == ["search.db", "settings.json"]


def _stop(*_: Any) -> Any:
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (["motions", "gear-pair", "--at", "0.7,0.8"], '--at is "0.7,0.8"; it must be one value'),
        (["motions", "gear-pair", "--at", "9"], '--at is "9"; it must be numbers from 0.4 to 1.2'),
        (["motions", "gear-pair", "--at", "0.7", "--box", "x"], '--box is "x"; it must be STATE=LOW:HIGH'),
        (["motions", "gear-pair", "--at", "0.7", "--box", "x=1"], '--box is "x=1"; it must be STATE=LOW'),
        (["motions", "gear-pair", "--at", "0.7", "--box", "x=2:1"], "box['x'] is (2.0, 1.0); it must be two"),
        (["motions", "gear-pair", "--at", "0.7", "--box", "z=1:2"], "box has 'z'; it must be one of x, x'"),
        (["motions", "gear-pair", "--at", "0.7", "--starts", "0"], "starts is 0; it must be a whole number"),
        (["motions", "gear-pair", "--at", "0.7", "--jobs", "0"], "executor is 0; it must be a whole number"),
        (["atlas", "gear-pair", "--count", "1"], "count is 1; it must be a whole number of at least 2"),
        (["atlas", "nothing"], "nothing"),
    ],
)
def test_bad_input(
    given: list[str], sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert one sentence and exit code 2."""
    assert main([*given, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert sentence in said and said.count("\n") == 1
