"""Interrupted traces taken up again from the command line, and other methods."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.commands import Capture, Patch, interrupt_after

import periodic as per
from reports.app.cli import main


def test_resumed_trace_ends_as_an_uninterrupted_one(tmp_path: Path, monkeypatch: Patch) -> None:
    """Assert that a trace interrupted twice and resumed holds the same points as one that was not."""
    whole, parts = tmp_path / "whole", ["trace", "duffing", "--to", "1.5", "--out", str(tmp_path / "parts")]
    assert main(["trace", "duffing", "--to", "1.5", "--out", str(whole)]) == 0
    with monkeypatch.context() as patch:
        interrupt_after(5, patch)
        assert main(parts) == 130
        assert main([*parts, "--resume"]) == 130
    assert main([*parts, "--resume"]) == 0
    expected, found = (per.Branch.load(folder / "branch.nc") for folder in (whole, tmp_path / "parts"))
    assert len(found) == len(expected)
    assert found.values == pytest.approx(expected.values, rel=1e-11)
    assert found.stop == expected.stop


def refusal(capsys: Capture, *arguments: str) -> str:
    """What is said of bad input."""
    assert main(list(arguments)) == 2
    return capsys.readouterr().err.strip().removeprefix("orbitrace: ")


def test_what_cannot_be_resumed(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert the sentences about no branch, a damaged one, and one of another scene, number or start."""
    monkeypatch.chdir(tmp_path)
    out = ("--out", "kept", "--resume")
    assert refusal(capsys, "trace", "duffing", *out) == (
        '--resume is "kept"; it must be a directory with the branch.nc of an interrupted trace'
    )
    with monkeypatch.context() as patch:
        interrupt_after(5, patch)
        assert main(["trace", "duffing", *out[:2]]) == 130
    capsys.readouterr()
    said = refusal(capsys, "trace", "duffing", "--set", "force=0.4", *out)
    assert said.endswith("it must be one traced with F = 0.4, as now (it has 0.5)")
    said = refusal(capsys, "trace", "vitrea79-810N", *out)
    assert "it must be one of this scene (guess is a branch in Omega with 5 points;" in said
    said = refusal(capsys, "trace", "duffing", "--from", "3", "--to", "0.3", *out)
    assert "start and bounds must be as before" in said
    Path("kept/branch.nc").write_bytes(b"nothing")
    assert "a branch that can be read" in refusal(capsys, "trace", "duffing", *out)


@pytest.mark.parametrize("method", ["shooting", "harmonic-balance"])
def test_other_methods_find_the_same_fold(method: str, tmp_path: Path) -> None:
    """Assert that the upper fold of the Duffing scene is where collocation has it."""
    arguments = ["--from", "1.2", "--to", "2.3", "--method", method, "--out", str(tmp_path)]
    assert main(["trace", "duffing", *arguments]) == 0
    branch = per.Branch.load(tmp_path / "branch.nc")
    (fold, *_) = branch.labelled(per.Label.FOLD)
    assert fold.parameter == pytest.approx(2.211935317020, rel=1e-8)
