"""Self-excited orbits of a condensed structure against full collocation of all its states."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
import symbolic as sym

PHASES = np.linspace(0, 2 * np.pi, 65)


def system(condense: bool) -> sym.CompiledSystem:
    """A cantilever that a damper of negative coefficient shakes at its tip, held by a cubic one."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=1)
    structure = sym.Structure(beam, damping=0.01)
    tip = structure["tip"]
    damper = sym.Damper(tip, sym.parameter("c", -0.1))
    return sym.compile(structure + damper + sym.CubicDamper(tip, 1.0), condense=condense)


def orbit(condense: bool) -> per.Point:
    """The orbit at c = -0.2, from a guess of the first mode."""
    model = system(condense)
    motion = {"tip": 0.08 * np.cos(PHASES), "tip'": -0.28 * np.sin(PHASES)}
    if not condense:
        motion |= {"slope1": 1.37 * motion["tip"], "slope1'": 1.37 * motion["tip'"]}
    guess = per.sampled(
        times=PHASES / 3.5,
        state=motion,
        algebraic={"force on tip": np.zeros(65)} if condense else None,
        parameter={"omega": 3.5, "c": -0.1},
        system=model,
    )
    determined = {"omega": per.PhaseCondition()}
    of = per.trace(model, "c", (-0.1, -0.21), guess=guess, determined=determined, at=-0.2, tol=1e-7)
    return next(p for p in of.points if p.parameter == -0.2)


def test_frequency_and_size_are_those_of_all_states() -> None:
    """Assert the frequency to 10 digits, the amplitude to 8, and one multiplier that is 1."""
    ours, full = orbit(True), orbit(False)
    assert ours.orbit.omega == pytest.approx(full.orbit.omega, rel=1e-10)
    assert ours.maximum["tip"] == pytest.approx(full.maximum["tip"], rel=1e-8)
    assert np.abs(ours.multipliers - 1).min() < 1e-7
    assert ours.stable and full.stable
