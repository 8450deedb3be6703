"""The command `orbitrace modes`: files, table, ranges by default, and what is said of bad input."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import periodic as per
from reports.app.cli import main


def test_modes_of_a_joint(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert files and numbers of the damper's mode, whose joint slips from F / k on, an amplitude of 0.2."""
    out = tmp_path / "out"
    assert main(["modes", "jenkins-damper", "--over", "amplitude", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "damping ratio" in said and "GR" in said
    files = sorted(file.name for file in out.iterdir())
    assert files == ["modes.csv", "modes.nc", "modes.png", "settings.json"]
    rows = list(csv.DictReader((out / "modes.csv").read_text("utf-8").splitlines()))
    (onset,) = [row for row in rows if row["label"] == "GR"]
    assert float(onset["amplitude of x"]) == pytest.approx(0.2, rel=1e-5)
    assert float(rows[0]["damping ratio"]) == pytest.approx(0.02 / (2 * 1.5**0.5), rel=1e-6)
    branch = per.Branch.load(out / "modes.nc")
    assert len(branch) == len(rows)
    assert (out / "modes.png").stat().st_size > 10_000


def test_range_and_mode(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that discs are read in micrometres, and that the dry disc has the damping that it was given."""
    given = ["modes", "dry-810N", "--from", "0.1", "--to", "1", "--out", str(tmp_path / "out")]
    assert main(given) == 0
    said = capsys.readouterr().out
    assert "amplitude of x (um)" in said and "0.0070000" in said


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (["duffing", "--over", "speed"], '--over is "speed"; it must be amplitude'),
        (["duffing", "--of", "y"], '--of is "y"; it must be one of x'),
        (
            ["duffing", "--from", "0", "--to", "1"],
            "--from, --to are 0 to 1; they must be two different positive",
        ),
        (["duffing", "--which", "3", "--to", "1"], "which is 3; the system at rest has 1 modes"),
        (
            ["duffing", "--which", "-1", "--to", "1"],
            '--which is "-1"; it must be a whole number of at least 0',
        ),
        (["nothing"], "nothing"),
    ],
)
def test_bad_input(
    given: list[str], sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert one sentence, exit code 2, and that nothing is written."""
    out = tmp_path / "out"
    assert main(["modes", *given, "--out", str(out)]) == 2
    assert sentence in capsys.readouterr().err
    assert not list(out.glob("modes.*"))
