"""Orbits that are refused beyond a change of the pattern of events."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.joints import dry_friction

import periodic as per
from periodic.bifurcations.label import Label
from periodic.correction.solution import Solution
from periodic.system.precision import CONVERGED
from periodic.tracing.steps import patternchange
from periodic.tracing.steps.patternchange import (
    ACROSS,
    CHANGE_ITERATIONS,
    CHANGES_IN_A_STEP,
    FARTHEST_AHEAD,
    FARTHEST_BEYOND,
    MESHES_BEYOND,
    Crossed,
    Reached,
    crossed,
    reached,
    standing,
    undetermined,
)


@pytest.fixture(scope="module")
def solution() -> Solution:
    """An orbit of a mass that friction holds for a while, with its tangent."""
    few = per.ArclengthControl(max_points=2)
    run = per.continuation(per.Problem(dry_friction(), "Omega", (0.6, 0.7)), tol=1e-6, control=few)
    assert len(list(run)) and run.state is not None
    return run.state.last


def test_an_orbit_along_which_event_nodes_alone_move_is_undetermined(solution: Solution) -> None:
    """Assert it of a tangent whose states and parameter are rounding, however long it is."""
    tangent = solution.tangent
    rounding = 1e-13 * tangent.profile, 1e-13 * tangent.parameters
    loose = replace(tangent, profile=rounding[0], parameters=rounding[1], phases=np.ones_like(tangent.phases))
    for factor in (1e-4, 1.0, 1e13):
        assert undetermined(replace(solution, tangent=loose.scaled(factor)))
    assert not undetermined(solution)
    brief = replace(tangent, profile=1e-9 * tangent.profile, parameters=0 * tangent.parameters)
    assert not undetermined(replace(solution, tangent=brief))


def change(part: float = 0.5, strict: bool = False, **more: Any) -> Any:
    """A change of the pattern at a part of the step."""
    return SimpleNamespace(
        **{"part": part, "strict": strict, "condition": "condition", "otherwise": None, **more}
    )


@pytest.mark.parametrize(
    ("found", "stands"),
    [
        (None, False),
        (change(0.0, strict=True), True),
        (change(CONVERGED, strict=True), True),
        (change(2 * CONVERGED, strict=True), False),
        (change(0.0), False),
    ],
)
def test_change_at_the_begin_of_a_step(found: Any, stands: bool) -> None:
    """Assert that the base is the end itself where a switch grazes there, and only there."""
    base: Any = "base"
    assert standing(base, found) == (Reached(base, 0.0, found) if stands else None)


@pytest.fixture
def solving(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """How the orbit at a change is solved for: what succeeds, where it lies, and what was asked."""
    state: dict[str, Any] = {"ok": lambda condition: True, "along": lambda orbit: 0.5, "asked": []}

    def held(solver: Any, guess: Any, on: Any, most: int) -> Any:
        state["asked"].append((guess, on.condition, most))
        return SimpleNamespace(ok=state["ok"](on.condition), orbit=f"orbit at {on.condition}")

    monkeypatch.setattr(patternchange, "_held", held)
    monkeypatch.setattr(patternchange, "progress", lambda solver, base, orbit: state["along"](orbit))
    monkeypatch.setattr(patternchange, "_comes_back", lambda *_: False)
    monkeypatch.setattr(patternchange, "tangent", lambda problem, base, ds: ds)
    monkeypatch.setattr(patternchange, "spaced", lambda orbit, increment: f"{orbit} + {increment:g}")
    return state


def stepping(*earlier: Any) -> tuple[Any, Any]:
    """A solver that finds these changes up to an orbit, one after the other, then none; and a base."""
    left = list(earlier)
    method = SimpleNamespace(change=lambda system, base, orbit: left.pop(0) if left else None)
    problem = SimpleNamespace(system=None)
    return SimpleNamespace(discretisation=method, problem=problem), SimpleNamespace(
        orbit="base", tangent=None
    )


def test_change_within_a_step_is_where_it_ends(solving: dict[str, Any]) -> None:
    """Assert the guess along the tangent, or the one that is given, and the end."""
    own, (solver, base) = change(0.25), stepping()
    found = reached(solver, base, None, 2.0, own)
    assert found is not None
    assert (found.end.orbit, found.ds, found.change) == ("orbit at condition", 0.5, own)
    assert reached(solver, base, "near", 2.0, own) is not None  # type: ignore[arg-type]
    asked = [("base + 0.5", "condition", CHANGE_ITERATIONS), ("near", "condition", CHANGE_ITERATIONS)]
    assert solving["asked"] == asked


@pytest.mark.parametrize(
    ("along", "strict", "ends"),
    [
        (FARTHEST_AHEAD * 2.0, False, True),
        (FARTHEST_AHEAD * 2.0 * (1 + 1e-12), False, False),
        (0.5 * CONVERGED * 2.0, False, False),
        (2 * CONVERGED * 2.0, False, True),
        (0.5 * CONVERGED * 2.0, True, True),
        (0.0, True, True),
        (0.0, False, False),
        (-0.5 * CONVERGED, True, True),
        (-0.5 * CONVERGED, False, False),
        (-CONVERGED, True, False),
        (-0.1, True, False),
    ],
)
def test_change_that_lies_in_the_step(
    along: float, strict: bool, ends: bool, solving: dict[str, Any]
) -> None:
    """Assert that it lies ahead, one that grazes however near, and not much farther than the step.

    One that grazes may lie at the base, which Newton's method knows to CONVERGED only.
    """
    solving["along"] = lambda orbit: along
    solver, base = stepping()
    assert (reached(solver, base, None, 2.0, change(strict=strict)) is not None) is ends


@pytest.mark.parametrize("at_base", [True, False])
def test_change_that_the_branch_comes_back_from(
    at_base: bool, solving: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that there is none, and whether it is said to lie where the step begins."""
    asked: list[Any] = []
    monkeypatch.setattr(patternchange, "_comes_back", lambda found, change, base: asked.append(base) or True)
    solving["along"] = lambda orbit: (1.0 if at_base else 1.5) * CONVERGED * 2.0
    solver, base = stepping()
    assert reached(solver, base, None, 2.0, change(strict=True)) is None and asked == [at_base]


def test_what_a_change_may_be_instead(solving: dict[str, Any]) -> None:
    """Assert that the other condition is tried once Newton's method fails, from a guess of its own."""
    solving["ok"] = lambda condition: condition == "other"
    other = change(0.75, condition="other")
    solver, base = stepping()
    found = reached(solver, base, "near", 2.0, change(otherwise=other))  # type: ignore[arg-type]
    assert found is not None and found.change is other
    assert [each[:2] for each in solving["asked"]] == [("near", "condition"), ("base + 1.5", "other")]
    solving["ok"] = lambda condition: False
    assert reached(solver, base, None, 2.0, change(otherwise=other)) is None


def test_earlier_change_is_taken_first(solving: dict[str, Any]) -> None:
    """Assert that the end is at the first change of the step, solved from the end that missed it."""
    first = change(0.1, strict=True, condition="first")
    solver, base = stepping(first)
    found = reached(solver, base, None, 2.0, change(strict=True))
    assert found is not None and found.change is first
    assert solving["asked"][1][:2] == ("orbit at condition", "first")


@pytest.mark.parametrize(
    ("own", "other", "first"), [(False, False, False), (False, True, True), (True, False, True)]
)
def test_events_that_cross_are_one_change(
    own: bool, other: bool, first: bool, solving: dict[str, Any]
) -> None:
    """Assert that an earlier change counts where one of both is a grazing: else they are the same one."""
    earlier, later = change(0.1, strict=other), change(strict=own)
    solver, base = stepping(earlier)
    found = reached(solver, base, None, 2.0, later)
    assert found is not None and found.change is (earlier if first else later)


def test_changes_without_end_are_given_up(solving: dict[str, Any]) -> None:
    """Assert that no more than eight are tried."""
    solver, base = stepping(*[change(strict=True)] * 20)
    assert reached(solver, base, None, 2.0, change(strict=True)) is None
    assert len(solving["asked"]) == CHANGES_IN_A_STEP


@pytest.mark.parametrize(
    ("strict", "stages", "at_base", "rate", "back"),
    [
        (True, None, False, 1.0, True),
        (True, None, False, -1.0, False),
        (True, None, False, 0.0, False),
        (True, 1.0, False, 1.0, False),
        (True, 1.0, True, 1.0, True),
        (False, None, True, 1.0, False),
    ],
)
def test_branch_that_comes_back(strict: bool, stages: Any, at_base: bool, rate: float, back: bool) -> None:
    """Assert it of a grazing whose condition grows along the branch, of extrema at the base alone."""
    row = SimpleNamespace(stages=stages)
    condition = SimpleNamespace(linearise=lambda system, orbit, free: row)
    found: Any = SimpleNamespace(
        problem=SimpleNamespace(system=None, free=(0,)),
        orbit=None,
        tangent=SimpleNamespace(rate_of=lambda given: rate if given is row else None),
    )
    own = change(strict=strict, condition=condition)
    assert patternchange._comes_back(found, own, at_base) is back


def end(value: float, rate: float, motion: float = 0.0) -> Any:
    """An orbit of a branch: its parameter, how that changes along the branch, and its relative error."""
    return SimpleNamespace(
        value=value, tangent=SimpleNamespace(parameter=rate), error=SimpleNamespace(motion=motion), orbit=None
    )


@pytest.mark.parametrize(
    ("before", "after", "onward"),
    [
        (end(1.0, 1.0), end(1.1, 0.5), True),
        (end(1.0, -1.0), end(0.9, -0.5), True),
        (end(1.0, 1.0), end(1.1, -0.5), False),
        (end(1.0, 1.0), end(0.9, 0.5), False),
        (end(1.0, 1.0, 0.2), end(0.9, 0.5), True),
        (end(1.0, 1.0), end(0.9, 0.5, 0.2), True),
        (end(1.0, 1.0, 0.05), end(0.9, 0.5, 0.05), False),
        (end(-1.0, 1.0, 0.2), end(-1.1, 0.5), True),
        (end(1.0, 1.0), end(1.0, 1.0), True),
        (end(1.0, 0.0), end(1.1, 1.0), False),
    ],
)
def test_parameter_that_goes_on(before: Any, after: Any, onward: bool) -> None:
    """Assert that it changes the same way at both orbits and between them, but for their errors."""
    assert patternchange._onward(before, after) is onward


@pytest.mark.parametrize(("rates", "twice"), [((1.0, 2.0), True), ((-1.0, -2.0), True), ((1.0, -1.0), False)])
def test_branch_that_turns_twice(rates: tuple[float, float], twice: bool) -> None:
    """Assert it where the parameter changes the same way before and after."""
    assert patternchange._folded_twice(end(0, rates[0]), end(0, rates[1])) is twice


def ways(
    *found: tuple[float, float, float] | None, spare: tuple[int, ...] = ()
) -> tuple[list[Any], list[Any]]:
    """Ways beyond a change, and what is found on each: distance, parameter and its rate."""
    each = [SimpleNamespace(number=k, spare=k in spare) for k in range(len(found))]
    orbits = [None if f is None else Crossed(end(f[1], f[2]), f[0], False) for f in found]
    return each, orbits


@pytest.mark.parametrize(
    ("found", "spare", "final", "taken", "tried"),
    [
        ([(0.3, 1.1, 1.0), (0.1, 1.2, 1.0)], (), True, 0, 1),
        ([None, (0.1, 1.2, 1.0)], (), True, 1, 2),
        ([(0.3, 1.1, -1.0), (0.1, 0.9, -1.0)], (), True, 1, 2),
        ([(0.1, 1.1, -1.0), (0.3, 0.9, -1.0)], (), True, 0, 2),
        ([(0.1, 1.1, -1.0), (0.3, 0.9, -1.0)], (), False, None, 2),
        ([(0.1, 1.1, -1.0), (0.3, 1.1, 1.0)], (1,), True, 0, 1),
        ([(0.1, 0.9, 1.0), (0.3, 1.1, 1.0)], (1,), True, 1, 2),
        ([None, (0.3, 1.1, 1.0)], (1,), True, 1, 2),
        ([None, None], (), True, None, 2),
    ],
)
def test_way_beyond_a_change(
    found: Any,
    spare: tuple[int, ...],
    final: bool,
    taken: int | None,
    tried: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert the first that goes on, else the nearest in the end; spare ways only beyond two folds."""
    each, orbits = ways(*found, spare=spare)
    asked: list[int] = []

    def along(solver: Any, at: Any, way: Any) -> Any:
        asked.append(way.number)
        return orbits[way.number]

    monkeypatch.setattr(patternchange, "_along", along)
    own: Any = SimpleNamespace(beyond=lambda system, orbit: iter(each), final=final)
    solver: Any = SimpleNamespace(problem=SimpleNamespace(system=None))
    result = crossed(solver, Reached(end(1.0, 1.0), 0.1, own))
    assert result is (None if taken is None else orbits[taken])
    assert asked == list(range(tried))


PD, NS = Label.DOUBLING, Label.TORUS


@pytest.mark.parametrize(
    ("labels", "spare", "grazes", "taken", "within", "tried"),
    [
        ([[PD], [], [PD]], (), True, 1, 0.3, 2),
        ([[PD], [PD], [PD]], (), True, 0, 0.1, 3),
        ([[PD, NS], [PD], [PD, NS]], (), True, 1, 0.1, 3),
        ([[PD], [PD], []], (2,), True, 0, 0.3, 2),
        ([[PD], []], (), False, 0, 0.4, 1),
        ([[PD], None, None], (), True, 0, 0.4, 3),
    ],
)
def test_excursion_with_fewer_special_points(
    labels: list[list[Label] | None],
    spare: tuple[int, ...],
    grazes: bool,
    taken: int,
    within: float,
    tried: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert that beside a grazing smaller ones are tried, and how near the smallest with as many is."""
    each = [SimpleNamespace(number=k, spare=k in spare) for k in range(len(labels))]
    gaps = (0.4, 0.3, 0.1)
    orbits = [
        None if own is None else Crossed(end(1.0 + gap, 1.0), gap, False, own, gap)
        for own, gap in zip(labels, gaps, strict=False)
    ]
    asked: list[int] = []

    def along(solver: Any, at: Any, way: Any) -> Any:
        asked.append(way.number)
        return orbits[way.number]

    monkeypatch.setattr(patternchange, "_along", along)
    own: Any = SimpleNamespace(beyond=lambda system, orbit: iter(each), final=True, grazes=grazes)
    solver: Any = SimpleNamespace(problem=SimpleNamespace(system=None))
    result, best = crossed(solver, Reached(end(1.0, 1.0), 0.1, own)), orbits[taken]
    assert result is not None and best is not None
    assert result.solution is best.solution and result.labels == best.labels
    assert (result.within, asked) == (within, list(range(tried)))


@pytest.mark.parametrize(
    ("apart", "value", "ds", "grazes", "taken"),
    [
        (FARTHEST_BEYOND, 0.5, 0.0, False, True),
        (1.01 * FARTHEST_BEYOND, 0.5, 0.0, False, False),
        (ACROSS * 0.099, 0.5, 0.1, False, True),
        (ACROSS * 0.101, 0.5, 0.1, False, False),
        (ACROSS * 0.1, 0.5, 0.1, True, False),
        (0.0, 1.0, 0.1, False, True),
        (0.0, 1.01, 0.1, False, False),
        (0.0, -0.01, 0.1, False, False),
    ],
)
def test_orbit_beyond_a_change_is_near(
    apart: float, value: float, ds: float, grazes: bool, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert how far it may be, farther where events only change places, and that it is within bounds."""
    new = SimpleNamespace(ok=True, error=SimpleNamespace(motion=0.0), orbit="new", value=value)
    monkeypatch.setattr(patternchange, "_held", lambda *_: new)
    monkeypatch.setattr(patternchange, "_accurate", lambda solver, found, condition: found)
    monkeypatch.setattr(patternchange, "distance", lambda problem, one, other: 3.0 * apart)
    monkeypatch.setattr(patternchange, "size_of", lambda orbit: 3.0)
    monkeypatch.setattr(patternchange, "at_once", lambda before, after: [Label.DOUBLING])
    solver: Any = SimpleNamespace(
        problem=SimpleNamespace(system=None, low=0.0, high=1.0),
        transfers=lambda orbit, mesh, phases: ["guess"],
        discretisation=SimpleNamespace(change=lambda system, one, other: None),
    )
    way: Any = SimpleNamespace(parameter=None, mesh=None, phases=None, condition=None, grazes=False)
    old: Any = SimpleNamespace(orbit="old", value=0.25)
    at = Reached(old, ds, SimpleNamespace(grazes=grazes))  # type: ignore[arg-type]
    found = patternchange._along(solver, at, way)
    assert (found is not None) is taken
    if found is not None:
        assert found.solution is new and found.distance == pytest.approx(apart) and not found.grazes
        assert found.labels == [Label.DOUBLING] and found.within == abs(value - 0.25)
    new.error.motion = np.inf
    assert patternchange._along(solver, at, way) is None
    new.error.motion, new.ok = 0.0, False
    assert patternchange._along(solver, at, way) is None
    new.ok, solver.discretisation.change = True, lambda system, one, other: "another change"
    assert patternchange._along(solver, at, way) is None


@pytest.mark.parametrize(("errors", "solved"), [([1e-7], 0), ([1e-5, 1e-7], 1), ([1e-5] * 9, MESHES_BEYOND)])
def test_meshes_beyond_a_change(errors: list[float], solved: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that they are made anew as long as the error misses the tolerance, four times at the most."""

    def at(k: int) -> Any:
        mesh = SimpleNamespace(matches=lambda other: False)
        orbit = SimpleNamespace(mesh=mesh, phases=None, number=k)
        refinement = SimpleNamespace(refined=lambda: mesh)
        return SimpleNamespace(
            ok=True, error=SimpleNamespace(curable=errors[k]), orbit=orbit, refinement=refinement
        )

    monkeypatch.setattr(patternchange, "_held", lambda solver, guess, on: at(guess))
    monkeypatch.setattr(patternchange, "Held", lambda guess, condition: SimpleNamespace())
    solver: Any = SimpleNamespace(
        tolerance=SimpleNamespace(orbit=1e-6), transfers=lambda orbit, mesh, phases: [orbit.number + 1]
    )
    assert patternchange._accurate(solver, at(0), None).orbit.number == solved  # type: ignore[arg-type, attr-defined]
