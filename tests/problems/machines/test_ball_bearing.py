"""The ball bearing JIS 6306 with varying compliance, against shooting with DOP853."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference.returning import Rates, Shot, shot
from support.kept import kept

import periodic as per
import symbolic as sym

KRPM = 2000 * math.pi / 60
PLACES = (9.0, 8.0, 7.0, 6.0, 5.9)
PEAKS = {7.0: (0.49618627, 0.29072993), 6.0: (2.43086450, 0.41931401)}
"""Known x and y peak to peak in um (another author's integration, its peaks on samples)."""


@kept
def branch() -> per.Branch:
    """The branch from 10 krpm to beyond the doubling; it has no point between its two tori but by itself."""
    return per.trace(
        sym.scene("ball-bearing"),
        "speed",
        (5.4 * KRPM, 10 * KRPM),
        start=10 * KRPM,
        at=np.array(PLACES) * KRPM,
    )


def rates(krpm: float) -> Rates:
    """The equations in um, ' = d/dtau, tau = 8 W_c t, each ball written out."""
    omega = 8 * krpm * KRPM * 40.1 / 104.0

    def found(tau: float, s: np.ndarray) -> list[float]:
        theta = (tau + 2 * np.pi * np.arange(8)) / 8
        depth = np.maximum(s[0] * np.cos(theta) + s[2] * np.sin(theta) - 6, 0) * 1e-6
        load = 13.34e9 * depth**1.5
        ax = (196 - load @ np.cos(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[1]
        ay = -(load @ np.sin(theta)) / 20 * 1e6 / omega**2 - 10 / omega * s[3]
        return [s[1], ax, s[3], ay]

    return found


def confirmed(point: per.Point) -> Shot:
    """The orbit of a point by shooting, begun a little beside it.

    The step of its differences is where their noise is least: moduli of multipliers are known to 1e-6 by it.
    """
    guess = point.orbit.state(np.zeros(1))[0] + 1e-6
    return shot(rates(point.parameter / KRPM), guess, (1.0, 1.0, 1.0, 1.0), step=1e-3)


@pytest.mark.parametrize("place", PLACES)
def test_orbits(place: float) -> None:
    """Assert orbit, peaks and multipliers of one passage at five speeds by shooting."""
    (point,) = [p for p in branch().labelled(per.Label.USER) if abs(p.parameter / KRPM - place) < 1e-9]
    own = confirmed(point)
    assert point.orbit.state(np.zeros(1))[0] == pytest.approx(own.start, abs=2e-7)
    assert point.peak_to_peak("x") * 1e6 == pytest.approx(own.peak_to_peak(0), rel=1e-6)
    assert point.peak_to_peak("y") * 1e6 == pytest.approx(own.peak_to_peak(2), rel=1e-6)
    assert np.abs(point.multipliers) == pytest.approx(np.abs(own.multipliers), rel=3e-5)


@pytest.mark.parametrize("krpm", PEAKS)
def test_known_peaks(krpm: float) -> None:
    """Assert the known peaks, to the 1e-5 by which samples miss them."""
    (point,) = [p for p in branch().labelled(per.Label.USER) if abs(p.parameter / KRPM - krpm) < 1e-9]
    found = [point.peak_to_peak(q) * 1e6 for q in "xy"]
    assert found == pytest.approx(PEAKS[krpm], rel=1e-5)


def test_tori() -> None:
    """Assert the two NS between which two pairs of multipliers that meet are off the unit circle."""
    tori = branch().labelled(per.Label.TORUS)
    assert [t.parameter / KRPM for t in tori] == pytest.approx([8.981543, 8.360663], abs=2e-6)
    for torus in tori:
        assert abs(confirmed(torus).multipliers[0]) == pytest.approx(1.0, abs=2e-4)


def test_known_doubling() -> None:
    """Assert the known doubling, PD of one passage and not BP of eight, and to 1e-8 all its ten digits."""
    (doubling,) = branch().labelled(per.Label.DOUBLING)
    assert doubling.parameter / KRPM == pytest.approx(5.428828134, rel=1e-7)
    ends = (5.42 * KRPM, 5.44 * KRPM)
    close = per.trace(sym.scene("ball-bearing"), "speed", ends, guess=doubling.orbit, tol=1e-8)
    (closer,) = close.labelled(per.Label.DOUBLING)
    assert closer.parameter / KRPM == pytest.approx(5.428828134, rel=5e-10)
