"""Motion anywhere in a condensed structure against full collocation of all its states."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse
from support.cantilevers import cantilever, cubic

import periodic as per
import symbolic as sym

PHASES = np.linspace(0, 2 * np.pi, 11)


@pytest.mark.parametrize("method", [per.Collocation(), per.HarmonicBalance()])
def test_motion_is_that_of_all_states(method: per.extend.Discretisation) -> None:
    """Assert deflection and slope, and their velocities, to 7 digits of their peaks."""
    full, system = cantilever(2, cubic, condense=False), cantilever(2, cubic)
    given = {"at": 3.1, "tol": 1e-8}
    ends = [
        per.trace(full, "Omega", (3.0, 3.2), **given),
        per.trace(system, "Omega", (3.0, 3.2), method=method, **given),
    ]
    whole, ours = (next(p.orbit for p in of.points if p.parameter == 3.1) for of in ends)
    places, rates = per.motion(system, ours, [0, 1, 2, 3], PHASES)
    for column, name in enumerate(["w1", "slope1", "tip", "slope2"]):
        for found, signal in ((places, whole[name]), (rates, whole[f"{name}'"])):
            expected = signal(PHASES / 3.1)
            assert np.abs(found[:, column] - expected).max() < 1e-7 * np.abs(expected).max()


def test_tip_is_the_place() -> None:
    """Assert that the place's own motion is the orbit's, and one sentence for what is none."""
    system = cantilever(2, cubic)
    orbit = per.trace(system, "Omega", (3.0, 3.2), tol=1e-7).points[0].orbit
    place, rate = per.motion(system, orbit, [2], orbit.mesh.nodes(orbit.phases))
    assert np.allclose(place[:, 0], orbit.nodes[:, 0], rtol=0, atol=1e-12)
    assert np.allclose(rate[:, 0] / orbit.omega, orbit.nodes[:, 1], rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match="index of place 'freedom 0' is 9; it must be a whole number from 0"):
        per.motion(system, orbit, [9], PHASES)
    with pytest.raises(ValueError, match="structure is 'wing'; it must be one of structure"):
        per.motion(system, orbit, [0], PHASES, "wing")


def test_recovery_is_the_matrix_times_the_motion() -> None:
    """Assert a bending moment at the clamp to rounding, and one sentence for each bad matrix."""
    system = cantilever(2, cubic)
    ours = per.trace(system, "Omega", (3.0, 3.2), tol=1e-7).points[0].orbit
    place, _ = per.motion(system, ours, None, PHASES)
    clamp = np.array([[24.0, -4.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    found = per.recovery(system, ours, scipy.sparse.csc_array(clamp), PHASES)
    assert np.abs(found - place @ clamp.T).max() < 1e-13 * np.abs(found).max()
    with pytest.raises(ValueError, match="matrix has 3 columns; it must have 4, one for each freedom"):
        per.recovery(system, ours, np.eye(3), PHASES)
    with pytest.raises(ValueError, match="matrix is .*; it must be a matrix of"):
        per.recovery(system, ours, [["stress"]], PHASES)


def test_energy_of_modes_is_that_of_the_motion() -> None:
    """Assert that energies of all modes are kinetic and elastic energy to 12 digits; the first has most."""
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=2)
    system = cantilever(2, cubic)
    orbit = per.trace(system, "Omega", (3.0, 3.2), tol=1e-7).points[0].orbit
    place, rate = per.motion(system, orbit, None, PHASES)
    whole = (np.sum(rate @ beam.M * rate, axis=1) + np.sum(place @ beam.K * place, axis=1)) / 2
    energy = sym.modal_energy(beam, place, rate)
    assert energy.shape == (11, 4)
    assert np.abs(energy.sum(axis=1) / whole - 1).max() < 1e-12
    assert energy[:, 0].mean() > 0.99 * whole.mean()
    with pytest.raises(ValueError, match=r"displacement has shape \(11, 3\); it must be \(K, 4\)"):
        sym.modal_energy(beam, place[:, :3], rate)
    with pytest.raises(ValueError, match="count is 5; it must be a whole number from 1 to 4"):
        sym.modal_energy(beam, place, rate, 5)
