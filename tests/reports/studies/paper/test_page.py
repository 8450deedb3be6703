"""The committed page of the report on the paper: complete, put together from its sections, and not stale."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest

from reports.studies.pages.content import Kept
from reports.studies.pages.page import PAGE
from reports.studies.pages.text import FIGURES, rendered
from reports.studies.paper import damping, filmlaws, frequency, regions, supports, timedomain, unseen
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import Row, Verdict, compared, rows

pytestmark = pytest.mark.studies

NUMBERS: dict[str, Callable[[], Mapping[str, float]]] = {
    "timedomain": timedomain.key_numbers,
    "damping": damping.key_numbers,
    "frequency": frequency.numbers,
    "supports": lambda: supports.numbers() | supports.branch_numbers(),
    "unseen": unseen.numbers,
}
WHOLE = ("timedomain", "damping", "frequency", "unseen")
"""Sections of which NUMBERS computes all the numbers."""

ROUGH = re.compile(
    r".*(_settled_s|(?<!_orbit)_decay_per_s|_free_Hz|_forced_Hz|_early_film_um|_early_deflection_um|_fig\w+_x_um|_until_ms"
    r"|_(?<!rest_)damping|_zeta_read_mean|_zeta_read_highest|_zeta_second|_zeta_second_read"
    r"|_zeta_transient_rk4|_zeta_transient_rk4_80us|_free_taken_for_steady_um|_free_left_um|_free_left_paper_um"
    r"| difference| second direction)"
)
"""Names of the numbers read off transients, or that are rounding errors, which are known to fewer digits."""


def kept(name: str) -> Kept:
    """What the page was made from."""
    return REPORT.kept(REPORT.folder)[name]


def page() -> str:
    """The committed page."""
    return (REPORT.folder / PAGE).read_text("utf-8")


def assert_fresh(name: str, found: Mapping[str, float]) -> None:
    """Assert that numbers computed anew are those that the page was made from."""
    told = kept(name).numbers
    assert set(found) <= set(told)
    for key, value in found.items():
        rough = ROUGH.fullmatch(key)
        assert value == pytest.approx(told[key], rel=1e-2 if rough else 1e-4, abs=1e-6 if rough else 1e-12), (
            key
        )


@pytest.mark.parametrize("name", REPORT.sections)
def test_text_is_fresh(name: str) -> None:
    """Assert that the page's text is that of the section's template as it is, with the kept numbers."""
    assert f"\n\n{REPORT.told(name, kept(name))}\n\n" in page()


@pytest.mark.parametrize("name", REPORT.sections)
def test_rows_are_fresh(name: str) -> None:
    """Assert that the page's rows are those of the table as it is, verdicts included."""
    lines = [line.strip("| ").split(" | ") for line in page().splitlines() if line.startswith("| P")]
    told = {line[0]: line for line in lines}
    for row in rows(name, kept(name).numbers):
        difference = "" if row.difference is None else f"{100 * row.difference:+.1f} %"
        assert told[row.key] == [row.key, row.what, row.paper, row.ours, difference, row.verdict, row.check]


@pytest.mark.long
@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_are_fresh(name: str) -> None:
    """Assert that the page's key numbers are those of the code as it is; each section's tests have some."""
    found = NUMBERS[name]()
    assert_fresh(name, found)
    if name in WHOLE:
        assert set(found) == set(kept(name).numbers)


@pytest.mark.long
def test_table_of_orbits_is_fresh() -> None:
    """Assert the same of the table of six orbits."""
    for found, told in zip(unseen.rows(), kept("unseen").rows, strict=True):
        assert set(found) == set(told)
        for key, value in told.items():
            rough = 1e-2 if key == "least_N" else 1e-4
            assert found[key] == (value if isinstance(value, str) else pytest.approx(value, rel=rough))


@pytest.mark.long
def test_film_laws_are_fresh() -> None:
    """Assert the same of the section on film laws, which takes a minute."""
    assert_fresh("filmlaws", filmlaws.numbers())


@pytest.mark.long
def test_regions_are_fresh() -> None:
    """Assert the same of the section on regions, which takes minutes."""
    assert_fresh("regions", regions.numbers())


def test_page_is_complete() -> None:
    """Assert that every section is there, and that the first table has a row for every row of the paper."""
    assert tuple(REPORT.kept(REPORT.folder)) == tuple(REPORT.sections)
    keys = {row.key for name in REPORT.sections for row in rows(name, kept(name).numbers)}
    assert {f"P{k}" for k in range(1, 17)} <= keys


def test_page_is_put_together_from_its_sections() -> None:
    """Assert that nobody has edited the page by hand."""
    assert REPORT.text(REPORT.folder) == page()


def test_figures_are_those_of_the_page() -> None:
    """Assert that every figure that the page shows is there, and no other."""
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", page())
    assert sorted(shown) == sorted(file.name for file in (REPORT.folder / FIGURES).iterdir())


def test_rows_on_the_page() -> None:
    """Assert that a row is told with its difference and verdict, and rows are sorted by number."""
    row = compared("P9", "speed", 325.0, 330.5, "rev/min", "two ways")
    told = rendered(REPORT.folder, "introduction.md.j2", {"rows": (row, replace(row, key="P10"))})
    assert "| P9 | speed | 325 rev/min | 330.5 rev/min | +1.7 % | reproduced within 2 % | two ways |" in told
    assert page().index("| P9 |") < page().index("| P10 |")


@pytest.mark.parametrize(
    "ours, verdict",
    [
        (100.9, "reproduced"),
        (99.1, "reproduced"),
        (101.1, "reproduced within 2 %"),
        (95.1, "reproduced within 5 %"),
        (105.1, "not reproduced"),
        (-100.0, "not reproduced"),
    ],
)
def test_verdicts(ours: float, verdict: str) -> None:
    """Assert that the verdict on a number follows from its difference."""
    assert compared("P1", "deflection", 100.0, ours, "um", "").verdict == verdict


def test_verdict_without_a_number() -> None:
    """Assert that a row says itself what a comparison without numbers shows, or that there is none."""
    row = Row(key="P14", what="", paper="", ours="", check="")
    assert row.verdict == "cannot be compared"
    assert replace(row, given=Verdict.REPRODUCED).verdict == "reproduced"
