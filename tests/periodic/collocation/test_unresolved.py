"""Vibrations too fast for the mesh: the multipliers that they lose are told, the others kept."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.collocation.collocation import CollocationRefinement
from periodic.collocation.fastmotions import substeps
from periodic.collocation.fastmotions.unresolved import FAST, growth, lost

DAMPING = 1e-5
"""Ratio of both oscillators."""


def two_modes(ratio: float) -> sym.CompiledSystem:
    """Return a slow forced oscillator and a free one, `ratio` times as fast, that do not touch."""
    x, y = sym.coordinate("x"), sym.coordinate("y")
    parts: list[sym.Part] = []
    for coordinate, name, omega in ((x, "slow", 1.0), (y, "fast", ratio)):
        parts.append(sym.Mass(coordinate, 1.0))
        parts.append(sym.Spring(coordinate, sym.parameter(f"{name} stiffness", omega**2)))
        parts.append(sym.Damper(coordinate, sym.parameter(f"{name} damping", 2 * DAMPING * omega)))
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 1.0)]))


def moduli(ratio: float, omega: float) -> list[float]:
    """Return the exact sizes of the multipliers, largest first."""
    both = [np.exp(-2 * np.pi * DAMPING * natural / omega) for natural in (1.0, ratio)]
    return [both[0], both[0], both[1], both[1]]


def orbit_of(system: sym.CompiledSystem, method: per.Collocation | per.Shooting) -> per.Point:
    """Return the first orbit at Omega = 0.7."""
    one = per.ArclengthControl(max_points=1)
    return per.trace(system, "Omega", (0.7, 0.8), control=one, method=method)[0]


@pytest.mark.parametrize("family", list(per.Family))
def test_growth(family: per.Family) -> None:
    """Assert the stability function: of the scheme's order, A-stable, 0 at infinity for Radau only."""
    scheme = per.Scheme(family, 4)
    small = np.array([0.1j, -0.1, 0.05 + 0.05j])
    assert growth(scheme, small) == pytest.approx(np.exp(small), abs=1e-12)
    order = 2 * scheme.ncol - (family is per.Family.RADAU)
    errors = [abs(growth(scheme, np.array([z]))[0] - np.exp(z)) for z in (1j, 0.5j)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order + 1, abs=0.1)
    far = np.abs(growth(scheme, np.array([1e3j])))
    assert far < 0.01 if family is per.Family.RADAU else far == pytest.approx(1.0)


@pytest.mark.parametrize("ratio", [3.0, 20.5, 60.25])
def test_fast_vibrations_are_resolved(ratio: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that multipliers of a vibration up to 86 times the excitation are right, by a finer mesh."""
    monkeypatch.setattr(substeps, "exponentials", lambda *_: None)
    point = orbit_of(two_modes(ratio), per.Collocation())
    assert np.abs(point.multipliers) == pytest.approx(moduli(ratio, 0.7), abs=3e-6)
    assert point.error.multiplier <= 3e-6
    assert lost(two_modes(ratio), point.orbit) < 1e-6


@pytest.mark.parametrize("ratio", [20.5, 60.25, 2000.0, 3e4])
def test_exponentials_need_no_mesh_for_them(ratio: float) -> None:
    """Assert multipliers of a vibration up to 43000 times the excitation to 1e-9, on 24 intervals."""
    point = orbit_of(two_modes(ratio), per.Collocation())
    assert point.orbit.mesh.ntst == 24
    assert np.abs(point.multipliers) == pytest.approx(moduli(ratio, 0.7), abs=1e-9)
    assert point.error.multiplier < 1e-9


@pytest.mark.parametrize("ratio", [2000.0, 3e4])
def test_what_is_lost_is_told(ratio: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the error of multipliers that no allowed mesh resolves is their true size."""
    monkeypatch.setattr(substeps, "exponentials", lambda *_: None)
    point = orbit_of(two_modes(ratio), per.Collocation())
    true = moduli(ratio, 0.7)
    away = abs(np.abs(point.multipliers)[-1] - true[-1])
    assert away > 1e-9
    assert point.error.multiplier == pytest.approx(away, rel=1e-3)
    assert (np.abs(np.abs(point.multipliers) - true) <= point.floor).all()
    assert point.error.orbit < 1e-7


def test_strong_damping_loses_nothing() -> None:
    """Assert that modes that die within an interval are no loss: their multiplier is 0 as it should be."""
    x = sym.coordinate("x")
    stiff = sym.compile(
        sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 1e6) + sym.HarmonicForce(x, 1.0)
    )
    point = orbit_of(stiff, per.Collocation())
    assert lost(stiff, point.orbit) == 0.0 and point.error.multiplier < 1e-9
    assert FAST > 1


def test_shooting_needs_no_mesh_for_it() -> None:
    """Assert that shooting, whose integrator follows every vibration, has the multipliers at once."""
    point = orbit_of(two_modes(60.25), per.Shooting(segments=4))
    assert np.abs(point.multipliers) == pytest.approx(moduli(60.25, 0.7), abs=1e-7)
    assert point.orbit.mesh.ntst < 100


def test_rates_beyond_all_numbers() -> None:
    """Assert that a vibration so fast and damped that its rates overflow loses nothing, and warns of none."""
    system = two_modes(3.0)
    orbit = orbit_of(system, per.Collocation()).orbit
    beyond = {"fast stiffness": 1e240, "fast damping": 2e120 * DAMPING}
    names = [p.name for p in system.parameters]
    assert set(beyond) < set(names)
    values = [beyond.get(name, value) for name, value in zip(names, orbit.parameter, strict=True)]
    assert lost(system, replace(orbit, parameter=np.array(values))) == 0.0


@pytest.mark.parametrize(
    ("nodes", "reversals", "most"),
    [(0, 0, 100), (10, 10, 100), (11, 4, 110), (46, 45, 460), (4, 11, 110), (46, 300, 3000)],
)
def test_intervals_in_proportion_to_what_happens(nodes: int, reversals: int, most: int) -> None:
    """Assert the largest number of intervals: that of the settings for up to ten event nodes and reversals
    of the state that has most, in proportion to either beyond."""
    waves = np.column_stack([np.arange(400.0), np.cos(np.pi * np.minimum(np.arange(400), reversals + 1))])
    for ntst, full in ((most - 1, False), (most, True)):
        orbit = SimpleNamespace(phases=np.zeros(nodes), mesh=SimpleNamespace(ntst=ntst), nodes=waves)
        method = per.Collocation(ntst_max=100)
        given: Any = SimpleNamespace(orbit=orbit, method=method, _in_wrong_mode=False)
        given._largest = CollocationRefinement._largest.fget(given)  # type: ignore[attr-defined]
        assert given._largest == most
        assert CollocationRefinement.exhausted.fget(given) == full  # type: ignore[attr-defined]
