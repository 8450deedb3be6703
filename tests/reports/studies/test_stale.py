"""The list of what another engine has computed."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from reports.studies.pages.content import Found, Kept, Section
from reports.studies.pages.engine import current
from reports.studies.pages.page import Page
from reports.studies.stale import REPORTS, TEXTS, main, of_report, of_text

NAMES = ("new", "old", "foreign", "unknown", "missing")


def commit(root: Path, name: str, text: str) -> None:
    """Commit a file."""
    (root / name).parent.mkdir(parents=True, exist_ok=True)
    (root / name).write_text(text, "utf-8")
    who = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
    for command in (("init", "-q"), ("add", "."), (*who, "commit", "-q", "-m", name)):
        subprocess.run(["git", *command], cwd=root, check=True)


def test_sections_of_other_engines(tmp_path: Path) -> None:
    """Assert what is said of sections by the engine here, an older one, a foreign one, none recorded."""
    page = Page(
        name="toy",
        folder=tmp_path / "reports",
        sections=dict.fromkeys(NAMES, Section(title="", compute=lambda _: Found(numbers={}))),
    )
    commit(tmp_path, "periodic/a.py", "a = 1\n")
    old = current(tmp_path)
    commit(tmp_path, "reports/sections/unknown.json", '{"numbers": {}, "rows": []}')
    commit(tmp_path, "symbolic/a.py", "a = 1\n")
    commit(tmp_path, "periodic/a.py", "a = 2\n")
    now = current(tmp_path)
    engines = {"new": (now, 1.0), "old": (old, 41.7), "foreign": (type(old)(sources="0", commit="dead"), 2.0)}
    for name, (engine, seconds) in engines.items():
        kept = Kept(engine=engine, seconds=seconds, numbers={}, rows=[])
        (tmp_path / "reports" / "sections" / f"{name}.json").write_text(kept.written(), "utf-8")
    found = {line[1]: line for line in of_report(page, now.sources, tmp_path)}
    assert list(found) == ["foreign", "old", "unknown", "missing"]  # quickest first
    assert found["old"] == ("toy", "old", f"at commit {old.commit}", "2", "42")
    assert found["foreign"] == ("toy", "foreign", "at commit dead", "not in this history", "2")
    at = found["unknown"][2].removeprefix("not recorded, kept at commit ")
    assert found["unknown"] == ("toy", "unknown", f"not recorded, kept at commit {at}", "2", "")
    assert found["missing"] == ("toy", "missing", "nothing", "", "")
    commit(tmp_path, "tests/README.md", f"By `a.py` of commit `{old.commit}` and commit `{now.commit}`.")
    assert list(of_text("tests", tmp_path)) == [("tests", "", f"at commit {old.commit}", "2", "")]


def test_all_pages_are_looked_at(capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that every folder with sections is a report of the list, and that the count is said."""
    root = Path(__file__).parents[3]
    folders = {file.parent for file in (root / "reports").rglob("sections")}
    assert folders == {page.folder for page in REPORTS}
    assert all("commit `" in (root / folder / "README.md").read_text("utf-8") for folder in TEXTS)
    main()
    count = sum(len(page.sections) for page in REPORTS)
    assert f" of {count} sections of reports are not by the engine" in capsys.readouterr().out


@pytest.mark.parametrize("page", REPORTS, ids=lambda page: page.name)
def test_tests_that_a_page_names_are_there(page: Page) -> None:
    """Assert that each test or folder of tests that a report names exists."""
    root = Path(__file__).parents[3]
    text = (page.folder / "README.md").read_text("utf-8")
    for name in re.findall(r"\btests/[\w/]+(?:\.py)?", text):
        assert (root / name).exists(), name
