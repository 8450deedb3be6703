"""The command line of a study: what it keeps, what it refuses, and what the page says that it makes."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from jinja2 import UndefinedError
from matplotlib.figure import Figure

from reports.studies.pages import page as pages
from reports.studies.pages.command import command
from reports.studies.pages.content import Found, Kept, Section
from reports.studies.pages.engine import Engine
from reports.studies.pages.page import Page
from symbolic.scenes.errors import InputError

pytestmark = pytest.mark.studies

Capture = pytest.CaptureFixture[str]


def drawn() -> Figure:
    figure = Figure()
    figure.subplots().plot([0, 1])
    return figure


def speed(tell: Callable[[str], None]) -> Found:
    tell("working")
    return Found(
        numbers={"speed rpm": 330.5}, rows=[{"name": "a", "value": 1.25}], figures={"curve": drawn()}
    )


def interrupted(tell: Callable[[str], None]) -> Found:
    raise KeyboardInterrupt


ENGINE = Engine(sources="0a1b2c3d4e", commit="abcdef0123")


@pytest.fixture(autouse=True)
def engine(monkeypatch: pytest.MonkeyPatch) -> Callable[[Engine], None]:
    """What makes an engine the one that is here; at first ENGINE."""

    def here(engine: Engine) -> None:
        monkeypatch.setattr(pages, "current", lambda: engine)
        monkeypatch.setattr(pages, "sources", lambda: engine.sources)

    here(ENGINE)
    return here


@pytest.fixture
def page(tmp_path: Path) -> Page:
    """A page of three sections whose second is never done."""
    folder = tmp_path / "study"
    folder.mkdir()
    (folder / "introduction.md.j2").write_text(
        "# A study of speeds, made for tests alone\n\n{{ kept | length }} of {{ count }} sections.", "utf-8"
    )
    (folder / "speed.md.j2").write_text(
        'At {{ n["speed rpm"] | fmt(".2f") }} rev/min, {{ limit }} allowed.\n\n'
        "![What it\nshows.](curve.png)\n\n"
        "{% for row in rows %}\n| {{ row.name }} | {{ row.value | fmt('+.1%') }} |\n{% endfor %}\n",
        "utf-8",
    )
    fast = Section(title="Speed", compute=speed, context=lambda _: {"limit": 3})
    again = Section(title="Again", compute=speed, context=lambda _: {"limit": 4}, template="speed.md.j2")
    sections = {"speed": fast, "late": Section(title="Late", compute=interrupted), "again": again}
    return Page(name="toy", folder=folder, sections=sections, context=lambda _: {"count": 3})


def test_page_is_made_of_templates_and_kept_data(
    page: Page, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the whole page, with numbers, a table, a figure with its caption and what is missing."""
    out = tmp_path / "out"
    monkeypatch.setattr(pages, "spent", iter((5.0, 47.26)).__next__)
    assert command(page, ["--only", "speed", "--out", str(out)]) == 0
    told = capsys.readouterr()
    assert told.out == f"written: {out / 'README.md'}\n" and "computing speed: working" in told.err
    assert (
        (out / "README.md").read_text("utf-8")
        == """\
# A study of speeds, made for tests alone

1 of 3 sections.

1. Speed

## 1. Speed

At 330.50 rev/min, 3 allowed.

![What it shows.](figures/curve.png)

*What it shows.*

| a | +125.0% |

*By the engine at commit `abcdef0123`, in 42 s of processor time.*

Sections not computed yet: late, again.

*`make report-toy` computes this page, `make report-toy SECTION="NAME ..."` some of its sections
(speed, late, again), and `make stale` lists those whose engine has changed since.*
"""
    )
    assert (out / "figures" / "curve.png").stat().st_size > 1000


def test_interrupted_study_keeps_what_is_done(page: Page, tmp_path: Path, capsys: Capture) -> None:
    """Assert that an interrupted study keeps its finished sections, and goes on with another."""
    assert command(page, ["--out", str(tmp_path)]) == 130
    assert f"interrupted; the sections computed so far are in {tmp_path}" in capsys.readouterr().err
    assert list(page.kept(tmp_path)) == ["speed"]
    assert command(page, ["--only", "again", "--out", str(tmp_path)]) == 0
    assert list(page.kept(tmp_path)) == ["speed", "again"]
    assert "\n3. Again\n" in (tmp_path / "README.md").read_text("utf-8")


def test_stale_sections_are_computed_alone(
    page: Page, tmp_path: Path, engine: Callable[[Engine], None]
) -> None:
    """Assert which sections are stale, quickest first, and that another commit of the same engine is none."""
    assert command(page, ["--only", "again", "speed", "--out", str(tmp_path)]) == 0
    assert page.stale(tmp_path) == ["late"]
    engine(replace(ENGINE, commit="0123456789"))
    assert page.stale(tmp_path) == ["late"]
    newer = Engine(sources="ffffffffff", commit="0123456789")
    engine(newer)
    for name, seconds in (("speed", "7.5"), ("again", "2.5")):
        file = tmp_path / "sections" / f"{name}.json"
        file.write_text(re.sub(r'"seconds": [\d.]+', f'"seconds": {seconds}', file.read_text()))
    assert page.stale(tmp_path) == ["again", "speed", "late"]
    before = (tmp_path / "README.md").read_text("utf-8")
    page.make(tmp_path, ["again"], lambda _: None)  # the page keeps what is older
    assert (tmp_path / "README.md").read_text("utf-8") == page.text(tmp_path) != before
    assert "## 1. Speed" in page.text(tmp_path) and page.stale(tmp_path) == ["speed", "late"]
    assert command(page, ["--stale", "--out", str(tmp_path)]) == 130  # the last is never done
    assert page.stale(tmp_path) == ["late"]
    assert [kept.engine for kept in page.kept(tmp_path).values()] == [newer, newer]
    (tmp_path / "README.md").unlink()
    assert page.make(tmp_path, [], lambda _: None).read_text("utf-8") == page.text(tmp_path)


def test_engine_that_changes_meanwhile(page: Page, tmp_path: Path, capsys: Capture) -> None:
    """Assert that a section is not kept whose engine's sources have changed while it was computed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pages, "sources", lambda: "ffffffffff")
        assert command(page, ["--only", "speed", "--out", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "periodic/ or symbolic/ changed while section speed was computed, which is not kept; they" in told
    assert page.kept(tmp_path) == {}


def test_section_of_before_engines_were_recorded(page: Page, tmp_path: Path) -> None:
    """Assert that such a section is read, said to be so and stale."""
    (tmp_path / "sections").mkdir()
    file = tmp_path / "sections" / "speed.json"
    file.write_text('{"numbers": {"speed rpm": 1.0}, "rows": []}')
    assert page.kept(tmp_path)["speed"] == Kept(numbers={"speed rpm": 1.0}, rows=[])
    assert "*By an engine that was not recorded.*" in page.text(tmp_path)
    assert "speed" in page.stale(tmp_path)


@pytest.mark.parametrize("spoilt", ["README.md", "figures", "sections"])
def test_folder_of_something_else(spoilt: str, page: Page, tmp_path: Path, capsys: Capture) -> None:
    """Assert that a study refuses, before it computes, a folder that holds something else by its names."""
    file = tmp_path / spoilt
    if spoilt == "sections":
        file.mkdir()
        file = file / "again.json"
    file.write_text("{ my own notes", "utf-8")
    assert command(page, ["--only", "speed", "--out", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert told.startswith("python -m reports.studies.toy: --out is ") and told.count("\n") == 1
    assert file.read_text("utf-8") == "{ my own notes"


def test_missing_number_fails(page: Page, tmp_path: Path) -> None:
    """Assert that a number that a template names and nothing kept has is an error, unless computed anew."""
    page.make(tmp_path, ["speed"], lambda _: None)
    kept = tmp_path / "sections" / "speed.json"
    kept.write_text(kept.read_text("utf-8").replace("speed rpm", "speed"), "utf-8")
    with pytest.raises(UndefinedError, match="speed rpm"):
        page.text(tmp_path)
    assert page.unfit(tmp_path, ["speed"]) == ["speed"] and page.unfit(tmp_path, []) == []
    with pytest.raises(InputError, match="speed rpm"):
        page.ready(tmp_path, ["again"])
    assert page.ready(tmp_path, ["speed"]) == tmp_path


def test_interrupted_section_is_no_section(tmp_path: Path) -> None:
    """Assert that Ctrl-C in the middle of a section ends the study at once and writes nothing of it."""
    study = [sys.executable, "-m", "reports.studies.paper", "--only", "frequency", "--out", str(tmp_path)]
    with subprocess.Popen(study, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert "traces in speed" in process.stderr.readline()
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        said = process.stderr.read()
    assert process.returncode == 130
    assert f"interrupted; the sections computed so far are in {tmp_path}" in said
    assert list((tmp_path / "sections").iterdir()) == []


def test_full_disk(page: Page, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a page that cannot be written is said to be so, and not the standard output."""

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    assert command(page, ["--only", "speed", "--out", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert f'--out is "{tmp_path / "sections"}" (No space left on device)' in told


def test_unknown_section(page: Page, capsys: Capture) -> None:
    """Assert that a section that is not there is refused with the names of those that are."""
    with pytest.raises(SystemExit) as ended:
        command(page, ["--only", "none"])
    assert ended.value.code == 2
    assert "'speed', 'late', 'again'" in capsys.readouterr().err
