"""Impacts with restitution: COCO's problem `hspo`, x'' + c x' + k x = A cos w t with a rigid wall x <= d.

Between impacts the oscillator is linear. With its matrix E = exp(2 pi M) over a period and g = (E - 1)^-1
(0, -(1 + 1/e)), orbits of one impact, after which the speed is v, obey at w = 1

    (A / c)^2 = (d - v g_1)^2 + v^2 (1 - g_2)^2,

whose least A is a fold; v = 0 is grazing, at A = c d.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from reference.bouncing import DAMPING, GAP, RESTITUTION, VALUES, bouncing, equations, settled_at, shot
from reference.closer import closer
from reference.contact import Contact, Wall, periodic
from reference.shooting import in_order
from scipy.linalg import expm
from support.kept import kept

import periodic as per
import symbolic as sym

C, D, E = DAMPING, GAP, RESTITUTION


@kept
def branch() -> per.Branch:
    """Orbits with one impact over A, from 1 down to grazing."""
    system = bouncing()
    return per.trace(system, "A", (0.01, 1.0), start=1.0, guess=settled_at(system), tol=1e-9)


def closed_form() -> tuple[float, float]:
    """A of the fold, and of an orbit whose speed after the impact is -0.2."""
    over = expm(2 * np.pi * np.array([[0.0, 1.0], [-1.0, -C]]))
    g = np.linalg.solve(over - np.eye(2), [0.0, -(1 + 1 / E)])

    def force(v: float) -> float:
        return float(C * np.hypot(D - v * g[0], v * (1 - g[1])))

    return force(D * g[0] / (g[0] ** 2 + (1 - g[1]) ** 2)), force(-0.2)


def exact(point: per.Point) -> NDArray[np.complex128]:
    """The multipliers in closed form, in extended precision."""
    wall = Wall(np.array([-1.0, 0.0, D, 0.0, 0.0]), np.diag([1.0, -E, 1.0, 1.0, 1.0]))
    force = np.array([0.0, point.parameter])
    system = Contact(np.array([[0.0, 1.0], [-1.0, -C]]), np.zeros(2), force, [wall])
    begin = point.orbit.state(np.zeros(1))[0]
    return closer(system, 1.0, periodic(system, 1.0, begin)).multipliers


def test_orbits_and_multipliers_through_impacts() -> None:
    """Assert orbits and multipliers against event-exact shooting to 1e-9, down to near grazing."""
    points = [p for p in branch() if p.parameter > 0.102]
    assert len(points) > 10
    for point in points:
        found = shot(point)
        phase = np.linspace(0.0, 6.2, 40)
        phase = phase[np.abs(phase - found.kinks[0]) > 1e-6]
        np.testing.assert_allclose(point.orbit.state(phase), found.state(phase), atol=1e-9)
        np.testing.assert_allclose(in_order(point.multipliers), found.multipliers, atol=1e-9)
        np.testing.assert_allclose(point.maximum["x"], D, atol=1e-12)


def test_fold_and_grazing() -> None:
    """Assert the fold and the grazing to 1e-10, where the branch goes on without impacts to its bound."""
    fold, given = closed_form()
    first, _ = branch().labelled(per.Label.FOLD)
    np.testing.assert_allclose(first.parameter, fold, rtol=1e-10)
    (graze,) = branch().labelled(per.Label.GRAZING)
    np.testing.assert_allclose(graze.parameter, C * D, rtol=1e-10)
    before = branch()[branch().points.index(graze) - 1]
    assert np.abs(before.multipliers).max() > 10
    np.testing.assert_allclose(np.abs(graze.multipliers), np.exp(-np.pi * C), rtol=1e-9)
    assert branch()[-1].parameter == 0.01
    assert given > fold


@pytest.mark.parametrize("tol", [1e-6, 1e-9])
def test_branch_without_impact_gains_one(tol: float) -> None:
    """Assert that linear orbits are followed to grazing, and from there those with an impact."""
    found = per.trace(bouncing(), "A", (0.01, 1.0), tol=tol)
    (graze,) = found.labelled(per.Label.GRAZING)
    np.testing.assert_allclose(graze.parameter, C * D, rtol=1e-8)
    assert found[-1].parameter == 1.0 and "bound reached" in str(found.stop)
    np.testing.assert_allclose(in_order(found[-1].multipliers), in_order(branch()[0].multipliers), atol=1e-8)


def test_errors_beside_a_fold() -> None:
    """Assert multipliers of up to 50 to what is claimed, between grazing and the fold just beside it.

    They are those of the orbit of the same A, though the range of A is far wider than the fold is away.
    """
    found = per.trace(bouncing(), "A", (0.015, 0.35), tol=1e-6)
    beside = [p for p in found if p.maximum["x"] > D - 1e-9 and 1e-6 < C * D - p.parameter < 2.8e-5]
    assert beside
    for point in beside:
        own, true = point.multipliers, exact(point)
        assert abs(own.sum() - true.sum()) / np.abs(true).max() < max(1.5 * point.error.multiplier, 1e-8)


def test_start_with_impacts_from_rest() -> None:
    """Assert that an orbit with impacts is found by itself, and bouncing at low frequencies followed."""
    system = bouncing()
    found = per.trace(system, "w", (0.3, 0.72), start=0.3)
    assert found[0].maximum["x"] == pytest.approx(D, abs=1e-9)
    assert "bound reached" in str(found.stop) or "PD" in found.table()
    for point in found[:: max(len(found) // 8, 1)]:
        if not point.label:
            motion = shot(point)
            phase = np.linspace(0.0, 6.2, 40)
            phase = phase[[np.abs(np.asarray(motion.kinks) - p).min() > 1e-5 for p in phase]]
            np.testing.assert_allclose(point.orbit.state(phase), motion.state(phase), atol=1e-5)
            np.testing.assert_allclose(
                in_order(point.multipliers), in_order(motion.multipliers), atol=1e-4, rtol=1e-4
            )


def test_rigid_stop_is_the_wall() -> None:
    """Assert that the part gives the multipliers of the equations, above and below."""
    x = sym.coordinate("x", scale=0.5)
    for below in (False, True):
        parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, C), sym.HarmonicForce(x, 1.0, 1.0)]
        system = sym.compile(sym.combine([*parts, sym.RigidStop(x, D, E, below=below)]))
        first = per.trace(system, "Omega", (0.99, 1.0), start=1.0, guess=settled_at(system))[0]
        assert first.parameter == 1.0
        np.testing.assert_allclose(in_order(first.multipliers), in_order(branch()[0].multipliers), atol=1e-5)
    with pytest.raises(
        ValueError, match="restitution is 1.5; it must be a number greater than 0 and up to 1"
    ):
        sym.RigidStop(x, D, 1.5)


@pytest.mark.parametrize("method", [per.Shooting(), per.HarmonicBalance()])
def test_other_methods_refuse_impacts(method: Any) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError, match="for a system with impacts it must be Collocation"):
        per.trace(bouncing(), "A", (0.01, 0.05), method=method)


RESETS: list[tuple[Any, str]] = [
    (lambda x, p, w: 3, "what resets returned is 3; it must be a mapping of names to pairs"),
    (lambda x, p, w: {"wall": p.d - x.x}, r"resets\['wall'\] is .*; it must be a pair"),
    (lambda x, p, w: {"wall": (p.d - x.x, {"u": 1.0})}, r"resets\['wall'\] has 'u'; it must be one of x, v"),
]


@pytest.mark.parametrize(("resets", "sentence"), RESETS)
def test_resets_that_are_none(resets: Any, sentence: str) -> None:
    """Assert the sentences for what is no reset."""
    with pytest.raises(ValueError, match=sentence):
        sym.compile(sym.Equations(equations, {"x": 0.0, "v": 0.0}, VALUES, frequency="w", resets=resets))
