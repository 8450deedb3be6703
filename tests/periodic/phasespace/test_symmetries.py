"""Symmetries of equations, and motions that are images of each other."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from support.kept import kept
from support.oscillators import X, Y, oscillator, two_with_friction

import periodic as per
import symbolic as sym
from periodic.phasespace.search.search import search_of
from periodic.phasespace.search.symmetries import candidates, symmetries_of
from reports.studies.motions import known

pytestmark = pytest.mark.usefixtures("users_kernels")

LATER = "x -> -x half a period later"


@kept
def wells() -> per.phasespace.Motions:
    """Two wells: motions in either, and those beside them."""
    system = oscillator(sym.Spring(X, -2.0), sym.CubicSpring(X, 1.0), force=0.2, c=0.25)
    return per.motions(system, box={"x": (-2, 2), "x'": (-2, 2)}, starts=64, places=16, periods=3)


def names(system: sym.CompiledSystem) -> list[str]:
    """The symmetries of a system, in words."""
    box = {state.name: (-3.0, 3.0) for state in system.states}
    search = search_of(system, None, box, 1, 4, 100, 4, 0, 1e-6)
    found = symmetries_of(search.crowd, search.box, 0, not search.frequency)
    return [symmetry.name for symmetry in found]


@pytest.mark.parametrize(
    ("model", "told"),
    [
        (lambda: oscillator(sym.CubicSpring(X, 1.0)), [LATER]),
        (lambda: oscillator(sym.CubicSpring(X, 1.0), sym.ConstantForce(X, 0.1)), []),
        (lambda: oscillator(sym.CoulombFriction(X, 0.2), sym.Backlash(X, 3.0, 0.4)), [LATER]),
        (lambda: oscillator(sym.Backlash(X, 3.0, 0.4), sym.OneSidedSpring(X, 3.0, 2.5)), []),
        (two_with_friction, ["x -> -x, y -> -y half a period later"]),
        (known.lorenz, ["x -> -x, y -> -y"]),
    ],
)
def test_symmetries_by_name(model: Callable[[], sym.CompiledSystem], told: list[str]) -> None:
    """Assert the symmetries of systems with kinks and friction, and those that a mean load takes away."""
    assert names(model()) == told


def test_coordinates_that_may_be_exchanged() -> None:
    """Assert that two equal masses with a spring between them may be exchanged."""
    model = sym.Mass(X, 1.0) + sym.Mass(Y, 1.0) + sym.Spring(X, 1.0) + sym.Spring(Y, 1.0)
    model = model + sym.CubicSpring(X, 0.5, to=Y) + sym.Damper(X, 0.1) + sym.Damper(Y, 0.1)
    forces = sym.HarmonicForce(X, 1.0, 1.0) + sym.HarmonicForce(Y, 1.0, 1.0)
    told = ["x -> -x, y -> -y half a period later", "x -> y, y -> x", "x -> -y, y -> -x half a period later"]
    assert names(sym.compile(model + forces)) == told
    assert names(known.thomas())[1:] == [
        "x -> y, y -> z, z -> x",
        "x -> -y, y -> -z, z -> -x",
        "x -> z, y -> x, z -> y",
        "x -> -z, y -> -x, z -> -y",
    ]


def test_images_have_the_same_multipliers() -> None:
    """Assert that each motion of two wells has an image, and that the saddle between them is its own."""
    found = wells()
    middle = [k for k, motion in enumerate(found) if motion.images == (k,)]
    assert len(middle) == 1 and found[middle[0]].found == "about a state at rest"
    assert all(len(motion.images) == 1 for motion in found)
    for motion in found:
        assert motion.point is not None
        (image,) = motion.images
        other = found[image].point
        assert np.sort(np.abs(other.multipliers)) == pytest.approx(
            np.sort(np.abs(motion.point.multipliers)), rel=1e-5
        )
    assert "image of 2" in str(found) and "symmetric" in str(found)
    assert any(motion.found == "the image of another" for motion in found)
    assert "images under symmetries of the equations (x -> -x half a period later)" in str(found)


def test_saddle_out_of_reach_of_motions() -> None:
    """Assert the multiplier of the motion between two wells, whose product is exp(-c T)."""
    found = wells()
    saddle = next(motion for motion in found if motion.found == "about a state at rest").point
    assert saddle is not None
    product = float(np.prod(np.abs(saddle.multipliers)))
    assert product == pytest.approx(math.exp(-0.25 * 2 * math.pi), rel=1e-6)
    assert np.abs(saddle.multipliers).max() > 200 and saddle.peak_to_peak("x") < 0.25


def test_few_candidates_of_many_coordinates() -> None:
    """Assert that of many coordinates all change signs or none, and that positions go with velocities."""
    places = [sym.coordinate(f"q{k}") for k in range(8)]
    model = sum((sym.Mass(q, 1.0) + sym.Spring(q, 1.0) for q in places[1:]), sym.Mass(places[0], 1.0))
    system = sym.compile(model + sym.HarmonicForce(places[0], 1.0, 1.0))
    box = search_of(system, None, {}, 1, 4, 100, 4, 0, 1e-6).box
    each = list(candidates(box, True))
    assert len(each) == 3
    assert np.array_equal(each[1].matrix, -np.eye(16)) and each[1].shift == 0.0
