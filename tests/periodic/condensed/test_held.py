"""Structures that nothing holds but the parts at their places, and modes that are just critically damped."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
import symbolic as sym


def floating(condense: bool, **given: object) -> sym.CompiledSystem:
    """A beam that is free at both ends, on a spring with a cubic part at each."""
    bare = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2, left="free")
    beam = sym.Structure(bare, **{"damping": 0.02, **given})  # type: ignore[arg-type]
    left, tip = beam["w0"], beam["tip"]
    supports = [
        part
        for end in (left, tip)
        for part in (sym.Spring(end, 4.0), sym.CubicSpring(end, 30.0), sym.Damper(end, 0.1))
    ]
    return sym.compile(sym.combine([beam, *supports, sym.HarmonicForce(tip, 0.2, 2.5)]), condense=condense)


@pytest.mark.parametrize(
    "given",
    [{}, {"damping": 0.0, "rayleigh": (0.1, 0.01)}, pytest.param({"damping": 0.0}, marks=pytest.mark.long)],
)
def test_floating_beam_is_that_of_all_states(given: dict[str, object]) -> None:
    """Assert motion, forces and multipliers of a beam with two rigid-body modes to 8 digits."""
    found = []
    for condense in (True, False):
        system = floating(condense, **given)
        of = per.trace(system, "Omega", (2.5, 2.6), tol=1e-9)
        found.append(of.points[-1])
    ours, full = found
    for name in ("w0", "tip"):
        assert ours.maximum[name] == pytest.approx(full.maximum[name], rel=1e-8)
    assert np.abs(ours.multipliers).max() == pytest.approx(np.abs(full.multipliers).max(), rel=1e-7)


def test_forces_are_those_of_the_parts() -> None:
    """Assert that what is stated as force on a place is that of spring and damper, to 8 digits."""
    point = per.trace(floating(True), "Omega", (2.5, 2.6), tol=1e-9).points[-1]
    full = per.trace(floating(False), "Omega", (2.5, 2.6), tol=1e-9).points[-1]
    phases = np.linspace(0, 2, 201)
    motion, rate = full.orbit["w0"](phases), full.orbit["w0'"](phases)
    force = -4.0 * motion - 30.0 * motion**3 - 0.1 * rate
    assert point.maximum["force on w0"] >= force.max() - 1e-8
    assert point.maximum["force on w0"] == pytest.approx(force.max(), rel=1e-3)


def test_critically_damped_mode() -> None:
    """Assert the motion of a structure with two equal exponents to 8 digits."""
    found = []
    for condense in (True, False):
        structure = sym.Structure(
            np.eye(2), None, [[2.0, -1.0], [-1.0, 2.0]], at={"a": 0, "b": 1}, damping=(0.05, 1.0)
        )
        a, b = structure["a"], structure["b"]
        system = sym.compile(
            structure + sym.CubicSpring(b, 0.5) + sym.HarmonicForce(a, 0.3, 1.0), condense=condense
        )
        found.append(per.trace(system, "Omega", (0.8, 0.9), tol=1e-9).points[-1].maximum)
    for name in ("a", "b"):
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-8)


def test_what_stays_loose_is_refused() -> None:
    """Assert one sentence where the places leave a rigid-body mode."""
    bare = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2, left="free")
    beam = sym.Structure(bare)
    tip = beam["tip"]
    with pytest.raises(ValueError, match="rigid-body modes that forces at its places do not hold"):
        sym.compile(beam + sym.CubicSpring(tip, 1.0) + sym.HarmonicForce(tip, 1.0, 2.0))
