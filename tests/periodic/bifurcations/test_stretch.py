"""A second change of sign within a step."""

from __future__ import annotations

import pytest

from periodic.bifurcations.stretch import second_change


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_what_is_expected_at_an_end_is_known(end: float) -> None:
    """Assert that a pair of multipliers that passes just at an end of a step is not looked for there."""
    assert second_change(lambda place: 1.0 + place, {0.0: 1.0, 1.0: 2.0}, end) is None


@pytest.mark.parametrize("place", [0.2, 0.5, 0.9])
def test_dip_below_zero_is_found(place: float) -> None:
    """Assert that a parabola's dip is found from wherever it is expected."""

    def value(at: float) -> float:
        return (at - 0.4) ** 2 - 0.01

    found = second_change(value, {0.0: value(0.0), 1.0: value(1.0)}, place)
    assert found is not None and value(found) < 0
