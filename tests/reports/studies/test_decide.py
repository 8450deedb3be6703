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
