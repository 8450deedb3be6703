"""The report on work and precision: its page is whole and fresh, and its errors are those of the code."""

from __future__ import annotations

import importlib
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reports.bench.suite import COUNTS, NTST
from reports.pages.report import FIGURES, KEPT, PAGE
from reports.trade import aims, cases, dial, dialled, duffing, grazing, lost, names, page, parts, smooth
from reports.trade.measure import Measured
from reports.trade.page import ORBITS, REPORT
from reports.trade.whole import accuracies
from reports.trade.words import cheapest, decade, power, seconds

FOLDER = Path(page.__file__).parent
KEYS: list[tuple[object, dict[str, tuple[str, ...]]]] = [
    (smooth.STUDY, {names.ANCHORED: ("tol 1e-7",), names.BALANCE: ("H 5",), "Gauss 4, even": ("ntst 24",)}),
    (grazing.STUDY, {names.ANCHORED: ("tol 1e-6",), "Radau 4, even": ("ntst 48",)}),
    (lost.STUDY, {names.ANCHORED: ("tol 1e-4",), "Radau 3, even": ("ntst 24",)}),
    (duffing.STUDY, {names.SHOOTING: ("tol 1e-6",), names.BALANCE: ("H 7",), "Radau 5, even": ("ntst 12",)}),
]
"""Errors that are computed anew: far above rounding, quick to get."""


def kept(name: str) -> list[Measured]:
    """Return the measurements that the page was made from."""
    return [Measured(**row) for row in REPORT.kept(FOLDER)[name]["rows"]]


@pytest.mark.parametrize(("study", "keys"), KEYS, ids=[s.key for s, _ in KEYS])  # type: ignore[attr-defined]
def test_errors_are_fresh(study: smooth.Study, keys: dict[str, tuple[str, ...]]) -> None:
    """Assert that errors computed anew are those of the page, and that two methods share the reference."""
    known = study.reference()
    assert known.agreement < 1e-8 and known.multiplier_agreement < 1e-7
    told = REPORT.kept(FOLDER)[study.key]["numbers"]
    assert known.multiplier == pytest.approx(told["multiplier"], rel=1e-8)
    wanted = [c for c in study.cases() if c.setting in keys.get(c.family, ())]
    assert len(wanted) == len(keys)
    for case in wanted:
        assert isinstance(case, cases.Case)
        found = case.measured(study.problem(), known)
        (row,) = [r for r in kept(study.key) if (r.family, r.setting) == (case.family, case.setting)]
        assert found.error == pytest.approx(row.error, rel=0.05)


def test_tolerances_are_kept() -> None:
    """Assert that each anchored orbit errs nowhere by more than a tolerance allows, as the page shows."""
    for name in ("smooth", "grazing", "lost", "duffing"):
        rows = [r for r in kept(name) if r.family == names.ANCHORED and r.error is not None]
        assert len(rows) >= 7
        for row in rows:
            assert row.error is not None
            assert row.error <= max(float(row.setting.removeprefix("tol ")), 1e-9)


@pytest.mark.parametrize("name", REPORT.kept(FOLDER))
def test_text_is_fresh(name: str) -> None:
    """Assert that the page's text is that of the code as it is, with the kept numbers and times."""
    said = REPORT.kept(FOLDER)[name]
    module = importlib.import_module(f"reports.trade.{name}")
    if name == "parts":
        models = [
            parts.Model(**(row | {"swing": tuple(row["swing"]), "folds": tuple(row["folds"])}))
            for row in said["rows"]
        ]
        assert parts.text(models, said["numbers"]) == said["text"]
        assert parts.key_numbers(models) == pytest.approx(said["numbers"])
        return
    if name == "aims":
        assert aims.text([aims.Result(**row) for row in said["rows"]]) == said["text"]
        return
    if name == "dial":
        rows = [dialled.Kept(**row) for row in said["rows"]]
        assert dial.told(rows, said["numbers"]) == said["text"]
        assert dial.summed(rows) == pytest.approx(said["numbers"])
        return
    text = module.STUDY.text if name in ORBITS else module.text
    assert text(kept(name), said["numbers"]) == said["text"]


def test_aims_say_what_is_not_met_and_who_is_missing() -> None:
    """Assert that aims are held against the numbers, and AUTO's as stated where it is not installed."""
    branch = {"s": 0.1, "points": 100.0, "per point ms": 1.0, "fold error": 1e-12}
    draft = {"s": 0.05, "points": 100.0, "per point ms": 0.5, "fold error": 1e-6}
    disc = {f"ntst {ntst} ms": 0.01 * ntst for ntst in NTST}
    chain = {f"{count} oscillators ms": 1e-4 * count**3 for count in COUNTS}
    rows = [
        aims.Result(name="Duffing A branch, draft", numbers=draft),
        aims.Result(name="Duffing A branch, standard", numbers=branch),
        aims.Result(name="disc branch, standard", numbers={"s": 0.4}),
        aims.Result(name="disc iteration", numbers=disc),
        aims.Result(name="chain iteration", numbers=chain),
        aims.Result(name="memory", numbers={"peak MB": 900.0, "of which Newton MB": 800.0}),
        aims.Result(name="start", numbers={"import s": 0.5, "help s": 0.2, "first trace s": 2.0}),
        aims.Result(name=aims.AUTO, skipped="bifpy is not installed"),
    ]
    found = {aim.what: aim for aim in aims.aims(aims.by_name(rows))}
    assert aims.alike(aims.by_name(rows)) == "Duffing A branch, standard"
    late = found["disc branch, 500 to 100 rev/min, `standard`"]
    assert late.cells[1:] == ("300 ms", "400 ms", "1.33", "**no**")
    assert found["Duffing A branch, standard, whole; half of AUTO's"].limit == pytest.approx(0.12)
    assert found["power of ntst that the cost grows with"].found == pytest.approx(1.0)
    assert found["power of n that the cost grows with"].found == pytest.approx(3.0)
    assert "Not measured: AUTO-07p by bifpy, ntst 50: bifpy is not installed." in aims.text(rows)


def test_page_is_put_together_from_its_sections(tmp_path: Path) -> None:
    """Assert that nobody has edited the page by hand."""
    (tmp_path / KEPT).symlink_to(FOLDER / KEPT)
    REPORT.assemble(tmp_path)
    assert (tmp_path / PAGE).read_text("utf-8") == (FOLDER / PAGE).read_text("utf-8")


def test_page_is_complete() -> None:
    """Assert that every section is there."""
    assert tuple(REPORT.kept(FOLDER)) == REPORT.sections


def test_figures_are_those_of_the_page() -> None:
    """Assert that every figure that the page shows is there, and no other."""
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", (FOLDER / PAGE).read_text("utf-8"))
    assert sorted(shown) == sorted(file.name for file in (FOLDER / FIGURES).iterdir())


def test_quickest_and_decade() -> None:
    """Assert which measurement is the quickest for an error, and what a decade costs on an exact law."""
    rows = [Measured(family="a", setting=f"{k}", seconds=0.01 * 2.0**k, error=10.0**-k) for k in range(1, 6)]
    assert cheapest(rows, 1e-3) == rows[2]
    assert cheapest([replace(r, error=None) for r in rows], 1.0) is None
    assert decade(rows, "a") == pytest.approx(2.0)
    assert np.isnan(decade(rows[:1], "a"))
    assert power(3.4e-9) == "3e-9" and power(2e-12) == "2e-12"
    assert seconds(0.00234) == "2.34 ms" and seconds(12.34) == "12.3 s"


def test_folds_of_a_branch() -> None:
    """Assert that the dial's `draft` has the folds of Duffing A, known by DOP853, to 1e-5."""
    draft = next(accuracies())
    folds = [2.211935317020, 1.438670145514]
    found = draft.measured(duffing.STUDY.problem(), folds)
    assert found.error is not None and found.error < 1e-5
