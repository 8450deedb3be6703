"""Key numbers of the report's section on readings of the film law."""

from __future__ import annotations

import math

import pytest

import periodic
from reports.studies.paper.branches import films

pytestmark = pytest.mark.studies

READINGS = {
    "calibrated": (3.850006, 281.181464, 0.00676333, 237.486586, 252.035057),
    "constant-one-body": (3.570320, 281.193196, 0.00618655, 236.239420, 252.044790),
    "constant-two-body": (3.883912, 281.180738, 0.00683137, 237.625732, 252.034609),
    "hamrock-dowson": (4.264827, 281.180219, 0.00756604, 238.739082, 252.036521),
    "equation-5": (0.311437, 282.654412, 7.83285e-05, 193.121886, 253.430139),
}
"""h0 (um), linear resonance (rev/min), damping ratio at 360 rev/min and the first two folds (rev/min)."""

FLOORS = {1e-6: (118.273204, 24.498586), 1e-7: (157.828682, 24.375528)}
"""Upper fold (rev/min) and x p-p at 250 rev/min (um) by floor."""


@pytest.mark.parametrize("name", READINGS)
def test_reading(name: str) -> None:
    """Assert film, resonance, damping and folds of a reading."""
    found = films.reading_numbers(name) | films.fold_numbers(name, films.reading_branch(name))
    keys = ("film um", "resonance rpm", "damping ratio", "fold 1 rpm", "fold 2 rpm")
    for key, value in zip(keys, READINGS[name], strict=True):
        assert found[f"{name} {key}"] == pytest.approx(value, rel=1e-5 if key == "damping ratio" else 1e-6)


def test_superharmonic_folds_of_the_thin_film() -> None:
    """Assert that the thin film of eq. (5) has two folds more, at the superharmonic of order two."""
    found = films.fold_numbers("thin", films.reading_branch("equation-5"))
    assert found["thin fold 3 rpm"] == pytest.approx(132.16635, rel=1e-6)
    assert found["thin fold 4 rpm"] == pytest.approx(141.11753, rel=1e-6)


def test_illegible_exponent() -> None:
    """Assert the film of eq. (5) by the reading of its illegible exponent."""
    found = films.exponent_numbers()
    for exponent, value in ((0.55, 1.759622), (0.58, 0.880237), (0.625, 0.311437)):
        assert found[f"equation-5 film with exponent {exponent:g} um"] == pytest.approx(value, rel=1e-6)
    assert found["equation-5 exponent for 3.85 um"] == pytest.approx(0.516089, rel=1e-5)


def test_film_that_oil_b_would_need() -> None:
    """Assert that the paper's 0.0018 needs 1.59 um where the law gives 0.46 um and 0.00017."""
    found = films.film_for_damping()
    assert found["oil B film um"] == pytest.approx(0.460254, rel=1e-5)
    assert found["oil B damping ratio"] == pytest.approx(0.000169809, rel=1e-5)
    assert found["oil B film for 0.0018 um"] == pytest.approx(1.591271, rel=1e-6)


@pytest.mark.parametrize("name", films.READINGS)
def test_one_number_of_a_law_enters(name: str) -> None:
    """Assert that the residual depends on all numbers of a law through one combination of them."""
    assert films.directions(name) < 1e-13


def test_readings_of_one_thickness_have_one_orbit() -> None:
    """Assert that two readings tuned to one h0 have one orbit, through loss of contact."""
    first, second = films.tuned_orbits()
    assert first.minimum["load"] < 1e-3 * 810
    assert films.tuned_difference() < 1e-10
    assert second.peak_to_peak("x") == pytest.approx(first.peak_to_peak("x"), rel=1e-10)


def test_squeeze_film_fills_the_gap_at_a_vanishing_load() -> None:
    """Assert that ln(W/Q) at the upper fold is about -61.3, far below what ambient pressure carries."""
    assert films.least_load() == pytest.approx(-61.30, abs=0.02)
    assert films.ambient_share() == pytest.approx(1.548e-4, rel=1e-3)


@pytest.mark.parametrize("floor", FLOORS)
def test_upper_fold_with_a_floor(floor: float) -> None:
    """Assert that the upper fold moves far down where the film separates no faster than under a floor."""
    found = films.floor_numbers(floor)
    fold, swing = FLOORS[floor]
    assert found[f"floor {floor:g} fold 1 rpm"] == pytest.approx(fold, rel=1e-6)
    assert found[f"floor {floor:g} at 250 rpm um"] == pytest.approx(swing, rel=1e-6)


@pytest.mark.parametrize(("floor", "fold"), [(1e-1, 252.061232), (1e-4, 252.035057)])
def test_no_upper_fold_with_a_floor_of_ambient_pressure(floor: float, fold: float) -> None:
    """Assert that the upper sheet then goes on to 100 rev/min, stable, and the lower fold hardly moves."""
    upper, lower = films.floor_branch(floor), films.lower_branch(floor)
    assert upper.stop.reason is periodic.Reason.BOUND
    assert not upper.labelled(periodic.Label.FOLD) and upper.stable.all()
    assert math.isclose(upper[-1].parameter, 100 * films.RPM) and upper[-1].peak_to_peak("x") > 2e-4
    speeds = [p.parameter / films.RPM for p in lower.labelled(periodic.Label.FOLD)]
    assert speeds == pytest.approx([fold], rel=1e-7)
