"""A gear pair with backlash, varying stiffness and transmission error, against shooting with DOP853."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from reference.returning import Rates, Shot, shot
from support.kept import kept

import periodic as per
import symbolic as sym

FOLDS = (0.598153117, 0.835837679)
"""Known frequencies of folds (event-exact shooting of another author)."""

PLACES = (1.1, 0.9, 0.7, 0.62, 0.5)


@kept
def branch() -> per.Branch:
    """The branch from 1.2 down to 0.4."""
    return per.trace(sym.scene("gear-pair"), "Omega", (0.4, 1.2), start=1.2, at=PLACES)


def rates(w: float) -> Rates:
    """w^2 x'' = F_m + sum F_j (j w)^2 cos j tau - 2 zeta w x' - K B(x), as y' of (x, x')."""

    def found(tau: float, y: np.ndarray) -> list[float]:
        x, v = y
        waves = [math.cos(j * tau) for j in (1, 2, 3)]
        stiffness = 1 - np.dot((0.2, 0.1, 0.05), waves)
        play = max(x - 1, 0.0) + min(x + 1, 0.0)
        force = 0.1 + w**2 * np.dot((0.01, 0.016, 0.018), waves) - 0.1 * w * v - stiffness * play
        return [v, force / w**2]

    return found


def confirmed(point: per.Point) -> Shot:
    """The orbit of a point by shooting, begun a little beside it; tight, for its differences cross kinks."""
    beside = point.orbit.state(np.zeros(1))[0] * (1 + 1e-6)
    return shot(rates(point.parameter), beside, (1.0, 1.0), rtol=1e-13)


def test_folds() -> None:
    """Assert the known folds to nine digits, and that the branch gets to its end."""
    assert branch().stop.reason is per.Reason.BOUND
    found = [p.parameter for p in branch().labelled(per.Label.FOLD)]
    assert found[:2] == pytest.approx(FOLDS, abs=2e-9)


@pytest.mark.parametrize("place", PLACES)
def test_orbits(place: float) -> None:
    """Assert orbits and multipliers of every sheet at five frequencies by shooting, to 1e-7 and 1e-5."""
    points = [p for p in branch().labelled(per.Label.USER) if p.parameter == place]
    assert points
    for point in points:
        own = confirmed(point)
        assert point.orbit.state(np.zeros(1))[0] == pytest.approx(own.start, abs=1e-7)
        assert point.peak_to_peak("x") == pytest.approx(own.peak_to_peak(0), rel=1e-6)
        assert abs(point.multipliers[0]) == pytest.approx(abs(own.multipliers[0]), rel=1e-5)


def test_liouville() -> None:
    """Assert that the multipliers of every orbit have the product exp(-4 pi zeta/w), to 1e-7."""
    for point in branch():
        exact = math.exp(-4 * math.pi * 0.05 / point.parameter)
        assert np.prod(point.multipliers).real == pytest.approx(exact, rel=1e-7)


def test_rest_is_where_the_mesh_carries_the_load() -> None:
    """Assert where the search for a rest begins: in mesh, on the side of the load."""
    system = sym.scene("gear-pair")
    assert system.rest(system.nominal)[0] == pytest.approx([1.1, 0.0], abs=1e-15)


def test_two_shafts_are_one_coordinate() -> None:
    """Assert that wheels on shafts of one frequency k/m move against each other as one mass does.

    With u = u1 - u2 - e: m (u'' + e'') + c u' + k(tau) B(u) + m s^2 (u + e) = F, m = m1 m2/(m1 + m2); the
    error as that of the mesh, or as a part with the springs' share as a force. To 1e-9 in the deflection.
    """
    omega, m1, m2, stiff = sym.parameter("Omega", 0.9, "rad/s"), 2.0, 3.0, 0.02
    m, error = m1 * m2 / (m1 + m2), (0.05, 0.02)
    u1, u2, u = (sym.coordinate(name) for name in ("u1", "u2", "u"))
    mesh = {"variation": (0.2, 0.1), "damping": 0.1}
    wheels = [
        part for q, own in ((u1, m1), (u2, m2)) for part in (sym.Mass(q, own), sym.Spring(q, stiff * own))
    ]
    teeth = sym.GearMesh(u1, 1.0, 1.0, to=u2, error=error, frequency=omega, **mesh)
    two = sym.compile(sym.combine([*wheels, sym.ConstantForce(u1, 0.3 * m1), teeth]))
    sprung = [sym.HarmonicForce(u, -m * stiff * e, omega, order=k) for k, e in enumerate(error, 1)]
    alone = [sym.Mass(u, m), sym.Spring(u, stiff * m), sym.ConstantForce(u, 0.3 * m), *sprung]
    alone += [sym.GearMesh(u, 1.0, 1.0, **mesh), sym.TransmissionError(u, m, error, omega)]
    one = sym.compile(sym.combine(alone))
    found = [per.trace(s, "Omega", (0.85, 0.9), start=0.9, tol=1e-9)[-1].orbit for s in (two, one)]
    tau = np.linspace(0, 2 * np.pi, 50)
    e = sum(a * np.cos(k * tau) for k, a in enumerate(error, 1))
    deflections = found[0].state(tau)[:, 0] - found[0].state(tau)[:, 2] - e, found[1].state(tau)[:, 0]
    assert deflections[0] == pytest.approx(deflections[1], abs=1e-9)
    assert [s.name for s in two.switches] == ["u1 - u2 = backlash", "u1 - u2 = -backlash"]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"damping": -1.0}, "damping of the mesh is -1"),
        ({"error": 0.1}, "error is 0.1; it must be a sequence"),
    ],
)
def test_bad_mesh(given: dict[str, Any], said: str) -> None:
    """Assert one sentence for what damps or disturbs no mesh, and for two wheels that are one."""
    u = sym.coordinate("u")
    with pytest.raises((ValueError, TypeError), match=f"^{said}"):
        sym.GearMesh(u, 1.0, 1.0, **given)
    with pytest.raises(ValueError, match="^to is"):
        sym.compile(sym.Mass(u, 1.0) + sym.GearMesh(u, 1.0, 1.0, to=u))
