"""Disks that fill up, directories that take no files, and files that are damaged, foreign or malicious."""

from __future__ import annotations

import io
import json
import os
import pickle
import resource
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from support.commands import Capture, check_sentence, command, interrupt_after, refusal

import periodic as per
from periodic.results import netcdf as storage
from periodic.results.files import digest
from periodic.results.journal import TABLE
from reports.app.cli import main

pytestmark = pytest.mark.faults

TRACE = ("trace", "duffing", "--to", "0.7", "--accuracy", "draft", "--out")
JOURNAL = "branch.journal"


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a trace that nothing happened to."""
    folder = tmp_path_factory.mktemp("finished")
    assert main([*TRACE, str(folder)]) == 0
    return folder


def told(process: subprocess.Popen[str]) -> list[str]:
    """The lines on standard error, each a sentence of the program."""
    lines = process.communicate()[1].splitlines()
    assert all(line.startswith("orbitrace: ") and line.isprintable() for line in lines), lines
    return [line.removeprefix("orbitrace: ") for line in lines]


@pytest.mark.parametrize("limit", [0, 30_000])
def test_files_that_may_not_grow(limit: int, finished: Path, tmp_path: Path) -> None:
    """Assert that a full disk is told sooner or later, that an earlier result stays, and resuming helps."""
    out = tmp_path / "out"
    shutil.copytree(finished, out)
    expected = per.Branch.load(out / "branch.nc")
    kept = {file.name: file.read_bytes() for file in out.iterdir()}

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    process = command(*TRACE, str(out), preexec_fn=limited)
    journal, refused = told(process)
    assert process.returncode == 2
    assert journal.endswith("cannot be written to (File too large); the trace goes on without it")
    check_sentence(refused)
    assert refused.startswith(
        f'--out is "{out}" (File too large); it must be a directory that can be written'
    )
    assert {file.name: file.read_bytes() for file in out.iterdir() if file.name != JOURNAL} == kept
    steps = out.joinpath(JOURNAL).stat().st_size
    assert (steps > 0) == ("--resume goes on from branch.journal" in refused) == (limit > 10_000)
    assert main([*TRACE, str(out), *(["--resume"] if steps else [])]) == 0
    assert per.Branch.load(out / "branch.nc").values == pytest.approx(expected.values, rel=1e-6)


def mounted(tmp_path: Path, options: str, *arguments: str) -> subprocess.Popen[str]:
    """The command line where a directory is a file system of its own, seen by no other process."""
    program = "import sys; from reports.app.cli import main; sys.exit(main())"
    mount = f'mount -t tmpfs -o {options} tmpfs "$0" && exec "$@"'
    line = ["unshare", "--mount", "sh", "-c", mount, str(tmp_path), sys.executable, "-c", program]
    pipes: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([*line, *arguments], **pipes)


def may_mount() -> bool:
    """Whether this user may make file systems that only a process sees."""
    try:
        line = ["unshare", "--mount", "true"]
        return os.geteuid() == 0 and subprocess.run(line, capture_output=True, check=False).returncode == 0
    except OSError:
        return False


needs_mounts = pytest.mark.skipif(not may_mount(), reason="needs the right to mount")


@needs_mounts
@pytest.mark.parametrize("size", ["8k", "60k"])
def test_small_disk(size: str, tmp_path: Path) -> None:
    """Assert that a disk that fills up is told in sentences: of the journal, of the results."""
    process = mounted(tmp_path, f"size={size}", *TRACE, str(tmp_path / "out"))
    lines = told(process)
    assert process.returncode == 2 and 1 <= len(lines) <= 2
    assert lines[-1].startswith(f'--out is "{tmp_path / "out"}" (No space left on device); it must be')


@needs_mounts
def test_read_only_directory(tmp_path: Path) -> None:
    """Assert that a directory that takes no files is refused before the work starts."""
    process = mounted(tmp_path, "ro", *TRACE, str(tmp_path / "out"))
    (said,) = told(process)
    out = tmp_path / "out"
    assert said == f'--out is "{out}" (Read-only file system); it must be a directory that can be written to'
    assert process.returncode == 2


@pytest.mark.parametrize("name", ["branch.nc", "branch.json", JOURNAL, "incomplete"])
def test_directories_in_place_of_files(name: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert that a directory where a file goes, or the other way round, is a refusal or of no concern."""
    (tmp_path / name).mkdir() if name != "incomplete" else (tmp_path / name).touch()
    code = main([*TRACE, str(tmp_path)])
    said = capsys.readouterr().err
    if name == "incomplete":
        assert (code, said) == (0, "")
        return
    assert code == 2 and said.count("\n") == 1
    check_sentence(said.strip().removeprefix("orbitrace: "))
    assert "(Is a directory)" in said


def test_empty_journal_does_not_hide_a_branch(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a trace killed before its first step does not keep an interrupted branch from going on."""
    with monkeypatch.context() as patch:
        interrupt_after(5, patch)
        assert main([*TRACE, str(tmp_path)]) == 130
    (tmp_path / JOURNAL).touch()
    assert main([*TRACE, str(tmp_path), "--resume"]) == 0


class Malicious:
    """Makes a file when it is unpickled."""

    def __init__(self, mark: Path) -> None:
        self.mark = mark

    def __reduce__(self) -> tuple[Any, ...]:
        return (Path.touch, (self.mark,))


def journal(payload: bytes, schema: str = TABLE) -> bytes:
    """A journal of one step with the right digest."""
    with closing(sqlite3.connect(":memory:")) as base:
        base.execute(schema)
        if schema == TABLE:
            base.execute("INSERT INTO steps VALUES (0, ?, ?)", (payload, digest(payload)))
        base.commit()
        return base.serialize()


def archive(**arrays: Any) -> bytes:
    """A file of NumPy arrays, objects allowed."""
    memory = io.BytesIO()
    np.savez(memory, allow_pickle=True, **arrays)
    return memory.getvalue()


def malicious(mark: Path) -> dict[str, bytes]:
    """Files that run something where they are read with less care."""
    thing = np.array([Malicious(mark)], dtype=object)
    said = np.frombuffer(
        json.dumps({"attributes": {}, "dimensions": {"value": ["point"]}}).encode(), np.uint8
    )
    code = f"__import__('pathlib').Path({str(mark)!r}).touch()"
    return {
        "pickle": pickle.dumps(Malicious(mark)),
        "objects": journal(archive(said=said, value=thing)),
        "said": journal(archive(said=thing)),
        "no arrays": journal(pickle.dumps(Malicious(mark))),
        "nothing": journal(b""),
        "view": journal(b"", f"CREATE VIEW steps AS SELECT 0 number, writefile({str(mark)!r}, 0) content"),
        "code": code.encode(),
        "scene": f'title = "{code}"\nkind = "{code}"'.encode(),
        "random": np.random.default_rng(1).bytes(5000),
        "long": journal(bytes(5000))[:700],
    }


@pytest.mark.parametrize("name", list(malicious(Path())))
def test_foreign_files(name: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert that nothing in a file is run, and that it is refused as a scene, a branch and a journal."""
    mark, out = tmp_path / "mark", tmp_path / "out"
    content = malicious(mark)[name]
    out.mkdir()
    for place in (tmp_path / "scene.toml", out / "branch.nc", out / JOURNAL):
        place.write_bytes(content)
        arguments = ("trace", str(place)) if place.suffix == ".toml" else (*TRACE, str(out), "--resume")
        check_sentence(refusal(capsys, *arguments).replace(str(tmp_path), ""))
        assert out.is_dir() and place.read_bytes() == content
    assert not mark.exists()


def test_code_in_attributes(finished: Path, tmp_path: Path) -> None:
    """Assert that no attribute of a branch file is run, its checksum being right."""
    mark, path = tmp_path / "mark", tmp_path / "branch.nc"
    code = f"__import__('pathlib').Path({str(mark)!r}).touch()"
    with xr.open_dataset(finished / path.name, engine="h5netcdf", decode_times=False) as data:
        sound = data.load()
    for name in (*sound.attrs, *(f"layout of {group}" for group in ("states", "outputs"))):
        data = sound.copy()
        if name.startswith("layout of "):
            layout = json.loads(data.attrs["layout"])
            layout[name.rpartition(" ")[2]][0][0] = code
            data.attrs["layout"] = json.dumps(layout)
        else:
            data.attrs[name] = json.dumps(code) if name == "made" else code
        del data.attrs["checksum"]
        data.attrs["checksum"] = storage.checksum(data)
        data.to_netcdf(path, engine="h5netcdf")
        try:
            repr(per.Branch.load(path))
        except per.BranchFileError as error:
            assert "\n" not in str(error)
        assert not mark.exists(), name


def spoilt(content: bytes, random: np.random.Generator) -> bytes:
    """Some bits flipped, a part cut off, taken out or overwritten."""
    changed = bytearray(content)
    place = int(random.integers(len(changed)))
    match int(random.integers(4)):
        case 0:
            return bytes(changed[:place])
        case 1:
            del changed[place : place + int(random.integers(1, 100))]
        case 2:
            changed[place : place + 8] = random.bytes(8)
        case _:
            for _ in range(int(random.integers(1, 4))):
                changed[int(random.integers(len(changed)))] ^= 1 << int(random.integers(8))
    return bytes(changed)


def check_spoilt(count: int, seed: int, sound: bytes, folder: Path) -> None:
    """Assert that a spoilt branch file is refused in a sentence or holds just what it held; quietly."""
    path, random, refused = folder / "branch.nc", np.random.default_rng(seed), 0
    path.write_bytes(sound)
    wanted = storage.checksum(storage.dataset(per.Branch.load(path)))
    for _ in range(count):
        path.write_bytes(spoilt(sound, random))
        try:
            assert storage.checksum(storage.dataset(per.Branch.load(path))) == wanted
        except per.BranchFileError as error:
            assert str(error).startswith("branch file ") and "\n" not in str(error)
            refused += 1
    assert refused > count / 2


def test_spoilt_branch_files(finished: Path, tmp_path: Path) -> None:
    """Assert it of sixty."""
    check_spoilt(60, 0, (finished / "branch.nc").read_bytes(), tmp_path)


@pytest.mark.long
def test_many_spoilt_branch_files(finished: Path, tmp_path: Path) -> None:
    """Assert it of two thousand."""
    check_spoilt(2000, 1, (finished / "branch.nc").read_bytes(), tmp_path)


def test_file_that_promises_more_than_it_has(tmp_path: Path) -> None:
    """Assert that arrays of a size that no file of this length holds are not read."""
    import h5py

    path = tmp_path / "branch.nc"
    with h5py.File(path, "w") as file:
        file.attrs["format"] = storage.FORMAT
        file.create_dataset("value", shape=(2**40,), dtype=float, chunks=(1024,))
    with pytest.raises(per.BranchFileError, match="is damaged"):
        per.Branch.load(path)


def test_interrupt_where_nothing_listens(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that Ctrl-C in a command that has nothing to save ends it quietly, with a shell's exit code."""

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("reports.app.linear.study.study", interrupted)
    assert main(["linear", "duffing", "--out", str(tmp_path)]) == 130
    assert capsys.readouterr().err == "" and list(tmp_path.iterdir()) == []
