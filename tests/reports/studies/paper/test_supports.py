"""Key numbers of the report's section on supports."""

from __future__ import annotations

import pytest
from support.fresh import assert_fresh

from reports.studies.paper import supports
from reports.studies.paper.branches import stiffness
from reports.studies.paper.page import REPORT
from symbolic.scenes.errors import InputError

pytestmark = pytest.mark.studies

LINEAR = {
    "rigid resonance rpm": 281.181464,
    "scene resonance rpm": 249.997652,
    "scene second resonance rpm": 979.733973,
    "scene antiresonance rpm": 476.963027,
    "resonance with bearings of 10 contacts rpm": 268.028220,
    "resonance with leaf springs rpm": 250.720022,
    "stiffness for 250 rpm share 0.1 N/m": 796.324475e6,
    "stiffness for 250 rpm share 0.3 N/m": 513.043007e6,
    "stiffness for 270 rpm share 0.3 N/m": 1525.085934e6,
    "stiffness for 250 rpm share 0.7 N/m": 128.743357e6,
    "scene damping ratio": 0.00763845,
    "rigid damping ratio": 0.00545709,
}
BRANCH = {
    "rigid fold 1 rpm": 237.486586,
    "rigid fold 2 rpm": 252.035057,
    "rigid doubling 1 rpm": 569.961132,
    "rigid doubling 2 rpm": 545.397607,
    "scene fold 1 rpm": 217.585928,
    "scene fold 1 um": 24.893788,
    "scene fold 2 rpm": 228.275548,
    "scene fold 2 um": 16.542337,
    "scene doubling 1 rpm": 501.730576,
    "scene doubling 2 rpm": 492.673672,
    "scene housings at fold 1 um": 31.085563,
}


def test_linear_numbers() -> None:
    """Assert the linear key numbers to the digits given."""
    found = supports.numbers()
    for name, value in LINEAR.items():
        assert found[name] == pytest.approx(value, rel=1e-5), name


def test_branch_numbers() -> None:
    """Assert folds and doublings on rigid and on finite supports."""
    found = supports.branch_numbers()
    for name, value in BRANCH.items():
        assert found[name] == pytest.approx(value, rel=1e-6), name


def test_orbits_by_time_integration() -> None:
    """Assert that time integration comes back to the orbits, in contact and on all three sheets."""
    found = supports.check_numbers()
    assert len(found) == len(supports.CHECKED)
    assert max(found.values()) < 1e-6


@pytest.mark.parametrize("share", supports.SHARES)
@pytest.mark.parametrize("rpm", [150.0, 250.0, 280.0])
def test_stiffness_brings_the_resonance_there(rpm: float, share: float) -> None:
    """Assert that the stiffness found for a speed has its resonance at that speed."""
    found = stiffness.stiffness_for(rpm, share)
    assert stiffness.resonance_speed(found, share) == pytest.approx(rpm, rel=1e-9)


def test_softer_bearings_and_larger_discs() -> None:
    """Assert that a lower resonance needs softer bearings, and so does a larger share of the disc."""
    needed = [[stiffness.stiffness_for(rpm, f) for rpm in supports.TARGETS] for f in supports.SHARES]
    for row in needed:
        assert row == sorted(row, reverse=True)
    for column in zip(*needed, strict=True):
        assert list(column) == sorted(column, reverse=True)


@pytest.mark.parametrize("rpm", [281.2, 300.0])
def test_no_stiffness_raises_the_resonance(rpm: float) -> None:
    """Assert that a resonance above that on rigid supports is refused, with the speeds that can be had."""
    with pytest.raises(InputError, match=r"no stiffness of the bearings gives; .* and 281\.181 \(rigid\)"):
        stiffness.stiffness_for(rpm, 0.3)


def test_section_is_fresh() -> None:
    """Assert that the section, computed whole, is what the page was made from; errors to a factor of ten."""
    assert_fresh(REPORT, "supports", {"return error": 0.9})
