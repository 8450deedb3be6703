"""The command `orbitrace export` and the page that `trace --html` writes."""

from __future__ import annotations

import json
import re
from importlib.util import find_spec
from pathlib import Path

import h5py
import pytest
from support.commands import Capture, check_sentence, refusal

import periodic as per
from periodic.results.interactive import library
from reports.app.cli import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a short branch of the disc, with a page."""
    pytest.importorskip("plotly")
    made = tmp_path_factory.mktemp("disc")
    arguments = ["trace", "vitrea79-810N", "--to", "450", "--accuracy", "draft", "--html", "--out", str(made)]
    assert main(arguments) == 0
    return made


@pytest.mark.parametrize("source", [".", "branch.nc"])
def test_export(source: str, folder: Path, tmp_path: Path, capsys: Capture) -> None:
    """Assert that a directory and a file are exported to a folder that is made, with so many samples."""
    file = tmp_path / "new" / "disc.h5"
    assert main(["export", str(folder / source), str(file), "--samples", "32"]) == 0
    assert capsys.readouterr().out == f"written: {file}\n"
    with h5py.File(file) as found:
        assert found["orbits/x"].shape == (len(per.Branch.load(folder / "branch.nc")), 32)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("nowhere", "a.h5"), 'BRANCH is "nowhere"; it must be a branch that can be read'),
        ((".", "a.xls"), "FILE is 'a.xls'; it must be a file that ends in .csv, .mat, .h5"),
        ((".", "a.h5", "--samples", "2"), "--samples is 2; it must be a whole number of at least 4"),
        ((".", "a.h5", "--samples", "two"), '--samples is "two"; it must be a whole number'),
        (
            (".", "branch.nc/a.h5"),
            'FILE is "branch.nc/a.h5" (File exists); it must be a file that can be',
        ),
    ],
)
def test_refusals(
    arguments: tuple[str, ...], said: str, folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert one sentence and exit code 2."""
    monkeypatch.chdir(folder)
    found = refusal(capsys, "export", *arguments)
    assert found.startswith(said)
    check_sentence(found)


def test_page_is_in_the_units_of_the_scene(folder: Path) -> None:
    """Assert that the page shows rev/min and micrometres."""
    text = (folder / "branch.html").read_text("utf-8")
    (data,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    told = json.loads(data)
    assert told["parameter"] == {"name": "speed", "unit": "rev/min"}
    assert {"name": "x", "unit": "µm"} in told["signals"]
    assert [told["points"][k]["at"] for k in (0, -1)] == pytest.approx([500, 450])


@pytest.mark.parametrize("package", ["jinja2", "plotly"])
def test_page_without_a_package(
    package: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a missing package is told before the work starts."""
    monkeypatch.setattr(library, "find_spec", lambda name: None if name == package else find_spec(name))
    said = refusal(capsys, "trace", "duffing", "--html", "--out", str(tmp_path / "out"))
    assert said == f"--html needs the package {package}; pip install 'orbitrace[html]' installs it"
    assert not (tmp_path / "out").exists()
