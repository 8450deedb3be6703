"""The report on decisions: quick sections are computed anew, and what the page says is what is known."""

from __future__ import annotations

import pytest

from reports.studies.decide.page import REPORT
from reports.studies.decide.truths import TRUTHS

pytestmark = pytest.mark.studies

FOLDER = REPORT.folder


def test_anchors_are_fresh() -> None:
    """Assert modes with known numbers, computed anew, to what the page says and to what is known."""
    kept, found = REPORT.kept(FOLDER)["anchors"], REPORT.sections["anchors"].compute(lambda _: None)
    for row, other in zip(found.rows, kept.rows, strict=True):
        assert row["what"] == other["what"]
        assert row["found"] == pytest.approx(other["found"], rel=1e-6)
        assert row["found"] == pytest.approx(row["known"], rel=1e-6)


def test_damping_of_the_disc() -> None:
    """Assert that the dry disc has the paper's damping, and the film alone less where it moves little."""
    rows = {(row["scene"], round(row["amplitude_um"], 3)): row for row in REPORT.kept(FOLDER)["disc"].rows}
    assert rows["dry-810N", 0.1]["ratio"] == pytest.approx(0.007, rel=1e-5)
    assert rows["vitrea79-810N", 0.1]["ratio"] == pytest.approx(0.005827, rel=1e-3)
    assert rows["vitrea79-810N", 20.0]["ratio"] == pytest.approx(0.163771, rel=1e-4)


@pytest.mark.parametrize("truth", TRUTHS[:2], ids=lambda truth: truth.key)
def test_truths_are_those_of_the_models(truth) -> None:  # type: ignore[no-untyped-def]
    """Assert that motions that were integrated are motions of the model that is fitted, on some sheet."""
    import periodic as per

    size = per.Amplitude("x")
    omega, exact = truth.rising[2], abs(truth.motion(truth.rising[2], True))
    branch = truth.response.traced(truth.system, truth.hidden, at=[omega])
    there = [size(truth.system, point.orbit) for point in branch if point.parameter == omega]
    assert min(abs(a / exact - 1) for a in there) < 1e-5


def test_intervals_hold_the_truth() -> None:
    """Assert that all fits ended, that 95 % intervals are such by chance, and one set of data anew."""
    from scipy.stats import binomtest

    from reports.studies.decide.coverage import fitted

    for truth in TRUTHS:
        rows = REPORT.kept(FOLDER)[truth.key].rows
        assert not [row["reason"] for row in rows if row["reason"]]
        for name in truth.hidden:
            held = sum(row[f"{name} held"] for row in rows)
            ends = binomtest(held, len(rows)).proportion_ci(0.99, method="wilson")
            assert ends.low <= 0.95 <= ends.high
            assert abs(sum(row[name] for row in rows)) / len(rows) < 3 / len(rows) ** 0.5
    kept, found = REPORT.kept(FOLDER)["coverage-duffing"].rows[3], fitted("coverage-duffing", 3)
    for name in TRUTHS[0].hidden:
        assert found[name] == pytest.approx(kept[name], abs=1e-3)


def test_designs_are_no_worse_than_brute_force() -> None:
    """Assert that each optimum is known to be one, and within 1e-6 of a direct search or better."""
    for row in REPORT.kept(FOLDER)["designs"].rows:
        assert not row["reason"]
        assert row["objective"] <= row["brute"] * (1 + 1e-6)
