"""A beam with a stop at its tip as equations of twelve states, against closed-form pieces of its motion."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import scipy
from reference.closer import closer
from reference.contact import Contact, Period, Stop, periodic

import periodic as per
import symbolic as sym

ELEMENTS, DAMPING, STIFFNESS, GAP, FORCE = 3, 0.01, 100.0, 0.02, 0.03
PLACES = (3.385, 3.4)


@cache
def matrices() -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """M^-1, K and modal damping of a cantilever of unit properties, and its first frequency."""
    given = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=ELEMENTS)
    mass, stiffness = np.asarray(given.M), np.asarray(given.K)
    squares, modes = scipy.linalg.eigh(stiffness, mass)
    frequencies = np.sqrt(squares)
    damping = mass @ modes @ np.diag(2 * DAMPING * frequencies) @ modes.T @ mass
    return np.linalg.inv(mass), stiffness, damping, float(frequencies[0])


@cache
def system() -> sym.CompiledSystem:
    """v' = M^-1 (...): the stop's force stands in every row."""
    inverse, stiffness, damping, first = matrices()
    count = len(inverse)

    def rates(s: Any, p: Any, w: Any) -> dict[str, Any]:
        q, v = ([getattr(s, f"{name}{i}") for i in range(count)] for name in "qv")
        f = [-sum(stiffness[i, j] * q[j] + damping[i, j] * v[j] for j in range(count)) for i in range(count)]
        f[-2] = f[-2] - STIFFNESS * sym.functions.fmax(q[-2] - GAP, 0)
        f[0] = f[0] + FORCE * w.cos
        forced = {f"v{i}": sum(inverse[i, j] * f[j] for j in range(count)) for i in range(count)}
        return {f"q{i}": v[i] for i in range(count)} | forced

    states = {f"{name}{i}": 0.01 for name in "qv" for i in range(count)}
    return sym.compile(sym.Equations(rates, states, {"W": first}, frequency="W"))


@cache
def exact() -> Contact:
    """The same in pieces."""
    inverse, stiffness, damping, _ = matrices()
    count, tip = len(inverse), len(inverse) - 2
    matrix = np.block([[np.zeros((count, count)), np.eye(count)], [-inverse @ stiffness, -inverse @ damping]])
    row = np.zeros(2 * count + 3)
    row[tip], row[2 * count] = 1.0, -GAP
    pushed, forced = np.zeros(2 * count + 3), np.zeros(2 * count)
    pushed[count : 2 * count], forced[count:] = inverse[:, tip], FORCE * inverse[:, 0]
    return Contact(matrix, np.zeros(2 * count), forced, [Stop(row, -STIFFNESS * pushed)])


def test_one_place_is_found() -> None:
    """Assert how much is linear, though all rows of velocities have the stop's force."""
    assert str(sym.structure_of(system())) == "12 states, 11 linear, 1 place"


def test_motion_past_grazing() -> None:
    """Assert tip and multipliers at two places to what is claimed; the contact's force alone has unknowns."""
    branch = per.trace(system(), "W", (3.37, 3.4), start=3.37, at=PLACES)
    assert branch.stop.reason is per.Reason.BOUND and branch.shortfall == ""
    assert branch.made["method"]["is"] == "CondensedCollocation"
    assert [p.parameter for p in branch.labelled("GR")] == pytest.approx([3.37734135], abs=1e-7)
    for point in branch.labelled(per.Label.USER):
        assert point.orbit.mesh.ntst <= 150
        start = beginning(point)
        found = periodic(exact(), point.parameter, start)
        tip = len(matrices()[0]) - 2
        assert start[tip] == pytest.approx(found.start[tip], abs=1e-6 * point.peak_to_peak(f"q{tip}"))
        assert np.abs(found.multipliers[:, None] - point.multipliers).min(axis=1).max() < 1e-6


def test_free_flight_only_shows_the_motion() -> None:
    """Assert multipliers beside a fold that lies beside grazing, where rounding moves the contact.

    Out of contact the motion is exact, and no finer mesh betters them. What is claimed is the error of sums
    of their powers: two of them, .04 from each other, are each off by more. Rounding decides how far
    below the tolerance it is: 1e-8 to 5e-7.
    """
    plain = per.Watch(peaks={})
    begun = per.trace(system(), "W", (3.645, 3.66), start=3.66, watch=plain)
    branch = per.trace(system(), "W", (3.645, 3.66), start=3.66, guess=begun[-1].orbit, watch=plain)
    assert [p.label for p in branch.special_points] == [per.Label.END, "LP", "GR", per.Label.END]
    beside = [p for p in branch if p.orbit.mesh.segment_lengths(p.orbit.phases).min() < 0.02]
    assert len(beside) >= 4
    assert branch.labelled("LP")[0].orbit.mesh.ntst <= 80
    for point in (p for p in beside if p.label is per.Label.NONE):
        near = periodic(exact(), point.parameter, beginning(point))
        true, other = (power_sums(closer(exact(), w, near)) for w in (point.parameter * KNOWN).tolist())
        rounding = np.abs(true - other).max()
        claimed = max(1e-6, 3 * point.error.multiplier)
        assert np.abs(power_sums(point) - true).max() < claimed + rounding


KNOWN = np.array([1.0, 1.0 + 5e-14])
"""To what the reference knows a frequency: rounding of the matrix M^-1 K changes the first one by 2e-14."""


def beginning(point: per.Point) -> np.ndarray:
    """The state at the beginning of the period, SI."""
    return np.array([float(point.orbit[f"{name}{i}"](0.0)) for name in "qv" for i in range(6)])


def power_sums(found: per.Point | Period) -> np.ndarray:
    """The sum of multipliers and half that of their squares, over the largest one."""
    scaled = found.multipliers / max(1.0, float(np.abs(found.multipliers).max()))
    return np.array([scaled.sum().real, (scaled**2).sum().real / 2])
