"""Ten thousand spoilt scene files: each is a scene that can be traced, or is refused in one sentence."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from support.commands import Capture, check_sentence, refusal
from support.mutations import SCENES, mutant

from reports.app.cli import main
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError
from symbolic.scenes.reading import load
from symbolic.scenes.schema import Scene

pytestmark = pytest.mark.mutated

BLOCK = 500


def scene_of(path: Path, seed: int) -> Scene | None:
    """Write a mutant and load it; None of one that is refused."""
    path.write_bytes(mutant(seed))
    try:
        return load(str(path))
    except InputError as error:
        check_sentence(str(error))
        return None


def check_block(block: int, folder: Path) -> None:
    """Assert that every mutant of a block is a scene whose model compiles, or refused."""
    scenes = [scene_of(folder / "mutant.toml", seed) for seed in range(BLOCK * block, BLOCK * (block + 1))]
    sound = [scene for scene in scenes if scene is not None]
    assert 0.15 * BLOCK < len(sound) < 0.5 * BLOCK
    for scene in sound:
        assert build(scene).states


@pytest.mark.parametrize("block", range(2))
def test_mutants_load_or_are_refused(block: int, tmp_path: Path) -> None:
    """Assert it of a thousand."""
    check_block(block, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("block", range(2, 20))
def test_the_other_mutants(block: int, tmp_path: Path) -> None:
    """Assert it of the other nine thousand."""
    check_block(block, tmp_path)


def check_traced(seeds: range, folder: Path, capsys: Capture) -> None:
    """Assert that the command line traces the sound mutants, or stops early, and refuses the others."""
    path, out = folder / "mutant.toml", folder / "out"
    arguments = ["trace", str(path), "--accuracy", "draft", "--out", str(out), "--max-newton", "40"]
    codes = []
    for seed in seeds:
        path.write_bytes(mutant(seed))
        codes.append(main(arguments))
        told = capsys.readouterr()
        assert told.err.count("\n") == (codes[-1] != 0)
        assert (codes[-1] == 2) == (told.out == ""), told.err
        check_sentence(told.err.strip().removeprefix("orbitrace: ")) if codes[-1] == 2 else None
    assert {2, 3} <= set(codes) <= {0, 2, 3}


def test_mutants_are_traced(tmp_path: Path, capsys: Capture) -> None:
    """Assert that sound mutants can be traced: a share of them, for a few steps."""
    check_traced(range(100_000, 100_040), tmp_path, capsys)


@pytest.mark.long
def test_more_mutants_are_traced(tmp_path: Path, capsys: Capture) -> None:
    """Assert the same of more."""
    check_traced(range(101_000, 102_000), tmp_path, capsys)


def test_overrides_on_the_command_line(capsys: Capture) -> None:
    """Assert that odd texts in place of a value, a key, a range or a number of steps are refused the same."""
    odd = ["", " ", "nan", "1e400", "-1", "0x10", "\x1b[2J", "\x00", "a\nb", "é" * 300, "{}", "1=1", "\ud800"]
    for text in odd:
        for arguments in (
            *(["--set", f"mass={text}"], ["--set", f"{text}=1"], ["--set", text], ["--from", text]),
            *(["--to", text], ["--at", text], ["--max-points", text], ["--max-newton", text]),
        ):
            check_sentence(refusal(capsys, "trace", "duffing", *arguments))


@pytest.mark.parametrize("digits", ["9" * 400, "9" * 5000, "0x" + "f" * 5000, "-0x" + "f" * 5000, "9e999"])
def test_numbers_of_many_digits(digits: str, tmp_path: Path) -> None:
    """Assert that numbers which Python does not write out are refused as others are."""
    path = tmp_path / "long.toml"
    text = (SCENES[0].parent / "duffing.toml").read_text("utf-8").replace("mass = 1.0", f"mass = {digits}")
    path.write_text(text, "utf-8")
    with pytest.raises(InputError) as caught:
        load(str(path))
    check_sentence(str(caught.value))


def test_no_end_of_a_file(tmp_path: Path) -> None:
    """Assert that of a file without end, or one too large, no more is read than a scene may have."""
    large = tmp_path / "large.toml"
    large.write_text("# a comment\n" * 10_000, "utf-8")
    with pytest.raises(InputError, match="is larger than 32768 bytes"):
        load(str(large))
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    for source in (str(pipe), "/dev/zero") if Path("/dev/zero").exists() else (str(pipe),):
        with pytest.raises(InputError, match=r"is no regular file\); it must be one of"):
            load(source)
