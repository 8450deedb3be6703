"""The committed page of the report on the paper: complete, put together from its sections, and not stale."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from reports.pages.report import FIGURES, KEPT, PAGE, keep
from reports.pages.section import Section
from reports.paper import (
    damping,
    damping_text,
    filmlaws,
    frequency,
    method,
    method_text,
    regions,
    regions_text,
    supports,
    supports_text,
    timedomain,
    unseen,
)
from reports.paper.page import REPORT
from reports.paper.rows import Row, Verdict, compared

FOLDER = Path(method.__file__).parent
NUMBERS: dict[str, Callable[[], Mapping[str, float]]] = {
    "timedomain": lambda: timedomain.key_numbers(lambda _: None),
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

TEXTS: dict[str, Callable[[Mapping[str, float]], str]] = {
    "method": method_text.text,
    "damping": damping_text.text,
    "supports": lambda n: supports_text.text(n, supports.SHARES, supports.TARGETS),
    "timedomain": timedomain._text,
    "regions": lambda n: regions_text.text(
        n, {key.removeprefix("difference "): n[key] for key in n if key.startswith("difference ")}
    ),
}
"""Texts that follow from the numbers alone."""

ROWS: dict[str, Callable[[Mapping[str, float]], tuple[Row, ...]]] = {
    "method": lambda n: (method._row(dict(n)),),
    "timedomain": lambda n: timedomain._rows(dict(n)),
    "frequency": lambda n: frequency._rows(dict(n)),
    "supports": lambda n: supports._rows(dict(n)),
    "damping": lambda _: damping.rows(),
    "regions": lambda n: regions._rows(dict(n)),
}
"""Rows from the kept numbers; those of damping are computed anew."""


def assert_fresh(name: str, found: Mapping[str, float]) -> None:
    """Assert that numbers computed anew are those that the page was made from."""
    told = REPORT.kept(FOLDER)[name]["numbers"]
    assert set(found) <= set(told)
    for key, value in found.items():
        rough = ROUGH.fullmatch(key)
        assert value == pytest.approx(told[key], rel=1e-2 if rough else 1e-4, abs=1e-6 if rough else 1e-12), (
            key
        )


@pytest.mark.parametrize("name", TEXTS)
def test_text_is_fresh(name: str) -> None:
    """Assert that the page's text is that of the code as it is, with the kept numbers."""
    said = REPORT.kept(FOLDER)[name]
    assert TEXTS[name](said["numbers"]) == said["text"]


@pytest.mark.parametrize("name", ROWS)
def test_rows_are_fresh(name: str) -> None:
    """Assert that the page's rows are those of the code as it is, verdicts included."""
    said = REPORT.kept(FOLDER)[name]
    for row, kept in zip(ROWS[name](said["numbers"]), said["rows"], strict=True):
        for key in ("key", "what", "paper", "ours", "verdict"):
            assert getattr(row, key) == kept[key]
        assert (row.difference is None) == (kept["difference"] is None)
        assert row.difference is None or row.difference == pytest.approx(kept["difference"], rel=1e-4)


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_are_fresh(name: str) -> None:
    """Assert that the page's key numbers are those of the code as it is."""
    found = NUMBERS[name]()
    assert_fresh(name, found)
    if name in WHOLE:
        assert set(found) == set(REPORT.kept(FOLDER)[name]["numbers"])


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
    said = REPORT.kept(FOLDER)
    assert tuple(said) == REPORT.sections
    keys = {row["key"] for section in said.values() for row in section["rows"]}
    assert {f"P{k}" for k in range(1, 17)} <= keys


def test_page_is_put_together_from_its_sections(tmp_path: Path) -> None:
    """Assert that nobody has edited the page by hand."""
    (tmp_path / KEPT).symlink_to(FOLDER / KEPT)
    REPORT.assemble(tmp_path)
    assert (tmp_path / PAGE).read_text("utf-8") == (FOLDER / PAGE).read_text("utf-8")


def test_figures_are_those_of_the_page() -> None:
    """Assert that every figure that the page shows is there, and no other."""
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", (FOLDER / PAGE).read_text("utf-8"))
    assert sorted(shown) == sorted(file.name for file in (FOLDER / FIGURES).iterdir())


def test_section_is_kept(tmp_path: Path) -> None:
    """Assert that what a section says comes back as the page needs it, its figures with captions."""
    figure = Figure()
    figure.subplots().plot([0, 1])
    row = compared("P9", "speed", 325.0, 330.5, "rev/min", "two ways")
    section = Section(
        title="Speed",
        text="Text.\n\n![What it\nshows.](curve.png)",
        numbers={"speed": 330.5},
        rows=(replace(row, key="P10"), row),
        figures={"curve": figure},
    )
    keep(tmp_path, "frequency", section)
    REPORT.assemble(tmp_path)
    text = (tmp_path / PAGE).read_text("utf-8")
    assert "![What it shows.](figures/curve.png)\n\n*What it shows.*" in text
    assert "| P9 | speed | 325 rev/min | 330.5 rev/min | +1.7 % | reproduced within 2 % | two ways |" in text
    assert text.index("| P9 |") < text.index("| P10 |")
    missing = "method, timedomain, damping, supports, filmlaws, unseen, regions"
    assert f"Sections not computed yet: {missing}." in text
    assert (tmp_path / FIGURES / "curve.png").stat().st_size > 1000


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
