"""The search for a first orbit: what is tried after what, on solvers that are given."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.correction.outcome import FAILURES, Outcome
from periodic.correction.solver import SpentError
from periodic.results.stop import Reason, Stop
from periodic.stability.multipliers import Stability
from periodic.tracing import start
from periodic.tracing.start import BESIDE_BOUND, ELSEWHERE, GROWN, Start


@dataclass(frozen=True)
class Guess:
    """An orbit that is its parameter and a name."""

    parameter: Any
    name: str = "guess"
    mesh: Any = None

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Guess)
            and self.name == other.name
            and list(self.parameter) == list(other.parameter)
        )


def guess(value: float = 2.0, name: str = "guess") -> Guess:
    """An orbit at a value of the first of two parameters, the second 3."""
    return Guess(np.array([value, 3.0]), name)


def outcome(orbit: Any = None, ok: bool = True, motion: float = 0.0, value: float = 2.0) -> Any:
    """What Newton's method makes of a guess."""
    found = SimpleNamespace(
        ok=ok, error=SimpleNamespace(motion=motion), orbit=orbit, outcome=Outcome.SINGULAR, value=value
    )
    found.failed = lambda why: outcome(orbit, False) if why is Outcome.COLLAPSED else None
    return found


@dataclass(frozen=True)
class Problem:
    """A branch in the first of two parameters, from 1 to 5."""

    system: Any = field(
        default_factory=lambda: SimpleNamespace(
            parameters=[SimpleNamespace(name="p"), SimpleNamespace(name="F")]
        )
    )
    parameter: str = "p"
    bounds: tuple[float, float] = (1.0, 5.0)
    autonomous: bool = False
    free: tuple[int, ...] = (0,)

    low = property(lambda self: self.bounds[0])
    high = property(lambda self: self.bounds[1])
    scale = property(lambda self: self.bounds[1] - self.bounds[0])
    index = property(lambda self: 0 if self.parameter == "p" else 1)

    def value(self, orbit: Any) -> float:
        """The parameter."""
        return float(orbit.parameter[self.index])


@dataclass(frozen=True)
class Solving:
    """A solver: at which guesses it finds an orbit, by their names."""

    finds: tuple[str, ...] = ()
    settling: bool = False
    problem: Problem = field(default_factory=Problem)
    tolerance: Any = field(default_factory=lambda: Tolerance())
    discretisation: Any = None
    asked: list[Any] = field(default_factory=list)

    def at_parameter(self, orbit: Any, sign: float) -> Any:
        """The orbit at a guess, if there is one."""
        self.asked.append((orbit, sign))
        return outcome(orbit, orbit.name in self.finds)


@dataclass(frozen=True)
class Tolerance:
    """A tolerance of orbits."""

    orbit: float = 1e-7


def method(settles: bool = False, rest: Any = None, motions: Any = (), others: Any = ()) -> Any:
    """A discretisation that has an equilibrium, motions that settle, and other discretisations."""
    own = SimpleNamespace(
        stability=Stability.MULTIPLIERS,
        settles=lambda system: settles,
        resting=lambda system, near: rest,
        motions=motions,
        alternatives=others,
        reworded=lambda system, orbit: None,
        drifting=lambda system, parameter: ["x", "y"],
    )
    own.guess = lambda system, parameter, orbit: orbit
    own.at = lambda tolerance: own
    return own


def test_first_orbit_that_becomes_another_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the search goes on from the other one, and with what else there is where that fails."""
    asked = list[str]()

    def worded(solver: Any, orbit: Any, sign: float) -> Any:
        asked.append(orbit.name)
        found = outcome(guess(name=f"{orbit.name}'"), orbit.name == "motion''")
        found.outcome = Outcome.CONVERGED if found.ok else Outcome.MOVED
        return found

    monkeypatch.setattr(start, "worded", worded)
    found, _ = searched(Solving(discretisation=method(True, motions=[guess(name="motion")])))
    assert found.ok and asked == ["motion", "motion'", "motion''"]


@pytest.fixture(autouse=True)
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let motions settle to those of the method, and orbits be refined to themselves."""
    for name in ("settled", "settled_or_none"):
        monkeypatch.setattr(start, name, lambda method, system, near: iter(method.motions))
    monkeypatch.setattr(start, "refined", lambda solver, found, fixed=False: found)
    monkeypatch.setattr(start, "worded", lambda solver, orbit, sign: solver.at_parameter(orbit, sign))
    monkeypatch.setattr(start, "held", lambda system, motion: [])
    monkeypatch.setattr(start, "collapsed", lambda near, found: False)
    monkeypatch.setattr(start, "away", lambda *_: (_ for _ in ()).throw(FAILURES[0]("no kernel")))


def nowhere(*given: Any) -> tuple[None, Stop]:
    """A branch without points."""
    return None, Stop(Reason.NO_START, "none")


def searched(solver: Solving, follow: Any = nowhere, search: bool = True) -> tuple[Any, Start]:
    """What is found from a guess, and the search."""
    own = Start(solver, follow, search)  # type: ignore[arg-type]
    return own._found(guess(), 1.0), own  # type: ignore[arg-type]


def test_guess_itself_comes_first() -> None:
    """Assert that nothing else is tried where it leads to an orbit."""
    solver = Solving(("guess",), discretisation=method())
    found, own = searched(solver)
    assert found.ok and solver.asked == [(guess(), 1.0)] and own.tried == []


def test_everything_is_tried_in_order() -> None:
    """Assert a settled motion, rest, other values, and parameters grown from 0, each said."""
    settles = method(rest=guess(name="rest"), motions=[guess(name="settled")])
    solver = Solving(discretisation=settles)
    found, own = searched(solver)
    assert not found.ok
    names = [orbit.name for orbit, _ in solver.asked]
    assert names == ["guess", "rest", *["rest"] * len(ELSEWHERE), "settled", "rest"]
    values = [orbit.parameter[0] for orbit, _ in solver.asked[2:-2]]
    assert values == pytest.approx([2.0] * len(ELSEWHERE))
    assert own.tried == ["rest under the mean load", "other values of p", "a simulation left to settle"]


def test_motions_are_settled_first_where_the_method_does_so() -> None:
    """Assert that each is tried in turn, before rest."""
    motions = [guess(name="settled"), guess(name="settled further")]
    solver = Solving(("settled further",), discretisation=method(True, guess(name="rest"), motions))
    found, own = searched(solver)
    assert found.orbit.name == "settled further" and own.tried == ["a simulation left to settle"]
    assert [orbit.name for orbit, _ in solver.asked] == ["guess", "settled", "settled further"]


def test_motion_that_friction_holds_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it ends the search for motions, with the joints that hold it."""
    monkeypatch.setattr(start, "held", lambda system, motion: ["a", "b"])
    solver = Solving(discretisation=method(False, None, [guess(name="settled")]))
    _, own = searched(solver)
    assert own.tried[-1] == (
        "a simulation left to settle: a and b holds all along, at a place that is not determined"
    )
    assert "settled" not in [orbit.name for orbit, _ in solver.asked]


def test_orbit_that_violates_its_word_is_read_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that its word is read from a motion where the method settles, and not else."""
    calls: list[Any] = []

    def worded(solver: Any, orbit: Any, sign: float) -> Any:
        calls.append(orbit.name)
        return outcome(guess(name="worded"))

    monkeypatch.setattr(start, "worded", worded)
    monkeypatch.setattr(Solving, "at_parameter", lambda self, orbit, sign: outcome(orbit, True, np.inf))
    found, _ = searched(Solving(discretisation=method(True)))
    assert found.orbit.name == "worded" and calls == ["guess"]
    found, _ = searched(Solving(discretisation=method(False)))
    assert found.orbit.name == "guess" and calls == ["guess"]


def test_orbit_that_collapsed_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is not taken, and that at a fold it fails as such."""
    monkeypatch.setattr(start, "collapsed", lambda near, found: True)
    found, _ = searched(Solving(("guess",), discretisation=method()), search=False)
    assert not found.ok


def test_without_a_search_the_word_is_read_or_a_fold_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert no settled motion; the orbit of another word if there is one, else one at a fold."""
    own = method(rest=guess(name="rest"), motions=[guess(name="settled")])
    solver = Solving(("reworded",), discretisation=own)
    found, begun = searched(solver, search=False)
    assert not found.ok and [orbit.name for orbit, _ in solver.asked] == ["guess"] and begun.tried == []
    own.reworded = lambda system, orbit: guess(name="reworded")
    found, _ = searched(solver, search=False)
    assert found.ok and found.orbit.name == "reworded"


@pytest.mark.parametrize(
    ("value", "ok", "taken"),
    [
        (3.0, True, True),
        (3.0, False, False),
        (1.0 - 3.9 * BESIDE_BOUND, True, True),
        (1.0 - 4.1 * BESIDE_BOUND, True, False),
        (5.0 + 3.9 * BESIDE_BOUND, True, True),
        (5.0 + 4.1 * BESIDE_BOUND, True, False),
    ],
)
def test_orbit_at_a_fold(value: float, ok: bool, taken: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is taken within the bounds, or beside them by a millionth of the range."""
    scaled: list[float] = []
    kernel = SimpleNamespace(scaled=lambda sign: scaled.append(sign) or "kernel")
    monkeypatch.setattr(start, "away", lambda system, orbit, multiplier, autonomous: kernel)
    solver: Any = SimpleNamespace(
        problem=Problem(),
        constraint=lambda near, along, ds: (along, ds),
        on=lambda near, given: outcome(near, ok and given == ("kernel", 0.0), value=value),
    )
    first = outcome(ok=False)
    found = Start(solver, nowhere)._at_fold(guess(), -1.0, first)  # type: ignore[arg-type]
    assert (found is not first) is taken and scaled == [-1.0]


@pytest.mark.parametrize(
    ("factor", "reached", "sign", "bounds"),
    [
        (0.5, 2.0, 1, (1.0, 2.0)),
        (2.0, 2.0, -1, (2.0, 4.0)),
        (0.5, 1.9, 1, (1.0, 2.0)),
        (1.0, 2.0, 0, None),
    ],
)
def test_orbit_approached_along_a_branch(factor: float, reached: float, sign: int, bounds: Any) -> None:
    """Assert the branch from a multiple of the wanted value to it, and nothing where it ends before."""
    followed: list[Any] = []

    def follow(solver: Any, begin: Any, way: int, most: Any) -> Any:
        followed.append((begin, way, most, solver.problem.bounds))
        return guess(reached, "reached"), Stop(Reason.BOUND, "")

    solver = Solving(("guess",), discretisation=method(), tolerance=Tolerance(1e-6))
    found = Start(solver, follow)._approached(guess(), factor)  # type: ignore[arg-type]
    if bounds is None:
        assert found is None and followed == []
        return
    assert followed == [(guess(2.0 * factor), sign, None, bounds)]
    assert found == (guess(2.0, "reached") if reached == 2.0 else None)


def test_way_that_cannot_be_resolved_is_followed_loosely() -> None:
    """Assert that it is said where it stopped, and that it goes on with a coarser tolerance."""
    followed: list[Any] = []

    def follow(solver: Any, begin: Any, way: int, most: Any) -> Any:
        followed.append((begin.parameter[0], solver.tolerance.orbit))
        ends = [(guess(1.5), Stop(Reason.INACCURATE, "too fine")), (guess(2.0), Stop(Reason.BOUND, ""))]
        return ends[len(followed) - 1]

    own = Start(Solving(("guess",), discretisation=method()), follow)  # type: ignore[arg-type]
    assert own._approached(guess(), 0.5) == guess(2.0)  # type: ignore[arg-type]
    assert own.shortfall == "at 1.5, on the way there, too fine"
    assert followed == [(1.0, 1e-6), (1.5, 1e-2)]


@pytest.mark.parametrize(
    ("value", "reached", "reason", "said", "yields"),
    [
        (3.0, 3.0, Reason.BOUND, "F grown from 0", True),
        (-3.0, -3.0, Reason.BOUND, "F grown from 0", True),
        (3.0, 1.23456, Reason.SMALL_STEP, "F grown from 0 (to 1.235: why)", False),
        (3.0, 1.0, Reason.MAX_NEWTON, "F grown from 0", False),
    ],
)
def test_parameter_grown_from_0(
    value: float, reached: float, reason: Reason, said: str, yields: bool
) -> None:
    """Assert the branch from 0, whichever sign it has, in 300 steps at most; where it ends is said."""
    followed: list[Any] = []

    def follow(solver: Any, begin: Any, way: int, most: Any) -> Any:
        followed.append(
            (begin.parameter.tolist(), way, most, solver.problem.parameter, solver.problem.bounds)
        )
        return Guess(np.array([2.0, reached])), Stop(reason, "why")

    own = Start(Solving(("guess",), discretisation=method()), follow)  # type: ignore[arg-type]
    found = list(own._grown(Guess(np.array([2.0, value]))))  # type: ignore[arg-type]
    assert followed == [([2.0, 0.0], int(np.sign(value)), GROWN, "F", (0.0, value))]
    assert own.tried == [said] and (found == [Guess(np.array([2.0, reached]))]) is yields


def test_parameters_that_cannot_be_grown() -> None:
    """Assert that one which is 0 is left out, and one without an orbit at 0 is not said."""
    own = Start(Solving(discretisation=method()), nowhere)  # type: ignore[arg-type]
    assert list(own._grown(Guess(np.array([2.0, 0.0])))) == []  # type: ignore[arg-type]
    assert list(own._grown(guess())) == [] and own.tried == []  # type: ignore[arg-type]


@pytest.mark.parametrize("finds", [True, False])
def test_orbit_of_another_discretisation(finds: bool) -> None:
    """Assert that it is a guess for the own one, solved with a loose tolerance first."""
    other = method()
    other.guess = lambda system, parameter, orbit: guess(name="carried over")
    tolerances: list[float] = []

    def at(tolerance: float) -> Any:
        tolerances.append(tolerance)
        return other

    own = method(others=[SimpleNamespace(at=at)])
    own.guess = lambda system, parameter, orbit: guess(name=f"back from {orbit.name}")
    solver = Solving(("carried over", "back from carried over") if finds else (), discretisation=own)
    found = Start(solver, nowhere)._by_others(guess(), 1.0)  # type: ignore[arg-type]
    assert tolerances == [1e-2]
    assert found is None if not finds else found.orbit.name == "back from carried over"  # type: ignore[union-attr, attr-defined]


@pytest.mark.parametrize(("own", "least", "found"), [(1e-7, 1e-2, 1e-2), (1e-1, 1e-2, 1e-1)])
def test_loose_tolerance(own: float, least: float, found: float) -> None:
    """Assert that a tolerance is not made finer."""
    solver = Solving(discretisation=method(), tolerance=Tolerance(own))
    assert Start._loosely(solver, least).tolerance.orbit == found  # type: ignore[arg-type]


def test_what_was_tried_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the outcome alone where nothing else was tried, else what nothing holds, and what was tried."""
    monkeypatch.setattr(start, "open_phase", lambda system, values, parameter: "")
    own = Start(Solving(discretisation=method()), nowhere)  # type: ignore[arg-type]
    assert own.why_not(Outcome.SINGULAR, np.zeros(2)) == Outcome.SINGULAR.value
    own.tried = ["rest", "a simulation"]
    assert own.why_not(Outcome.SINGULAR, np.zeros(2)) == (
        f"{Outcome.SINGULAR.value}; nothing holds x and y; nor was one found from rest, a simulation; "
        "guess=per.sampled(...) takes a motion from a simulation"
    )
    free = Start(Solving(discretisation=method(), problem=Problem(autonomous=True)), nowhere)  # type: ignore[arg-type]
    free.tried = ["rest"]
    assert "nothing holds" not in free.why_not(Outcome.SINGULAR, np.zeros(2))
    monkeypatch.setattr(start, "open_phase", lambda system, values, parameter: f"{parameter} is free")
    own.tried = []
    assert own.why_not(Outcome.SINGULAR, np.zeros(2)) == f"{Outcome.SINGULAR.value}; p is free"


@pytest.mark.parametrize("tried", [[], ["rest", "a simulation"]])
def test_iterations_that_are_spent(tried: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the sentence, with what had been tried by then."""

    def spent(self: Start, *_: Any) -> Any:
        self.tried = tried
        raise SpentError("spent")

    monkeypatch.setattr(Start, "_found", spent)
    also = f", nor yet from {', '.join(tried)}" if tried else ""
    with pytest.raises(SpentError) as refused:
        Start(Solving(discretisation=method()), nowhere).found(guess(), 1.0)  # type: ignore[arg-type]
    assert str(refused.value).startswith(
        f"all before a first orbit: none was found at the start itself{also}; "
    )


def test_orbit_elsewhere_is_from_rest_or_settled() -> None:
    """Assert rest first, then the motions that have settled there, then what Newton's method says."""
    motions: Iterator[Any] = iter([guess(name="settled"), guess(name="settled further")])
    solver = Solving(("settled further",), discretisation=method(True, guess(name="rest"), motions))
    found = Start(solver, nowhere)._there(guess(), 1.0)  # type: ignore[arg-type]
    assert [orbit.name for orbit, _ in solver.asked] == ["rest", "settled", "settled further"] and found.ok
    none = Solving(discretisation=method(True))
    assert not Start(none, nowhere)._there(guess(), 1.0).ok  # type: ignore[arg-type]
    direct = Solving(("guess",), discretisation=method(True, motions=[guess(name="settled")]))
    assert Start(direct, nowhere)._there(guess(), 1.0).orbit == guess()  # type: ignore[arg-type, comparison-overlap]
    assert len(direct.asked) == 1
