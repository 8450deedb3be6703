"""Many motions followed in C: the same motions as one by one, events and tangents included."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.oscillators import SYSTEMS, X, oscillator

import symbolic as sym
from periodic.system.ensembles import DIVERGED, PILED
from symbolic.arrays import Array
from symbolic.integration.ensembles.ensemble import Ensemble

pytestmark = pytest.mark.usefixtures("users_kernels")

PERIOD = 2 * math.pi


def ensemble(system: sym.CompiledSystem, tolerance: float = 1e-11, largest: float = 1e8) -> Ensemble:
    """The motions of a system."""
    found = system.ensemble(system.nominal, tolerance, largest)
    assert found is not None
    return found


def starts(system: sym.CompiledSystem, count: int = 4, size: float = 0.3) -> Array:
    """States beside rest."""
    rest = system.rest(system.nominal)[0]
    return np.asarray(rest + size * np.random.default_rng(3).uniform(-1, 1, (count, len(rest))))


@pytest.mark.parametrize("kind", SYSTEMS)
def test_motions_are_those_of_one_by_one(kind: str) -> None:
    """Assert states after each of three periods, by another integrator and another search for events."""
    system = SYSTEMS[kind]()
    together, n = ensemble(system), len(system.states)
    begin = together.begin(starts(system))
    found = together.run(begin, 3, PERIOD, keep=True)
    assert (found.outcome == 0).all() and found.sections is not None
    for y, modes, sections in zip(begin, found.modes, found.sections, strict=True):
        phase = PERIOD * np.arange(4)
        path = system.motion(y[:n], y[n:], system.nominal, phase, 1e-11)
        last = np.searchsorted(path.phase, phase, side="right") - 1
        size = 1 + np.abs(path.state).max()
        assert np.abs(sections[:, :n] - path.state[last]).max() < 3e-8 * size
        assert tuple(modes) == tuple(path.modes)


@pytest.mark.parametrize("kind", ["gap", "impact", "slider", "friction and impact", "film", "gears"])
def test_tangents_are_the_derivatives_of_motions(kind: str) -> None:
    """Assert the derivatives of the map over a period, by differences of motions."""
    system = SYSTEMS[kind]()
    together, n = ensemble(system, 1e-12), len(system.states)
    begin = together.begin(starts(system, 1, 0.15))  # no slider at its limit
    tangents = together.tangents_at(begin)
    modes = together.run(begin, 0, PERIOD).modes
    found = together.run(begin, 1, PERIOD, tangents=tangents, raw=True, modes=modes)
    step = 1e-6
    for k in range(n):
        beside = [together.begin(begin[:, :n] + side * step * np.eye(n)[k]) for side in (1, -1)]
        ends = [together.run(y, 1, PERIOD).ends[0, :n] for y in beside]
        slope = (ends[0] - ends[1]) / (2 * step)
        assert found.tangents[0, k, :n] == pytest.approx(slope, abs=2e-4 * max(1.0, np.abs(slope).max()))


def test_stiff_motion() -> None:
    """Assert van der Pol's relaxation at mu = 1000 by Radau's method: explicit steps would be 10,000."""
    mu = 1000.0
    equations = sym.Equations(
        lambda x, p: {"x": x.y, "y": mu * (1 - x.x**2) * x.y - x.x},
        states={"x": 2.0, "y": 0.0},
        scales={"y": 1.0},
    )
    together = ensemble(sym.compile(equations), 1e-9)
    found = together.run(np.array([[2.0, 0.0]]), 1, 100.0)
    settled = solve_ivp(
        lambda t, x: [x[1], mu * (1 - x[0] ** 2) * x[1] - x[0]], (0, 100), [2.0, 0.0], "Radau", rtol=1e-10
    )
    assert found.outcome[0] == 0
    assert found.ends[0, 0] == pytest.approx(settled.y[0, -1], rel=1e-7)


def test_outcomes() -> None:
    """Assert what is said of motions that diverge, need too many steps, or have no end of events."""
    runaway = sym.compile(sym.Equations(lambda x, p: {"x": x.x**2}, states={"x": 1.0}))
    assert ensemble(runaway).run(np.array([[1.0], [-1.0]]), 1, PERIOD).outcome.tolist() == [DIVERGED, 0]
    bouncing = sym.Equations(
        lambda x, p: {"x": x.v, "v": -1.0 + 0 * x.x},
        states={"x": 1.0, "v": 0.0},
        resets=lambda x, p: {"floor": (x.x, {"v": -0.5 * x.v})},
    )
    found = ensemble(sym.compile(bouncing)).run(np.array([[1.0, 0.0]]), 2, 10.0, keep=True)
    assert found.outcome.tolist() == [PILED]
    assert found.sections is not None and np.isnan(found.sections[0, 1:]).all()


def test_known_ends() -> None:
    """Assert that motions end at the places given, after two stretches there, and at no others."""
    system = oscillator(force=0.0)
    together = ensemble(system)
    targets = np.zeros((1, 2)), [7], np.ones(2), 1e-3
    found = together.run(np.array([[1.0, 0.0], [-0.5, 0.3]]), 100, PERIOD, targets=targets, keep=True)
    assert found.label.tolist() == [7, 7] and np.abs(found.ends).max() < 1e-3
    assert found.sections is not None
    for path, end in zip(found.sections, found.ends, strict=True):
        reached = np.isfinite(path).all(axis=1)
        last = int(reached.sum()) - 1
        assert reached[: last + 1].all() and (path[last] == end).all() and last < 100
    assert together.run(np.array([[1.0, 0.0]]), 3, PERIOD, targets=targets).label.tolist() == [-1]


def test_held_surfaces_do_not_change() -> None:
    """Assert the changes of mode in a period: none where friction holds, four where it slips and sticks."""
    slipping, holding = (oscillator(sym.CoulombFriction(X, 0.5), force=f, omega=0.5) for f in (1.0, 0.2))
    counts = [
        int(ensemble(each).run(np.zeros((1, 2)), 10, PERIOD).changes[0, 0]) for each in (slipping, holding)
    ]
    assert counts == [4, 0]


def test_exceptions_of_callbacks_are_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert it of Ctrl-C while a motion begins, through C that cannot carry it."""

    def interrupted(*given: object) -> None:
        raise KeyboardInterrupt

    together = ensemble(SYSTEMS["friction"]())
    monkeypatch.setattr(Ensemble, "_changed", interrupted)
    with pytest.raises(KeyboardInterrupt):
        together.run(np.zeros((3, 2)), 1, PERIOD)
