"""An impulse on one coordinate, by energy and momentum."""

from __future__ import annotations

import numpy as np
import pytest

import symbolic as sym


@pytest.mark.parametrize("restitution", [1.0, 0.6])
def test_a_wall_on_a_structure(restitution: float) -> None:
    """Assert that the impulse acts at the tip alone, and what energy it takes, to rounding.

    M (v+ - v-) is 0 but at the tip, and the energy lost (1 - e^2) v_tip^2 / (2 (M^-1)_tt).
    """
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=3)
    structure = sym.Structure(beam, damping=0.02)
    tip = structure["tip"]
    model = structure + sym.RigidStop(tip, 0.01, restitution) + sym.HarmonicForce(tip, 0.02, 3.0)
    system = sym.compile(model, condense=False)
    names, at = [state.name for state in system.states], beam.at["tip"]
    nodes = [f"{('w', 'slope')[k % 2]}{1 + k // 2}" if k != at else "tip" for k in range(beam.size)]
    rates = [names.index(f"{name}'") for name in nodes]
    before = np.random.default_rng(1).normal(size=(1, len(names)))
    (switch,) = system.resets
    after = system.reset(switch, before, np.zeros(1), system.nominal)
    mass = np.asarray(beam.M.toarray() if hasattr(beam.M, "toarray") else beam.M)
    old, new = before[0, rates], after[0, rates]
    impulse = mass @ (new - old)
    assert new[at] == pytest.approx(-restitution * old[at], rel=1e-14)
    assert np.abs(np.delete(impulse, at)).max() < 1e-13 * abs(impulse[at])
    lost = (old @ mass @ old - new @ mass @ new) / 2
    expected = (1 - restitution**2) * old[at] ** 2 / (2 * np.linalg.inv(mass)[at, at])
    assert lost == pytest.approx(expected, abs=1e-13)
    positions = [names.index(name) for name in nodes]
    np.testing.assert_array_equal(before[0, positions], after[0, positions])
