"""The flagship scene `vitrea79-810N`: reference values, folds, and the upper sheet through loss of contact.

The references are calculations of their own kind: stiff integration with shooting (`reference.squeeze`).
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from reference import squeeze
from support.kept import kept
from support.traces import (
    FINE,
    RPM,
    STANDARD,
    disc,
    disc_system,
    fold_speeds,
    largest_multiplier,
    user_points,
)

import periodic as per

SWING = {450.0: 1.615395, 360.0: 3.865414, 300.0: 11.964066, 290.0: 14.612729, 285.0: 15.716579}
"""x p-p in um by speed in rev/min."""

MULTIPLIER = {360.0: 0.965143, 300.0: 0.940676, 285.0: 0.691304}
"""Largest multipliers."""

FOLDS = (237.48658593, 252.03505698)
"""Speeds of the two folds by shooting, the upper sheet's first."""

LOST = (280.0, 260.0, 245.0)
"""Speeds at which the contact is lost on the upper sheet."""

SPEEDS = (*SWING, *LOST)
DEFAULT = per.ArclengthControl().ds
VARIANTS = {
    "fine": {"accuracy": FINE},
    "from 100 up": {"rpm": (100.0, 500.0)},
    "steps of 60 %": {"ds": 0.6 * DEFAULT},
    "steps of 200 %": {"ds": 2.0 * DEFAULT},
}
"""Other ways to trace the branch than from 500 down at standard accuracy."""


@kept
def main_branch(accuracy: per.Accuracy | float) -> per.Branch:
    """The branch from 500 to 100 rev/min, with all speeds of this module asked for."""
    return disc(accuracy=accuracy, at=SPEEDS)


def upper(accuracy: per.Accuracy, rpm: float) -> per.Point:
    """The point at a speed that is met first coming down: that of the upper sheet."""
    return user_points(main_branch(accuracy), rpm * RPM)[0]


@cache
def integrated(rpm: float) -> squeeze.Period:
    """One period by stiff integration from the collocation orbit's own state at tau = 0."""
    scene = squeeze.VITREA79.at(rpm)
    start = upper(STANDARD, rpm).orbit.state(np.zeros(1))[0]
    return squeeze.one_period(scene, squeeze.state_from_xvh(scene, start))


@pytest.mark.parametrize("rpm, swing", SWING.items())
def test_swing(rpm: float, swing: float) -> None:
    """Assert that x p-p agrees with stiff integration to the six decimals given."""
    assert upper(STANDARD, rpm).peak_to_peak("x") * 1e6 == pytest.approx(swing, rel=1e-6)


@pytest.mark.parametrize("rpm, multiplier", MULTIPLIER.items())
def test_multiplier(rpm: float, multiplier: float) -> None:
    """Assert that the largest multiplier agrees with stiff integration to the six decimals given."""
    assert largest_multiplier(upper(STANDARD, rpm)) == pytest.approx(multiplier, abs=1e-6)


@pytest.mark.parametrize("rpm", SPEEDS)
def test_agrees_with_fine(rpm: float) -> None:
    """Assert that every output's extremes and the multipliers hardly change with accuracy, on every sheet."""
    points = [user_points(main_branch(accuracy), rpm * RPM) for accuracy in (1e-7, FINE)]
    for standard, fine in zip(*points, strict=True):
        assert standard.peak_to_peak("x") == pytest.approx(fine.peak_to_peak("x"), rel=1e-7)
        for output in ("film", "deflection", "load"):
            assert standard.peak_to_peak(output) == pytest.approx(fine.peak_to_peak(output), rel=1e-6)
        assert largest_multiplier(standard) == pytest.approx(largest_multiplier(fine), rel=1e-6)


def test_one_branch_with_two_folds() -> None:
    """Assert that one branch goes from 500 to 100 rev/min with just two folds, where they should be."""
    branch = main_branch(STANDARD)
    assert (branch[0].parameter, branch[-1].parameter) == (500 * RPM, 100 * RPM)
    assert branch.stop.reason is per.Reason.BOUND
    first, second = fold_speeds(branch)
    assert 237 < first < 238 and 252 < second < 253


@pytest.mark.parametrize("accuracy", [STANDARD, FINE])
def test_folds_by_shooting(accuracy: per.Accuracy) -> None:
    """Assert that both folds lie where shooting finds them."""
    assert fold_speeds(main_branch(accuracy)) == pytest.approx(FOLDS, rel=1e-9)


@pytest.mark.parametrize("variant", VARIANTS)
def test_folds_do_not_depend_on_the_way(variant: str) -> None:
    """Assert that accuracy, direction and step size do not move the folds."""
    speeds = sorted(fold_speeds(disc(**VARIANTS[variant])))  # type: ignore[arg-type]
    assert speeds == pytest.approx(fold_speeds(main_branch(STANDARD)), rel=1e-8)


@pytest.mark.parametrize("variant", VARIANTS)
def test_branch_does_not_depend_on_the_way(variant: str) -> None:
    """Assert that every way traces the same branch: bound to bound, with the same stability on it."""
    branch = disc(**VARIANTS[variant])  # type: ignore[arg-type]
    assert {branch[0].parameter, branch[-1].parameter} == {500 * RPM, 100 * RPM}
    changes = np.flatnonzero(np.diff(branch.stable))
    assert len(changes) == 2 and branch.stable[0] and branch.stable[-1]


def test_sheets() -> None:
    """Assert that between the folds there are three orbits, the middle one unstable, elsewhere one."""
    for rpm in SPEEDS:
        points = user_points(main_branch(STANDARD), rpm * RPM)
        assert [p.stable for p in points] == ([True, False, True] if rpm == 245.0 else [True])
    high, middle, low = (p.peak_to_peak("x") for p in user_points(main_branch(STANDARD), 245.0 * RPM))
    assert high > middle > low


@pytest.mark.parametrize("rpm", LOST)
def test_integration_stays_on_the_orbit(rpm: float) -> None:
    """Assert that stiff integration started on the orbit comes back to it after a period, with its swing."""
    period = integrated(rpm)
    assert np.abs(period.end - period.start).max() < 1e-8
    assert upper(STANDARD, rpm).peak_to_peak("x") == pytest.approx(period.x_pp, rel=1e-8)


@pytest.mark.parametrize("rpm", LOST)
def test_integration_has_the_same_film_and_load(rpm: float) -> None:
    """Assert that film and largest load agree with stiff integration through loss of contact."""
    period, point = integrated(rpm), upper(STANDARD, rpm)
    assert point.peak_to_peak("film") == pytest.approx(period.h_pp, rel=1e-7)
    assert point.maximum["load"] == pytest.approx(period.load_max, rel=1e-7)


@pytest.mark.parametrize("rpm", LOST)
def test_integration_has_the_same_multiplier(rpm: float) -> None:
    """Assert that the monodromy matrix of stiff integration has the same largest multiplier."""
    found = largest_multiplier(upper(STANDARD, rpm))
    assert found == pytest.approx(abs(integrated(rpm).multipliers[0]), rel=1e-6)


@pytest.mark.parametrize("rpm", LOST)
def test_orbit_is_periodic_for_shooting(rpm: float) -> None:
    """Assert that shooting from the orbit converges to the orbit and not to another one."""
    scene = squeeze.VITREA79.at(rpm)
    period = squeeze.periodic_orbit(scene, integrated(rpm).start)
    assert upper(STANDARD, rpm).peak_to_peak("x") == pytest.approx(period.x_pp, rel=1e-8)


def test_integration_on_the_unstable_sheet() -> None:
    """Assert that the middle orbit at 245 rev/min is one for stiff integration too, as unstable."""
    scene, point = squeeze.VITREA79.at(245.0), user_points(main_branch(STANDARD), 245.0 * RPM)[1]
    start = squeeze.state_from_xvh(scene, point.orbit.state(np.zeros(1))[0])
    period = squeeze.one_period(scene, start)
    assert point.peak_to_peak("x") == pytest.approx(period.x_pp, rel=1e-7)
    assert largest_multiplier(point) == pytest.approx(abs(period.multipliers[0]), rel=1e-6)


@pytest.mark.parametrize("rpm", [450.0, 360.0, 300.0])
def test_liouville(rpm: float) -> None:
    """Assert that the multipliers have the product exp(integral of the trace) where the contact holds.

    With h as third state the trace is dh'/dh = -(beta/h + 1.5/delta)/g, h and delta over delta0.
    """
    scene, point = squeeze.VITREA79.at(rpm), upper(FINE, rpm)
    _, _, beta, g, _ = scene.scaled
    tau = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    columns = dict(
        zip(point.maximum, per.outputs(disc_system("vitrea79-810N"), point.orbit, tau).T, strict=True)
    )
    film, deflection = columns["film"] / scene.delta0, columns["deflection"] / scene.delta0
    exponent = 2 * np.pi * np.mean(-(beta / film + 1.5 / deflection) / g)
    assert np.prod(point.multipliers).real == pytest.approx(np.exp(exponent), rel=1e-5)


@pytest.mark.parametrize("accuracy", [STANDARD, FINE])
def test_no_point_is_inaccurate(accuracy: per.Accuracy) -> None:
    """Assert that every accepted point has an error estimate, multipliers included, below its tolerance."""
    tolerance = accuracy.value
    for point in main_branch(accuracy):
        assert point.error.orbit <= tolerance
        assert point.error.worst <= tolerance


def test_no_point_has_a_residual() -> None:
    """Assert that every accepted orbit fulfils its equations, the film law (a logarithm of the load) too."""
    system = disc_system("vitrea79-810N")
    for orbit in (point.orbit for point in main_branch(STANDARD)):
        arguments = [
            a.reshape(-1, a.shape[2]) for a in (orbit.knot_rates[:, 1:], orbit.stages, orbit.algebraic)
        ]
        residual = system.residual(*arguments, orbit.stage_phases.ravel(), orbit.parameter)
        assert np.abs(residual[:, :3]).max() < 1e-5
        assert np.abs(residual[:, 3]).max() < 1e-3


def test_load_is_positive() -> None:
    """Assert that the load never reaches zero, however deeply the contact is lost."""
    branch = main_branch(STANDARD)
    assert all(point.minimum["load"] > 0 for point in branch)
    assert min(point.minimum["load"] for point in branch) < 1e-10
    assert all(point.minimum["deflection"] > 0 and point.minimum["film"] > 0 for point in branch)


def test_mean_load_is_the_preload() -> None:
    """Assert that over a period the load carries the preload, whose excess would accelerate the discs."""
    for rpm in SPEEDS:
        point = upper(STANDARD, rpm)
        edges = point.orbit.mesh.nodes(point.orbit.phases)
        nodes, weights = np.polynomial.legendre.leggauss(12)
        half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
        tau = (middle[:, None] + half[:, None] * nodes).ravel()
        load = per.outputs(disc_system("vitrea79-810N"), point.orbit, tau)[
            :, list(point.maximum).index("load")
        ]
        mean = (load.reshape(len(half), -1) @ weights) @ half / (2 * np.pi)
        assert mean == pytest.approx(810.0, rel=1e-6)


@pytest.mark.parametrize("rpm, load", [(260.0, 5.84853e-21), (250.0, 7.66597e-25), (245.0, 3.14430e-26)])
@pytest.mark.parametrize("accuracy", [per.Accuracy.STANDARD, per.Accuracy.FINE])
def test_least_load_where_contact_is_lost(rpm: float, load: float, accuracy: per.Accuracy) -> None:
    """Assert the least load on the upper sheet, by dense sampling of the orbit; CVODES gives the same."""
    system = disc_system("vitrea79-810N")
    bounds = (238 * RPM, 300 * RPM)
    branch = per.trace(system, "speed", bounds, start=bounds[1], at=[rpm * RPM], tol=accuracy)
    point = branch.labelled(per.Label.USER)[0]
    loads = per.outputs(system, point.orbit, np.linspace(0, 2 * np.pi, 20001))[:, _column(system, "load")]
    assert point.minimum["load"] == pytest.approx(loads.min(), rel=1e-5)
    assert point.minimum["load"] == pytest.approx(load, rel=1e-4)


def _column(system: per.extend.System, output: str) -> int:
    return [variable.name for variable in system.outputs].index(output)
