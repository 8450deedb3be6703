"""Which directory results go to: those of other settings never beside others."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from support.commands import Capture, Patch, check_sentence, interrupt_after, refusal

import periodic as per
from reports.app.cli import main

DRAFT = ("trace", "duffing", "--to", "0.35", "--accuracy", "draft")
OUT = Path("orbitrace-out")


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: Patch) -> None:
    """Each test runs in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def force(folder: Path) -> float:
    """The force that a directory's branch was traced with."""
    return float(per.Branch.load(folder / "branch.nc")[0].orbit.parameters["F"])


def test_other_settings_go_to_another_folder() -> None:
    """Assert that other settings have a directory of their own, which the same settings find again."""
    for value in ("0.5", "0.4", "0.4"):
        assert main([*DRAFT, "--set", f"force={value}"]) == 0
    folders = {folder.name: force(folder) for folder in OUT.iterdir()}
    assert folders == {"duffing": 0.5, "duffing-2": 0.4}


def test_edited_scene_is_another() -> None:
    """Assert that a scene file that was changed meanwhile does not write over what it was before."""
    assert main(["new", "duffing", "mine.toml"]) == 0
    arguments = ["trace", "mine.toml", *DRAFT[2:]]
    assert main(arguments) == 0
    text = Path("mine.toml").read_text("utf-8")
    Path("mine.toml").write_text(text.replace("force = 0.5", "force = 0.25"), "utf-8")
    assert main(arguments) == 0
    assert (force(OUT / "mine"), force(OUT / "mine-2")) == (0.5, 0.25)


def test_folder_given_with_other_results(capsys: Capture) -> None:
    """Assert that a directory that is given is refused, in one sentence, where it holds other results."""
    assert main([*DRAFT, "--out", "here"]) == 0
    before = (Path("here") / "branch.nc").read_bytes()
    capsys.readouterr()
    said = refusal(capsys, *DRAFT, "--set", "force=0.4", "--out", "here")
    assert said.startswith('--out is "here", made with oscillator.force = 0.5; it must be empty')
    check_sentence(said)
    said = refusal(capsys, "linear", "duffing", "--set", "force=0.4", "--out", "here")
    assert said.startswith('--out is "here", made with oscillator.force = 0.5')
    assert (Path("here") / "branch.nc").read_bytes() == before


def test_commands_share_a_folder() -> None:
    """Assert that commands with the same scene share a directory, and that the record tells of both."""
    assert main(list(DRAFT)) == 0
    assert main(["linear", "duffing", "--set", "to_frequency=0.35"]) == 0
    assert [folder.name for folder in OUT.iterdir()] == ["duffing"]
    told = json.loads((OUT / "duffing" / "settings.json").read_text("utf-8"))
    assert told["trace"] == {"at": [], "axis": None, "accuracy": "draft", "method": "collocation"}
    assert told["linear"] == {"at": [], "axis": None}
    assert told["parameters"]["trace"]["to_frequency"] == 0.35


def test_resuming_finds_its_folder(monkeypatch: Patch) -> None:
    """Assert that --resume without a directory goes on where a trace of the same settings was interrupted."""
    assert main(list(DRAFT)) == 0
    with monkeypatch.context() as patch:
        interrupt_after(4, patch)
        assert main([*DRAFT, "--set", "force=0.4"]) == 130
    assert len(per.Branch.load(OUT / "duffing-2" / "branch.nc")) == 4
    assert main([*DRAFT, "--set", "force=0.4", "--resume"]) == 0
    assert len(per.Branch.load(OUT / "duffing-2" / "branch.nc")) > 4


def test_nothing_is_left_of_a_trace_without_results(monkeypatch: Patch) -> None:
    """Assert that a trace that leaves nothing leaves no record either."""
    with monkeypatch.context() as patch:
        patch.setattr(per, "trace", lambda *_, **__: (_ for _ in ()).throw(KeyboardInterrupt))
        assert main([*DRAFT, "--out", "here"]) == 130
    assert list(Path("here").iterdir()) == []


@pytest.mark.parametrize("text", ["", "[1]", "{"])
def test_record_that_cannot_be_read(text: str) -> None:
    """Assert that a damaged record is none: it is written anew."""
    Path("here").mkdir()
    (Path("here") / "settings.json").write_text(text, "utf-8")
    assert main([*DRAFT, "--out", "here"]) == 0
    assert json.loads((Path("here") / "settings.json").read_text("utf-8"))["scene"] == "duffing"
