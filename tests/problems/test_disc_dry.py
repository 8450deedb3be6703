"""The scenes without squeeze film, dry and quasi-static, against shooting with SciPy's DOP853."""

from __future__ import annotations

import numpy as np
import pytest
from reference import squeeze
from reference.discs import dry, quasistatic
from reference.shooting import Field, Motion, motion, periodic_orbit
from support.kept import kept
from support.traces import RPM, disc, fold_speeds, largest_multiplier, user_points

import periodic as per
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

DRY, FILM = "dry-810N", "quasistatic-film-810N"
Case = tuple[str, float]
FOLDS: dict[Case, tuple[float, float]] = {
    (DRY, 0.05): (253.3339343, 258.1646647),
    (DRY, 0.007): (153.3576357, 253.7458674),
    (DRY, 0.0018): (102.3791620, 253.6766132),
    (FILM, 0.007): (153.2598204, 250.8645615),
}
"""Speeds of the folds by scene and damping ratio, in order down the branch."""

SPEEDS: dict[Case, tuple[float, float]] = {
    (DRY, 0.05): (300.0, 255.0),
    (DRY, 0.007): (300.0, 220.0),
    (DRY, 0.0018): (300.0, 150.0),
    (FILM, 0.007): (300.0, 220.0),
}
"""Speeds above the folds, where there is one orbit, and between them, where there are three."""

PHASES = np.linspace(0.0, 2 * np.pi, 401)
GRAZING_FREQUENCY, GRAZING_DEFLECTION = 0.95310, 2.5 ** (2 / 3)
"""Of the undamped free vibration that grazes zero load, over omega0 and delta0."""

each_case = pytest.mark.parametrize("case", FOLDS, ids=str)


TOLERANCE = 1e-7


def branch_of(case: Case) -> per.Branch:
    """The branch from 500 to 100 rev/min."""
    scene, ratio = case
    return disc(scene, TOLERANCE, at=SPEEDS[case], ratio=ratio)


def problem(case: Case, rpm: float) -> Field:
    """The case at a speed, for shooting."""
    scene, ratio = case
    return (dry if scene == DRY else quasistatic)(squeeze.VITREA79.at(rpm), ratio)


def shot(case: Case, point: per.Point) -> Motion:
    """The orbit by shooting, from a guess a little beside the collocation orbit."""
    guess = point.orbit.state(np.zeros(1))[0] * (1 + 1e-5)
    return periodic_orbit(problem(case, point.parameter / RPM), guess, rtol=1e-11)


@each_case
def test_far_bound_is_reached(case: Case) -> None:
    """Assert that the branch goes from 500 to 100 rev/min."""
    branch = branch_of(case)
    assert branch.stop.reason is per.Reason.BOUND
    assert (branch[0].parameter, branch[-1].parameter) == (500 * RPM, 100 * RPM)


@each_case
def test_folds(case: Case) -> None:
    """Assert that the branch has these two folds and no other."""
    assert fold_speeds(branch_of(case)) == pytest.approx(FOLDS[case], rel=1e-8)


@each_case
def test_folds_by_integration(case: Case) -> None:
    """Assert that integration from the orbits at the folds comes back to them, with a multiplier of 1."""
    for point in branch_of(case).labelled(per.Label.FOLD):
        start = point.orbit.state(np.zeros(1))[0]
        period = motion(problem(case, point.parameter / RPM), start, rtol=1e-11)
        assert np.abs(period.end - period.start).max() < 1e-8
        assert np.abs(period.multipliers - 1).min() < 1e-4


@each_case
def test_orbits_by_shooting(case: Case) -> None:
    """Assert that orbits on every sheet, in contact and out of it, are those of shooting."""
    for rpm in SPEEDS[case]:
        for point in user_points(branch_of(case), rpm * RPM):
            difference = np.abs(point.orbit.state(PHASES) - shot(case, point).state(PHASES)).max()
            assert difference < 2e-7 * point.orbit.span()


@each_case
def test_multipliers_by_shooting(case: Case) -> None:
    """Assert that the largest multipliers on every sheet are those of shooting."""
    for rpm in SPEEDS[case]:
        for point in user_points(branch_of(case), rpm * RPM):
            expected = abs(shot(case, point).multipliers[0])
            assert largest_multiplier(point) == pytest.approx(expected, rel=5e-6)


@each_case
def test_sheets(case: Case) -> None:
    """Assert that there is one orbit above the folds and three between them, the middle one unstable."""
    single, triple = (user_points(branch_of(case), rpm * RPM) for rpm in SPEEDS[case])
    assert [point.stable for point in single] == [True]
    assert [point.stable for point in triple] == [True, False, True]


@each_case
def test_liouville(case: Case) -> None:
    """Assert that the multipliers of every orbit have the product exp(-4 pi zeta omega0/omega)."""
    for point in branch_of(case):
        c = squeeze.VITREA79.at(point.parameter / RPM).scaled[4]
        exact = np.exp(-4 * np.pi * case[1] * np.sqrt(1.5 * c))
        assert np.prod(point.multipliers) == pytest.approx(exact, rel=2e-5)


@each_case
def test_no_point_is_inaccurate(case: Case) -> None:
    """Assert that every accepted point has an error estimate, multipliers included, below its tolerance."""
    for point in branch_of(case):
        assert point.error.orbit <= TOLERANCE
        assert point.error.worst <= TOLERANCE


@each_case
def test_contact_is_lost_in_resonance(case: Case) -> None:
    """Assert that the load is never negative and vanishes on the upper sheet, not on the lower one."""
    branch = branch_of(case)
    upper, _, lower = user_points(branch, SPEEDS[case][1] * RPM)
    assert min(point.minimum["load"] for point in branch) >= 0
    assert upper.minimum["load"] < 1e-6 and lower.minimum["load"] > 100


def test_lift_off_and_return_are_tied() -> None:
    """Assert that both passages of zero deflection have their event node, at the phases of shooting."""
    case = (DRY, 0.007)
    for point in user_points(branch_of(case), 220.0 * RPM)[:2]:
        found = np.sort(np.mod(point.orbit.phases, 2 * np.pi))
        assert found == pytest.approx(shot(case, point).kinks, abs=1e-6)


@kept
def faint(ratio: float, force: float) -> tuple[per.Branch, np.ndarray]:
    """Branch through a resonance of faint damping, and the least (unclipped) deflection along it over delta0.

    force: F/(Q zeta) of the force that acts on the deflection, F/Q = 1.5 (a/delta0) (omega/omega0)^2.
    """
    reference = squeeze.VITREA79
    amplitude = force * ratio / 1.5 / GRAZING_FREQUENCY**2
    changes = [("damping.ratio", str(ratio)), ("waviness.amplitude", repr(amplitude * reference.delta0))]
    middle = np.sqrt(3 * reference.preload / (reference.mass * reference.delta0)) / reference.waves
    branch = per.trace(build(load(DRY, changes)), "speed", (1.02 * middle, 0.93 * middle))
    assert branch.stop.reason is per.Reason.BOUND
    least = [(1 + amplitude * np.sin(PHASES) - p.orbit.state(PHASES)[:, 0]).min() for p in branch]
    return branch, np.array(least)


def test_contact_is_first_lost_at_the_energy_balance() -> None:
    """Assert that contact holds throughout at a relative force of 2.64 zeta and is lost at 2.68 zeta."""
    assert faint(1e-4, 2.64)[1].min() > 0.005
    assert faint(1e-4, 2.68)[1].min() < -0.005


def test_grazing_orbit() -> None:
    """Assert frequency and largest deflection of the undamped orbit that just loses contact."""
    branch, least = faint(1e-4, 2.67)
    first = int(np.flatnonzero(least < 0)[0])
    part = least[first - 1] / (least[first - 1] - least[first])
    reference = squeeze.VITREA79
    middle = np.sqrt(3 * reference.preload / (reference.mass * reference.delta0)) / reference.waves
    highest = np.array([point.maximum["deflection"] for point in branch]) / reference.delta0
    for values, known in ((branch.values / middle, GRAZING_FREQUENCY), (highest, GRAZING_DEFLECTION)):
        assert (1 - part) * values[first - 1] + part * values[first] == pytest.approx(known, rel=2e-5)
