"""Key numbers of the report's section on what the paper could not see."""

from __future__ import annotations

from functools import cache

import pytest

from reports.paper import unseen

FOLDS = {
    "vitrea79-810N": (237.486586, 252.035057),
    "vitrea79-2100N": (294.691534, 307.692770),
    "turbo33-810N": (198.557444, 253.316928, 134.600069, 141.078358),
    "turbo33-2100N": (262.362900, 308.491855, 164.201025, 165.596776),
}
DOUBLINGS = {
    "vitrea79-810N": (545.397607, 569.961132),
    "vitrea79-2100N": (651.170989, 665.878674),
    "turbo33-810N": (550.323755, 576.063621),
    "turbo33-2100N": (654.023249, 669.871355),
}
LOST = {"vitrea79-810N": 287.9, "vitrea79-2100N": 327.1, "turbo33-810N": 291.8, "turbo33-2100N": 328.9}


@cache
def numbers() -> dict[str, float]:
    """The section's key numbers, made once."""
    return unseen.numbers()


@pytest.mark.parametrize("name", FOLDS)
def test_folds(name: str) -> None:
    """Assert the folds of each disc; see test_disc_*.py for their independent checks."""
    found = [numbers()[f"{name} fold {k} rpm"] for k in range(1, len(FOLDS[name]) + 1)]
    assert found == pytest.approx(list(FOLDS[name]), abs=2e-6)
    assert f"{name} fold {len(found) + 1} rpm" not in numbers()


@pytest.mark.parametrize("name", DOUBLINGS)
def test_doublings(name: str) -> None:
    """Assert the band in which the small motion of each disc is unstable."""
    found = [numbers()[f"{name} doubling {k} rpm"] for k in (1, 2)]
    assert found == pytest.approx(list(DOUBLINGS[name]), abs=2e-5)


@pytest.mark.parametrize("name", LOST)
def test_loss_of_contact(name: str) -> None:
    """Assert where each disc first loses contact, to the accuracy of the interpolation."""
    assert numbers()[f"{name} contact lost below rpm"] == pytest.approx(LOST[name], abs=0.2)


def test_doubled_orbits() -> None:
    """Assert that the traced orbit of two periods is the simulated motion, and where its branch ends."""
    found = numbers()
    traced, simulated = found["doubled orbit at 500 rpm x um"], found["simulated motion at 500 rpm x um"]
    assert traced == pytest.approx(simulated, rel=1e-6)
    assert traced == pytest.approx(24.975666, abs=1e-5)
    assert found["doubled orbits fold rpm"] == pytest.approx(449.410772, abs=1e-5)


def test_labelled_orbits() -> None:
    """Assert that the six orbits are what their captions say."""
    orbits = unseen.labelled()
    assert list(orbits) == list("ABCDEF")
    assert [point.stable for point in orbits.values()] == [True, True, True, False, False, True]
    lost = [point.minimum["load"] < 1e-3 * 810 for point in orbits.values()]
    assert lost == [False, False, True, True, True, False]


def test_damping_grows_with_loss_of_contact() -> None:
    """Assert that damping from the multipliers is the Jacobian's size at first and grows twentyfold."""
    curve = unseen.damping("vitrea79-810N")
    assert curve[0][1] == pytest.approx(0.00832, rel=1e-2)
    assert curve[-1][1] > 0.19
