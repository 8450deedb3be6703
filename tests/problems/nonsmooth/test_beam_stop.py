"""The scene beam-stop at five places, against closed-form pieces of the motion of all its states."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from reference.contact import Contact, Period, Stop, period
from support.kept import kept

import periodic as per
import symbolic as sym

HZ = 2 * math.pi
PLACES = tuple(HZ * f for f in (17.0, 18.5, 19.5, 21.0, 25.0))
ELEMENTS, RAYLEIGH, STIFFNESS, GAP, FORCE = 2, 3.5e-4, 2000.0, 1e-3, 0.02


@kept
def branch() -> per.Branch:
    """The branch of the scene with fewer elements, whose fastest mode closed forms can follow."""
    system = sym.scene("beam-stop", {"structure.beam.beam.elements": ELEMENTS})
    return per.trace(system, "Omega", (16 * HZ, 26 * HZ), start=16 * HZ, at=PLACES)


@cache
def beam() -> tuple[Contact, int]:
    """The beam in states (q, dq/dt), and the index of its tip."""
    given = sym.beam(length=0.3, bending=2.8, mass_per_length=0.314, elements=ELEMENTS)
    mass, stiffness, tip = np.asarray(given.M), np.asarray(given.K), given.at["tip"]
    n, inverse = len(mass), np.linalg.inv(mass)
    matrix = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -RAYLEIGH * inverse @ stiffness]]
    )
    pushed = np.concatenate([np.zeros(n), inverse[:, tip], np.zeros(3)])
    row = np.zeros(2 * n + 3)
    row[tip], row[2 * n] = 1.0, -GAP
    stop = Stop(row, -STIFFNESS * pushed)
    return Contact(matrix, np.zeros(2 * n), FORCE * pushed[: 2 * n], [stop]), tip


def exact(Omega: float, x: float, v: float) -> tuple[Period, int]:
    """The orbit by Newton's method from the tip's state, the beam bent as by a static force."""
    contact, tip = beam()
    n = len(contact.matrix) // 2
    shape = np.linalg.solve(contact.matrix[n:, :n], contact.force[n:])
    start = np.concatenate([x * shape / shape[tip], v * shape / shape[tip]])
    for _ in range(12):
        found = period(contact, Omega, start)
        start = start - np.linalg.solve(found.monodromy - np.eye(2 * n), found.end - start)
    return period(contact, Omega, start), tip


def test_orbits() -> None:
    """Assert the tip to 3e-6 of the gap and the leading multiplier on every sheet; the end is reached."""
    points = branch().labelled(per.Label.USER)
    assert branch().stop.reason is per.Reason.BOUND
    assert {point.parameter for point in points} == set(PLACES) and len(points) > len(PLACES)
    for point in points:
        x = float(point.orbit["tip"](np.zeros(1))[0])
        v = float(point.orbit["tip'"](np.zeros(1))[0])
        found, tip = exact(point.parameter, x, v)
        n = len(found.start) // 2
        assert found.end == pytest.approx(found.start, abs=1e-9)
        assert x == pytest.approx(found.start[tip], abs=3e-6 * GAP)
        assert v == pytest.approx(found.start[n + tip], abs=3e-6 * GAP * point.parameter)
        assert abs(point.multipliers[0]) == pytest.approx(abs(found.multipliers[0]), rel=1e-5)


def test_special_points() -> None:
    """Assert that the branch grazes, folds twice in contact and parts, in this order."""
    labels = [point.label for point in branch().special_points if point.label is not per.Label.USER]
    assert [str(label) for label in labels] == ["EP", "GR", "LP", "LP", "GR", "EP"]


@pytest.mark.long
def test_contacts_that_part_and_join_again() -> None:
    """Assert that a beam between two stops passes where both of its contacts part, and where they join.

    Two at a time by symmetry.
    """
    given = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=10)
    structure = sym.Structure(given, damping=0.02)
    tip = structure["tip"]
    model = structure + sym.Gap(tip, 30.0, -0.01, 0.01) + sym.HarmonicForce(tip, 0.02, 3.0)
    found = per.trace(sym.compile(model), "Omega", (2.0, 4.0), start=2.0)
    assert found.stop.reason is per.Reason.BOUND and found.shortfall == ""
    places = [point.parameter for point in found.labelled("GR")]
    assert places == pytest.approx([2.051069, 3.262614, 3.272653], abs=2e-6)
    assert [len(p.orbit.mesh.events) for p in (found.points[0], found.points[-1])] == [0, 4]
