"""Words of the same event nodes in another order, and steps in which several of them change places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.predictor import spaced
from periodic.events.rewrites.permuted import permuted
from periodic.orbit.orbit import Orbit
from periodic.tracing.steps.wayacross import matched


@pytest.fixture(scope="module")
def rubbing() -> sym.CompiledSystem:
    """Two coupled masses, each on friction of its own."""
    x, y = (sym.coordinate(name, unit="m") for name in "xy")
    own = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.CoulombFriction(x, 0.3)]
    other = [sym.Mass(y, 1.0), sym.Spring(y, 2.0), sym.Damper(y, 0.1), sym.CoulombFriction(y, 0.05)]
    coupled = [sym.Coupling(x, y, 0.3, 0.01), sym.HarmonicForce(x, 1.0)]
    return sym.compile(sym.combine([*own, *other, *coupled]))


@pytest.fixture(scope="module")
def branch(rubbing: sym.CompiledSystem) -> per.Branch:
    """Its branch, on which stops and releases of both change places from Omega .43 to .48."""
    return per.trace(rubbing, "Omega", (0.4, 0.6), start=0.4, tol=1e-6, at=(0.49,))


def _order(orbit: Orbit) -> tuple[int, ...]:
    return tuple(event.switch for event in orbit.mesh.events)


def test_one_step_over_two_swaps(rubbing: sym.CompiledSystem, branch: per.Branch) -> None:
    """Assert that symmetric swaps take one step, and four where each is stopped at, to the same orbits."""
    changes = [
        (a, b) for a, b in zip(branch[:-1], branch[1:], strict=True) if _order(a.orbit) != _order(b.orbit)
    ]
    over = [(a, b) for a, b in changes if sorted(_order(a.orbit)) == sorted(_order(b.orbit))]
    assert len(over) >= 2
    with pytest.MonkeyPatch.context() as patched:
        for way in ("reordered", "rewritten"):
            patched.setattr(per.Collocation, way, lambda *given: None)
        stopping = per.trace(rubbing, "Omega", (0.4, 0.6), start=0.4, tol=1e-6, at=(0.49,))
    assert len(branch) < len(stopping)
    assert branch.stop == stopping.stop
    for label in (per.Label.GRAZING, per.Label.FOLD, per.Label.DOUBLING, per.Label.TORUS):
        both = zip(branch.labelled(label), stopping.labelled(label), strict=True)
        for one, other in both:  # the meshes differ: to what both claim, 2e-9
            assert abs(one.parameter - other.parameter) < one.error.orbit + other.error.orbit < 1e-8
    (ours,), (theirs,) = (b.labelled(per.Label.USER) for b in (branch, stopping))
    tau = np.linspace(0, 2 * np.pi, 97)
    np.testing.assert_allclose(ours.orbit.state(tau), theirs.orbit.state(tau), atol=1e-7)
    np.testing.assert_allclose(
        np.sort(np.abs(ours.multipliers)), np.sort(np.abs(theirs.multipliers)), atol=1e-6
    )


def test_neighbours_change_places(rubbing: sym.CompiledSystem, branch: per.Branch) -> None:
    """Assert that a stop moved past another's stop follows it, and that none may pass one of its own."""
    orbit = branch[0].orbit
    events, lengths = orbit.mesh.events, orbit.mesh.segment_lengths(orbit.phases)
    assert permuted(rubbing, orbit, orbit.phases) is None
    joint = [event.switch in (events[0].switch, *_own(rubbing, events[0].switch)) for event in events]
    i = next(i for i in range(len(events) - 1) if joint[i] != joint[i + 1])
    phases = orbit.phases.copy()
    phases[i] += lengths[i] + 1e-3
    found = permuted(rubbing, orbit, phases)
    assert found is not None
    assert [event for event, _ in found] == [*events[:i], events[i + 1], events[i], *events[i + 2 :]]
    assert [phase for _, phase in found] == sorted(phases)
    k = next(k for k in range(len(events) - 1) if joint[k] == joint[k + 1])
    phases = orbit.phases.copy()
    phases[k] += lengths[k] + 1e-3
    assert permuted(rubbing, orbit, phases) is None


def _own(system: sym.CompiledSystem, switch: int) -> tuple[int, ...]:
    """All switches of the joint that a switch is of."""
    each = [(s.switch, *(s.releases or ())) for s in system.surfaces]
    return next(own for own in each if switch in own)


def test_corresponding_points(branch: per.Branch) -> None:
    """Assert that an orbit's event nodes correspond to the same ones of another, in any order."""
    pairs = zip(branch[:-1], branch[1:], strict=True)
    each = [(a.orbit, b.orbit) for a, b in pairs if sorted(_order(a.orbit)) == sorted(_order(b.orbit))]
    assert any(_order(one) != _order(other) for one, other in each)
    for one, other in each:
        found = matched(one, other)
        assert sorted(found) == list(range(len(one.phases)))
        assert [other.mesh.events[j] for j in found] == list(one.mesh.events)


@pytest.mark.parametrize("part", [0.2, 0.5, 0.9])
def test_events_that_merge_as_the_cube(branch: per.Branch, part: float) -> None:
    """Assert that a gap that closes as the cube of the way left is foreseen where a tangent overshoots."""
    orbit = branch[0].orbit
    lengths = orbit.mesh.segment_lengths(orbit.phases)
    ahead = orbit.phases.copy()
    ahead[1] -= 3 * part * lengths[0]
    found = spaced(orbit, replace(orbit, phases=ahead))
    now = orbit.mesh.segment_lengths(found.phases)
    if 3 * part < 1:
        assert found.phases is ahead
    else:
        assert now[0] == pytest.approx(lengths[0] * (1 - part) ** 3)
    assert now.sum() == pytest.approx(lengths.sum())
    assert (now > 0).all()
    passed = replace(orbit, phases=orbit.phases - 4 * lengths[0] * (np.arange(len(ahead)) == 1))
    assert spaced(orbit, passed) is passed
