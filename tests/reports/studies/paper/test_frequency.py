"""Key numbers of the report's section on the frequency domain."""

from __future__ import annotations

import pytest
from support.fresh import TIME, assert_fresh

from reports.studies.paper import frequency
from reports.studies.paper.branches import preload
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import rows

pytestmark = pytest.mark.studies


def test_continuation_in_preload_meets_that_in_speed() -> None:
    """Assert that both give the same orbits at their common points, to 1e-8."""
    assert max(frequency.meeting().values()) < 1e-8


def test_trends_with_preload() -> None:
    """Assert that x falls with preload at 200 rev/min and rises at 360 where contact is kept (P15, P16)."""
    assert preload.trend(200.0) == (pytest.approx(300.021108, abs=1e-5), 2500.0, -1)
    assert preload.trend(360.0) == (pytest.approx(146.823758, abs=1e-5), 2500.0, 1)


def test_resonance_speeds() -> None:
    """Assert that natural speeds and highest points are as the page says (P8, P9)."""
    found = frequency.numbers()
    assert found["vitrea79-810N natural speed rpm"] == pytest.approx(281.181464, abs=1e-5)
    assert found["vitrea79-2100N natural speed rpm"] == pytest.approx(330.522929, abs=1e-5)
    assert found["turbo33-810N natural speed rpm"] == pytest.approx(282.528930, abs=1e-5)
    # A spline between the computed points.
    assert found["vitrea79-810N branch peak um"] == pytest.approx(26.207, abs=2e-3)
    assert found["turbo33-810N branch peak um"] == pytest.approx(44.340, abs=2e-3)
    assert found["vitrea79-2100N branch peak um"] == pytest.approx(41.537, abs=2e-3)


def test_rows() -> None:
    """Assert the verdicts of this section's rows."""
    verdicts = {row.key: row.verdict for row in rows("frequency", frequency.numbers())}
    assert verdicts == {
        "P8": "reproduced within 3 %",
        "P9": "reproduced within 2 %",
        "P15": "reproduced",
        "P16": "reproduced",
    }


def test_section_is_fresh() -> None:
    """Assert that the section, computed whole, is what the page was made from; curves meet to rounding.

    Highest points come from a spline between the computed points, which other steps have elsewhere.
    """
    assert_fresh(REPORT, "frequency", {"branch peak": 1e-4, "difference$": TIME})
