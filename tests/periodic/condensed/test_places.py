"""Stops and friction at the places of a condensed structure, against full collocation of all its states."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from support.cantilevers import cantilever

import periodic as per
import symbolic as sym
from periodic.condensed import refinement
from periodic.condensed.estimate import ContactError


def stop(tip: Any) -> list[sym.Part]:
    """A stop as stiff as the beam, beyond half the deflection that it limits."""
    return [sym.Stop(tip, sym.HertzLaw(3.0, 1.0), 0.05)]


def friction(tip: Any) -> list[sym.Part]:
    """An elastic element that slips: a state of its own."""
    return [sym.Jenkins(tip, 1.0, 0.05)]


def at(system: sym.CompiledSystem, tol: float) -> per.Point:
    """The orbit at a value of the parameter."""
    of = per.trace(system, "Omega", (3.2, 3.3), at=3.25, tol=tol)
    return next(p for p in of.points if p.parameter == 3.25)


@pytest.mark.parametrize(("parts", "tol", "digits"), [(stop, 1e-7, 1e-7), (friction, 1e-6, 3e-6)])
def test_motion_is_that_of_all_states(
    parts: Callable[[Any], Sequence[sym.Part]], tol: float, digits: float
) -> None:
    """Assert the largest and least deflection, and the largest multiplier."""
    ours, full = (at(cantilever(1, parts, condense=c, damping=0.05), tol) for c in (True, False))
    span = full.maximum["tip"] - full.minimum["tip"]
    assert ours.maximum["tip"] == pytest.approx(full.maximum["tip"], abs=digits * span)
    assert ours.minimum["tip"] == pytest.approx(full.minimum["tip"], abs=digits * span)
    assert abs(max(abs(ours.multipliers)) - max(abs(full.multipliers))) < 10 * digits
    assert len(ours.orbit.phases) == len(full.orbit.phases) > 0


def test_fold_beside_grazing() -> None:
    """Assert the LP 1e-5 past the GR where a spring engages: to 1e-10, its multipliers to 1e-7.

    Its contact is held by the error estimate, else the orbit would be asked for to 1e-12 (890 intervals).
    """

    def fold(tol: float) -> per.Point:
        system = cantilever(10, lambda tip: [sym.OneSidedSpring(tip, 300.0, 0.01)], force=0.02, damping=0.02)
        few = per.ArclengthControl(max_points=5)
        return per.trace(system, "Omega", (2.0, 4.0), control=few, tol=tol).labelled(per.Label.FOLD)[0]

    ours, fine = fold(1e-6), fold(1e-8)
    assert ours.parameter == pytest.approx(fine.parameter, rel=1e-10)
    apart = np.abs(ours.multipliers[:, None] - fine.multipliers)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-7
    assert ours.orbit.mesh.ntst < 500


def test_too_much_memory_is_an_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that meshes grow to no more than there may be memory for, and that the reason is said."""
    monkeypatch.setattr(refinement, "LARGEST", 2e5)
    system = cantilever(1, stop, damping=0.05)
    found = per.trace(system, "Omega", (3.2, 3.3), start=3.2, tol=1e-9)
    assert found.stop.reason is per.Reason.INACCURATE
    assert "more would take over 0.0002 GB of memory" in str(found.stop)


def test_multipliers_ask_for_intervals_by_their_order() -> None:
    """Assert that errors 10 and 1000 times the aim ask for 10^(1/(2s-1)) and its cube as many intervals.

    Multipliers by Radau IIA of s points are of the order 2s - 1 where forces depend on the motion.
    """
    run = per.continuation(per.Problem(cantilever(1, stop, damping=0.05), "Omega", (3.2, 3.3)), tol=1e-6)
    solver = run.solver
    solution = solver.at_parameter(next(run).orbit, 1.0)
    assert len(solution.orbit.phases)
    method, aim, finest = solver.discretisation, refinement.AIM * 1e-6 / refinement.SAFETY, []
    for ratio in (1.0, 10.0, 1000.0):
        error = ContactError(0.0, ratio * aim, variation=ratio * aim)
        asked = method.refine(solver.problem.system, solution.orbit, error)
        assert isinstance(asked, refinement.CondensedRefinement)
        finest.append(asked._wanted.max())
    order = 2 * solution.orbit.mesh.scheme.ncol - 1
    assert finest[1] / finest[0] == pytest.approx(10 ** (1 / order), rel=1e-9)
    assert finest[2] / finest[0] == pytest.approx(1000 ** (1 / order), rel=1e-9)
