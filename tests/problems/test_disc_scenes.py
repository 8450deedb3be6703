"""The other squeeze-film scenes: folds, superharmonic peaks, and stiff integration on every sheet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from reference import squeeze
from support.traces import FINE, RPM, STANDARD, disc, fold_speeds, largest_multiplier, user_points

import periodic as per
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

FOLDS = {
    "vitrea79-2100N": (294.691534, 307.692770),
    "turbo33-810N": (198.557444, 253.316928, 134.600069, 141.078358),
    "turbo33-2100N": (262.362900, 308.491855, 164.201025, 165.596776),
}
"""Speeds of the folds in order down the branch: the resonance's two, then the superharmonic peak's."""

REFERENCE = {
    "vitrea79-2100N": replace(squeeze.VITREA79, preload=2100.0),
    "turbo33-810N": squeeze.TURBO33,
    "turbo33-2100N": replace(squeeze.TURBO33, preload=2100.0),
}
SPEEDS = {
    "vitrea79-2100N": (400.0, 320.0, 300.0),
    "turbo33-810N": (280.0, 220.0, 137.0),
    "turbo33-2100N": (360.0, 280.0, 165.0),
}
SHEETS = {
    ("vitrea79-2100N", 300.0): 3,
    ("turbo33-810N", 220.0): 3,
    ("turbo33-810N", 137.0): 3,
    ("turbo33-2100N", 280.0): 3,
    ("turbo33-2100N", 165.0): 3,
}
"""How many orbits there are at a speed, where there is more than one."""

each_scene = pytest.mark.parametrize("scene", FOLDS)
each_speed = pytest.mark.parametrize(
    "scene, rpm", [(scene, rpm) for scene, speeds in SPEEDS.items() for rpm in speeds]
)


def branch_of(scene: str) -> per.Branch:
    """The branch from 500 to 100 rev/min to 1e-8."""
    return disc(scene, 1e-8, at=SPEEDS[scene])


@each_scene
def test_far_bound_is_reached(scene: str) -> None:
    """Assert that the branch goes from 500 to 100 rev/min."""
    branch = branch_of(scene)
    assert branch.stop.reason is per.Reason.BOUND
    assert (branch[0].parameter, branch[-1].parameter) == (500 * RPM, 100 * RPM)


@each_scene
def test_folds(scene: str) -> None:
    """Assert that the branch has these folds and no others."""
    assert fold_speeds(branch_of(scene)) == pytest.approx(FOLDS[scene], rel=5e-9)


@each_scene
def test_unstable_between_folds_alone(scene: str) -> None:
    """Assert that the stability changes at each fold and nowhere else."""
    stable = [point.stable for point in branch_of(scene) if point.label is not per.Label.FOLD]
    assert stable[0] and stable[-1]
    assert np.count_nonzero(np.diff(stable)) == len(FOLDS[scene])


@each_scene
def test_multiplier_at_the_folds(scene: str) -> None:
    """Assert that one multiplier is 1 at each fold."""
    for point in branch_of(scene).labelled(per.Label.FOLD):
        assert np.abs(point.multipliers - 1).min() < 1e-4


@each_scene
def test_no_point_is_inaccurate(scene: str) -> None:
    """Assert that every accepted point has an error estimate, multipliers included, below its tolerance."""
    tolerance = STANDARD.value
    for point in branch_of(scene):
        assert point.error.orbit <= tolerance
        assert point.error.worst <= tolerance


@each_scene
def test_load_is_positive(scene: str) -> None:
    """Assert that the load is positive everywhere, and falls below 1e-15 N in resonance."""
    lowest = min(point.minimum["load"] for point in branch_of(scene))
    assert 0 < lowest < 1e-15


@each_speed
def test_sheets(scene: str, rpm: float) -> None:
    """Assert that every sheet has its point at a speed."""
    points = user_points(branch_of(scene), rpm * RPM)
    count = SHEETS.get((scene, rpm), 1)
    assert [point.stable for point in points] == [True, False, True][:count]


@each_speed
def test_integration_stays_on_every_orbit(scene: str, rpm: float) -> None:
    """Assert that stiff integration from each orbit comes back to it, with its swing and multiplier."""
    reference = REFERENCE[scene].at(rpm)
    for point in user_points(branch_of(scene), rpm * RPM):
        start = squeeze.state_from_xvh(reference, point.orbit.state(np.zeros(1))[0])
        period = squeeze.one_period(reference, start)
        assert np.abs(period.end - period.start).max() < 1e-7
        assert point.peak_to_peak("x") == pytest.approx(period.x_pp, rel=1e-7)
        assert largest_multiplier(point) == pytest.approx(abs(period.multipliers[0]), rel=1e-5)


def test_several_lift_offs_in_a_period() -> None:
    """Assert that an orbit which loses contact twice a period is tied to both, and stays under integration.

    A waviness of 3 um drives the superharmonic peak of the thin oil far out of contact.
    """
    amplitude, rpm = 3e-6, 131.0
    system = build(load("turbo33-810N", [("waviness.amplitude", str(amplitude))]))
    bounds = (145 * RPM, 120 * RPM)
    branch = per.trace(system, "speed", bounds, at=[rpm * RPM], tol=per.Accuracy.DRAFT)
    assert branch.stop.reason is per.Reason.BOUND
    upper, middle, lower = user_points(branch, rpm * RPM)
    assert (len(upper.orbit.phases), len(lower.orbit.phases)) == (2, 0)
    reference = replace(REFERENCE["turbo33-810N"], amplitude=amplitude).at(rpm)
    for point in (upper, middle, lower):
        start = squeeze.state_from_xvh(reference, point.orbit.state(np.zeros(1))[0])
        period = squeeze.one_period(reference, start)
        assert np.abs(period.end - period.start).max() < 1e-3
        assert point.peak_to_peak("x") == pytest.approx(period.x_pp, rel=1e-4)
        assert largest_multiplier(point) == pytest.approx(abs(period.multipliers[0]), rel=1e-3)


@pytest.mark.parametrize(
    "scene", ["vitrea79-2100N", *(pytest.param(s, marks=pytest.mark.long) for s in FOLDS if "turbo" in s)]
)
def test_folds_from_below(scene: str) -> None:
    """Assert that the branch traced from 100 to 500 rev/min has the same folds in the opposite order."""
    up = disc(scene, rpm=(100.0, 500.0))
    assert up.stop.reason is per.Reason.BOUND
    assert fold_speeds(up)[::-1] == pytest.approx(fold_speeds(branch_of(scene)), rel=1e-8)


@pytest.mark.long
@each_scene
def test_folds_at_other_accuracies_and_steps(scene: str) -> None:
    """Assert that folds agree between accuracies, directions and step sizes."""
    ds = per.ArclengthControl().ds
    ways = [
        disc(scene, accuracy=FINE),
        disc(scene, ds=0.6 * ds),
        disc(scene, ds=2.0 * ds),
        disc(scene, rpm=(100.0, 500.0), accuracy=FINE),
    ]
    for way in ways:
        assert sorted(fold_speeds(way)) == pytest.approx(sorted(fold_speeds(branch_of(scene))), rel=1e-8)
