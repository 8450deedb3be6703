"""A gear pair with backlash, written as equations with fmax and fmin: as right as with declared switches.

x'' + 2 zeta x' + K(tau) B(x) = F_m + sum_j F_j (j w)^2 cos j tau, tau = w t, K = 1 - sum_j k_j cos j tau,
B = max(x - 1, 0) + min(x + 1, 0) (Kahraman & Singh 1991).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from reference.hybrid import Hybrid, Signs, Surface, periodic_orbit
from reference.shooting import in_order
from support.kept import kept

import periodic as per
import symbolic as sym

F = sym.functions
ZETA, MEAN, FORCE, MESH = 0.05, 0.1, (0.01, 0.004, 0.002), (0.2, 0.1, 0.05)
FOLDS = (0.835837679, 0.598153117)
"""From shooting with DOP853, event by event."""


def equations(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The gear pair."""
    cosines = [wave.cos, 2 * wave.cos**2 - 1, 4 * wave.cos**3 - 3 * wave.cos]
    stiffness = 1 - sum(k * c for k, c in zip(MESH, cosines, strict=True))
    excited = sum(f * (j + 1) ** 2 * c for j, (f, c) in enumerate(zip(FORCE, cosines, strict=True)))
    backlash = F.fmax(x.x - 1, 0) + F.fmin(x.x + 1, 0)
    force = MEAN + p.w**2 * excited - 2 * ZETA * x.v - stiffness * backlash
    return {"x": x.v, "v": force}


@cache
def gear() -> sym.CompiledSystem:
    """The compiled gear pair; it rests near where its mean load presses it."""
    return sym.compile(sym.Equations(equations, {"x": 1.1, "v": 0.0}, {"w": 1.0}, frequency="w"))


@kept
def branch() -> per.Branch:
    """Responses over the frequency, through two folds."""
    return per.trace(gear(), "w", (0.5, 1.0), at=0.7)


def exact(w: float) -> Hybrid:
    """The same in tau, with y = (x, dx/dt)."""

    def mesh(tau: float) -> float:
        return 1 - sum(k * np.cos((j + 1) * tau) for j, k in enumerate(MESH))

    def rates(tau: float, y: Any, signs: Signs) -> list[float]:
        backlash = (y[0] - 1) * (signs[0] > 0) + (y[0] + 1) * (signs[1] < 0)
        excited = sum(f * (j + 1) ** 2 * np.cos((j + 1) * tau) for j, f in enumerate(FORCE))
        force = MEAN + w**2 * excited - 2 * ZETA * y[1] - mesh(tau) * backlash
        return [y[1] / w, force / w]

    def jacobian(tau: float, y: Any, signs: Signs) -> list[list[float]]:
        touching = float(signs[0] > 0) + float(signs[1] < 0)
        return [[0, 1 / w], [-mesh(tau) * touching / w, -2 * ZETA / w]]

    def plane(place: float) -> Surface:
        return Surface(lambda t, y: y[0] - place, lambda t, y: (0.0, np.array([1.0, 0.0])))

    return Hybrid(rates, jacobian, (plane(1.0), plane(-1.0)))


def test_folds_of_equations_with_backlash() -> None:
    """Assert both folds to 1e-9 at the usual tolerance of 1e-6, and that no point misses it."""
    folds = [p.parameter for p in branch().labelled(per.Label.FOLD)]
    np.testing.assert_allclose(folds, FOLDS, atol=2e-9)
    assert [s.name for s in gear().switches] == ["x - 1", "x + 1"]
    assert max(p.error.multiplier for p in branch()) < 1e-6


def test_multipliers_of_equations_with_backlash() -> None:
    """Assert orbits and multipliers at w = 0.7 on all three sheets against event-exact shooting."""
    sheets = branch().labelled(per.Label.USER)
    assert len(sheets) == 3
    for point in sheets:
        found = periodic_orbit(exact(point.parameter), point.orbit.state(np.zeros(1))[0])
        phase = np.linspace(0.1, 6.2, 20)
        np.testing.assert_allclose(point.orbit.state(phase), found.state(phase), atol=2e-7)
        np.testing.assert_allclose(in_order(point.multipliers), found.multipliers, atol=1e-6)
