"""Newton's increments by transfer matrices, against those column by column."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn.jointcases import drawn_joints

import periodic as per
from periodic.condensed import memory, operator
from periodic.condensed import transfer as transfers
from periodic.condensed.linearised import SplitLinearisation
from periodic.condensed.operator import CondensedOperator
from periodic.condensed.settling import settled
from periodic.events.eventrows import event_rows
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform
from periodic.orbit.scheme import Family, Scheme
from symbolic.kernels import native


def linearised(seed: int, *, joined: bool, monkeypatch: pytest.MonkeyPatch) -> tuple[CondensedOperator, int]:
    """The equations of a beam with several joints about a settled motion, in the first parameter."""
    if native.compiler() is not None:  # the motion settles in less time
        monkeypatch.setenv("ORBITRACE_KERNELS", "c")
    monkeypatch.setattr(transfers, "pays", lambda *_: joined)
    monkeypatch.setattr(operator, "pays", lambda *_: True)
    system = drawn_joints("joints", seed).system
    start = at_rest(system, uniform(Scheme(Family.RADAU, 4), 8), system.nominal)
    orbit, index = next(settled(system, start)), len(system.nominal) - 1
    about = SplitLinearisation.about(system, orbit, (index,))
    return CondensedOperator(about, event_rows(system, orbit, (index,))), index


@pytest.mark.parametrize("seed", [122, 171])
def test_is_the_same_as_column_by_column(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert increment, tangent and multipliers to 10 digits, with a row in the states at all points."""
    found = []
    for joined in (True, False):
        equations, index = linearised(seed, joined=joined, monkeypatch=monkeypatch)
        system, orbit = equations.given.system, equations.orbit
        assert orbit.mesh.events and (equations.transfer is not None) == joined
        row = per.Amplitude(system.outputs[0].name).linearise(system, orbit, (index,))
        increments = equations.solve([row], np.eye(2))
        values = np.linalg.eigvals(equations.fundamental[-1])
        found.append([*(each for i in increments for each in i._arrays), np.sort(np.abs(values))])
    for ours, other in zip(*found, strict=True):
        assert np.abs(ours - other).max(initial=0.0) <= 1e-10 * max(
            1.0, float(np.abs(other).max(initial=0.0))
        )


def test_intervals_are_solved_for_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the same forces and own states, to rounding, one interval at a time and all at once."""
    equations, _ = linearised(122, joined=True, monkeypatch=monkeypatch)
    assert equations.transfer is not None
    kept, found = equations.transfer.kept, []
    for cache in (1.0, 1e12):
        monkeypatch.setattr(memory, "CACHE", cache)
        found.append(transfers.Transfer(equations.system, kept).unknowns)
    assert np.abs(found[0] - found[1]).max() <= 1e-12 * np.abs(found[1]).max()
