"""The report on work and precision: its page is whole and fresh, and its errors are those of the code."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from reports.benchmarks.work import COUNTS, NTST
from reports.studies.pages.content import Kept
from reports.studies.pages.page import PAGE
from reports.studies.pages.text import FIGURES
from reports.studies.trade import aims, dial, dialled, orbits, parts
from reports.studies.trade.methods import cases, names
from reports.studies.trade.methods.measure import Measured
from reports.studies.trade.methods.names import power
from reports.studies.trade.methods.problems import duffing
from reports.studies.trade.methods.whole import accuracies
from reports.studies.trade.page import REPORT
from reports.studies.trade.words import cheapest, decade, seconds

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder
KEYS: dict[str, dict[str, tuple[str, ...]]] = {
    "smooth": {names.ANCHORED: ("tol 1e-7",), names.BALANCE: ("H 5",), "Gauss 4, even": ("ntst 24",)},
    "grazing": {names.ANCHORED: ("tol 1e-6",), "Radau 4, even": ("ntst 48",)},
    "lost": {names.ANCHORED: ("tol 1e-5",), "Radau 3, even": ("ntst 24",)},
    "duffing": {names.SHOOTING: ("tol 1e-6",), names.BALANCE: ("H 7",), "Radau 5, even": ("ntst 12",)},
}
"""Errors that are computed anew: far above rounding, quick to get."""


def kept(name: str) -> list[Measured]:
    """Return the measurements that the page was made from."""
    return [Measured(**row) for row in REPORT.kept(FOLDER)[name].rows]


@pytest.mark.parametrize("name", KEYS)
def test_errors_are_fresh(name: str) -> None:
    """Assert that errors computed anew are those of the page, and that two methods share the reference."""
    study, keys = orbits.STUDIES[name], KEYS[name]
    known = study.reference()
    assert known.agreement < 1e-8 and known.multiplier_agreement < 1e-7
    told = REPORT.kept(FOLDER)[name].numbers
    assert known.multiplier == pytest.approx(told["multiplier"], rel=1e-8)
    wanted = [c for c in study.cases() if c.setting in keys.get(c.family, ())]
    assert len(wanted) == len(keys)
    for case in wanted:
        assert isinstance(case, cases.Case)
        found = case.measured(study.problem(), known)
        (row,) = [r for r in kept(name) if (r.family, r.setting) == (case.family, case.setting)]
        assert found.error == pytest.approx(row.error, rel=0.05)


def test_tolerances_are_kept() -> None:
    """Assert that each anchored orbit errs nowhere by more than a tolerance allows, as the page shows."""
    for name in ("smooth", "grazing", "lost", "duffing"):
        rows = [r for r in kept(name) if r.family == names.ANCHORED and r.error is not None]
        assert len(rows) >= 7
        for row in rows:
            assert row.error is not None
            assert row.error <= max(float(row.setting.removeprefix("tol ")), 1e-9)


def test_numbers_follow_from_rows() -> None:
    """Assert that the numbers kept of two sections are those of the rows kept."""
    kept = REPORT.kept(FOLDER)
    assert parts.key_numbers(parts.read(kept["parts"])) == pytest.approx(kept["parts"].numbers)
    rows = [dialled.Compared(**row) for row in kept["dial"].rows]
    assert dial.summed(rows) == pytest.approx(kept["dial"].numbers)


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
    told = REPORT.told("aims", Kept(numbers={}, rows=[row.kept() for row in rows]))
    assert "Not measured: AUTO-07p by bifpy, ntst 50: bifpy is not installed." in told


def test_results_of_a_record() -> None:
    """Assert that what pytest-benchmark measured comes under the names and in the units of the page."""

    def benchmark(group: str, param: str | None, **told: float) -> dict[str, object]:
        return {"group": group, "param": param, "extra_info": told, "stats": {"median": 0.5}}

    record = {
        "machine_info": {"cpu": {"brand_raw": "Z80", "count": 1}},
        "load": 0.0,
        "benchmarks": [
            benchmark("disc", "disc branch, draft", points=100.0),
            benchmark("disc iteration", "ntst 50", linearised=2),
            benchmark("disc iteration", "ntst 100", linearised=1),
            benchmark("start", "import"),
            benchmark("memory", None, **{"peak MB": 3.0}),
        ],
        "skipped": {"bice, 50 steps": "not here"},
        "versions": dict.fromkeys(aims.PACKAGES, "1.0"),
    }
    found = aims.results(record)
    assert aims.by_name(found) == {
        "disc branch, draft": {"s": 0.5, "points": 100.0, "per point ms": 5.0},
        "disc iteration": {"ntst 50 ms": 250.0, "ntst 100 ms": 500.0},
        "start": {"import s": 0.5},
        "memory": {"peak MB": 3.0},
    }
    assert found[0].skipped == "Z80, 1 cores, load 0.0 when it ended"
    assert {r.name: r.skipped for r in found if r.skipped}["bice, 50 steps"] == "not here"


def test_who_is_quicker_where() -> None:
    """Assert what the page says of AUTO: about level on one oscillator, slower from two on."""
    numbers = aims.by_name([aims.Result(**row) for row in REPORT.kept(FOLDER)["aims"].rows])
    ratios = {row[0]: float(row[3]) for row in aims.chains(numbers) if row[3] != "-"}
    assert ratios["1 oscillators"] == pytest.approx(1.0, abs=0.3)
    assert 0.9 > ratios["2 oscillators"] > ratios["5 oscillators"]
    assert max(ratios[f"{n} oscillators"] for n in (5, 10, 25)) < 0.5
    auto, own = numbers["AUTO-07p itself, ntst 20"], numbers["Duffing A branch, standard"]
    assert auto["s"] < own["s"] and own["fold error"] < 1e-10 < auto["fold error"]
    assert numbers["memory"]["peak MB"] < 400


def test_page_is_that_of_its_sections() -> None:
    """Assert that text and numbers on the page are those of the code, that nothing is missing or too much."""
    page = (FOLDER / PAGE).read_text("utf-8")
    assert page == REPORT.text(FOLDER)
    assert tuple(REPORT.kept(FOLDER)) == tuple(REPORT.sections)
    shown = re.findall(rf"\]\({FIGURES}/([\w-]+\.png)\)", page)
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
    found = draft.measured(duffing(), folds)
    assert found.error is not None and found.error < 1e-5
