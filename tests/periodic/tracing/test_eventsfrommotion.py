"""Orbits read from motions ahead on a branch: which are tried, in which order, and which is taken."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.bifurcations.label import Label
from periodic.linear.unknowns import parameter_only, size_of
from periodic.orbit.mesh import EventNode
from periodic.tracing import eventsfrommotion
from periodic.tracing.eventsfrommotion import (
    BEFORE,
    FARTHEST,
    MOST_READINGS,
    NEARER,
    _as_far,
    _Search,
    reread,
    worded,
)
from periodic.tracing.steps.patternchange import Crossed
from periodic.tracing.steps.stepsize import ArclengthControl

STEPS = ArclengthControl(ds=0.125, ds_max=0.5)
ORBIT = along(lambda tau: np.sin(tau)[:, None])


def solver(**more: Any) -> Any:
    """A solver of a branch in its parameter 0 between -1 and 2, that changes no word."""
    problem = SimpleNamespace(
        free=(0,),
        index=0,
        system="system",
        bounds=(-1.0, 2.0),
        value=lambda orbit: orbit.parameter[0],
        units=lambda orbit: 3.0,
    )
    method = SimpleNamespace(reworded=lambda *given: None, settles=lambda system: False)
    return SimpleNamespace(problem=problem, discretisation=method, **more)


def solution(parameter: float = 0.5, rate: float = 1.0, **more: Any) -> Any:
    """An orbit with a tangent."""
    orbit = SimpleNamespace(parameter=np.array([parameter]), **more)
    return SimpleNamespace(orbit=orbit, tangent=SimpleNamespace(parameter=rate), ok=True)


@pytest.fixture
def search(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """What is looked for, which is never found; the base is within its limits."""
    calls: list[tuple[Any, ...]] = []

    def found(self: _Search, first: float, read: Any, parts: Any) -> None:
        calls.append((first, getattr(read, "keywords", {}).get("before", "settled"), tuple(parts)))
        assert (self.sign, self.other) == (-1.0, True)

    monkeypatch.setattr(_Search, "found", found)
    monkeypatch.setattr(eventsfrommotion, "off_limits", lambda solver, base, *_: base)
    monkeypatch.setattr(eventsfrommotion, "_distances", lambda *_: (5.0, 4.0, 3.0, 2.0, 1.0))
    return calls


def test_motions_are_read_soon_after_a_while_and_once_settled(search: list[tuple[Any, ...]]) -> None:
    """Assert the three readings with their distances, and nothing where none of them finds an orbit."""
    assert reread(solver(), solution(rate=-2.0), STEPS, None, other=True) is None
    every = (5.0, 4.0, 3.0, 2.0, 1.0)
    assert search == [
        (0.125, BEFORE[0], every),
        (0.125, BEFORE[1], every),
        (0.125, "settled", (4.0, 3.0, 2.0)),
    ]


@pytest.mark.parametrize(("free", "rate"), [((0, 1), 1.0), ((1,), 1.0), ((0,), 0.0)])
def test_motions_have_one_parameter(
    free: tuple[int, ...], rate: float, search: list[tuple[Any, ...]]
) -> None:
    """Assert that nothing is read along curves in two parameters, nor where the parameter stands still."""
    given = solver()
    given.problem.free = free
    assert reread(given, solution(rate=rate), STEPS, None, other=True) is None and not search


def test_first_motion_that_leads_on_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that no further motion is followed."""
    calls: list[Any] = []

    def found(self: _Search, first: float, read: Any, parts: Any) -> str | None:
        calls.append(read)
        return "found" if len(calls) == 2 else None

    monkeypatch.setattr(_Search, "found", found)
    monkeypatch.setattr(eventsfrommotion, "off_limits", lambda solver, base, *_: base)
    monkeypatch.setattr(eventsfrommotion, "_distances", lambda *_: (1.0,))
    assert reread(solver(), solution(), STEPS, None) == "found" and len(calls) == 2  # type: ignore[comparison-overlap]


def test_orbit_moved_within_its_limits_is_taken_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert it with its distance in sizes of the base, and that it is no touch."""
    moved = solution(0.7)
    monkeypatch.setattr(eventsfrommotion, "off_limits", lambda *_: moved)
    monkeypatch.setattr(eventsfrommotion, "distance", lambda problem, base, other: 3.0)
    monkeypatch.setattr(eventsfrommotion, "size_of", lambda base: 4.0)
    found = reread(solver(), solution(), STEPS, None)
    assert found == Crossed(moved, 0.75, False)


def searching(
    monkeypatch: pytest.MonkeyPatch,
    distances: dict[float, list[float]],
    leaps: bool = False,
    away: float = 1.0,
) -> tuple[_Search, Any]:
    """A search that finds orbits at distances, known for each distance ahead; and how it reads motions.

    leaps: whether they have other unstable multipliers than the base. away: how far their tangents lead away
    from it.
    """
    way = SimpleNamespace(dot=lambda tangent, orbit, units, size: tangent * units * size)
    monkeypatch.setattr(eventsfrommotion, "way_and_tangent", lambda base, found: (way, away))
    monkeypatch.setattr(eventsfrommotion, "size_of", lambda orbit: 1.0)
    labels = [Label.BRANCH] if leaps else []
    monkeypatch.setattr(eventsfrommotion, "at_once", lambda base, found: labels)
    monkeypatch.setattr(_Search, "_ahead", lambda self, ds: ds)
    monkeypatch.setattr(_Search, "_solved", lambda self, guess: guess)
    own = _Search(solver(), solution(), 1.0, False)

    def read(near: Any) -> Iterator[Any]:
        yield None
        yield from (Crossed(solution(), apart, False) for apart in distances.get(near, []))

    return own, read


def test_orbit_that_is_near_in_steps_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the first one no farther than twice the distance ahead; none where all are farther."""
    own, read = searching(monkeypatch, {2.0: [2.0 * FARTHEST * 1.01], 1.0: [9.0, FARTHEST, 0.1]})
    found = own.found(2.0, read, (1.0, 0.5, 0.25))
    assert found is not None and found.distance == FARTHEST
    assert own.found(4.0, read, (0.5, 3.0)) is None


@pytest.mark.parametrize(
    ("nearer", "goes_on"), [(FARTHEST * NEARER * 5.0, True), (6.0, False), (None, False)]
)
def test_orbit_farther_off_to_which_the_branch_goes(
    nearer: float | None, goes_on: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a settled motion is taken that comes nearer in proportion at a quarter of the step."""
    own, read = searching(monkeypatch, {1.0: [5.0], NEARER: [] if nearer is None else [nearer]})
    assert own.found(1.0, read, (1.0,)) is None
    monkeypatch.setattr(_Search, "settled", lambda self, near: read(near))
    assert (own.found(1.0, own.settled, (1.0,)) is not None) is goes_on


@pytest.mark.parametrize(("nearer", "taken"), [(0.5, True), (0.9, False), (None, False)])
def test_orbit_with_other_multipliers_comes_nearer_with_the_step(
    nearer: float | None, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that one as near as the step is not taken where a quarter of it leads no nearer."""
    own, read = searching(monkeypatch, {1.0: [1.0], NEARER: [] if nearer is None else [nearer]}, leaps=True)
    assert (own.found(1.0, read, (1.0,)) is not None) is taken


@pytest.mark.parametrize(
    ("leaps", "away", "taken"), [(True, 1.0, True), (True, -1.0, False), (False, -1.0, True)]
)
def test_orbit_beyond_a_fold_is_not_taken(
    leaps: bool, away: float, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert it of one with other multipliers from which the branch leads back to the base.

    On joints 119 the branch went back over itself from there, to where it had begun.
    """
    own, read = searching(monkeypatch, {1.0: [1.0], NEARER: [NEARER]}, leaps, away)
    assert (own.found(1.0, read, (1.0,)) is not None) is taken


def test_orbit_farther_off_with_other_multipliers_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert it of a motion that has not settled, though a quarter of the step leads nearer."""
    own, read = searching(monkeypatch, {1.0: [5.0], NEARER: [1.0]}, leaps=True)
    assert own.found(1.0, read, (1.0,)) is None


@pytest.mark.parametrize(
    ("ds", "ordered", "value"), [(0.25, True, 0.75), (9.0, True, 2.0), (0.25, False, 0.75)]
)
def test_guess_ahead_within_the_bounds(
    ds: float, ordered: bool, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the orbit along the tangent; its phases stay where they are where event nodes would cross."""
    base = SimpleNamespace(orbit=replace(ORBIT, parameter=np.array([0.5])))

    def ahead(problem: Any, base: Any, ds: float) -> Any:
        return replace(base.orbit, nodes=base.orbit.nodes + ds, parameter=base.orbit.parameter + ds)

    def still(problem: Any, base: Any, ds: float) -> Any:
        return replace(ahead(problem, base, ds), nodes=base.orbit.nodes - ds)

    monkeypatch.setattr(eventsfrommotion, "tangent", ahead)
    monkeypatch.setattr(eventsfrommotion, "at_fixed_phases", still)
    monkeypatch.setattr(eventsfrommotion, "in_order", lambda orbit: ordered)
    monkeypatch.setattr(eventsfrommotion, "_as_far", lambda base, ds: ds)
    found = _Search(solver(), base, 1.0, False)._ahead(ds)  # type: ignore[arg-type]
    assert found.parameter.tolist() == [value]
    assert found.nodes == pytest.approx(base.orbit.nodes + (ds if ordered else -ds))
    assert base.orbit.parameter.tolist() == [0.5]


@pytest.mark.parametrize("rates", [(0.0, 0.0), (3.0, -3.0), (-1e6, 2e6)])
def test_lengths_of_excursions_are_no_distance(rates: tuple[float, float]) -> None:
    """Assert the step at which parameter and states are so far off, whatever phases do meanwhile."""
    orbit = along(lambda tau: np.sin(tau)[:, None], [(EventNode(0, 1), 1.0), (EventNode(0, -1), 1.0 + 1e-9)])
    problem = SimpleNamespace(units=lambda orbit: 2.0)
    way = replace(parameter_only(orbit, 0.5), phases=np.array(rates))
    base: Any = SimpleNamespace(problem=problem, orbit=orbit, tangent=way)
    assert _as_far(base, 0.01) == pytest.approx(0.04, rel=1e-12)
    base.tangent = replace(way, profile=np.full_like(orbit.nodes, 0.75 * size_of(orbit)))
    assert _as_far(base, 0.01) == pytest.approx(0.01 / np.hypot(0.25, 0.75), rel=1e-3)


@pytest.mark.parametrize(
    ("error", "rate", "sign", "other", "taken"),
    [
        (1e-9, 1.0, 1.0, False, True),
        (1e-5, 1.0, 1.0, False, False),
        (1e-9, -1.0, 1.0, False, False),
        (1e-9, -1.0, -1.0, False, True),
        (1e-9, 0.0, 1.0, False, False),
        (1e-9, 1.0, 1.0, True, False),
    ],
)
def test_orbit_from_which_the_branch_goes_on(
    error: float, rate: float, sign: float, other: bool, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that an orbit is exact enough, leads the same way, and has another word if that is asked for."""
    found = solution(rate=rate)
    found.error = SimpleNamespace(motion=error)
    monkeypatch.setattr(eventsfrommotion, "worded", lambda *_: found)
    monkeypatch.setattr(eventsfrommotion, "distance", lambda *_: 6.0)
    monkeypatch.setattr(eventsfrommotion, "size_of", lambda _: 3.0)
    monkeypatch.setattr(eventsfrommotion, "same_word", lambda *_: True)
    given = solver(tolerance=SimpleNamespace(orbit=1e-6))
    crossed = _Search(given, solution(), sign, other)._solved(None)  # type: ignore[arg-type]
    assert crossed == (Crossed(found, 2.0, grazes=False) if taken else None)
    found.ok = False
    assert _Search(given, solution(), sign, other)._solved(None) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(("right", "solved"), [(0, 1), (2, 3), (MOST_READINGS, MOST_READINGS + 1), (99, 6)])
def test_word_is_read_again_while_it_is_violated(
    right: int, solved: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that Newton's method begins from each motion, until an orbit keeps its word or five are read."""
    guesses: list[Any] = []

    def fixed(solver: Any, guess: Any, sign: float) -> Any:
        guesses.append(guess)
        motion = 0.0 if len(guesses) > right else np.inf
        return SimpleNamespace(ok=True, error=SimpleNamespace(motion=motion), orbit=guess)

    monkeypatch.setattr(eventsfrommotion, "_fixed", fixed)
    given = solver()
    given.discretisation.reworded = lambda system, orbit: orbit + 1
    assert worded(given, 0, 1.0).orbit == solved - 1  # type: ignore[arg-type, comparison-overlap]
    assert guesses == list(range(solved))


def test_word_that_cannot_be_read_again_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert one solution where no motion gives another word, and where Newton's method fails."""
    calls: list[Any] = []
    found = SimpleNamespace(ok=True, error=SimpleNamespace(motion=np.inf), orbit=None)
    monkeypatch.setattr(eventsfrommotion, "_fixed", lambda *given: calls.append(given) or found)
    assert worded(solver(), None, 1.0) is found and len(calls) == 1  # type: ignore[arg-type]
    found.ok = False
    given = solver()
    given.discretisation.reworded = lambda *_: pytest.fail("a failure has no word")
    assert worded(given, None, 1.0) is found  # type: ignore[arg-type]


def test_motions_that_settle_are_followed_where_the_method_can() -> None:
    """Assert that no motion is settled by a method that does not, and that a word may be none."""
    own = _Search(solver(), solution(), 1.0, False)
    assert list(own.settled(ORBIT)) == [] and list(own.reworded(ORBIT, 3)) == []
    own.solver.discretisation.reworded = lambda *given: given  # type: ignore[method-assign, assignment]
    assert list(own.reworded(ORBIT, 3)) == [("system", ORBIT, 3)]
