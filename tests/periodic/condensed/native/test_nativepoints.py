"""The rows at the points in C: those of NumPy, to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn.jointcases import drawn_joints

from periodic.collocation.residual import evaluated
from periodic.condensed.linearised import local_rows
from periodic.condensed.native.nativepoints import eliminated
from periodic.condensed.settling import settled
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Scheme
from periodic.system import linear_of
from symbolic.kernels import native

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


def test_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert forces, own rows and unknowns in all columns, of an orbit with event nodes and friction."""
    monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    system = drawn_joints("joints", 122).system
    part = linear_of(system)
    assert part is not None
    orbit = next(settled(system, at_rest(system, uniform(Scheme(), 8), system.nominal)))
    free = (0, len(system.nominal) - 1)
    assert eliminated(system, part, orbit, evaluated(system, orbit, free)) is not None
    fast = local_rows(system, part, orbit, free, tied=True).untied(orbit)
    plain = local_rows(system, part, orbit, free)
    assert np.array_equal(fast.rows, plain.rows) and fast.residual == plain.residual
    for found, expected in (
        (fast.forces, plain.forces),
        (fast.own, plain.own),
        (fast.unknowns, plain.unknowns),
    ):
        assert found.shape == expected.shape and expected.any()
        assert np.abs(found - expected).max() < 1e-13 * np.abs(expected).max()
