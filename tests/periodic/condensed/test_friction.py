"""Friction that sticks at places of a structure: where a motion settles, and what is refused."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.condensed import modalsaltation
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.settling import settled
from periodic.condensed.variations import CondensedVariations
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Scheme

BEAM = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)


def compiled(structure: sym.Structure, *places: str) -> sym.CompiledSystem:
    """A structure with friction at some places, driven at its tip."""
    frictions = [sym.CoulombFriction(structure[place], 0.002) for place in places]
    force = sym.HarmonicForce(structure["tip"], 0.02, 2.2)
    return sym.compile(sym.combine([structure, *frictions, force]))


@cache
def stuck() -> tuple[sym.CompiledSystem, per.Point]:
    """The system with friction at its tip alone, and an orbit of it."""
    system = compiled(sym.Structure(BEAM, damping=0.02), "tip")
    return system, per.trace(system, "Omega", (2.2, 2.21), control=per.ArclengthControl(max_points=1))[0]


def test_settled() -> None:
    """Assert the stops of motions in time: to 0.002 rad as in the orbit, and to 0.0002 settled further."""
    system, found = stuck()
    motions = settled(system, at_rest(system, uniform(Scheme(), 8), system.nominal))
    for most, orbit in zip((0.002, 0.0002), motions, strict=False):
        assert [event.switch for event in orbit.mesh.events] == [e.switch for e in found.orbit.mesh.events]
        assert orbit.phases == pytest.approx(found.orbit.phases, abs=most)
    assert found.error.orbit < 1e-7


@pytest.mark.long
@pytest.mark.parametrize("joint", ["slider", "absorber"])
def test_beside_own_states(joint: str) -> None:
    """Assert the two leading multipliers (1e-7) and the stops (1e-6) as with all states of the structure."""
    structure, found = sym.Structure(BEAM, damping=0.02, at={"middle": 0}), []
    tip, y = structure["tip"], sym.coordinate("y")
    absorber = [sym.CoulombFriction(tip, 0.006, to=y), sym.Mass(y, 0.2), sym.Damper(y, 0.02, to=tip)]
    parts = {
        "slider": [sym.CoulombFriction(tip, 0.001), sym.Jenkins(structure["middle"], 3.0, 0.002)],
        "absorber": [*absorber, sym.Spring(y, 2.0, to=tip)],
    }[joint]
    for condense in (True, False):
        model = sym.combine([structure, *parts, sym.HarmonicForce(tip, 0.02, 2.3)])
        point = per.trace(sym.compile(model, condense=condense), "Omega", (2.3, 2.301))[0]
        found.append(point)
    lengths = [point.orbit.mesh.segment_lengths(point.orbit.phases) for point in found]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-6) and len(lengths[0]) > 2
    moduli = [np.sort(np.abs(point.multipliers))[-2:] for point in found]
    assert moduli[0] == pytest.approx(moduli[1], abs=1e-7)


def test_forces_at_an_event_are_solved_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that saltation is not made of forces that a last Newton step still moved."""
    system, point = stuck()
    orbit = point.orbit
    assert len(SplitLinearisation.about(system, orbit, ()).saltations) == 2
    monkeypatch.setattr(modalsaltation, "MOST_ITERATIONS", 1)
    with pytest.raises(np.linalg.LinAlgError, match="forces at an event"):
        _ = SplitLinearisation.about(system, orbit, ()).saltations


def test_refused() -> None:
    """Assert what is said of gradients of multipliers, and of modes left out."""
    system, point = stuck()
    orbit = point.orbit
    with pytest.raises(ValueError, match="derivatives of multipliers need a structure"):
        CondensedVariations.about(system, orbit, ())
    some = compiled(sym.Structure(BEAM, damping=0.02, modes=2), "tip")
    with pytest.raises(ValueError, match="known only of a structure with all its modes"):
        per.trace(some, "Omega", (2.2, 2.3))
