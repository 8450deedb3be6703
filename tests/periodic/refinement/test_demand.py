"""How many intervals are wanted, and where, of orbits that are given: by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.surfaces import along

from periodic.correction.error import SAFETY, ErrorEstimate
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.refinement import demand, equidistribution


def wave(nodes: tuple[tuple[EventNode, float], ...] = (), intervals: int = 8) -> Orbit:
    """A sine."""
    return along(lambda tau: np.sin(tau)[:, None], nodes, intervals=intervals)


@pytest.mark.parametrize(
    ("error", "factor"), [(0.1, 1.0), (0.1 * 2**5, 2.0), (0.1 * 1.2**5, 1.2), (1e9, 2.5), (1e-9, 0.5)]
)
def test_intervals_by_the_error(error: float, factor: float) -> None:
    """Assert (error / aim)^(1 / (ncol + 1)) times as many, from 1/2 to 2.5; the aim is a tenth of tol."""
    orbit = wave()
    order = orbit.mesh.scheme.ncol + 1
    given = (error / 0.1) ** (order / 5) * 0.1 if 1e-8 < error < 1e8 else error
    estimate = ErrorEstimate(given * 1e-6 / SAFETY, 0.0)
    assert demand.wanted_ntst(orbit, estimate, 1e-6, 4, 1000, 40.0) == int(np.ceil(factor * 40 - 1e-9))
    assert demand.wanted_ntst(orbit, estimate, 1e-6, 500, 1000, 40.0) == 500
    assert demand.wanted_ntst(orbit, estimate, 1e-6, 4, 10, 40.0) == 10


def test_intervals_where_shares_are_known() -> None:
    """Assert the stricter aim of 0.03, and that the multipliers' error that is a share's does not count."""
    orbit = wave()
    order = orbit.mesh.scheme.ncol + 1
    estimate = ErrorEstimate(2.0**order * 0.03e-6 / SAFETY, 1.0, shares=np.ones(8))
    assert demand.wanted_ntst(orbit, estimate, 1e-6, 4, 1000, 40.0) == 80
    unknown = ErrorEstimate(np.inf, np.inf)
    assert demand.wanted_ntst(orbit, unknown, 1e-6, 4, 1000, 40.0) == 100


def test_demand_of_intervals_by_their_shares() -> None:
    """Assert 2 pieces of an interval whose share is 2^(ncol+1) goals, and less than one of a small share."""
    orbit = wave()
    ncol, goal = orbit.mesh.scheme.ncol, demand.AIM * 1e-6 / SAFETY
    part = np.array([2.0 ** (ncol + 1)] + [2.0 ** (-2 * ncol)] * 7)
    error = part.sum() / 8 * goal
    estimate = ErrorEstimate(0.0, error, shares=part)
    found = demand.demand(orbit, estimate, 1e-6, 1000)
    assert found is not None
    assert found * orbit.grid.width == pytest.approx([2.0] + [0.5] * 7)
    few = demand.demand(orbit, estimate, 1e-6, 2)
    assert few is not None and few @ orbit.grid.width == pytest.approx(2.0)
    assert demand.demand(orbit, replace(estimate, shares=None), 1e-6, 1000) is None
    assert demand.demand(orbit, replace(estimate, orbit=np.inf), 1e-6, 1000) is None
    steep = demand.demand(orbit, replace(estimate, multiplier=1e9 * error), 1e-6, 1000)
    assert steep is not None and (steep * orbit.grid.width).max() == pytest.approx(demand.MOST_PIECES)


def test_jumps_of_the_highest_derivative() -> None:
    """Assert |jump| * 2 / (widths), the larger at either end; around the period where the mesh is closed."""
    top, width = np.array([[0.0], [3.0], [4.0]]), np.array([1.0, 2.0, 2.0])
    assert equidistribution._jumps(top, width, closed=False) == pytest.approx([2.0, 2.0, 0.5])
    assert equidistribution._jumps(top, width, closed=True) == pytest.approx([8 / 3, 2.0, 8 / 3])
    assert equidistribution._jumps(top[1:2], width[1:2], closed=False) == pytest.approx([1.5])


def test_integral_of_a_density_goes_on_around_the_period() -> None:
    """Assert it between edges 1, 2 and 4 with totals 0, 3 and 4, and beyond them."""
    edges, total = np.array([1.0, 2.0, 4.0]), np.array([0.0, 3.0, 4.0])
    found = equidistribution._cumulative(np.array([1.5, 3.0, 4.5, 0.5, 7.5]), edges, total)
    assert found == pytest.approx([1.5, 3.5, 5.5, -0.25, 9.5])


def test_segments_are_halved_where_the_density_is() -> None:
    """Assert quarters of a segment, of which that with more than 1.4 intervals is halved again and again."""
    curve = np.array([[0.0, 1.0, 4.0], [0.0, 4.0, 4.0]])
    assert equidistribution._halved(0.0, 4.0, curve, 1e-9).tolist() == [
        0.0,
        0.0625,
        0.125,
        0.1875,
        0.25,
        0.5,
        0.75,
        1.0,
    ]
    assert equidistribution._halved(0.0, 4.0, curve, 0.6).tolist() == [0.0, 0.125, 0.25, 0.5, 0.75, 1.0]


def test_every_interval_keeps_a_part_of_the_mean_density() -> None:
    """Assert a fifth of it where an orbit is at rest, and 1 where all of it is."""

    def late(tau: np.ndarray) -> np.ndarray:
        return np.where(tau > np.pi, np.sin(tau) ** 6, 0.0)[:, None]

    orbit = along(late, intervals=40)
    found = equidistribution.density(orbit)
    still = equidistribution.density(along(lambda tau: 0 * tau[:, None]))
    assert still.tolist() == [1.0] * 40
    assert found[5] == found.min() and found.max() > 5 * found.min()


@pytest.mark.parametrize(
    ("density", "count"), [([1.0] * 10, 10.0), ([4.0, *[1.0] * 9], 1.4 * 13 / 4), ([100.0, *[0.1] * 9], 4.0)]
)
def test_even_intervals(density: list[float], count: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert 1.4 times the sum of shares over the largest, from 0.4 of the intervals to all of them."""
    monkeypatch.setattr(demand, "density", lambda _: np.array(density))
    assert demand.evenly(wave(intervals=10)) == pytest.approx(count)


def test_no_demand_where_the_multipliers_error_is_rounding() -> None:
    """Assert none up to three times rounding, and that the orbit's own part of the error does not count."""
    orbit, shares = wave(), np.ones(8)
    rough = ErrorEstimate(1e-9, SAFETY * 1e-5, rounding=1e-5, by_orbit=0.0, shares=shares)
    assert demand.demand(orbit, rough, 1e-6, 1000) is None
    above = replace(rough, multiplier=SAFETY * 1e-5 * 1.01)
    known = demand.demand(orbit, above, 1e-6, 1000)
    assert known is not None
    part = above.multiplier / (demand.AIM * 1e-6 / SAFETY)
    pieces = min(part ** (1 / (orbit.mesh.scheme.ncol + 1)), demand.MOST_PIECES)
    assert known * orbit.grid.width == pytest.approx(pieces)
    assert demand.demand(orbit, replace(above, by_orbit=above.multiplier), 1e-6, 1000) is None
    few = demand.demand(orbit, above, 1e-6, 5)
    assert few is not None and few @ orbit.grid.width == pytest.approx(5.0)
