"""Outputs along an orbit and their extremes in C against NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from support import traces

import periodic as per
import symbolic as sym
from periodic.orbit import extrema
from symbolic.kernels import native
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)


@pytest.mark.parametrize("method", [per.Collocation(), per.HarmonicBalance()])
def test_outputs_in_c_are_those_in_numpy(method: per.extend.Discretisation) -> None:
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


def test_extremes_in_c_are_those_in_numpy() -> None:
    """Assert extremes and their phases with contact lost and kept, unknowns and event nodes included."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ORBITRACE_KERNELS", "c")
        system = build(load("vitrea79-810N"))
    points = traces.disc().points
    assert max(len(p.orbit.phases) for p in points) > 0 and len(system.algebraics) > 0
    for point in points:
        compiled = extrema.native.extremes(system, point.orbit)
        expected = extrema._searched(system, point.orbit)
        assert compiled is not None
        for found, value in zip(compiled[:2], (expected.minimum, expected.maximum), strict=True):
            assert found == pytest.approx(value, rel=1e-12)
        for found, value in zip(compiled[2:], (expected.minimum_phase, expected.maximum_phase), strict=True):
            assert found == pytest.approx(value, abs=1e-6)
