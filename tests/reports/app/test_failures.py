"""The command line where things go wrong: sentences, exit codes and what is saved."""

import json
import os
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.commands import Capture, Patch, changed, command, refusal, wait_for_points

import periodic as per
import symbolic as sym
from periodic.results.files import replacing
from periodic.results.journal import Journal
from reports.app.cli import main

SCENES = ", ".join(sym.scene_names())

REFUSALS = {
    "trace vitrea80": f'scene is "vitrea80"; it must be one of {SCENES} or the path of a TOML file',
    "trace mine.toml": 'scene is "mine.toml", and there is no such file; `orbitrace new model mine.toml`',
    "report paper": "No such command 'report'.",
    "trace duffing --set mess=1": '--set key is "mess"; it must be one of oscillator.mass',
    "trace duffing --set force": '--set is "force"; it must be KEY=VALUE',
    "trace duffing --set force=-1": "oscillator.force is -1; it must be a number from 1e-12 to 1e+12 (N)",
    "trace vitrea79-810N --set lubricant=castor": 'film.lubricant is "castor"; it must be turbo33 or',
    "trace duffing --from -1": "--from is -1; it must be a number from 1e-09 to 1e+09 (rad/s)",
    "trace duffing --from nan": "--from is nan; it must be a number from",
    "trace dry-810N --to inf": "--to is inf; it must be a number from 0.1 to 100000 (rev/min)",
    "trace dry-810N --to fast": '--to is "fast"; it must be a number from',
    "trace dry-810N --from 100": "trace.to_rpm is 100; it must differ from --from so that there is a range",
    "trace dry-810N --from 300 --to 300": "--to is 300; it must differ from --from so that there is a range",
    "trace dry-810N --at 50": '--at is "50"; it must be numbers from 100 to 500 (rev/min) with commas',
    "trace dry-810N --at 200,,300": '--at is "200,,300"; it must be numbers from',
    "trace dry-810N --at nan": '--at is "nan"; it must be numbers from',
    "trace dry-810N --accuracy best": "Invalid value for '--accuracy': 'best' is not one of 'draft', ",
    "trace": "Missing argument 'SCENE'.",
    "trace duffing --fast": "No such option: --fast",
    "paint": "No such command 'paint'.",
}


@pytest.mark.parametrize("arguments", REFUSALS)
def test_refusal(arguments: str, capsys: Capture) -> None:
    """Assert that bad input ends in exit code 2 and one sentence, before anything is written."""
    assert refusal(capsys, *arguments.split()).startswith(REFUSALS[arguments])


def test_unwritable_folder(tmp_path: Path, capsys: Capture) -> None:
    """Assert that a folder that cannot be made is refused before the work starts."""
    (tmp_path / "file").touch()
    folder = tmp_path / "file" / "out"
    said = refusal(capsys, "trace", "duffing", "--out", str(folder))
    assert said == f'--out is "{folder}" (Not a directory); it must be a directory that can be written to'


def test_numerical_stop(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that a branch cut short for a numerical reason is saved and ends in exit code 3."""
    stop = per.Stop(per.Reason.SMALL_STEP, "for a test")
    changed(monkeypatch, lambda trace, *args, **kwargs: replace(trace(*args, **kwargs), stop=stop))
    assert main(["trace", "duffing", "--to", "0.4", "--out", str(tmp_path)]) == 3
    assert len(list(tmp_path.iterdir())) == 5
    assert json.loads((tmp_path / "branch.json").read_text("utf-8"))["stop"] == per.Reason.SMALL_STEP.value
    assert capsys.readouterr().err.startswith(f"orbitrace: stopped early ({stop}); the ")


def test_no_point_at_all(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that a branch without a single point still gives all files, and exit code 3."""
    stop = per.Stop(per.Reason.NO_START, "for a test")
    changed(monkeypatch, lambda trace, *args, **kwargs: replace(trace(*args, **kwargs), points=(), stop=stop))
    assert main(["trace", "dry-810N", "--to", "480", "--out", str(tmp_path)]) == 3
    assert len((tmp_path / "branch.csv").read_text("utf-8").splitlines()) == 1
    assert len(per.Branch.load(tmp_path / "branch.nc")) == 0
    assert capsys.readouterr().err == f"orbitrace: stopped early ({stop}); no point was found\n"


def test_interrupt(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that Ctrl-C saves the points so far and says so."""
    seen: list[per.Point] = []

    def interrupted(trace: Callable[..., per.Branch], *args: Any, **kwargs: Any) -> per.Branch:
        def press(point: per.Point) -> None:
            seen.append(point)
            if len(seen) == 4:
                raise KeyboardInterrupt

        return trace(*args, **{**kwargs, "watch": replace(kwargs["watch"], progress=press)})

    changed(monkeypatch, interrupted)
    assert main(["trace", "duffing", "--out", str(tmp_path)]) == 130
    assert len((tmp_path / "branch.csv").read_text("utf-8").splitlines()) == 1 + 4
    assert capsys.readouterr().err == f"orbitrace: interrupted; the 4 points so far are in {tmp_path}\n"


def test_interrupt_before_the_first_point(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that Ctrl-C before there is anything to save says just that."""

    def interrupted(*_: Any, **__: Any) -> per.Branch:
        raise KeyboardInterrupt

    changed(monkeypatch, interrupted)
    assert main(["trace", "duffing", "--out", str(tmp_path)]) == 130
    assert list(tmp_path.iterdir()) == []
    assert "nothing was saved" in capsys.readouterr().err


def test_failed_write_keeps_the_old_file(tmp_path: Path) -> None:
    """Assert that a write that fails leaves the old file as it was and no remains."""
    file = tmp_path / "branch.csv"
    file.write_text("old", "utf-8")
    with pytest.raises(OSError, match="full"), replacing(file) as part:
        part.write_text("ne", "utf-8")
        raise OSError("full")
    assert file.read_text("utf-8") == "old" and list(tmp_path.iterdir()) == [file]


def test_cut_short_never_replaces(tmp_path: Path, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that a branch cut short goes beside an earlier result, which stays as it was."""
    assert main(["trace", "duffing", "--to", "0.4", "--out", str(tmp_path)]) == 0
    before = (tmp_path / "branch.nc").read_bytes()
    stop = per.Stop(per.Reason.SMALL_STEP, "for a test")
    changed(monkeypatch, lambda trace, *args, **kwargs: replace(trace(*args, **kwargs), stop=stop))
    assert main(["trace", "duffing", "--to", "0.4", "--out", str(tmp_path)]) == 3
    assert (tmp_path / "branch.nc").read_bytes() == before
    assert len(list((tmp_path / "incomplete").iterdir())) == 4
    assert str(tmp_path / "incomplete") in capsys.readouterr().err


def steps(folder: Path) -> int:
    """Points of a branch in a folder, without its peaks, which lie within steps."""
    return sum(point.label != "PK" for point in per.Branch.load(folder / "branch.nc"))


def test_shorter_never_replaces_longer(tmp_path: Path) -> None:
    """Assert that of branches cut short the longer stays, and that the one to be resumed is the latest."""
    trace = ["trace", "duffing", "--out", str(tmp_path)]
    counts = {"": 5, "incomplete": 12, "incomplete-2": 4}
    for points in counts.values():
        assert main([*trace, "--max-points", str(points)]) == 3
    for name, points in counts.items():
        assert steps(tmp_path / name) == points
    assert main([*trace, "--max-points", "14", "--resume"]) == 3
    assert steps(tmp_path / "incomplete") == 14
    assert steps(tmp_path / "incomplete-2") == 4


def test_journal_is_resumed_before_an_older_branch(tmp_path: Path) -> None:
    """Assert that a journal that a killed trace left is taken up, not the older branch file beside it."""
    trace = ["trace", "duffing", "--out", str(tmp_path)]
    assert main([*trace, "--max-points", "3"]) == 3
    kept = (tmp_path / "branch.nc").read_bytes()
    assert main([*trace, "--max-points", "9"]) == 3
    branch = per.Branch.load(tmp_path / "incomplete" / "branch.nc")
    with Journal(tmp_path / "branch.journal", replace(branch, points=(), checkpoints=())) as journal:
        journal.add(branch.points, branch.stop, branch.checkpoints[0])
    for path in (tmp_path / "incomplete").iterdir():
        path.unlink()
    os.utime(tmp_path / "branch.journal", (0, 0))
    assert main([*trace, "--max-points", "10", "--resume"]) == 3
    again = per.Branch.load(tmp_path / "incomplete" / "branch.nc")
    assert steps(tmp_path / "incomplete") == 10
    assert again.values[: len(branch)].tolist() == branch.values.tolist()
    assert (tmp_path / "branch.nc").read_bytes() == kept


def test_title_that_is_no_formula(tmp_path: Path, capsys: Capture) -> None:
    """Assert that dollars and braces in a title are drawn as they are, and that changes stand beside it."""
    title = r"a $x_{ \\frac"
    arguments = ["trace", "duffing", "--to", "0.4", "--out", str(tmp_path), "--set", "force=0.4"]
    assert main([*arguments, "--set", f"title={title}"]) == 0
    assert capsys.readouterr().out.startswith(f"{title}, force = 0.4\n")


@pytest.mark.faults
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this machine has no device that is always full")
def test_full_standard_output(tmp_path: Path) -> None:
    """Assert that a standard output that takes nothing more is said in a sentence; the files are there."""
    with open("/dev/full", "w") as full:
        process = command("trace", "duffing", "--to", "0.4", "--out", str(tmp_path), stdout=full)
        said = process.communicate()[1]
    assert process.returncode == 2
    assert said == "orbitrace: standard output cannot be written to (No space left on device)\n"
    assert len(list(tmp_path.iterdir())) == 5


@pytest.mark.faults
def test_request_to_end(tmp_path: Path) -> None:
    """Assert that SIGTERM, like Ctrl-C, saves the points so far."""
    process = command("trace", "turbo33-2100N", "--accuracy", "fine", "--out", str(tmp_path))
    wait_for_points(process, tmp_path, 2)
    process.send_signal(signal.SIGTERM)
    assert "interrupted" in process.communicate()[1]
    assert process.returncode == 130
