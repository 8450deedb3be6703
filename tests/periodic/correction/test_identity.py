"""How far two orbits are apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.identity import distance


def apart(scale: float) -> float:
    """Distance over the peak to peak of two motions with impacts, their coordinate measured in such units."""
    q = sym.coordinate("q", scale=scale)
    parts = [sym.Mass(q, 1.0), sym.Spring(q, 1.0), sym.Damper(q, 0.1), sym.RigidStop(q, 1.0, 0.8)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(q, 0.5, 1.1)]))
    one = per.ArclengthControl(max_points=1)
    a, b = (per.trace(system, "Omega", (w, 1.2), control=one)[0].orbit for w in (1.1, 1.101))
    shift = float(np.abs(a.phases - b.phases).max())
    assert 1e-4 < shift < 1e-2
    same = replace(b, parameter=a.parameter)
    return distance(per.Problem(system, "Omega", (1.1, 1.2)), a, same) / a.span()


@pytest.mark.parametrize("scale", [1e3, 1e-3])
def test_impacts_that_are_later_count_as_the_motion_does(scale: float) -> None:
    """Assert that what an impact's phase adds does not depend on the unit of the states."""
    assert apart(scale) == pytest.approx(apart(1.0), rel=1e-2)
