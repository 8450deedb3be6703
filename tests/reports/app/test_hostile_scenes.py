"""Scene files whose names, titles and file names are written to break what the command line makes of them."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import pytest
from support.pages import opened

from periodic.results.textcell import text_cell
from reports.app.cli import main

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
