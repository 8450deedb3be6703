"""Peaks with other labels, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import periodic as per
from periodic.results.peaks import labelled_corners


def test_special_point_higher_or_lower_than_its_neighbours() -> None:
    """Assert both, and none of a plain point or peak, on a slope, or at an end."""

    def point(height: float, label: str) -> Any:
        error = SimpleNamespace(orbit=1e-3)
        return SimpleNamespace(label=per.Label(label), peak_to_peak=lambda name: height, error=error)

    given = [
        (9.0, "GR"),
        (1.0, ""),
        (3.0, "GR"),
        (2.0, "BP"),
        (2.5, "GR"),
        (2.6, ""),
        (2.4, "PK"),
        (2.7, "GR"),
    ]
    points = [point(*each) for each in given]
    assert labelled_corners(points, "x") == [points[2], points[3]]
    assert labelled_corners(points[:2], "x") == []
    flat = [point(1.0, ""), point(1.0009, "LP"), point(1.0, ""), point(0.9985, "GR"), point(1.0, "")]
    assert labelled_corners(flat, "x") == [flat[3]]
