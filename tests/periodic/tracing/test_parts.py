"""Small functions of tracing: values by hand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

import periodic as per
from periodic.orbit.mesh import EventNode
from periodic.results.stop import Reason, Stop
from periodic.stability.multipliers import Stability
from periodic.system import HELD
from periodic.tracing import eventsfrommotion, heldplaces, settling
from periodic.tracing.ends import ending, homoclinic, retraced
from periodic.tracing.eventsfrommotion import DISTANCES_BEYOND, same_word
from periodic.tracing.start import Start

UP, DOWN, OTHER = EventNode(0, 1), EventNode(0, -1), EventNode(1, 1)


@pytest.mark.parametrize(
    ("autonomous", "stability", "looked_for"),
    [
        (False, Stability.MULTIPLIERS, True),
        (True, Stability.MULTIPLIERS, False),
        (False, Stability.EIGENVALUES, False),
        (True, Stability.EIGENVALUES, False),
    ],
)
def test_rest_under_the_mean_load_is_of_forced_orbits_alone(
    autonomous: bool, stability: Stability, looked_for: bool
) -> None:
    """Assert that free oscillations and equilibria have none, nor what no simulation settles to."""
    method = SimpleNamespace(
        stability=stability,
        resting=lambda system, guess: f"rest of {guess}",
        guess=lambda system, parameter, orbit: f"{orbit}, adopted",
    )
    problem = SimpleNamespace(autonomous=autonomous, system=None)
    solver: Any = SimpleNamespace(problem=problem, discretisation=method)
    rest = SimpleNamespace(parameter=None)
    method.resting = lambda system, guess: rest if guess == "guess" else None
    method.guess = lambda system, parameter, orbit: orbit
    start = Start(solver, lambda *_: (None, None))  # type: ignore[arg-type, return-value]
    assert (start._rest("guess") is rest) is looked_for  # type: ignore[arg-type]
    assert start._rest("at rest") is None  # type: ignore[arg-type]
    if not looked_for:
        assert list(start._settled("guess")) == [] and start.tried == []  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("multipliers", "ties", "near"),
    [
        ([0.5, -0.9], True, False),
        ([1.0, -1.0], True, False),
        ([0.5, -1.5], True, True),
        ([0.8 + 0.8j, 0.8 - 0.8j], True, True),
        ([0.5, 1.5], False, False),
    ],
)
def test_distances_beyond_a_change(
    multipliers: list[complex], ties: bool, near: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that only unstable orbits with impacts are left for short distances alone."""
    monkeypatch.setattr(eventsfrommotion, "tied", lambda system, orbit: [0] if ties else [])
    base: Any = SimpleNamespace(spectrum=SimpleNamespace(multipliers=np.array(multipliers)), orbit=None)
    found = eventsfrommotion._distances(None, base)  # type: ignore[arg-type]
    assert found == ((1e-2, 1e-3, 1e-4) if near else DISTANCES_BEYOND)


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ((), (), True),
        ((UP, DOWN, OTHER), (DOWN, OTHER, UP), True),
        ((UP, DOWN, OTHER), (OTHER, UP, DOWN), True),
        ((UP, DOWN, OTHER), (DOWN, UP, OTHER), False),
        ((UP, DOWN), (UP, DOWN, OTHER), False),
        ((UP,), (), False),
    ],
)
def test_words_that_are_the_same(
    one: tuple[EventNode, ...], other: tuple[EventNode, ...], same: bool
) -> None:
    """Assert that words are compared from wherever they are counted, and modes of meshes too."""

    def orbit(events: tuple[EventNode, ...], modes: Any = ()) -> Any:
        nodes = [(event, 1.0 + k) for k, event in enumerate(events)]
        return along(lambda tau: np.sin(tau)[:, None], nodes, modes, intervals=4 * max(len(nodes), 1))

    assert same_word(orbit(one), orbit(other)) is same
    assert not same_word(orbit(one), orbit(other, [(5, 1)]))


def points(*values: float, **more: Any) -> Any:
    """Points of a branch of which the parameters are known, and whatever else is asked for."""
    error = SimpleNamespace(motion=0.0, blur=lambda parameter, scale: 0.0)
    return [SimpleNamespace(parameter=value, error=error, **more) for value in values]


@pytest.mark.parametrize(
    ("values", "turn"),
    [
        ([1.0, 2.0, 3.0], None),
        ([1.0, 2.0, 3.0, 2.5], 2),
        ([3.0, 2.0, 1.0, 1.5, 2.5], 2),
        ([1.0, 3.0, 2.0, 4.0], 2),
        ([1.0, 2.0, 2.0], None),
        ([2.0, 1.0], None),
        ([1.0], None),
    ],
)
def test_last_turn_of_a_branch(values: list[float], turn: int | None) -> None:
    """Assert the point at which the parameter last began to go the way that it goes now."""
    assert retraced._turn(points(*values)) == turn


@pytest.mark.parametrize(
    ("values", "passed"),
    [
        ([1.0, 2.0, 3.0, 2.5, 1.9], 1),
        ([1.0, 2.0, 3.0, 2.5, 2.0], 1),
        ([1.0, 2.0, 3.0, 2.5, 2.1], None),
        ([1.0, 2.0, 3.0, 2.0, 1.5], None),
        ([1.0, 2.0, 3.0, 3.5], None),
        ([1.0, 3.0, 3.0, 0.5], 0),
        ([3.0, 2.0, 1.0, 1.5, 2.2], 1),
    ],
)
def test_point_before_a_turn_that_is_passed(values: list[float], passed: int | None) -> None:
    """Assert that it is the nearest before the turn, in the step that comes past it first."""
    found = points(*values)
    assert retraced._passed(found) is (None if passed is None else found[passed])


def test_point_before_a_turn_is_farther_off_than_the_errors() -> None:
    """Assert that a point whose orbit differs from the turn's by no more than the errors is passed over."""
    exact = points(1.0, 2.99, 3.0, 2.995, 2.98)
    assert retraced._passed(exact) is exact[1]
    rough = points(1.0, 2.99, 3.0, 2.995, 2.98)
    for point in rough:
        point.error = SimpleNamespace(motion=0.01 / retraced.AT_WORST**2)
    assert retraced._passed(rough) is None
    assert retraced._blur(rough[1], rough[2]) == pytest.approx(2 * 0.01 * 2.99)


def resting(span: float, parameter: float, equilibrium: bool = False) -> Any:
    """A point of an orbit about 1 with a peak to peak."""
    nodes = np.array([[1.0 - span], [1.0]])
    orbit = SimpleNamespace(span=lambda: span, nodes=nodes, equilibrium=equilibrium)
    return SimpleNamespace(orbit=orbit, parameter=parameter)


@pytest.mark.parametrize(
    ("spans", "parameters", "gone"),
    [
        ((1e-10, 1e-14), (0.5, 0.5), True),
        ((1e-10, 1e-12, 1e-14), (0.5, 0.5, 0.5), True),
        ((1e-12, 1e-14), (0.5, 0.5), False),
        ((1e-10, 1e-14), (0.5, 0.501), False),
        ((1e-10, 1e-14, 1e-14), (0.5, 0.501, 0.501), False),
        ((1e-10, 1e-13), (0.5, 0.5), False),
        ((1e-14,), (0.5,), False),
    ],
)
def test_orbits_that_vanish(spans: tuple[float, ...], parameters: tuple[float, ...], gone: bool) -> None:
    """Assert that they shrink by 100 to 100 times rounding while the parameter stands still."""
    problem: Any = SimpleNamespace(scale=1.0)
    found = [resting(span, value) for span, value in zip(spans, parameters, strict=True)]
    assert ending.vanished(problem, found) is gone
    still = [*found[:-1], resting(spans[-1], parameters[-1], equilibrium=True)]
    assert not ending.vanished(problem, still)


def long(omega: float, parameter: float, least: float = 1e-4) -> Any:
    """A point of an orbit of peak to peak 1, whose least speed is given."""
    orbit = SimpleNamespace(
        node_rates=np.array([[least, 0.0], [3.0, 4.0]]),
        span=lambda: 1.0,
        mesh=SimpleNamespace(period=2 * np.pi),
        parameter=np.array([9.0, omega]),
    )
    error = SimpleNamespace(blur=lambda parameter, scale: 1e-9)
    return SimpleNamespace(orbit=orbit, parameter=parameter, error=error)


@pytest.mark.parametrize(
    ("omegas", "parameters", "least", "found"),
    [
        ((1.0, 0.3, 0.09), (0.5, 0.5, 0.5), 1e-4, 2 * np.pi / 0.09),
        ((1.0, 0.3, 0.11), (0.5, 0.5, 0.5), 1e-4, None),
        ((1.0, 0.3, 0.09), (0.5, 0.6, 0.6), 1e-4, None),
        ((1.0, 0.3, 0.09), (0.5, 0.5, 0.5), 1e-2, None),
        ((1.0, 0.3, 0.02), (0.5, 0.6, 0.6), 1e-4, 2 * np.pi / 0.02),
    ],
)
def test_periods_that_grow_without_bound(
    omegas: tuple[float, ...], parameters: tuple[float, ...], least: float, found: float | None
) -> None:
    """Assert that they grow by ten while the parameter stands still, on orbits that nearly rest somewhere."""
    given = [long(omega, value, least) for omega, value in zip(omegas, parameters, strict=True)]
    problem: Any = SimpleNamespace(conditions=(per.PhaseCondition(),), others=(1,), scale=1.0)
    assert homoclinic.period(problem, given) == (None if found is None else pytest.approx(found))
    forced: Any = SimpleNamespace(conditions=(), others=(), scale=1.0)
    assert homoclinic.period(forced, given) is None


@pytest.mark.parametrize(
    ("up", "down", "centre", "reached"),
    [(-0.5, 0.5, 0.0, False), (-0.2, 0.8, 0.6, False), (0.0, 1.0, 1.0, True), (-1.0, 0.0, -1.0, True)],
)
def test_pull_on_a_joint(up: float, down: float, centre: float, reached: bool) -> None:
    """Assert how far off the middle of its limits it is pulled, and whether it is at one of them."""
    pull = heldplaces._Pull(up, down)
    assert (pull.off_centre, pull.reached) == (pytest.approx(centre), reached)


def test_pulls_along_an_orbit() -> None:
    """Assert the releases sin tau - 2 and sin tau + 4 where they are nearest to 0, over their distance 6."""
    own = joint(place=(0, ((0, 1.0),)))
    system: Any = Surfaces([own], [[1.0]] * 3, [0.0, -2.0, 4.0])
    orbit = along(lambda tau: np.sin(tau)[:, None], modes=[(0, HELD)])
    (pull,) = heldplaces._pulls(system, orbit, [own])
    assert (pull.up, pull.down) == (pytest.approx(-1 / 6, abs=1e-6), pytest.approx(0.5, abs=1e-6))
    assert heldplaces._off_centre(system, orbit, [own]) == pytest.approx([1 / 3], abs=1e-6)
    assert heldplaces._room(system, orbit, [own]) == pytest.approx([1 / 6], abs=1e-6)
    assert heldplaces._room(system, orbit, [own], max) == pytest.approx([0.5], abs=1e-6)
    assert heldplaces._held(system, orbit) == [own] and heldplaces.at_limit(system, orbit) == []
    assert heldplaces.unplaced(system, orbit, orbit.mesh) == []
    loose = along(lambda tau: np.sin(tau)[:, None])
    assert heldplaces.unplaced(system, orbit, loose.mesh) == [own]
    assert heldplaces._held(system, loose) == []
    near: Any = Surfaces([own], [[1.0]] * 3, [0.0, -1.0, 4.0])
    assert heldplaces.at_limit(near, orbit) == [own]


@dataclass(frozen=True)
class Placed:
    """A problem."""

    system: Any
    parameter: str = "Omega"
    bounds: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True)
class Solving:
    """A solver of it."""

    problem: Placed


def test_places_that_are_moved() -> None:
    """Assert the least step by which a measure changes as wanted: half each where two places do the same."""
    found = heldplaces._solved(np.array([[2.0, 2.0], [2.0, 2.0]]), np.array([4.0, 4.0]))
    assert found == pytest.approx([1.0, 1.0])
    asked: list[Any] = []
    own, other = joint(place=(1, ())), joint(1, 3, place=(0, ()))
    orbit = along(lambda tau: np.sin(tau)[:, None])
    solution: Any = SimpleNamespace(orbit=replace(orbit, parameter=np.array([1.0, 2.0, 3.0])))

    solved = SimpleNamespace(ok=True)

    def solve(solver: Any, guess: Any, sign: float) -> Any:
        asked.append((guess.parameter.tolist(), sign))
        return solved

    step = np.array([0.5, 0.25])
    assert heldplaces._moved(None, solution, [own, other], step, -1.0, solve) is solved  # type: ignore[arg-type, comparison-overlap]
    assert asked == [([1.25, 2.5, 3.0], -1.0)]


@pytest.mark.parametrize(
    ("farthest", "most", "reached"),
    [
        (8.0, 4, [8.0]),
        (4.0, 4, [8.0, 4.0, 8.0]),
        (2.0, 1, [8.0, 4.0]),
        (2.0, 2, [8.0, 4.0, 2.0, 4.0, 8.0, 6.0, 8.0]),
    ],
)
def test_moves_are_made_in_parts(farthest: float, most: int, reached: list[float]) -> None:
    """Assert where orbits are sought on a way of 8 if none is found from farther off, and how it ends."""
    asked: list[float] = []
    own, base = joint(place=(0, ())), along(lambda tau: np.sin(tau)[:, None])

    def solve(solver: Any, guess: Any, sign: float) -> Any:
        (place,) = guess.parameter
        asked.append(float(place))
        ok = bool(abs(guess.nodes[0, 0] - place) <= farthest)  # the nodes say from where
        return SimpleNamespace(ok=ok, orbit=replace(guess, nodes=guess.nodes * 0 + place))

    orbit = replace(base, nodes=base.nodes * 0, parameter=np.array([0.0]))
    begun: Any = SimpleNamespace(orbit=orbit, ok=True)
    found = heldplaces._moved(None, begun, [own], np.array([8.0]), 1.0, solve, most)  # type: ignore[arg-type]
    assert asked == reached
    assert found.ok is (reached[-1] == 8.0)


@pytest.mark.parametrize(
    ("ends", "reached"),
    [
        ([(0.9, Reason.MAX_POINTS), (0.6, Reason.MAX_POINTS), (0.4, Reason.MAX_POINTS)], 0.4),
        ([(0.9, Reason.MAX_POINTS), (0.95, Reason.MAX_POINTS)], 0.9),
        ([(0.9, Reason.SMALL_STEP)], 0.9),
        ([(0.9, Reason.MAX_POINTS), (None, Reason.NO_START)], 0.9),
        ([(1.1, Reason.MAX_POINTS)], None),
        ([(-0.3, Reason.MAX_POINTS)], -0.3),
    ],
    ids=["half as far off", "farther off again", "ended", "no orbit", "the other way", "past the middle"],
)
def test_branches_in_a_place(
    ends: list[tuple[float | None, Reason]], reached: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert how far a branch is followed that begins 1 off the middle."""
    own = joint(place=(1, ()))
    base = replace(along(lambda tau: np.sin(tau)[:, None], modes=[(0, HELD)]), parameter=np.array([0.0, 1.0]))
    left, asked = list(ends), list[tuple[float, int]]()

    def follow(solver: Any, orbit: Any, way: int, most: int | None) -> Any:
        assert (solver.problem.parameter, most) == ("place", heldplaces.FOLLOWED)
        assert solver.problem.bounds == pytest.approx((-1.0, 3.0), abs=1e-2)
        asked.append((float(orbit.parameter[1]), way))
        off, reason = left.pop(0)
        found = None if off is None else replace(base, parameter=np.array([0.0, off]))
        return found, Stop(reason, "said")

    monkeypatch.setattr(heldplaces, "_off_centre", lambda system, orbit, held: orbit.parameter[1:])
    system = SimpleNamespace(parameters=[SimpleNamespace(name="Omega"), SimpleNamespace(name="place")])
    found = heldplaces._along_place(Solving(Placed(system)), base, own, -1, follow)  # type: ignore[arg-type]
    assert (None if found is None else float(found.parameter[1])) == reached
    before = [1.0, *(off for off, _ in ends if off is not None)]
    assert asked == [(place, -1) for place in before[: len(ends) - len(left)]]


def test_branches_in_a_place_that_creep_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that one is followed a limited number of times, however near to the next orbit each is."""
    own, asked = joint(place=(1, ())), list[float]()
    base = replace(along(lambda tau: np.sin(tau)[:, None], modes=[(0, HELD)]), parameter=np.array([0.0, 1.0]))

    def follow(solver: Any, orbit: Any, way: int, most: int | None) -> Any:
        asked.append(float(orbit.parameter[1]))
        return replace(base, parameter=np.array([0.0, asked[-1] - 1e-6])), Stop(Reason.MAX_POINTS, "said")

    monkeypatch.setattr(heldplaces, "_off_centre", lambda system, orbit, held: orbit.parameter[1:])
    system = SimpleNamespace(parameters=[SimpleNamespace(name="Omega"), SimpleNamespace(name="place")])
    found = heldplaces._along_place(Solving(Placed(system)), base, own, 1, follow)  # type: ignore[arg-type]
    assert found is not None and len(asked) == heldplaces.MOST_FOLLOWED


def test_a_branch_in_a_place_leads_away_from_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that one that stays at the limit, nearer by rounding, is left for the one the other way."""
    own, solution = joint(place=(0, ())), SimpleNamespace(orbit="limit")
    ways = {1: "limit", -1: "away"}
    monkeypatch.setattr(heldplaces, "_along_place", lambda solver, orbit, surface, way, follow: ways[way])
    monkeypatch.setattr(heldplaces, "at_limit", lambda system, orbit: [own] if orbit == "limit" else [])
    monkeypatch.setattr(heldplaces, "_fixed", lambda solver, orbit, sign: SimpleNamespace(orbit=orbit))
    monkeypatch.setattr(heldplaces, "_valid", lambda moved: True)
    given: Any = Solving(Placed(None)), solution, [own], 1.0, None
    found = heldplaces._followed(*given)
    assert found is not None and found.orbit == "away"  # type: ignore[comparison-overlap]
    ways[-1] = "limit"
    assert heldplaces._followed(*given) is None


@pytest.mark.parametrize(
    ("ok", "motion", "centre", "better"),
    [
        (True, 1e-9, 0.1, True),
        (True, 1e-9, -0.2, False),
        (True, np.inf, 0.1, False),
        (False, 1e-9, 0.1, False),
    ],
)
def test_moves_that_are_better(
    ok: bool, motion: float, centre: float, better: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that an orbit is found that does not violate its word and whose joints are nearer the middle."""
    monkeypatch.setattr(heldplaces, "_off_centre", lambda *_: np.array([0.05, centre]))
    moved: Any = SimpleNamespace(ok=ok, error=SimpleNamespace(motion=motion), orbit=None)
    assert heldplaces._better(moved, None, [], np.array([0.2, 0.0])) is better  # type: ignore[arg-type]


def test_joints_that_hold_a_motion_at_no_place() -> None:
    """Assert the names of jumps along which it slides all the time; a joint with a place holds it there."""
    placed, alone = joint(1, 3, place=(0, ())), joint(2, 6, alone=True)
    weights = [[0.0, 1.0]] * 9
    system: Any = Surfaces([joint(), placed, alone], weights)
    still = along(lambda tau: np.column_stack([np.sin(tau), 0 * tau]))
    assert settling.held(system, still) == ["s0"]
    moving = along(lambda tau: np.column_stack([np.sin(tau), 1e-3 * np.cos(tau)]))
    assert settling.held(system, moving) == []
