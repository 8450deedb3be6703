"""The command line as tests call it."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import periodic as per
from reports.app.cli import main

Capture = pytest.CaptureFixture[str]


Patch = pytest.MonkeyPatch


def refusal(capsys: Capture, *arguments: str) -> str:
    """Return the one line with which a command line is refused."""
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("orbitrace: ") and told.err.count("\n") == 1
    return told.err.removeprefix("orbitrace: ").rstrip()


def changed(monkeypatch: Patch, change: Callable[..., per.Branch]) -> None:
    """Put `change(trace, *args, **kwargs)` in the place of `periodic.trace`."""
    original = per.trace
    monkeypatch.setattr(per, "trace", lambda *args, **kwargs: change(original, *args, **kwargs))


def command(*arguments: str, **options: Any) -> subprocess.Popen[str]:
    """The command line in a process of its own."""
    program = "import sys; from reports.app.cli import main; sys.exit(main())"
    pipes = {"stderr": subprocess.PIPE, "text": True, **options}
    return subprocess.Popen([sys.executable, "-c", program, *arguments], **pipes)


def wait_for_points(process: subprocess.Popen[str], folder: Path, count: int) -> None:
    """Wait until the journal of a trace that another process runs holds so many points, or the trace ends."""
    while process.poll() is None and journalled(folder / "branch.journal") < count:
        time.sleep(0.01)


def journalled(journal: Path) -> int:
    """How many points a journal holds; 0 while it has none."""
    try:
        return len(per.recovered(journal)) if journal.is_file() else 0
    except per.BranchFileError:
        return 0


def interrupt_after(count: int, monkeypatch: Patch) -> None:
    """Let every trace be interrupted at its point of this number."""

    def interrupted(trace: Any, *args: Any, **kwargs: Any) -> per.Branch:
        seen: list[per.Point] = []

        def press(point: per.Point) -> None:
            seen.append(point)
            if len(seen) == count:
                raise KeyboardInterrupt

        watch = replace(kwargs.get("watch", per.Watch()), progress=press)
        branch: per.Branch = trace(*args, **{**kwargs, "watch": watch})
        return branch

    changed(monkeypatch, interrupted)


BOILERPLATE = ("Traceback", "further information", "validation error", "Error(", "input_value", "pydantic")


def check_sentence(said: str) -> None:
    """Assert that a refusal is one line of a reasonable length: a field, what it is; what is allowed."""
    field, _, rest = said.partition(" ")
    found, _, allowed = rest.rpartition("; ")
    assert field and found and allowed
    assert said.isprintable() and len(said) < 500, said
    assert not any(words in said for words in BOILERPLATE), said
