"""`python -m reports.studies.stale` lists what the engine that is here has not computed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from reports.app.console import table
from reports.studies.decide.page import REPORT as DECIDE
from reports.studies.extremes.page import REPORT as EXTREMES
from reports.studies.machines.page import REPORT as MACHINES
from reports.studies.motions.page import REPORT as MOTIONS
from reports.studies.pages.content import Kept
from reports.studies.pages.engine import ROOT, commit_of, commits_since, current, sources
from reports.studies.pages.page import KEPT, Page
from reports.studies.paper.page import REPORT as PAPER
from reports.studies.proof.page import REPORT as PROOF
from reports.studies.structures.page import REPORT as STRUCTURES
from reports.studies.trade.page import REPORT as TRADE

REPORTS = (PAPER, TRADE, EXTREMES, MACHINES, STRUCTURES, PROOF, DECIDE, MOTIONS)

TEXTS = ("tests/survey", "tests/mutants")
"""Folders of pages that name the commit of their engine in the text, for all that is on them."""

HEADINGS = ("page", "section", "computed by", "engine commits since", "CPU s")

Line = tuple[str, str, str, str, str]
"""A row of the list, by HEADINGS."""


def of_report(page: Page, now: str, root: Path = ROOT) -> Iterator[Line]:
    """Yield the sections of a report that an engine with these sources has not computed."""
    kept = page.kept(page.folder)
    for name in page.stale(page.folder, now):
        found = kept.get(name)
        told = _unrecorded(page, name, root) if found is None or found.engine is None else _by(found, root)
        seconds = "" if found is None or found.seconds is None else f"{found.seconds:.0f}"
        yield page.name, name, *told, seconds


def _by(kept: Kept, root: Path) -> tuple[str, str]:
    """What computed a section, and how many commits have changed the engine since."""
    engine = kept.engine
    assert engine is not None
    return str(engine).removeprefix("engine ").replace("`", ""), _since(engine.commit, root)


def _unrecorded(page: Page, name: str, root: Path) -> tuple[str, str]:
    """When a section was kept whose engine is not known."""
    file = page.folder / KEPT / f"{name}.json"
    commit = commit_of(file, root) if file.exists() else ""
    return (f"not recorded, kept at commit {commit}", _since(commit, root)) if commit else ("nothing", "")


def _since(commit: str, root: Path) -> str:
    count = commits_since(commit, root) if commit else None
    return "not in this history" if count is None else str(count)


def of_text(folder: str, root: Path = ROOT) -> Iterator[Line]:
    """Yield the commits that a page names whose engine has been changed since."""
    text = (root / folder / "README.md").read_text("utf-8")
    for commit in re.findall(r"commit `(\w+)`", text):
        count = _since(commit, root)
        if count != "0":
            yield folder, "", f"at commit {commit}", count, ""


def main() -> None:
    """Print the list."""
    now = sources()
    rows = [line for page in REPORTS for line in of_report(page, now)]
    texts = [line for folder in TEXTS for line in of_text(folder)]
    if rows or texts:
        table(HEADINGS, rows + texts, "section")
    count = sum(len(page.sections) for page in REPORTS)
    print(f"{len(rows)} of {count} sections of reports are not by the {current()}")


if __name__ == "__main__":
    main()
