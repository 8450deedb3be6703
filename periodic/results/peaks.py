"""The peaks that a branch has unasked: their names and outputs, and those with other labels."""

from __future__ import annotations

from collections.abc import Sequence

from periodic.bifurcations.label import Label
from periodic.orbit.layout import Layout
from periodic.results.point import Point

PEAK_OF = "peak of "
"""How their names begin."""


def usual_peaks(layout: Layout) -> dict[str, str]:
    """Return the outputs whose peak to peak is watched by default, by the names of their peaks."""
    states = {state.name for state in layout.states}
    return {PEAK_OF + output.name: output.name for output in layout.outputs if output.name in states}


def labelled_corners(points: Sequence[Point], output: str) -> list[Point]:
    """Return the special points at which a peak to peak is greater than at both neighbours, or less.

    By more than the errors of the three. There its slope jumps, without a zero that would be located: at
    grazings, and at branch points where a doubled orbit becomes a plain one.
    """
    found = []
    for before, point, after in zip(points, points[1:], points[2:], strict=False):
        if point.label not in (Label.NONE, Label.PEAK):
            low, height, high = (each.peak_to_peak(output) for each in (before, point, after))
            error = height * max(each.error.orbit for each in (before, point, after))
            if min(height - low, height - high) > error or min(low - height, high - height) > error:
                found.append(point)
    return found
