"""Bifurcations of tori: those of orbits where a second force does nothing, and what it changes; lockings."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy
from support.kept import kept

import periodic as per
import symbolic as sym
from reports.studies.motions.tori import forced, two_forces

pytestmark = pytest.mark.usefixtures("users_kernels")


def hard(second: float | None = None, mean: float = 0.0) -> sym.CompiledSystem:
    """x'' + .2 x' + x + x^3 = F cos + mean, beside it a second phase, whose cosine is a force too."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = p.F * wave.cos + mean - 0.2 * x.v - x.x - x.x**3
        if second is None:
            return {"x": x.v, "v": force}
        return {"x": x.v, "v": force + second * x.c} | phase(x, p)

    return compiled(rates, second is not None, 1.0)


def soft(second: float | None = None) -> sym.CompiledSystem:
    """A forced van der Pol oscillator, beside it a second phase."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        force = p.F * wave.cos - 0.3 * (x.x**2 - 1) * x.v - x.x
        return {"x": x.v, "v": force} | ({} if second is None else phase(x, p))

    return compiled(rates, second is not None, 1.2)


def phase(x: Any, p: Any) -> dict[str, Any]:
    """A phase that turns sqrt(2) times as fast as the first."""
    left, turns = 1 - x.c**2 - x.s**2, math.sqrt(2) * p.Omega
    return {"c": left * x.c - turns * x.s, "s": left * x.s + turns * x.c}


def compiled(rates: Any, second: bool, omega: float) -> sym.CompiledSystem:
    """Compile rates of x, v, and c, s of a second phase."""
    states = {"x": 0.0, "v": 0.0} | ({"c": 1.0, "s": 0.0} if second else {})
    return sym.compile(sym.Equations(rates, states, {"F": 2.0, "Omega": omega}, frequency="Omega"))


@pytest.mark.parametrize(
    ("label", "model", "begin", "bounds", "digits"),
    [
        ("PD", lambda second: hard(second, mean=0.3), 7.0, (7.0, 7.4), 1e-8),
        ("NS", soft, 0.8, (0.6, 0.8), 1e-8),
        ("BP", hard, 2.6, (2.6, 2.9), 2e-5),
    ],
)
def test_a_phase_that_does_nothing(
    label: str, model: Any, begin: float, bounds: tuple[float, float], digits: float
) -> None:
    """Assert that tori of an orbit and a phase bifurcate where the orbit does, and in the same way."""
    orbits, tori = model(None), model(0.0)
    branch = per.trace(orbits, "F", bounds, start=begin)
    (known,) = branch.labelled(label)
    family = per.trace(tori, "F", bounds, guess=per.settled_torus(tori, {"F": begin}))
    marked = {point.label for point in family} - {"", "EP"}
    (found,) = family.labelled(label)
    assert marked == {label}
    assert found.parameter == pytest.approx(known.parameter, rel=digits)
    sizes = np.sort(np.abs(found.multipliers))
    shared = np.sort(np.abs(known.multipliers))
    assert sizes[-2:] == pytest.approx([1.0, 1.0], abs=1e-4)
    assert np.abs(sizes[:, None] - shared).min(axis=0) == pytest.approx(0.0, abs=1e-4)
    assert not found.stable


def test_doubling_moves_with_the_square_of_the_second_force() -> None:
    """Assert that a small second force moves the doubling by its square."""
    moved = []
    for second in (0.0, 0.01, 0.02):
        system = hard(second, mean=0.3)
        torus = per.settled_torus(system, {"F": 7.1})
        (point,) = per.trace(system, "F", (7.1, 7.3), guess=torus).labelled("PD")
        moved.append(point.parameter)
    once, twice = moved[1] - moved[0], moved[2] - moved[0]
    assert once > 1e-5 and twice / once == pytest.approx(4.0, rel=1e-2)


def test_motions_beyond_a_doubling_go_round_twice() -> None:
    """Assert that beside an unstable torus motions settle on one of half the rotation number."""
    system = two_forces()
    family = per.trace(system, "eta", (0.85, 1.0), guess=per.settled_torus(system, {"eta": 0.87}))
    (point,) = family.labelled("PD")
    assert point.parameter == pytest.approx(0.92002913, abs=1e-7)
    whole = math.sqrt(2) - 1
    before = per.settled_torus(system, {"eta": 0.915}, start={"x": 0.1}, settle=4000)
    after = per.settled_torus(system, {"eta": 0.925}, start={"x": 0.1}, settle=4000)
    assert before.rotation_number == pytest.approx(whole, rel=1e-9)
    assert after.rotation_number == pytest.approx((1 + whole) / 2, rel=1e-9) or after.rotation_number == (
        pytest.approx(whole / 2, rel=1e-9)
    )


@kept
def round_a_tongue() -> per.tori.TorusBranch:
    """Tori of the forced oscillator, over a narrow tongue down to where they begin."""
    high = 1.3955  # near the tongue, so that steps are short
    torus = per.settled_torus(forced(), {"eta": high})
    return per.trace(forced(), "eta", (1.0, high), guess=torus)


def test_narrow_tongue_is_passed_over() -> None:
    """Assert that a locking is told, and that tori go on beyond it to the torus bifurcation of the orbits."""
    family = round_a_tongue()
    told, passed = family.stops[1].split("; ")
    assert passed.startswith("a rotation number of 2/7 was passed over somewhere between 1.39")
    branch = per.trace(forced(), "eta", (1.0, 1.4), start=1.0)
    (born,) = branch.labelled("NS")
    assert told.startswith("the torus shrinks to an orbit, a torus bifurcation (NS) near ")
    assert float(told.rpartition(" ")[2]) == pytest.approx(born.parameter, abs=1e-6)
    at = per.settled_torus(forced(), {"eta": 1.3})
    beside = min(family, key=lambda point: abs(point.parameter - 1.3))
    assert at.rotation_number == pytest.approx(beside.torus.rotation_number, abs=0.02)


def test_wide_tongue_has_its_orbits() -> None:
    """Assert the stable and the unstable orbit of three periods on which the motion locks, born at a fold."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": 1.2 * wave.cos - 0.3 * (x.x**2 - 1) * x.v - x.x}

    states = {"x": 0.0, "v": 0.0}
    system = sym.compile(sym.Equations(rates, states, {"eta": 2.9, "idle": 0.0}, frequency="eta"))
    family = per.trace(system, "eta", (2.8, 3.2), guess=per.settled_torus(system))
    assert family.stops[1].startswith("the motion locks: the rotation number 0.")
    assert family.stops[1].endswith("/3; beyond there are stable and unstable orbits of 3 periods")
    assert sorted(point.stable for point in family.orbits) == [False, True]
    branch = per.trace(
        system, "eta", (2.9, 3.1), start=family[-1].parameter + 0.02, guess=family.orbits[0].orbit
    )
    fold = min(branch.labelled("LP"), key=lambda point: point.parameter)
    assert fold.parameter == pytest.approx(family[-1].parameter, abs=1e-4)


def test_fixed_rotation_number() -> None:
    """Assert that tori of one rotation number pass, by symmetry, through the oscillator without a force."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        return {"x": x.v, "v": p.F * wave.cos - 0.3 * (x.x**2 - 1) * x.v - x.x}

    states = {"x": 0.0, "v": 0.0}
    system = sym.compile(sym.Equations(rates, states, {"F": 0.4, "eta": 1.4}, frequency="eta"))
    torus = per.settled_torus(system)
    family = torus.traced(system, "eta", (1.3, 1.6), released="F")
    assert family.rotation_numbers == pytest.approx(torus.rotation_number, rel=1e-14)
    low, *high = sorted(family.labelled("LP"), key=lambda point: point.parameter)
    assert low.torus.parameters["F"] == pytest.approx(0.0, abs=1e-5)
    assert [abs(point.torus.parameters["F"]) for point in high] == pytest.approx([1.27282094] * 2, rel=1e-7)

    free = scipy.integrate.solve_ivp(
        lambda t, y: [y[1], -0.3 * (y[0] ** 2 - 1) * y[1] - y[0]],
        (0, 1000),
        [2.0, 0.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
        events=lambda t, y: y[0],
    )
    crossings = free.t_events[0][100:]
    omega = math.pi * (len(crossings) - 1) / (crossings[-1] - crossings[0])
    assert low.parameter * (1 - torus.rotation_number) == pytest.approx(omega, rel=1e-8)


def test_refusals_of_what_is_released() -> None:
    """Assert a sentence for the same parameter twice."""
    torus = per.settled_torus(forced())
    with pytest.raises(ValueError, match="released is 'eta', over which the tori are traced"):
        torus.traced(forced(), "eta", (1.3, 1.5), released="eta")
