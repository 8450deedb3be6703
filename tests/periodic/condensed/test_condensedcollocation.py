"""A condensed structure against full collocation of all its states, and against itself with more states."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic
from support.kept import kept

import periodic as per
import symbolic as sym
from periodic.condensed.condensedcollocation import CondensedCollocation
from periodic.condensed.floquet import LASTING, Leading
from periodic.condensed.operator import CondensedOperator
from periodic.harmonic.splitbalance import SeriesLeading
from periodic.linear.unknowns import Increment
from periodic.orbit.scheme import Array
from periodic.tracing.methodchoice import chosen_method


@kept
def branch(elements: int, condense: bool = True) -> per.Branch:
    """The first resonance of a cantilever with a cubic spring at its tip."""
    return per.trace(cantilever(elements, cubic, condense=condense), "Omega", (3.0, 8.0), tol=1e-6)


def folds(of: per.Branch) -> list[float]:
    """Where the branch turns."""
    return [p.parameter for p in of.points if p.label is per.Label.FOLD]


def test_folds_are_those_of_all_states() -> None:
    """Assert both folds of 4 states to 9 digits against full collocation, their motions to 8."""
    ours, full = branch(1), branch(1, condense=False)
    assert ours.stop.reason is full.stop.reason is per.Reason.BOUND
    assert folds(ours) == pytest.approx(folds(full), rel=1e-9)
    for a, b in zip(folds(ours), folds(full), strict=True):
        largest = [
            max(p.maximum["tip"] for p in of.points if p.parameter == at) for of, at in ((ours, a), (full, b))
        ]
        assert largest[0] == pytest.approx(largest[1], rel=1e-7)


def test_multipliers_are_those_of_all_states() -> None:
    """Assert the pair that lasts to 7 digits, the other, of modulus 0.5, which no error counts, to 5."""
    at = [
        per.trace(cantilever(1, cubic, condense=c), "Omega", (3.0, 3.2), at=3.1, tol=1e-8)
        for c in (True, False)
    ]
    found = [next(p for p in of.points if p.parameter == 3.1) for of in at]
    both = [np.sort_complex(p.multipliers) for p in found]
    lasting = np.abs(both[1]) > LASTING
    assert lasting.sum() == 2
    assert np.allclose(both[0][lasting], both[1][lasting], rtol=0, atol=1e-7)
    assert np.allclose(*both, rtol=0, atol=1e-5)


def test_work_does_not_grow_with_the_structure() -> None:
    """Assert the folds of 20 degrees of freedom to what the mesh of elements leaves, with as many points."""
    small, large = branch(3), branch(10)
    assert folds(small) == pytest.approx(folds(large), rel=2e-3)
    assert len(large.points) < 1.5 * len(small.points)
    assert large.newton_iterations < 1.5 * small.newton_iterations


def test_other_methods_are_refused() -> None:
    """Assert one sentence."""
    with pytest.raises(ValueError, match="a structure must be compiled with condense=False"):
        per.trace(cantilever(2, cubic), "Omega", (3.0, 8.0), method=per.Shooting())
    with pytest.raises(ValueError, match="scheme is Gauss; condensation takes Radau IIA"):
        gauss = per.Collocation(scheme=per.Scheme(per.Family.GAUSS, 4))
        per.trace(cantilever(2, cubic), "Omega", (3.0, 8.0), method=gauss)


def oscillator(condense: bool) -> sym.CompiledSystem:
    """Two masses, the first driven, the second held by a cubic spring as well."""
    structure = sym.Structure(
        np.diag([1.0, 0.5]), np.diag([0.05, 0.02]), [[2.0, -1.0], [-1.0, 1.5]], at={"a": 0, "b": 1}
    )
    a, b = structure["a"], structure["b"]
    return sym.compile(
        structure + sym.CubicSpring(b, 0.5) + sym.HarmonicForce(a, 0.3, 1.0), condense=condense
    )


def test_two_places_of_which_one_is_driven_alone() -> None:
    """Assert the motion of both at a value of the parameter to 8 digits against full collocation."""
    found = []
    for condense in (True, False):
        of = per.trace(oscillator(condense), "Omega", (0.5, 0.9), at=0.8, tol=1e-8)
        found.append(next(p for p in of.points if p.parameter == 0.8))
    for name in ("a", "b"):
        assert found[0].maximum[name] == pytest.approx(found[1].maximum[name], rel=1e-8)


@pytest.mark.parametrize("condense", [True, False])
def test_three_methods_agree(condense: bool) -> None:
    """Assert the largest motion by harmonic balance, of the places or of all states, to 9 digits."""
    given = {"at": 3.1, "tol": 1e-9}
    found = []
    for system, method in (
        (cantilever(1, cubic, condense=condense), per.HarmonicBalance()),
        (cantilever(1, cubic), per.Collocation()),
    ):
        of = per.trace(system, "Omega", (3.0, 3.3), method=method, **given)
        found.append(next(p for p in of.points if p.parameter == 3.1))
    assert found[0].maximum["tip"] == pytest.approx(found[1].maximum["tip"], rel=1e-9)
    assert np.abs(found[0].multipliers).max() == pytest.approx(np.abs(found[1].multipliers).max(), rel=1e-9)


def test_journal_has_the_leading_multipliers(tmp_path: Path) -> None:
    """Assert that a branch is recovered whole."""
    journal = tmp_path / "branch.journal"
    system = cantilever(1, cubic)
    of = per.trace(system, "Omega", (3.0, 3.05), tol=1e-5, watch=per.Watch(journal=journal))
    assert len(per.recovered(journal).points) == len(of.points)


def test_increments_are_periodic() -> None:
    """Assert that what answers a step ends where it begins: of the equations, and of states that lack."""
    system, orbit = cantilever(1, cubic), branch(1)[2].orbit
    method = per.Collocation().at(1e-6)
    problem, method = chosen_method(method, per.Problem(system, "Omega", (3.0, 8.0)))
    operator = method.linearise(problem.system, orbit, problem.free)
    assert isinstance(operator, CondensedOperator)
    held = [per.Amplitude("tip").linearise(problem.system, orbit, problem.free)]
    places = operator.system.places
    lacking = np.random.default_rng(1).standard_normal((*orbit.stages.shape[:2], len(places)))
    for found in (operator.answered(held, lacking), operator.solve(held, np.ones((2, 1)))[0]):
        assert np.abs(found.nodes).max() > 0
        assert found.nodes[0] == pytest.approx(found.nodes[-1], rel=1e-9, abs=1e-13)
        assert found.nodes[1:] == pytest.approx(found.stages[:, -1], rel=1e-9, abs=1e-13)


def test_meshes_begin_with_intervals_of_their_own() -> None:
    """Assert the least and first numbers of intervals, which are those of few unknowns."""
    method = CondensedCollocation()
    assert (method.ntst_min, method.ntst) == (6, 12)


def test_changes_of_series_at_the_beginning_are_those_of_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert what a change of the forces, given at even phases, changes, by its values at stages."""
    seen, own = list[tuple[SeriesLeading, Increment]](), SeriesLeading.start
    monkeypatch.setattr(SeriesLeading, "start", lambda *given: seen.append(given) or own(*given))
    per.trace(cantilever(1, cubic, condense=True), "Omega", (3.0, 3.02), method=per.HarmonicBalance())
    leading, change = seen[0]

    def wave(angle: Array, like: Array) -> Increment:
        values = (np.cos(angle) + 0.3 * np.sin(2 * angle)).ravel()[:, None] * np.ones(like.shape[2])
        return replace(change, algebraic=values.reshape(like.shape))

    count, pieces = change.algebraic[..., 0].size, leading.floquet.given.orbit
    even = wave(2 * np.pi * np.arange(1, count + 1) / count, change.algebraic)
    angle = 2 * np.pi / pieces.mesh.period * pieces.stage_phases
    exact = Leading.start(leading, wave(angle, pieces.algebraic))
    assert own(leading, even) == pytest.approx(exact, rel=1e-9, abs=1e-12)


def test_modes_that_grow_beyond_all_numbers() -> None:
    """Assert that a negative frequency, at which damping drives, is a failure of the iteration."""
    system, orbit = cantilever(10, cubic, damping=0.02), branch(10)[2].orbit
    problem, method = chosen_method(CondensedCollocation().at(1e-6), per.Problem(system, "Omega", (3.0, 8.0)))
    parameter = np.array(orbit.parameter)
    parameter[problem.index] = -0.01
    with pytest.raises(FloatingPointError, match="^modes of the linear part grow beyond all numbers"):
        method.linearise(problem.system, replace(orbit, parameter=parameter), problem.free)
