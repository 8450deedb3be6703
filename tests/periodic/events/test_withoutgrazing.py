"""Words that differ without grazing, and steps over such changes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.events.rewrites.sites import Node
from periodic.events.rewrites.withoutgrazing import without_grazing
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import FORCED
from periodic.system import STUCK, Kind


@pytest.fixture(scope="module")
def rubbing() -> sym.CompiledSystem:
    """Two coupled masses, each on friction of its own."""
    x, y = (sym.coordinate(name, unit="m") for name in "xy")
    own = [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.1), sym.CoulombFriction(x, 0.3)]
    other = [sym.Mass(y, 1.0), sym.Spring(y, 2.0), sym.Damper(y, 0.1), sym.CoulombFriction(y, 0.05)]
    coupled = [sym.Coupling(x, y, 0.3, 0.01), sym.HarmonicForce(x, 1.0)]
    return sym.compile(sym.combine([*own, *other, *coupled]))


def _word(system: sym.CompiledSystem, *changes: tuple[float, int, int]) -> list[Node]:
    """Event nodes of the first joint: phase, the mode before and that after."""
    surface = next(s for s in system.surfaces if s.kind == Kind.SLIDING)
    assert surface.releases is not None
    found = list[Node]()
    for phase, before, after in changes:
        if before == STUCK:
            found.append((EventNode(surface.releases[0 if after > 0 else 1], after), phase))
        else:
            modes = ((surface.switch, STUCK),) if after == STUCK else ()
            found.append((EventNode(surface.switch, -before, modes=modes), phase))
    return found


REVERSING = (1.0, 1, -1), (4.0, -1, 1)
STICKING = (1.0, 1, STUCK), (2.0, STUCK, -1), (4.0, -1, 1)
PAUSING = (0.2, 1, STUCK), (0.6, STUCK, 1), (1.0, 1, -1), (4.0, -1, 1)
SLIPPING = (1.0, 1, STUCK), (1.4, STUCK, 1), (1.5, 1, STUCK), (2.0, STUCK, -1), (4.0, -1, 1)
BEYOND = (1.0, 1, -1), (1.2, -1, STUCK), (2.0, STUCK, -1), (4.0, -1, 1)
SHAKEN = (1.0, 1, -1), (2.0, -1, 1), (2.5, 1, -1), (4.0, -1, 1)


@pytest.mark.parametrize(
    ("one", "other", "free"),
    [
        (REVERSING, STICKING, True),  # crossing-sliding
        (STICKING, SLIPPING, True),  # adding-sliding
        (STICKING, BEYOND, True),  # switching-sliding
        (REVERSING, PAUSING, False),  # grazing-sliding
        (REVERSING, SHAKEN, False),  # grazing
        (REVERSING, (), False),  # slips all along, or never
        (STICKING, STICKING, True),
    ],
)
def test_what_begins_without_grazing(
    rubbing: sym.CompiledSystem,
    one: tuple[tuple[float, int, int], ...],
    other: tuple[tuple[float, int, int], ...],
    free: bool,
) -> None:
    """Assert that rows of the table that graze a level are told from those that do not, both ways round."""
    words = [_word(rubbing, *changes) for changes in (one, other)]
    assert without_grazing(rubbing, *words, FORCED) is free
    assert without_grazing(rubbing, *words[::-1], FORCED) is free


def test_a_stick_elsewhere_is_grazing(rubbing: sym.CompiledSystem) -> None:
    """Assert that a stick inside a slip is the same one only where its phases overlap."""
    moved = (0.5, 1, STUCK), (0.8, STUCK, 1), (1.0, 1, -1), (4.0, -1, 1)
    gone = (5.0, 1, STUCK), (5.5, STUCK, 1), (1.0, 1, -1), (4.0, -1, 1)
    words = [_word(rubbing, *changes) for changes in (PAUSING, moved, sorted(gone))]
    assert without_grazing(rubbing, words[0], words[1], FORCED)
    assert not without_grazing(rubbing, words[0], words[2], FORCED)


def test_steps_over_sticks_that_begin(rubbing: sym.CompiledSystem) -> None:
    """Assert that steps over changes without grazing lead to the points that stopping at each leads to."""
    bounds, at = (0.5, 0.62), (0.6,)
    branch = per.trace(rubbing, "Omega", bounds, start=0.62, tol=1e-6, at=at)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(per.Collocation, "rewritten", lambda *given: None)
        stopping = per.trace(rubbing, "Omega", bounds, start=0.62, tol=1e-6, at=at)
    both = [[len(point.orbit.mesh.events) for point in b] for b in (branch, stopping)]
    assert len(branch) < len(stopping) and both[0][0] == both[1][0] and both[0][-1] == both[1][-1]
    assert any(a != b for a, b in pairwise(both[0]))
    assert [p.label for p in branch.special_points] == [p.label for p in stopping.special_points]
    for one, other in zip(branch.special_points, stopping.special_points, strict=True):
        assert one.parameter == pytest.approx(other.parameter, abs=1e-7)
    (ours,), (theirs,) = (b.labelled(per.Label.USER) for b in (branch, stopping))
    tau = np.linspace(0, 2 * np.pi, 97)
    np.testing.assert_allclose(ours.orbit.state(tau), theirs.orbit.state(tau), atol=1e-7)
    np.testing.assert_allclose(
        np.sort(np.abs(ours.multipliers)), np.sort(np.abs(theirs.multipliers)), atol=1e-6
    )
