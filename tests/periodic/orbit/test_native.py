"""Outputs along an orbit in C against NumPy."""

from __future__ import annotations

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from symbolic.kernels import native

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


@pytest.mark.parametrize("method", [per.Collocation(), per.HarmonicBalance()])
def test_outputs_in_c_are_those_in_numpy(method: per.Discretisation) -> None:
    """Assert outputs between mesh points, of piecewise polynomials and of Fourier series, to rounding."""
    x = sym.coordinate("x")
    model = sym.Mass(x, 1.0) + sym.Spring(x, 1.0) + sym.Damper(x, 0.1) + sym.CubicSpring(x, 1.0)
    model = model + sym.HarmonicForce(x, 0.5, 1.0)
    compiled, plain = (sym.compile(model, kernels) for kernels in ("c", "numpy"))
    orbit = per.trace(compiled, "Omega", (0.9, 1.1), start=1.0, at=1.0, method=method).points[0].orbit
    tau = np.linspace(0.0, 2 * np.pi, 97)
    found, expected = (per.outputs(system, orbit, tau) for system in (compiled, plain))
    assert np.abs(found - expected).max() < 1e-13 * np.abs(expected).max()
    assert found[:, 0] == pytest.approx(orbit.state(tau)[:, 0], abs=1e-13)
