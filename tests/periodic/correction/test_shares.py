"""What each interval adds to the error of the multipliers, and the meshes that follow from it."""

from __future__ import annotations

import numpy as np
import pytest
from support.traces import RPM, disc, user_points

import periodic as per
import symbolic as sym
from periodic.stability.shares import shares


def test_they_are_what_the_intervals_add() -> None:
    """Assert that the error of one interval's map is found there, carried to the end of the period."""
    random = np.random.default_rng(1)
    maps = np.eye(3) + 0.1 * random.normal(size=(12, 3, 3))
    off = maps.copy()
    off[7] += 1e-6 * random.normal(size=(3, 3))
    products = [np.eye(3)], [np.eye(3)]
    for found, steps in zip(products, (maps, off), strict=True):
        for step in steps:
            found.append(step @ found[-1])
    coarse, fine = (np.array(found) for found in products)
    halved = np.repeat(fine, 2, axis=0)[:-1]  # matrices at the middles of intervals are not looked at
    each = shares(coarse, halved)
    assert each is not None
    assert each[7] == pytest.approx(np.linalg.norm(fine[-1] - coarse[-1]), rel=1e-6)
    assert np.delete(each, 7).max() < 1e-8 * each[7]


def test_singular_matrices_tell_nothing() -> None:
    """Assert that there is no answer where a motion is gone."""
    gone = np.array([np.eye(2), np.diag([1.0, 0.0]), np.diag([1.0, 0.0])])
    assert shares(gone, np.repeat(gone, 2, axis=0)[:-1]) is None


def test_what_rounding_has_left_tells_nothing() -> None:
    """Assert that there is no answer either where a motion is known to 1e-16 of the largest alone."""
    left = np.array([np.eye(2), np.diag([1.0, 1e-15]), np.diag([1.0, 1e-15])])
    assert shares(left, np.repeat(left, 2, axis=0)[:-1]) is None


def sums(point: per.Point) -> tuple[complex, complex]:
    """Sums of the multipliers and of their squares, over the largest."""
    size = max(1.0, float(np.abs(point.multipliers).max()))
    return point.multipliers.sum() / size, (point.multipliers**2).sum() / 2 / size**2


@pytest.mark.parametrize("ratio", [0.007, 0.0018])
def test_hertzian_contact_needs_few_intervals(ratio: float) -> None:
    """Assert meshes of at most 70 intervals where a contact d^1.5 is lost, and multipliers as claimed.

    The error goes with h^1.5 there, as d'' of the force does not exist: it is 1.5 times its estimate.
    """
    places = (300.0, 220.0)
    coarse, fine = (disc("dry-810N", tol, at=places, ratio=ratio) for tol in (1e-6, 1e-9))
    assert max(point.orbit.mesh.ntst for point in coarse) <= 70
    for rpm in places:
        both = zip(user_points(coarse, rpm * RPM), user_points(fine, rpm * RPM), strict=True)
        for point, better in both:
            off = np.abs(np.array(sums(point)) - sums(better)).max()
            assert off < 2 * point.error.multiplier + 1e-9
            assert point.error.multiplier < 1e-6 / 3


@pytest.mark.usefixtures("users_kernels")
def test_ball_bearing_needs_few_intervals() -> None:
    """Assert it of eight contacts lost and made in turn: at most 200 intervals but at three points."""
    krpm, places = 1000 * np.pi / 30, (9.0, 5.6, 5.2)
    coarse, fine = (
        per.trace(
            sym.scene("ball-bearing"),
            "speed",
            (4 * krpm, 10 * krpm),
            start=10 * krpm,
            at=np.array(places) * krpm,
            tol=tol,
        )
        for tol in (1e-6, 1e-8)
    )
    sizes = sorted(point.orbit.mesh.ntst for point in coarse)
    assert sizes[-4] <= 200 and sizes[-1] <= 400
    for point in coarse.labelled(per.Label.USER):
        same = [p for p in fine.labelled(per.Label.USER) if abs(p.parameter - point.parameter) < 1e-9]
        off = min(np.abs(np.array(sums(point)) - sums(other)).max() for other in same)
        assert off < 2 * point.error.multiplier + 1e-8
