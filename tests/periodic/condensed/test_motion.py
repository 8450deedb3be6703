"""Motion anywhere in a condensed structure against full collocation of all its states."""

from __future__ import annotations

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic

import periodic as per

PHASES = np.linspace(0, 2 * np.pi, 11)


@pytest.mark.parametrize("method", [per.Collocation(), per.HarmonicBalance()])
def test_motion_is_that_of_all_states(method: per.Discretisation) -> None:
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
