"""Scene files whose names, titles and file names are written to break what the command line makes of them."""

from __future__ import annotations

import csv
import io
import json
import sys
import time
import tomllib
from pathlib import Path
from typing import Any

import pytest
from support.commands import Capture, Patch
from support.pages import opened

from periodic.results.textcell import text_cell
from reports.app.cli import main
from reports.app.console import status, table
from reports.app.doctor import numbers

TITLE = "</title><script>window.broken=1</script> @@DATA@@ {{ data }} $\\frac{$"
NAME = "=<img src=x onerror=window.broken=1>$\\frac{$"
SCENE = """
title = TITLE
kind = "model"
[parameters]
"-O<script>" = {value = 0.5, unit = "rad/s"}
[[coordinate]]
name = NAME
[[part]]
kind = "Mass"
q = NAME
m = 1.0
[[part]]
kind = "Support"
q = NAME
k = 1.0
c = 0.1
[[part]]
kind = "HarmonicForce"
q = NAME
force = 0.2
frequency = "-O<script>"
[trace]
parameter = "-O<script>"
from = 0.5
to = 0.6
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A scene file; TOML's basic strings are those of JSON."""
    file = tmp_path_factory.mktemp("scene") / "=<img src=x onerror=window.broken=1>@@DATA@@.toml"
    file.write_text(SCENE.replace("TITLE", json.dumps(TITLE)).replace("NAME", json.dumps(NAME)), "utf-8")
    return str(file)


def heads(file: Path) -> list[str]:
    """The heads of a table."""
    return next(csv.reader(io.StringIO(file.read_text("utf-8"))))


def test_trace(scene: str, browser: Any, tmp_path: Path) -> None:
    """Assert that files are written, that the page shows all and runs nothing, and heads that are text."""
    assert main(["trace", scene, "--html", "--out", str(tmp_path)]) == 0
    with opened(browser, tmp_path / "branch.html") as page:
        page.wait_for_timeout(50)
        assert page.evaluate("window.broken") is None
        assert page.title() == TITLE and page.inner_text("h1") == TITLE
        assert page.text_content("#said").startswith("EP  -O<script> 0.5 rad/s · " + NAME)
        assert page.text_content("#branch .xtitle") == "-O<script> (rad/s)"
    assert heads(tmp_path / "branch.csv")[:2] == ["'-O<script>", f"'{NAME}_pp"]
    assert (tmp_path / "branch.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "branch.json").read_text("utf-8"))["scene"] == Path(scene).stem


def test_linear(scene: str, tmp_path: Path) -> None:
    """Assert the same of a linear study."""
    assert main(["linear", scene, "--out", str(tmp_path)]) == 0
    found = heads(tmp_path / "linear.csv")
    assert found[:2] == ["'-O<script>", "excitation_hz"] and found[2] == f"'{NAME}_pp_m"
    assert all(text_cell(head) == head for head in found)
    assert (tmp_path / "linear.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("text", ["\x1b[31m", "a\rb", "a\nb", "\u202e"])
@pytest.mark.parametrize("key", ["title", "name", "unit", "parameter"])
def test_text_that_a_terminal_would_obey(key: str, text: str, tmp_path: Path, capsys: Capture) -> None:
    """Assert one sentence that shows it written out."""
    given = SCENE.replace("-O<script>", "O" if key != "parameter" else json.dumps(text)[1:-1])
    given = given.replace("TITLE", json.dumps(text if key == "title" else "a title"))
    unit = json.dumps(text if key == "unit" else "m")
    given = given.replace("name = NAME", f"name = NAME\nunit = {unit}")
    (tmp_path / "a.toml").write_text(
        given.replace("NAME", json.dumps(text if key == "name" else "x")), "utf-8"
    )
    assert main(["trace", str(tmp_path / "a.toml"), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and said[:-1].isprintable() and "line of text" in said


@pytest.mark.parametrize("command", [["trace"], ["linear"], ["map", "--over", "k=1:2:2", "--jobs", "1"]])
def test_files_that_a_terminal_would_obey(command: list[str], tmp_path: Path, capsys: Capture) -> None:
    """Assert that names of files and directories are printed on one line, with such signs written out."""
    file, out = tmp_path / "\x1b[31m\n[red].toml", tmp_path / "\u202e\nout"
    given = SCENE.replace("-O<script>", "O").replace("TITLE", '"a title"').replace("NAME", '"x"')
    file.write_text(given.replace('q = "x"\nm', 'q = "x"\nname = "M"\nm'), "utf-8")
    assert main([command[0], str(file), *command[1:], "--out", str(out)]) == 0
    told = capsys.readouterr()
    assert all(line.isprintable() for line in (told.out + told.err).splitlines())
    assert r"\u202e\nout" in told.out


def test_what_is_shown_of_work(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that neither a terminal nor Rich obeys what is shown of work, and of a table."""
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with status("tracing [red]\x1b]0;a\x07") as update:
        assert update is not None
        update("then [/nothing]\x1b]0;b\x07")
        time.sleep(0.3)
    table(["[red]\x1b]0;c\x07"], [["[/]\x1b]0;d\x07"]], left="")
    told = capsys.readouterr()
    assert "\x1b]0;" not in told.err + told.out
    assert r"[/nothing]\x1b]0;b\x07" in told.err
    assert r"[red]\x1b]0;c\x07" in told.out and r"[/]\x1b]0;d\x07" in told.out


def test_doctor(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert the same of what the doctor says of the environment."""
    monkeypatch.setenv("OMP_NUM_THREADS", "1\x1b[31m\nchecks")
    monkeypatch.setattr(numbers, "CHECKS", {"one": (1e-7, lambda: ([1.0], [1.0]))})
    assert main(["doctor"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert all(line.isprintable() for line in told)
    assert [line for line in told if r"1\x1b[31m\nchecks" in line]


def test_file_of_a_new_scene(tmp_path: Path, capsys: Capture) -> None:
    """Assert that the name of a file does not end the comment that it stands in."""
    file = tmp_path / "a\ntitle = 1.toml"
    assert main(["new", "model", str(file)]) == 0
    assert tomllib.loads(file.read_text("utf-8"))["title"] == "Forced oscillator with a stop"
    assert capsys.readouterr().out.count("\n") == 1
