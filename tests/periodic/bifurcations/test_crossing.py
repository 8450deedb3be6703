"""Crossings of branches from both sides, and pairs behind neutral saddles: on steps that are given."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import branchcrossing, location
from periodic.bifurcations.branchcrossing import BRACKETS, crossing
from periodic.bifurcations.label import Label
from periodic.bifurcations.location import _accepted, _behind_saddle, _between_pair_and_saddle
from periodic.bifurcations.turningpoint import Found
from periodic.bifurcations.withinstep import RejectedError
from periodic.correction.outcome import FAILURES, Outcome


class Step:
    """A step whose solutions are their distances; none is known within a gap about the crossing."""

    def __init__(self, place: float, gap: float = 0.0) -> None:
        self.place, self.gap = place, gap
        self.asked: list[float] = []

    def at(self, distance: float, nearest: bool = False) -> Any:
        """The solution at a distance."""
        if abs(distance - self.place) < self.gap:
            raise RejectedError("too near")
        self.asked.append(distance)
        return SimpleNamespace(
            distance=distance,
            once=lambda value: value(distance),
            tangent=Tangent(distance),
            error=SimpleNamespace(worst=abs(distance)),
        )


class Tangent:
    """A tangent that is a number."""

    def __init__(self, number: float) -> None:
        self.number = number

    def scaled(self, factor: float) -> Tangent:
        """Times a factor."""
        return Tangent(factor * self.number)

    def __add__(self, other: Tangent) -> Tangent:
        return Tangent(self.number + other.number)


def vanishing(place: float) -> Any:
    """A function that vanishes there alone, and is curved."""
    return SimpleNamespace(value=lambda at: (at - place) * (1 + 0.1 * at))


@pytest.fixture
def between(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What is asked of the orbit between two others, which is found."""
    calls: list[Any] = []

    def found(within: Any, sides: Any, place: float, ends: Any) -> Any:
        calls.append((sides, place, ends))
        return SimpleNamespace(ok=True)

    monkeypatch.setattr(branchcrossing, "_between", found)
    return calls


def test_crossing_is_never_solved_for(between: list[Any]) -> None:
    """Assert the place, between orbits on either side of it that come nearer in each round."""
    step = Step(0.37, gap=0.9 * 2.0 / 512)
    found = crossing(step, (0.0, 2.0), vanishing(0.37))  # type: ignore[arg-type]
    assert found is not None and found[0] == pytest.approx(0.37, abs=1e-6)
    ((sides, place, ends),) = between
    assert place == found[0] and ends == (0.0, 2.0)
    assert np.diff(sides) == pytest.approx(2 * 2.0 / 512) and sides[0] < 0.37 < sides[1]
    assert len(step.asked) == 2 + 2 * len(BRACKETS)
    reach = [abs(at - 0.37) for at in step.asked[2::2]]
    assert reach[1:] == pytest.approx([2.0 * part for part in BRACKETS[1:]], rel=0.1)


def test_crossing_to_which_the_branch_cannot_be_followed(
    between: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert none where an orbit beside it fails, has the same sign on both sides, or is none in between."""
    assert crossing(Step(0.37, gap=0.01), (0.0, 2.0), vanishing(0.37)) is None  # type: ignore[arg-type]
    same = SimpleNamespace(
        value=lambda at: np.sign(at - 0.2) * (1.0 if at in (0.0, 2.0) else np.sign(at - 0.2))
    )
    assert crossing(Step(9.0), (0.0, 2.0), same) is None and between == []  # type: ignore[arg-type]
    monkeypatch.setattr(branchcrossing, "_between", lambda *_: SimpleNamespace(ok=False))
    assert crossing(Step(0.37), (0.0, 2.0), vanishing(0.37)) is None  # type: ignore[arg-type]

    def fails(*_: Any) -> Any:
        raise FAILURES[0]("singular")

    monkeypatch.setattr(branchcrossing, "_between", fails)
    assert crossing(Step(0.37), (0.0, 2.0), vanishing(0.37)) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(("residual", "outcome"), [(1e-9, Outcome.CONVERGED), (1.1e-8, Outcome.TOO_MANY)])
def test_orbit_between_two_others(residual: float, outcome: Outcome, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the cubic at its place, the tangent a part of the way, and the errors of the worse end."""
    operator = SimpleNamespace(residual=residual, fundamental="fundamental")
    accepted: list[Any] = []
    method = SimpleNamespace(
        linearise=lambda system, orbit, free: operator,
        accepted=lambda system, found: accepted.append(found) or found,
    )
    newton = SimpleNamespace(tolerance=1e-8)
    problem = SimpleNamespace(system=None, free=(0,), units=lambda orbit: 1.0)
    solver = SimpleNamespace(problem=problem, discretisation=method, tolerance=SimpleNamespace(newton=newton))
    step: Any = Step(9.0)
    step.solver, step.base = solver, "base"
    asked: list[Any] = []
    monkeypatch.setattr(branchcrossing, "cubic", lambda *given: asked.append(given) or "orbit")
    monkeypatch.setattr(branchcrossing, "_unit", lambda direction, orbit, units: direction)
    monkeypatch.setattr(branchcrossing, "Between", lambda *given: given)
    found: Any = branchcrossing._between(step, (0.5, 1.0), 0.6, (0.0, 2.0))
    ((_, a, b, width, part, base),) = asked
    assert (a.distance, b.distance, base) == (0.5, 1.0, "base")
    assert (width, part) == (0.5, pytest.approx(0.1))
    assert found[3].number == pytest.approx(0.8 * 0.5 + 0.2 * 1.0)
    assert found[4].distance == 2.0 and found[2].outcome is outcome
    assert (found[2].orbit, found[2].fundamental) == ("orbit", "fundamental")
    assert bool(accepted) is (outcome is Outcome.CONVERGED)


class Pair:
    """Solutions of a step: the sign of the test at distances, and how many multipliers are outside."""

    def __init__(self, pair: float, saddle: float) -> None:
        self.pair, self.saddle = pair, saddle
        self.base = self.at(0.0)

    def at(self, distance: float) -> Any:
        """The test changes sign at the pair and at the saddle; the pair alone passes the circle."""
        sign = float(np.sign((distance - self.pair) * (distance - self.saddle)))
        return SimpleNamespace(outside=2 * (distance > self.pair), once=lambda value: sign, distance=distance)


@pytest.mark.parametrize(("pair", "saddle"), [(0.2, 0.6), (0.7, 0.1), (0.31, 0.32)])
def test_place_between_a_pair_and_a_saddle(
    pair: float, saddle: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert one at which the test has the other sign, by where as many multipliers are outside."""
    monkeypatch.setattr(location, "unstable", lambda solution: solution.outside)
    step: Any = Pair(pair, saddle)
    found = _between_pair_and_saddle(step, step.at(1.0), 1.0)
    assert found is not None and min(pair, saddle) < found < max(pair, saddle)
    alone: Any = Pair(pair, 2.0)
    assert _between_pair_and_saddle(alone, alone.at(1.0), 1.0) is None


@pytest.mark.parametrize(
    ("outside", "known", "gap", "looked"),
    [(2, True, True, True), (0, True, True, False), (2, False, True, False), (2, True, False, False)],
)
def test_pairs_behind_saddles(
    outside: int, known: bool, gap: bool, looked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that they are looked for where the ledger lacks one, on both sides of the place between."""
    monkeypatch.setattr(location, "unstable", lambda solution: solution.outside)
    sought = (location.TORUS,) if known else ()
    monkeypatch.setattr(location, "codim2", SimpleNamespace(sought=lambda new, folds: sought))
    monkeypatch.setattr(location, "entry", lambda solution, label: label)
    monkeypatch.setattr(location, "gaps", lambda entries, folds: entries if gap else [])
    monkeypatch.setattr(location, "_between_pair_and_saddle", lambda *_: 0.4)
    monkeypatch.setattr(location, "_located", lambda within, span, ds, test: [span])
    within: Any = SimpleNamespace(base=SimpleNamespace(outside=0))
    new: Any = SimpleNamespace(outside=outside)
    found = _behind_saddle(within, new, 1.0, [])
    assert found == ([(0.0, 0.4), (0.4, 1.0)] if looked else [])
    monkeypatch.setattr(location, "_between_pair_and_saddle", lambda *_: None)
    assert _behind_saddle(within, new, 1.0, []) == []


def test_solutions_that_are_accepted() -> None:
    """Assert the solution itself up to the tolerance, and both refusals."""
    solver: Any = SimpleNamespace(tolerance=SimpleNamespace(orbit=1e-6))
    found: Any = SimpleNamespace(ok=True, error=SimpleNamespace(motion=1e-6), outcome=Outcome.SINGULAR)
    assert _accepted(solver, found) is found
    found.error.motion = 1.01e-6
    with pytest.raises(RejectedError, match="^the error estimate of a special point exceeds the tolerance$"):
        _accepted(solver, found)
    found.ok = False
    with pytest.raises(RejectedError, match="^the linear system was singular$"):
        _accepted(solver, found)


@pytest.mark.parametrize(
    ("labels", "shrunk", "kept"),
    [
        (["LP", "NS", "PD"], None, 3),
        (["LP", "EP", "PD"], None, 2),
        (["EP", "EP"], None, 1),
        (["LP", "HB", "PD"], 1, 2),
    ],
)
def test_bound_ends_the_points_of_a_step(
    labels: list[str], shrunk: int | None, kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the points up to it, or to the equilibrium to which orbits shrink."""
    base: Any = SimpleNamespace(tangent=SimpleNamespace(parameter=1.0))
    each = [
        Found(
            Label(label),
            0.1 * (k + 1),
            SimpleNamespace(orbit=SimpleNamespace(equilibrium=k != shrunk)),  # type: ignore[arg-type]
        )
        for k, label in enumerate(labels)
    ]
    monkeypatch.setattr(location, "WithinStep", lambda *_: SimpleNamespace(base=base))
    monkeypatch.setattr(location, "_folds", lambda *_: [])
    monkeypatch.setattr(location, "_check_ways", lambda pieces: None)
    monkeypatch.setattr(location, "codim2", SimpleNamespace(sought=lambda new, folds: ()))
    monkeypatch.setattr(location, "_at_values", lambda within, pieces, sought: each[::-1])
    monkeypatch.setattr(location, "_behind_saddle", lambda within, new, ds, found: [])
    found = location.special_points(None, base, base, 1.0, location.Sought([], 0.0))  # type: ignore[arg-type]
    assert found == each[:kept]
