"""A rotor in a stator: its orbit is a circle, all of which grazes at once. Known in closed form.

x'' + .1 x' + x + k (x - .1 y) = .2 W^2 cos, y'' + .1 y' + y + k (y + .1 x) = .2 W^2 sin,

with k = 20 max(1 - 1/r, 0):
|(1 - W^2 + k) + i (.1 W + .1 k)| r = .2 W^2, and in coordinates that rotate with the force it rests.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import periodic as per
import symbolic as sym

STIFF, DRAG, FORCE = 20.0, 0.1, 0.2


def rotor(s: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The equations."""
    k = STIFF * sym.functions.fmax(1 - 1 / sym.functions.sqrt(s.x**2 + s.y**2), 0)
    pull = FORCE * p.W**2
    return {
        "x": s.u,
        "y": s.v,
        "u": pull * wave.cos - 0.1 * s.u - s.x - k * (s.x - DRAG * s.y),
        "v": pull * wave.sin - 0.1 * s.v - s.y - k * (s.y + DRAG * s.x),
    }


def defect(r: float, W: float) -> float:
    """What the radius r misses the force by."""
    k = STIFF * max(1 - 1 / r, 0.0)
    return float(abs(1 - W**2 + k + 1j * 0.1 * (W + k)) * r - FORCE * W**2)


def fastest(r: float) -> float:
    """The largest W at which the rotor goes round with a radius in contact; 0 where there is none."""
    k = STIFF * (1 - 1 / r)
    square = [1 - (FORCE / r) ** 2, 0.0, 0.01 - 2 * (1 + k), 0.02 * k, (1 + k) ** 2 + 0.01 * k**2]
    found = np.roots(square)
    return float(found[abs(found.imag) < 1e-9].real.max(initial=0.0))


def exponents(r: float, W: float) -> np.ndarray:
    """Eigenvalues of small motion about the rest in rotating coordinates z = r e^(i phi) e^(i tau)."""

    def rates(y: np.ndarray) -> np.ndarray:
        z, v = y[0] + 1j * y[1], y[2] + 1j * y[3]
        k = STIFF * max(1 - 1 / abs(z), 0.0)
        a = FORCE * W**2 - 0.1 * (v + 1j * W * z) - z - k * (1 + 1j * DRAG) * z - 2j * W * v + W**2 * z
        return np.array([v.real, v.imag, a.real, a.imag])

    k = STIFF * max(1 - 1 / r, 0.0)
    z = FORCE * W**2 / (1 - W**2 + k + 1j * 0.1 * (W + k))
    rest, h = np.array([z.real, z.imag, 0.0, 0.0]), 1e-6
    columns = [(rates(rest + e) - rates(rest - e)) / (2 * h) for e in h * np.eye(4)]
    return np.asarray(np.linalg.eigvals(np.transpose(columns)))


@pytest.mark.parametrize("bounds", [(0.8, 4.0), (4.0, 0.8)])
def test_branch_passes_both_corners(bounds: tuple[float, float]) -> None:
    """Assert grazing, fold and multipliers in closed form both ways, and what sits on grazing points."""
    system = sym.compile(sym.Equations(rotor, dict.fromkeys("xyuv", 0.1), {"W": 1.0}, frequency="W"))
    branch = per.trace(system, "W", bounds, at=(0.9, 2.0), tol=1e-6)
    assert branch[-1].parameter == bounds[1] and branch.unaccounted == ()
    grazings = sorted(p.parameter for p in branch.labelled("GR"))
    expected = [brentq(lambda W: defect(1.0, W), *between) for between in ((0.8, 1.0), (1.0, 1.3))]
    assert grazings == pytest.approx(expected, rel=1e-7)
    furthest = minimize_scalar(
        lambda r: -fastest(r), bounds=(1.05, 2.5), method="bounded", options={"xatol": 1e-9}
    )
    fold = max(branch.labelled("LP"), key=lambda p: p.parameter)
    assert fold.parameter == pytest.approx(-furthest.fun, rel=1e-7)
    assert sorted(p.parameter for p in branch.labelled("NS")) == grazings
    inside = [p for p in branch.labelled("UZ")]
    assert len(inside) == 4
    for point in inside:
        r, W = float(np.hypot(*point.orbit.nodes[0, :2])), point.parameter
        assert abs(defect(r, W)) < 1e-6
        found = np.sort(np.abs(point.multipliers))
        assert found == pytest.approx(np.sort(np.exp(2 * np.pi * exponents(r, W).real / W)), rel=1e-4)
