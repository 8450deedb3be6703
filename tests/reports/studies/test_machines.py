"""The report on machines: its numbers are those of the code, and those that are known."""

from __future__ import annotations

import re

import pytest
from support.fresh import assert_fresh

from reports.studies.machines import films
from reports.studies.machines.machine import special
from reports.studies.machines.page import MACHINES, REPORT
from reports.studies.pages.page import PAGE
from reports.studies.pages.text import FIGURES

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder
NEAR = {"peak": 1e-5, "p-p": 1e-5}
"""Relative differences from known numbers that were read from samples; 2e-8 for the others."""

WHOLE = ("jeffcott-internal-damping", "journal-bearing")
"""Quick sections, computed whole."""

QUICK = ("gear-pair",)
"""Of these the branch, without what is marched or followed over two parameters."""


@pytest.mark.parametrize("name", [n for n, machine in MACHINES.items() if machine.known])
def test_known_numbers(name: str) -> None:
    """Assert that the numbers kept are the known ones."""
    kept = REPORT.kept(FOLDER)[name].numbers
    for known in MACHINES[name].known:
        near = next((v for key, v in NEAR.items() if key in known.name), 2e-8)
        assert kept[known.name] == pytest.approx(known.value, rel=near), known.name


@pytest.mark.parametrize("name", WHOLE)
def test_sections_are_fresh(name: str) -> None:
    """Assert that quick sections, computed whole, are what the page was made from."""
    assert_fresh(REPORT, name, {"swing$": 1e-5})


@pytest.mark.unaccounted  # where its slider first slips, the Jenkins damper's branch turns by 4e-6
@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[] if n in QUICK else [pytest.mark.long]) for n in MACHINES if n not in WHOLE],
)
def test_branches_are_fresh(name: str) -> None:
    """Assert that a branch traced anew has the special points and numbers of the page."""
    machine, kept = MACHINES[name], REPORT.kept(FOLDER)[name]
    found = machine.branch()
    assert machine.numbers(found) == pytest.approx(kept.numbers, rel=1e-6)
    rows = [machine.row(point) for point in special(found)]
    assert [row["label"] for row in rows] == [row["label"] for row in kept.rows]
    for row, other in zip(rows, kept.rows, strict=True):
        assert row["place"] == pytest.approx(other["place"], rel=1e-6)
        assert row["swing"] == pytest.approx(other["swing"], rel=1e-5)


def test_films() -> None:
    """Assert the known films by the grouping that they come of, and the kept ones of the law."""
    kept = REPORT.kept(FOLDER)["films"].numbers
    for (load, oil), value in films.PRINTED.items():
        assert films.regrouped(load, oil) == pytest.approx(value, rel=2e-6)
        assert kept[f"regrouped({load:g}, {oil:g})"] == pytest.approx(value, rel=2e-6)


def test_page_is_that_of_its_sections() -> None:
    """Assert that text and numbers on the page are those of the code, that nothing is missing or too much."""
    page = (FOLDER / PAGE).read_text("utf-8")
    assert page == REPORT.text(FOLDER)
    assert tuple(REPORT.kept(FOLDER)) == tuple(REPORT.sections)
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", page)
    assert sorted(shown) == sorted(file.name for file in (FOLDER / FIGURES).iterdir())
