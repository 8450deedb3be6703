"""The command `orbitrace prove`: certificates, the checker beside them, and what is said without."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import periodic as per
import symbolic as sym
from reports.app.cli import main

pytest.importorskip("flint")


def test_certificates(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that an orbit with impacts on a stop is proven, and its certificate checked by the copy."""
    out = tmp_path / "out"
    assert main(["prove", "stop", "--at", "1.1", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "proven, stable" in said and "there is one periodic orbit, and one only, stable" in said
    assert sorted(file.name for file in out.iterdir()) == ["check.py", "proof-1.json", "settings.json"]
    check = [sys.executable, "-I", "check.py", "proof-1.json"]
    run = subprocess.run(check, cwd=out, capture_output=True, text=True, check=True)
    assert run.stdout.startswith("proved: in boxes of half width ")


def test_not_decided(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert the exit code, and the reason, of a scene whose equations have no text."""
    assert main(["prove", "jenkins-damper", "--at", "0.5", "--out", str(tmp_path / "out")]) == 3
    assert "not decided: the system has sliders or relays; they are not" in capsys.readouterr().out
    assert not list((tmp_path / "out").glob("proof-*.json"))


def test_a_branch_that_stopped_early(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert that what is there is proven, and the exit code and the reason tell that it is not all."""

    def cut_short(*_: object) -> per.Branch:
        few = per.ArclengthControl(max_points=3)
        return per.trace(sym.scene("duffing"), "Omega", (0.3, 3.0), at=[0.3, 2.0], control=few)

    monkeypatch.setattr("reports.app.prove.run.trace", cut_short)
    assert main(["prove", "duffing", "--at", "0.3,2", "--out", str(tmp_path / "out")]) == 3
    told = capsys.readouterr()
    assert told.out.count("proven, stable") == 1
    assert told.err.startswith("orbitrace: stopped early (")


def test_no_such_points(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert what is said of a branch without folds."""
    assert main(["prove", "friction-damper", "--folds", "--out", str(tmp_path / "out")]) == 3
    assert capsys.readouterr().err.endswith("orbitrace: the branch has no such points\n")


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ([], '--at is ""; it must be at least one value, or --folds or --between must be given'),
        (["--between", "1"], '--between is "1"; it must be two values with a comma between them'),
        (
            ["--between", "1,x"],
            '--between is "1,x"; it must be numbers from 0.3 to 3 (rad/s) with commas between them',
        ),
        (["--at", "7"], '--at is "7"; it must be numbers from 0.3 to 3 (rad/s) with commas between them'),
    ],
)
def test_bad_input(given: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert one sentence and exit code 2."""
    assert main(["prove", "duffing", *given]) == 2
    assert capsys.readouterr().err == f"orbitrace: {sentence}\n"


def test_without_ball_arithmetic(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert what is said where python-flint is not installed."""
    monkeypatch.setitem(sys.modules, "flint", None)
    assert main(["prove", "duffing", "--at", "1", "--out", str(tmp_path / "out")]) == 2
    assert (
        capsys.readouterr().err
        == "orbitrace: prove needs python-flint; pip install 'orbitrace[proof]' brings it\n"
    )


def test_interrupted(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Assert that Ctrl-C during a proof ends with a sentence and its exit code."""

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("periodic.proved", interrupted)
    assert main(["prove", "stop", "--at", "1.1", "--out", str(tmp_path / "out")]) == 130
    assert capsys.readouterr().err == "orbitrace: interrupted; nothing was saved\n"


def test_a_stretch_and_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that a range without a fold is proven, and what is proven of points stands on the page."""
    out = tmp_path / "out"
    given = ["prove", "duffing", "--at", "2.5", "--between", "2.4,2.6", "--html", "--out", str(out)]
    assert main(given) == 0
    said = capsys.readouterr().out
    assert "stretch at 2.4 to 2.6: for each Omega from 2.4 to 2.6 in boxes" in said
    page = (out / "branch.html").read_text("utf-8")
    assert page.count('"note":"proven, stable"') == 1
