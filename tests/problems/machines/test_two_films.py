"""A shaft with a disc in two film bearings, one of which carries a seventh of the disc."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.condensed import floquet
from periodic.condensed.condensedcollocation import CondensedCollocation
from periodic.condensed.operator import CondensedOperator
from periodic.orbit.scheme import Array
from periodic.tracing.methodchoice import chosen_method

SLOW = 120.0
"""Speed in rad/s, at which the films are stiffer by far than the shaft's ends are heavy."""


def rotor() -> sym.CompiledSystem:
    """A shaft of seven elements, 18 kg, with a disc of 40 kg beside one of the bearings."""
    disc = sym.ShaftDisc(node=6, mass=40.0, polar=0.4, diametral=0.2)
    shaft = sym.shaft(length=0.8, diameter=0.06, elements=7, discs=[disc])
    places = {"left": ("x0", "y0"), "disc": ("x6", "y6"), "right": ("x7", "y7")}
    structure = sym.Structure(shaft, at=places, rayleigh=(0.0, 5e-6), scale=1e-5)
    speed = sym.parameter("speed", SLOW, "rad/s")
    x, y = structure["disc"]
    parts = [structure, sym.ConstantForce(y, -400.0), sym.Unbalance(x, y, 40.0, 1e-5, speed)]
    for side, viscosity in (("left", 0.04), ("right", 0.02)):
        x, y = structure[side]
        sizes = {"viscosity": viscosity, "radius": 0.03, "length": 0.04, "clearance": 4e-5}
        parts += [sym.JournalBearing(x, y, **sizes, speed=speed).named(side), sym.ConstantForce(y, -50.0)]
    return sym.compile(sym.combine(parts))


def test_outputs_are_told_apart_by_the_parts() -> None:
    """Assert that two films in one model compile, each with the eccentricity of its own bearing."""
    names = [output.name for output in rotor().outputs]
    assert [name for name in names if name.startswith("ecc")] == [
        "eccentricity of left",
        "eccentricity of right",
    ]


@kept
def at(intervals: int) -> per.Branch:
    """The motion at the slow speed, begun with so many intervals."""
    method = CondensedCollocation(ntst=intervals, ntst_min=intervals)
    few = per.ArclengthControl(max_points=1)
    return per.trace(rotor(), "speed", (SLOW, SLOW + 10), start=SLOW, method=method, control=few)


def test_multipliers_ask_for_intervals() -> None:
    """Assert that the mesh is as fine as the multipliers ask: to 5e-7 those of many more.

    Where equations of the whole period were set up for it, memory allowed too few; false ones appeared.
    """
    coarse, fine = at(40)[0], at(320)[0]
    assert coarse.orbit.mesh.ntst > 40
    assert not coarse.error.multiplier > 1e-6
    lasting = [m[np.abs(m) > 0.1] for m in (np.array(p.multipliers) for p in (coarse, fine))]
    assert len(lasting[0]) == len(lasting[1]) > 3
    first, second = (np.poly(values) for values in lasting)
    assert first == pytest.approx(second, abs=5e-7)
    assert coarse.stable and fine.stable


def operators(monkeypatch: pytest.MonkeyPatch) -> tuple[CondensedOperator, CondensedOperator, list[Any]]:
    """The equations about one orbit, solved at once and interval by interval, and a row that closes them."""
    system, orbit = rotor(), at(40)[0].orbit
    given = per.Problem(system, "speed", (SLOW, SLOW + 10))
    problem, method = chosen_method(per.Collocation().at(1e-6), given)
    found = [method.linearise(problem.system, orbit, problem.free) for _ in range(2)]
    for operator, interval_by_interval in zip(found, (False, True), strict=True):
        assert isinstance(operator, CondensedOperator)
        monkeypatch.setattr(floquet, "pays", lambda *given, by=interval_by_interval: by)
        assert (operator.leading.floquet.chain is not None) == interval_by_interval
    row = per.Amplitude("disc 1").linearise(problem.system, orbit, problem.free)
    return found[0], found[1], [row]  # type: ignore[return-value]


def test_error_is_estimated_by_intervals_as_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that what disturbed states cause is the same both ways: increments and multipliers."""
    at_once, chain, rows = operators(monkeypatch)
    count, points, _ = at_once.orbit.stages.shape
    draw = np.random.default_rng(3)
    lacking: Array = draw.standard_normal((count, points, len(at_once.system.places)))
    first, second = (operator.answered(rows, lacking) for operator in (at_once, chain))
    size = np.abs(first.stages).max()
    assert second.stages == pytest.approx(first.stages, abs=1e-7 * size)
    assert second.parameter == pytest.approx(first.parameter, rel=1e-7)
    modes = len(at_once.given.response.modes.exponents)
    begun = draw.standard_normal((modes, 3)) + 1j * draw.standard_normal((modes, 3))
    states = draw.standard_normal((*lacking.shape, 3))
    left = [operator.leading.floquet.left(states, begun) for operator in (at_once, chain)]
    assert left[1] == pytest.approx(left[0], abs=1e-7 * np.abs(left[0]).max())


def test_rubs_are_told_apart() -> None:
    """Assert the names of what two rings on one shaft say: by their places, or by a number."""
    x, y, u, v = (sym.coordinate(name) for name in "xyuv")
    held = [part for q in (x, y, u, v) for part in (sym.Mass(q, 1.0), sym.Spring(q, 1.0))]
    rings = [sym.Rub(x, y, 1.0, 0.1), sym.Rub(u, v, 1.0, 0.2), sym.Rub(u, v, 1.0, 0.3)]
    system = sym.compile(sym.combine([*held, *rings, sym.Unbalance(x, y, 1.0, 0.1)]))
    said = [output.name for output in system.outputs][4:]
    assert said == ["rub of x_y", "rub of u_v", "rub of u_v (2)"]
    switches = [surface.name for surface in system.switches]
    assert switches == ["r = clearance", "r = clearance of u_v", "r = clearance of u_v (2)"]
    assert math.isclose(system.nominal[[p.name for p in system.parameters].index("clearance_u_v_2")], 0.3)
