"""A chain of oscillators whose linear part is found in its equations, against all of its states."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from support.kept import kept

import periodic as per
import symbolic as sym


@cache
def chain(count: int, cubic: float = 0.5) -> sym.CompiledSystem:
    """Oscillators coupled to their neighbours, a cubic spring at the first, driven at the last."""
    q = [sym.coordinate(f"q{i}") for i in range(count)]
    parts: list[sym.Part] = []
    for x in q:
        parts += [sym.Mass(x, 1.0), sym.Spring(x, 1.0), sym.Damper(x, 0.05)]
    parts += [sym.Coupling(a, b, 0.2) for a, b in zip(q[:-1], q[1:], strict=True)]
    parts += [sym.CubicSpring(q[0], cubic)] if cubic else []
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(q[-1], 0.2, 1.6)]))


@kept
def branch(split: bool) -> per.Branch:
    """Past the last resonance of three."""
    system = sym.condensed(chain(3)) if split else chain(3)
    return per.trace(system, "Omega", (1.3, 1.0), at=1.1, tol=1e-8)


def test_structure_is_stated() -> None:
    """Assert how much of the model is linear, in words."""
    assert str(sym.structure_of(chain(3))) == "6 states, 5 linear, 1 place"
    assert sym.structure_of(chain(3)).nonlinear == ("q0",)


def test_folds_are_those_of_all_states() -> None:
    """Assert both folds to 9 digits, and the multipliers between them to 7."""
    ours, full = branch(True), branch(False)
    places = [[p.parameter for p in of.points if p.label is per.Label.FOLD] for of in (ours, full)]
    assert len(places[0]) == 2
    assert places[0] == pytest.approx(places[1], rel=1e-11)
    at = [next(p for p in of.points if p.parameter == 1.1) for of in (ours, full)]
    assert at[0].maximum["q0"] == pytest.approx(at[1].maximum["q0"], rel=1e-8)
    assert np.allclose(*(np.sort_complex(p.multipliers) for p in at), rtol=0, atol=1e-7)


def test_motion_of_every_state() -> None:
    """Assert positions and velocities of all masses to 7 digits."""
    ours, full = (next(p.orbit for p in branch(s).points if p.parameter == 1.1) for s in (True, False))
    phases = np.linspace(0, 6, 7)
    value, rate = per.motion(sym.condensed(chain(3)), ours, [0, 2, 4], phases)
    for k in range(3):
        assert np.allclose(value[:, k], full[f"q{k}"](phases / 1.1), rtol=0, atol=1e-7)
        assert np.allclose(rate[:, k], full[f"q{k}'"](phases / 1.1), rtol=0, atol=1e-7)


def test_branch_is_written_and_read(tmp_path: Path) -> None:
    """Assert that a file has the multipliers, more than the states that are left."""
    branch(True).save(tmp_path / "chain.nc")
    read = per.Branch.load(tmp_path / "chain.nc")
    assert len(read.points[0].multipliers) == 6
    assert np.array_equal(read.points[-1].multipliers, branch(True).points[-1].multipliers)


def test_linear_model_is_refused() -> None:
    """Assert one sentence."""
    with pytest.raises(ValueError, match="no state enters the equations nonlinearly"):
        sym.condensed(chain(2, cubic=0.0))


@kept
def whole(condense: bool) -> per.Branch:
    """A chain of ten past a resonance, condensed on the way or not."""
    watch = per.Watch(
        columns={"last": per.PeakToPeak("q9")}, events={"far": per.Level(per.Maximum("q5"), 0.3)}
    )
    method = per.Collocation(condense=condense)
    return per.trace(chain(10), "Omega", (1.3, 1.2), at=1.25, tol=1e-7, method=method, watch=watch)


def test_results_are_of_all_states() -> None:
    """Assert extremes, columns, events, orbits and multipliers of ten oscillators to 7 digits."""
    ours, full = ([p for p in whole(c).points if p.parameter == 1.25][0] for c in (True, False))
    assert ours.orbit.nodes.shape[1] == full.orbit.nodes.shape[1] == 20
    assert ours.maximum == pytest.approx(full.maximum, rel=1e-7)
    assert ours.columns == pytest.approx(full.columns, rel=1e-7)
    assert np.allclose(ours.orbit["q7'"](1.0), full.orbit["q7'"](1.0), rtol=0, atol=1e-7)
    assert np.allclose(*(np.sort_complex(p.multipliers) for p in (ours, full)), rtol=0, atol=1e-7)
    events = [[p.parameter for p in whole(c).labelled("far")] for c in (True, False)]
    assert len(events[0]) == 1
    ours, full = (
        {n: [p.parameter for p in each] for n, each in whole(c).peaks.items()} for c in (True, False)
    )
    assert [len(each) for each in ours.values()] == [0, 2, 2, 2, 2, 2, 2, 2, 4, 4]
    for name, places in ours.items():
        assert places == pytest.approx(full[name], rel=1e-6)
    assert events[0] == pytest.approx(events[1], rel=1e-8)
    assert whole(True).made["method"]["is"] == "CondensedCollocation"


def test_branch_is_taken_up(tmp_path: Path) -> None:
    """Assert that an interrupted branch, read from its file, goes on as if it had not been."""
    given = {"tol": 1e-5, "method": per.Collocation(condense=True)}
    short, long = per.ArclengthControl(max_points=4), per.ArclengthControl(max_points=8)
    begun = per.trace(chain(4), "Omega", (1.3, 1.2), control=short, **given)
    begun.save(tmp_path / "begun.nc")
    read = per.Branch.load(tmp_path / "begun.nc")
    ours = per.trace(chain(4), "Omega", (1.3, 1.2), control=long, guess=read, **given)
    once = per.trace(chain(4), "Omega", (1.3, 1.2), control=long, **given)
    assert [p.parameter for p in ours.points] == pytest.approx([p.parameter for p in once.points], rel=1e-10)


def test_many_states_are_condensed_unasked() -> None:
    """Assert that forty are, six are not, and that a condition elsewhere takes all states."""
    methods = []
    for count, determined in ((20, {}), (3, {}), (20, {"F": per.Level(per.PeakToPeak("q19"), 0.1)})):
        of = per.continuation(per.Problem(chain(count), "Omega", (1.6, 1.5), determined), tol=1e-4)
        methods.append(type(of.solver.discretisation).__name__)
    assert methods == ["CondensedCollocation", "Collocation", "Collocation"]


def test_small_motion_and_time_are_of_all_states() -> None:
    """Assert natural frequencies and a simulation of a condensed system, those of all states."""
    split = sym.condensed(chain(3))
    assert np.array_equal(sym.modes(split).frequencies, sym.modes(chain(3)).frequencies)
    motion = sym.simulate(split, settle=2, samples=20)
    assert np.array_equal(motion["q1"], sym.simulate(chain(3), settle=2, samples=20)["q1"])


def test_what_cannot_be_condensed_is_said() -> None:
    """Assert one sentence each."""
    method = per.Collocation(condense=True)
    with pytest.raises(ValueError, match="condense is True, but no state enters the equations nonlinearly"):
        per.trace(chain(2, cubic=0.0), "Omega", (1.3, 1.2), method=method)
    with pytest.raises(ValueError, match="condense is True, but a condition is on 'q2'"):
        determined = {"F": per.Level(per.Maximum("q2"), 0.1)}
        per.trace(chain(3), "Omega", (1.3, 1.2), method=method, determined=determined)
    with pytest.raises(ValueError, match="condense is 'yes'; it must be True, False or None"):
        per.Collocation(condense="yes")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="condense is False, but the system has its places alone"):
        per.trace(sym.condensed(chain(3)), "Omega", (1.3, 1.2), method=per.Collocation(condense=False))


def test_one_oscillator_is_a_place() -> None:
    """Assert the fold of Duffing's oscillator, whose only mass is the place, to 9 digits."""
    x = sym.coordinate("x")
    parts = [sym.Mass(x, 1.0), sym.Damper(x, 0.1), sym.Spring(x, 1.0), sym.CubicSpring(x, 1.0)]
    system = sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.5)]))
    places = []
    for condense in (True, False):
        method = per.Collocation(condense=condense)
        watch = per.Watch(stop={"LP": 1})
        of = per.trace(system, "Omega", (1.0, 3.0), method=method, tol=1e-9, watch=watch)
        places.append(of.labelled(per.Label.FOLD)[0].parameter)
    assert places[0] == pytest.approx(places[1], rel=1e-9)
