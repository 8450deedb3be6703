"""The report on proofs: its page is that of its sections, and quick ones are computed anew."""

from __future__ import annotations

import re

import pytest

from reports.studies.pages.page import PAGE
from reports.studies.proof.page import REPORT

pytestmark = pytest.mark.studies
pytest.importorskip("flint")

FOLDER = REPORT.folder

QUICK = ("stop", "van-der-pol", "impact-oscillator", "impact-oscillator-stretches")
"""Sections that take seconds."""

NOT_DECIDED = dict.fromkeys(
    ("dry-810N", "vitrea79-810N", "journal-bearing", "jenkins-damper", "duffing-stretches", "stiffness"), 1
)
"""How many points of a section are not proven, or not all of a stretch; none of the others."""


@pytest.mark.parametrize(
    "name", [n if n in QUICK else pytest.param(n, marks=pytest.mark.long) for n in REPORT.sections]
)
def test_sections_are_fresh(name: str) -> None:
    """Assert that what is proven anew is what the page says, with boxes and distances of its size."""
    kept, found = REPORT.kept(FOLDER)[name], REPORT.sections[name].compute(lambda _: None)
    assert len(found.rows) == len(kept.rows)
    for row, other in zip(found.rows, kept.rows, strict=True):
        same = ("label", "proven", "stable", "pieces", "accepted", "low", "high", "word")
        assert [row.get(key) for key in same] == [other.get(key) for key in same]
        if "place" not in row:
            continue
        assert row["place"] == pytest.approx(other["place"], rel=1e-7)
        assert row["distance"] <= 10 * max(other["distance"], 1e-12)
        assert row["radius"] <= max(10 * other["radius"], 1e-18)


def test_what_is_proven() -> None:
    """Assert what is not decided, that the checker accepts all else, and the greatest box."""
    kept = REPORT.kept(FOLDER)
    left = {name: sum(not row["proven"] for row in each.rows) for name, each in kept.items()}
    assert {name: count for name, count in left.items() if count} == NOT_DECIDED
    rows = [row for each in kept.values() for row in each.rows if row["proven"]]
    assert all(row["accepted"] for row in rows)
    assert max(row["radius"] for row in rows if "high" not in row) < 1e-9
    assert all(row["distance"] <= row["estimate"] for row in rows)


def test_a_stretch_that_ends_at_a_fold() -> None:
    """Assert that it ends less than 1e-6 above Duffing's lower fold."""
    last = REPORT.kept(FOLDER)["duffing-stretches"].rows[-1]
    found = re.match(r"proven from (\S+) to 1\.45 only", last["says"])
    assert last["accepted"] and found and 0 < float(found[1]) - 1.438670145514 < 1e-6


def test_known_numbers() -> None:
    """Assert the folds of the gear pair in nine digits, and that twenty cycles of Lorenz' are there."""
    kept = REPORT.kept(FOLDER)
    folds = [row["place"] for row in kept["gear-pair"].rows if row["label"] == "LP"]
    assert folds == pytest.approx([0.598153117286, 0.835837679095], rel=1e-9)
    assert len(kept["lorenz"].rows) == 20
    assert len(kept["lorenz-words"].rows) == 21


def test_page_is_that_of_its_sections() -> None:
    """Assert that text and numbers on the page are those of the code, and that nothing is missing."""
    page = (FOLDER / PAGE).read_text("utf-8")
    assert page == REPORT.text(FOLDER)
    assert tuple(REPORT.kept(FOLDER)) == tuple(REPORT.sections)
    assert not re.findall(r"\bnan\b|\binf\b", page)
