"""Peaks at grazings, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import periodic as per
from periodic.results.peaks import turning_grazings


def test_grazing_that_is_higher_or_lower_than_its_neighbours() -> None:
    """Assert both, and none of a point that is no grazing, on a slope, or at an end."""

    def point(height: float, label: str) -> Any:
        return SimpleNamespace(label=per.Label(label), peak_to_peak=lambda name: height)

    given = [
        (9.0, "GR"),
        (1.0, ""),
        (3.0, "GR"),
        (2.0, "GR"),
        (2.5, "GR"),
        (2.6, ""),
        (2.4, "LP"),
        (2.7, "GR"),
    ]
    points = [point(*each) for each in given]
    assert turning_grazings(points, "x") == [points[2], points[3]]
    assert turning_grazings(points[:2], "x") == []
