"""Impacts with restitution: COCO's problem `hspo`, x'' + c x' + k x = A cos w t with a rigid wall x <= d.

Between impacts the oscillator is linear. With its matrix E = exp(2 pi M) over a period and g = (E - 1)^-1
(0, -(1 + 1/e)), orbits of one impact, after which the speed is v, obey at w = 1

    (A / c)^2 = (d - v g_1)^2 + v^2 (1 - g_2)^2,

whose least A is a fold; v = 0 is grazing, at A = c d.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from reference.hybrid import Hybrid, Surface, periodic_orbit
from reference.shooting import Motion, in_order
from scipy.linalg import expm

import periodic as per
import symbolic as sym

C, D, E = 0.1, 1.0, 0.8
VALUES = {"A": 1.0, "w": 1.0, "c": C, "k": 1.0, "d": D, "e": E}


def equations(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The oscillator."""
    return {"x": x.v, "v": p.A * wave.cos - p.c * x.v - p.k * x.x}


def wall(x: Any, p: Any, wave: Any) -> dict[str, Any]:
    """The rigid wall."""
    return {"wall": (p.d - x.x, {"v": -p.e * x.v})}


def hspo() -> sym.CompiledSystem:
    """The compiled problem."""
    return sym.compile(sym.Equations(equations, {"x": 0.0, "v": 0.0}, VALUES, frequency="w", resets=wall))


def started(system: sym.CompiledSystem) -> per.Orbit:
    """The motion to which it settles at A = w = 1, with one impact in a period."""
    motion = sym.simulate(system, settle=40, tolerance=1e-9)
    assert np.count_nonzero(np.diff(motion.phase) == 0) == 1
    return per.sampled(motion.phase, motion.state, motion.algebraic, motion.parameter, system=system)


@cache
def branch() -> per.Branch:
    """Orbits with one impact over A, from 1 down to grazing."""
    system = hspo()
    return per.trace(system, "A", (0.01, 1.0), start=1.0, guess=started(system), tol=1e-9)


def exact(point: per.Point) -> Motion:
    """The orbit by event-exact shooting, its perturbations by saltation."""
    force, w = (point.orbit.parameters[name] for name in ("A", "w"))
    return shot(force, point.orbit.state(np.zeros(1))[0], w)


def shot(force: float, begin: NDArray[np.float64], w: float = 1.0) -> Motion:
    """The orbit that begins near a state, by event-exact shooting."""
    reset = lambda t, y: (np.array([y[0], -E * y[1]]), np.zeros(2), np.diag([1.0, -E]))  # noqa: E731
    surface = Surface(lambda t, y: D - y[0], lambda t, y: (0.0, np.array([-1.0, 0.0])), reset)
    system = Hybrid(
        lambda t, y, signs: [y[1] / w, (force * np.cos(t) - C * y[1] - y[0]) / w],
        lambda t, y, signs: [[0, 1 / w], [-1 / w, -C / w]],
        [surface],
    )
    return periodic_orbit(system, begin)


def closed_form() -> tuple[float, float]:
    """A of the fold, and of an orbit whose speed after the impact is -0.2."""
    over = expm(2 * np.pi * np.array([[0.0, 1.0], [-1.0, -C]]))
    g = np.linalg.solve(over - np.eye(2), [0.0, -(1 + 1 / E)])

    def force(v: float) -> float:
        return float(C * np.hypot(D - v * g[0], v * (1 - g[1])))

    return force(D * g[0] / (g[0] ** 2 + (1 - g[1]) ** 2)), force(-0.2)


def test_orbits_and_multipliers_through_impacts() -> None:
    """Assert orbits and multipliers against event-exact shooting to 1e-9, down to near grazing."""
    points = [p for p in branch() if p.parameter > 0.102]
    assert len(points) > 10
    for point in points:
        found = exact(point)
        phase = np.linspace(0.0, 6.2, 40)
        phase = phase[np.abs(phase - found.kinks[0]) > 1e-6]
        np.testing.assert_allclose(point.orbit.state(phase), found.state(phase), atol=1e-9)
        np.testing.assert_allclose(in_order(point.multipliers), found.multipliers, atol=1e-9)
        np.testing.assert_allclose(point.maximum["x"], D, atol=1e-12)


def test_fold_and_grazing() -> None:
    """Assert the fold to 1e-10, and that the branch ends at grazing, where the impact has no speed left."""
    fold, given = closed_form()
    (found,) = branch().labelled(per.Label.FOLD)
    np.testing.assert_allclose(found.parameter, fold, rtol=1e-10)
    end = branch()[-1]
    np.testing.assert_allclose(end.parameter, C * D, rtol=1e-8)
    assert "an impact has no speed left, the orbit grazes" in str(branch().stop)
    assert np.abs(end.multipliers).max() > 1e4
    assert given > fold


def test_branch_without_impact_ends_at_the_wall() -> None:
    """Assert that linear orbits are followed to A = c d, not through the wall; beyond, one settles on it."""
    system = hspo()
    linear = per.trace(system, "A", (0.01, 1.0))
    np.testing.assert_allclose(linear[-1].parameter, C * D, rtol=1e-5)
    assert "passes where an impact would be" in str(linear.stop)
    assert linear[-1].maximum["x"] <= D * (1 + 1e-5)
    beyond = per.trace(system, "A", (0.5, 1.0))[0]
    assert (beyond.parameter, len(beyond.orbit.phases)) == (0.5, 1)
    np.testing.assert_allclose(in_order(beyond.multipliers), exact(beyond).multipliers, rtol=1e-4)


def test_scene() -> None:
    """Assert the scene at five places against event-exact shooting, its fold and its end, without a guess."""
    places = (0.9, 0.7, 0.5, 0.3, 0.15)
    found = per.trace(sym.scene("impact-oscillator"), "A", (0.01, 1.0), start=1.0, at=places)
    points = found.labelled(per.Label.USER)
    assert [point.parameter for point in points] == list(places)
    for point in points:
        own = shot(point.parameter, point.orbit.state(np.zeros(1))[0])
        np.testing.assert_allclose(point.orbit.state(np.zeros(1)), own.state(np.zeros(1)), atol=3e-7)
        np.testing.assert_allclose(in_order(point.multipliers), own.multipliers, atol=2e-5)
    (fold,) = found.labelled(per.Label.FOLD)
    np.testing.assert_allclose(fold.parameter, closed_form()[0], rtol=1e-8)
    np.testing.assert_allclose(
        min(p.parameter for p in found if len(p.orbit.phases)), closed_form()[0], rtol=1e-8
    )


def test_rigid_stop_is_the_wall() -> None:
    """Assert that the part gives the multipliers of the equations, above and below."""
    x = sym.coordinate("x", scale=0.5)
    for below in (False, True):
        parts = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, C), sym.HarmonicForce(x, 1.0, 1.0)]
        system = sym.compile(sym.combine([*parts, sym.RigidStop(x, D, E, below=below)]))
        first = per.trace(system, "Omega", (0.99, 1.0), start=1.0, guess=started(system))[0]
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
        per.trace(hspo(), "A", (0.01, 0.05), method=method)


def test_conditions_on_multipliers_refuse_impacts() -> None:
    """Assert the sentence for a curve of folds, whose derivatives would not see the impact."""
    (fold,) = branch().labelled(per.Label.FOLD)
    with pytest.raises(ValueError, match="system has impacts"):
        per.trace(hspo(), "w", (1.0, 1.1), guess=fold.orbit, determined={"A": per.FoldCondition()})


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
