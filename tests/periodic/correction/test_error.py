"""The error estimate that every orbit carries, against its true error."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.kept import kept
from support.traces import DUFFING_A, FINE, RPM, disc_system, duffing, duffing_system

import periodic as per

FREQUENCIES = (0.5, 1.0, 1.6, 2.0)
SPEEDS = (450.0, 360.0, 300.0, 280.0, 260.0, 245.0)
"""In rev/min; the contact is lost at the last three."""

EVEN = np.linspace(0.0, 2 * np.pi, 2001)
SCHEMES = [(per.Family.RADAU, 4), (per.Family.RADAU, 5), (per.Family.GAUSS, 3), (per.Family.GAUSS, 4)]
TIGHT = (1e-10, per.Family.RADAU, 7)
TIGHT_DISC = (1e-9, per.Family.RADAU, 6)


def settings(tolerance: float, family: per.Family, ncol: int) -> dict[str, Any]:
    """Arguments that leave the discretisation as the only error that counts."""
    newton = per.NewtonSettings(tolerance=1e-9, max_iterations=16)
    return {
        "tol": per.Tolerance(orbit=tolerance, newton=newton),
        "method": per.Collocation(scheme=per.Scheme(family, ncol)),
    }


@kept
def oscillators(tolerance: float, family: per.Family, ncol: int) -> tuple[per.Point, ...]:
    """Duffing orbits, at some frequencies on three sheets."""
    branch = per.trace(
        duffing_system(*DUFFING_A),
        "Omega",
        (0.3, 3.0),
        at=FREQUENCIES,
        **settings(tolerance, family, ncol),
    )
    return branch.labelled(per.Label.USER)


@kept
def discs(tolerance: float, family: per.Family, ncol: int) -> tuple[per.Point, ...]:
    """Orbits of the disc on its upper sheet."""
    branch = per.trace(
        disc_system("vitrea79-810N"),
        "speed",
        (500 * RPM, 240 * RPM),
        at=[speed * RPM for speed in SPEEDS],
        **settings(tolerance, family, ncol),
    )
    return branch.labelled(per.Label.USER)


def true_error(point: per.Point, exact: per.Point) -> float:
    """Largest difference of the states over their largest peak to peak."""
    assert point.parameter == exact.parameter
    nodes = point.orbit.mesh.nodes(point.orbit.phases)
    tau = np.concatenate([EVEN, nodes, (nodes[1:] + nodes[:-1]) / 2])
    return float(np.abs(point.orbit.state(tau) - exact.orbit.state(tau)).max()) / exact.orbit.span()


@pytest.mark.parametrize("family, ncol", SCHEMES)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_estimate_of_smooth_orbits(tolerance: float, family: per.Family, ncol: int) -> None:
    """Assert that the estimate is within a factor of ten of the true error on every sheet."""
    for point, exact in zip(oscillators(tolerance, family, ncol), oscillators(*TIGHT), strict=True):
        assert 0.1 < point.error.orbit / true_error(point, exact) < 10


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_estimate_while_in_contact(tolerance: float) -> None:
    """Assert that the estimate is within a factor of ten of the true error where the contact holds."""
    pairs = list(zip(discs(tolerance, per.Family.RADAU, 4), discs(*TIGHT_DISC), strict=True))[:3]
    for point, exact in pairs:
        assert 0.1 < point.error.orbit / true_error(point, exact) < 10


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_estimate_through_loss_of_contact(tolerance: float) -> None:
    """Assert that the estimate is nowhere ten times too small, and mostly within a factor of ten.

    At a kink a single tiny interval may make it too large.
    """
    pairs = list(zip(discs(tolerance, per.Family.RADAU, 4), discs(*TIGHT_DISC), strict=True))[3:]
    ratios = [point.error.orbit / true_error(point, exact) for point, exact in pairs]
    assert min(ratios) > 0.1
    assert np.median(ratios) < 10


@pytest.mark.parametrize("family, ncol", SCHEMES)
def test_true_error_is_within_the_tolerance(family: per.Family, ncol: int) -> None:
    """Assert that orbits are as accurate as was asked for, but for a factor of three."""
    for tolerance in (1e-4, 1e-6, 1e-8):
        for point, exact in zip(oscillators(tolerance, family, ncol), oscillators(*TIGHT), strict=True):
            assert true_error(point, exact) < 3 * tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_multipliers_are_within_their_tolerance(tolerance: float) -> None:
    """Assert that the largest multiplier of every orbit is right to thirty tolerances."""
    for point, exact in zip(discs(tolerance, per.Family.RADAU, 4), discs(*TIGHT_DISC), strict=True):
        assert abs(point.multipliers[0]) == pytest.approx(abs(exact.multipliers[0]), abs=30 * tolerance)


def test_smaller_tolerance_takes_more_intervals() -> None:
    """Assert that meshes grow as the tolerance falls, with the order of the scheme."""
    counts = [
        np.mean([p.orbit.mesh.ntst for p in oscillators(tolerance, per.Family.RADAU, 4)])
        for tolerance in (1e-4, 1e-6, 1e-8)
    ]
    assert counts[0] < counts[1] < counts[2]
    assert counts[2] / counts[0] < 3 * 1e4 ** (1 / 5)


def test_dial() -> None:
    """Assert that every accepted point of a dialled accuracy has an estimate below its tolerance."""
    for accuracy in per.Accuracy:
        assert all(point.error.worst <= accuracy.value for point in duffing(accuracy=accuracy))


def test_fine_is_finer() -> None:
    """Assert that fine orbits agree with tight ones ten times closer than standard ones are asked to."""
    fine = duffing(accuracy=FINE, at=FREQUENCIES).labelled(per.Label.USER)
    for point, exact in zip(fine, oscillators(*TIGHT), strict=True):
        assert true_error(point, exact) < 1e-8


@pytest.mark.parametrize("tol", [1e-3, 1e-4, 1e-6])
def test_peaks_of_steep_outputs(tol: float) -> None:
    """Assert that errors of a disc's load, film and deflection at their extremes are told, to a third.

    They are up to 22 times those of the states, each relative to its own peak to peak. What is less than the
    tight orbits are good for is not told apart.
    """
    speeds = [speed * RPM for speed in SPEEDS[:3]]
    system = disc_system("vitrea79-810N")
    drafts, tight = (
        per.trace(system, "speed", (500 * RPM, 290 * RPM), at=speeds, tol=t).labelled(per.Label.USER)
        for t in (tol, 1e-9)
    )
    steep = [name for name in drafts[0].maximum if name not in {q.name for q in system.states}]
    assert len(drafts) == len(tight) == 3 and steep
    for point, exact in zip(drafts, tight, strict=True):
        ends = [
            max(abs(point.maximum[k] - exact.maximum[k]), abs(point.minimum[k] - exact.minimum[k]))
            / exact.peak_to_peak(k)
            for k in steep
        ]
        assert max(ends) < 1.5 * point.error.peaks + 1e-9
        assert point.error.peaks < 3 * max(ends) + 1e-9
    assert max(point.error.peaks for point in drafts) > 10 * max(point.error.orbit for point in drafts)


def test_peaks_of_states_are_their_own() -> None:
    """Assert that outputs that are states have no further error."""
    for point in oscillators(1e-6, per.Family.RADAU, 5):
        assert point.error.peaks == 0.0


def test_peaks_are_kept(tmp_path: Path) -> None:
    """Assert that a branch has them in a file."""
    branch = per.trace(disc_system("vitrea79-810N"), "speed", (500 * RPM, 450 * RPM), tol=1e-4)
    branch.save(tmp_path / "branch.nc")
    again = per.Branch.load(tmp_path / "branch.nc")
    assert [point.error.peaks for point in again] == [point.error.peaks for point in branch]
    assert max(point.error.peaks for point in again) > 0
