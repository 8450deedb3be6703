"""The README's examples run, each by itself, and print what it shows."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

import periodic as per

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "README.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    """The README's blocks of a language."""
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


def run(block: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run a block in a folder of its own and return what it has defined."""
    plt.switch_backend("Agg")
    monkeypatch.chdir(folder)
    said: dict[str, Any] = {}
    exec(block, said)
    plt.close("all")
    return said


def test_gear(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that the first example prints just what stands below it."""
    run(blocks("python")[0], tmp_path, monkeypatch)
    assert capsys.readouterr().out == blocks("text")[0]
    assert (tmp_path / "gears.png").is_file()


def test_own_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the second, and its file."""
    said = run(blocks("python")[1], tmp_path, monkeypatch)
    assert said["branch"].stop.reason is per.Reason.BOUND
    assert len(per.Branch.load("stop.nc")) == len(said["branch"])


def test_two_minutes() -> None:
    """Assert its length, and that no example is left out here."""
    assert len(TEXT.splitlines()) <= 150
    assert len(blocks("python")) == 2


def test_links_lead_somewhere() -> None:
    """Assert that every file it names is there."""
    prose = re.sub(r"```.*?```", "", TEXT, flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)#]+)\)", prose):
        assert (ROOT / target).exists(), target


def test_names_are_there() -> None:
    """Assert that parts and scenes of its table exist."""
    import symbolic as sym

    table = TEXT[TEXT.index("## I have") : TEXT.index("## Why")]
    for parts in re.findall(r"parts? ((?:`\w+`(?:, )?)+)", table):
        for name in re.findall(r"`(\w+)`", parts):
            assert hasattr(sym, name), name
    for command in re.findall(r"`orbitrace trace ([\w-]+)`((?:, `[\w-]+`)*)", table):
        for name in (command[0], *re.findall(r"`([\w-]+)`", command[1])):
            assert name in sym.scene_names(), name
