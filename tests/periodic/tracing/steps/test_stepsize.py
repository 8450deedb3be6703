"""Lengths and bounds of steps, of solutions that are given: values by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.orbit.mesh import EventNode
from periodic.tracing import collapse
from periodic.tracing.continuation import Continuation
from periodic.tracing.steps import foresight, leveltest, overchanges, stepbounds
from periodic.tracing.steps.stepsize import ArclengthControl, rounded
from periodic.tracing.steps.taken import NEARLY, Steps
from periodic.tracing.steps.wayacross import matched


@pytest.mark.parametrize(
    ("ds", "iterations", "ratio", "found"),
    [
        (0.02, 3, 0.0, 0.04),
        (0.02, 4, 0.0, 0.03),
        (0.02, 5, 0.0, 0.024),
        (0.02, 6, 0.0, 0.02),
        (0.02, 7, 0.0, 0.014),
        (0.15, 2, 0.0, 0.2),  # at most ds_max
        (0.02, 3, 0.8, 0.02),  # aims at 0.8 of the bounds
        (0.02, 3, 1.6, 0.01),
        (0.02, 3, 0.5, 0.032),
        (0.001, 3, 0.0, 0.004),  # recovers by 4
        (0.008, 3, 0.0, 0.02),  # up to ds
        (0.001, 4, 0.0, 0.0015),  # only after few iterations
        (1e-7, 9, 8.0, 1e-7),  # at least ds_min
    ],
)
def test_next_step(ds: float, iterations: int, ratio: float, found: float) -> None:
    """Assert the length after so many iterations, and so near the bounds."""
    assert ArclengthControl().next_size(ds, iterations, ratio) == pytest.approx(found, rel=1e-12)


@pytest.mark.parametrize(
    ("ratio", "part"), [(1.01, 0.75), (1.6, 0.5), (2.0, 0.4), (3.2, 0.25), (100.0, 0.25)]
)
def test_part_of_a_rejected_step(ratio: float, part: float) -> None:
    """Assert 0.8 over the ratio, from 0.25 to 0.75."""
    assert ArclengthControl().shorter(ratio) == pytest.approx(part, rel=1e-14)


def test_factors_are_whole_hundredths() -> None:
    """Assert that they are rounded down."""
    assert rounded(1.239999) == 1.23 and rounded(0.999) == 0.99 and rounded(2.0) == 2.0


def test_control_with_another_least_step() -> None:
    """Assert the least step alone is changed, and that the same one is no change."""
    control = ArclengthControl()
    assert control.down_to(1e-9) == replace(control, ds_min=1e-9)
    assert control.down_to(control.ds_min) is control


@pytest.mark.parametrize(
    ("cosine", "angle"),
    [(0.8, 1.0), (1.0, 0.0), (1.5, 0.0), (-2.0, np.pi / np.arccos(0.8)), (0.0, 0.5 * np.pi / np.arccos(0.8))],
)
def test_angles_in_parts_of_the_largest(cosine: float, angle: float) -> None:
    """Assert the angle over that whose cosine is 0.8, cosines beyond 1 being rounding."""
    assert stepbounds._angle(cosine, 0.8) == pytest.approx(angle, abs=1e-14)


@pytest.mark.parametrize(
    ("ends", "rates", "back"),
    [
        ((1.0, 1.0), (-4.0, 4.0), True),  # a parabola down to 0
        ((1.0, 1.0), (-1.9, 1.9), False),  # down to 0.525
        ((1.0, 1.0), (-2.1, 2.1), True),  # down to 0.475
        ((-1.0, -1.0), (4.0, -4.0), True),
        ((1.0, 1.0), (4.0, -4.0), False),
        ((2.0, 1.0), (-1.0, -1.0), False),  # a line
        ((1.0, 1.0), (0.0, 8.0), True),  # 1 - 8 t^2 (1 - t): 8 * 4 / 27 below, at 2/3
        ((1.0, 1.0), (0.0, 3.0), False),  # 0.444 below
        ((1.1, 9.1), (4.0, 12.0), False),  # 4 (t + 0.5)^2 + 0.1, lowest before the step
        ((9.1, 1.1), (-12.0, -4.0), False),  # ... and behind it
    ],
)
def test_cubic_that_comes_near_0(ends: tuple[float, float], rates: tuple[float, float], back: bool) -> None:
    """Assert whether it falls to half the smaller end value between the ends."""
    assert leveltest.comes_back(ends, rates) is back


@pytest.mark.parametrize(
    ("span", "alone", "shrunk"), [(0.19, True, True), (0.21, True, False), (0.19, False, False)]
)
def test_orbit_that_shrank(span: float, alone: bool, shrunk: bool) -> None:
    """Assert that an autonomous orbit of less than a tenth of its guess's span 2 is another one."""
    guess: Any = SimpleNamespace(span=lambda: 2.0)
    found: Any = SimpleNamespace(
        problem=SimpleNamespace(autonomous=alone), orbit=SimpleNamespace(span=lambda: span)
    )
    assert collapse.collapsed(guess, found) is shrunk


def test_event_nodes_correspond_to_the_nearest_alike() -> None:
    """Assert it around the period, and among other events."""

    def sine(tau: Any) -> Any:
        return np.sin(tau)[:, None]

    a, b = EventNode(0, 1), EventNode(1, 1)
    one = along(sine, [(a, 0.1), (b, 2.0), (a, 4.0)])
    other = along(sine, [(b, 1.0), (a, 3.5), (a, 6.2)])
    assert matched(one, other) == [2, 0, 1]


def test_steps_over_changes_are_tried_in_halves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that the whole step, its half and its quarter are tried in turn, while the word changes."""
    tried: list[float] = []

    def over(way: Any, ds: float, course: Any) -> Any:
        tried.append(ds)
        return "over" if ds < 0.11 else None

    monkeypatch.setattr(overchanges._Way, "over", over)
    monkeypatch.setattr(overchanges._Way, "changes", lambda way, ds: ds > 0.01)
    problem = SimpleNamespace(free=(0,), index=0)
    ahead: Any = SimpleNamespace(solver=SimpleNamespace(problem=problem))
    base: Any = SimpleNamespace(orbit=SimpleNamespace(mesh=SimpleNamespace(events=(1,))))
    given: Any = None
    assert overchanges.over_changes(ahead, given, base, 0.4, given) == "over"
    assert tried == [0.4, 0.2, 0.1]
    tried.clear()
    assert overchanges.over_changes(ahead, given, base, 0.2, given) == "over" and tried == [0.2, 0.1]
    tried.clear()
    assert overchanges.over_changes(ahead, given, base, 1.0, given) is None and tried == [1.0, 0.5, 0.25]
    tried.clear()
    assert overchanges.over_changes(ahead, given, base, 0.01, given) is None and not tried
    problem.free = (0, 1)
    assert overchanges.over_changes(ahead, given, base, 0.2, given) is None
    base.orbit.mesh.events, problem.free = (), (0,)
    assert overchanges.over_changes(ahead, given, base, 0.2, given) is None


@pytest.mark.parametrize(
    ("ends", "twice", "between", "passed"),
    [
        ((1.0, -1.0), False, None, True),
        ((1.0, 0.0), True, 0.5, False),
        ((1.0, 1.0), False, 0.5, False),
        ((1.0, 1.0), True, 0.5, True),
        ((1.0, 1.0), True, None, False),
    ],
)
def test_special_points_that_a_step_over_changes_has_passed(
    ends: tuple[float, float],
    twice: bool,
    between: float | None,
    passed: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert it of a change of sign, and of two that are looked for and found."""
    monkeypatch.setattr(overchanges, "sign_between", lambda *_: between)
    base, new = (SimpleNamespace(once=lambda _, value=value: value) for value in ends)
    test: Any = SimpleNamespace(value=None, twice=lambda *_: twice)
    course: Any = SimpleNamespace(returns=lambda *_: False)
    given: Any = None
    assert overchanges._Way(given, given, base, {})._passed(test, new, 1.0, course) is passed  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("begin", "values"),
    [(0.5, [0.1, 0.5, 0.7]), (0.1, [0.1, 0.7]), (0.0, (0.1, 0.7)), (1.0, (0.1, 0.7)), (2.0, (0.1, 0.7))],
)
def test_values_with_a_point(begin: float, values: Any) -> None:
    """Assert the user's, and that of the branch's own start if it lies within the range."""
    problem = SimpleNamespace(low=0.0, high=1.0)
    own: Any = SimpleNamespace(solver=SimpleNamespace(problem=problem), user=(0.1, 0.7))
    assert Steps._values(own, begin) == values


@pytest.mark.parametrize(
    ("grazes", "distance", "wanted", "ds", "least"),
    [
        (False, 0.001, 0.05, 0.05, 1e-7),
        (False, 0.1, 0.05, 0.1, 1e-7),
        (True, 0.1, 0.05, 0.02, 1e-7),
        (False, 1e-9, 1e-9, 1e-9, NEARLY * 1e-9),
    ],
)
def test_step_beyond_a_change(
    grazes: bool, distance: float, wanted: float, ds: float, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert its length and the least one: as long as before, the first one again after grazing."""
    from periodic.tracing import continuation

    beyond = SimpleNamespace(name="beyond")
    found = SimpleNamespace(grazes=grazes, distance=distance, solution=beyond, labels=(), within=0.0)
    monkeypatch.setattr(continuation, "crossed", lambda *_: found)
    monkeypatch.setattr(continuation, "replace", lambda state, **changed: changed)
    change = SimpleNamespace(grazes=False, final=False, last=False, strict=False, nearer=False)
    own: Any = SimpleNamespace(
        state=object(), solver=None, control=ArclengthControl(), collected=["point"], _emitted=lambda *_: None
    )
    own._counted = lambda label: None
    at: Any = SimpleNamespace(end=None, change=change)
    assert list(Continuation._crossed(own, at, wanted)) == ["point"]
    assert own.state["ds"] == pytest.approx(ds, rel=1e-14)
    assert own.state["least"] == pytest.approx(least, rel=1e-14)
    assert (own.state["last"], own.state["kept"]) == (found.solution, 1)


def test_what_is_foreseen_is_read_once() -> None:
    """Assert that a second question for the same base and length reads nothing, and another one does."""
    asked, led = list[float](), list[float]()

    def change(system: Any, orbit: Any, guess: float) -> str:
        asked.append(guess)
        return f"change at {guess}"

    solver: Any = SimpleNamespace(
        problem=SimpleNamespace(system=None), discretisation=SimpleNamespace(change=change)
    )
    ahead = foresight.Foresight(solver)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(foresight, "tangent", lambda problem, base, ds: led.append(ds) or ds)
        base, other = (SimpleNamespace(orbit=None) for _ in range(2))
        assert [ahead.guess(base, 0.1), ahead.guess(base, 0.1)] == [0.1, 0.1] and not asked
        said = [ahead.change(at, ds) for at, ds in ((base, 0.1), (base, 0.1), (base, 0.2), (other, 0.2))]
    assert said == ["change at 0.1", "change at 0.1", "change at 0.2", "change at 0.2"]
    assert asked == led == [0.1, 0.2, 0.2]


@pytest.mark.parametrize("apart", [0.3, 0.1, 1.9e-5, 0.0])
def test_bounds_of_a_step(apart: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert angles over the largest, and the root of the bend, less noise of 10 tolerances, over its bound.

    Orbits have a peak to peak of 2 in units of 1: noise is 2e-5 for a tolerance of 1e-6, the bound 0.1 ds.
    """
    from periodic.stability.multipliers import Stability

    along_branch = SimpleNamespace(
        dot=lambda other, *metric: 4.0, scaled=lambda factor: SimpleNamespace(by=factor)
    )
    tangent = SimpleNamespace(dot=lambda onward, *metric: np.cos(0.1) if onward.by == 0.5 else np.nan)
    monkeypatch.setattr(stepbounds, "way_and_tangent", lambda base, new: (None, along_branch))
    monkeypatch.setattr(stepbounds, "size_of", lambda orbit: 1.0)
    monkeypatch.setattr(stepbounds, "_bend", lambda *_: apart)
    monkeypatch.setattr(stepbounds, "_motion", lambda solution, ds: None)
    monkeypatch.setattr(stepbounds, "rotated", lambda *_: SimpleNamespace(ratio=0.25, ahead=0.5))
    monkeypatch.setattr(stepbounds.codim2, "alignment", lambda base, new: np.cos(0.2))
    orbit = SimpleNamespace(span=lambda: 2.0)
    base: Any = SimpleNamespace(
        orbit=orbit, problem=SimpleNamespace(units=lambda orbit: 1.0), tangent=tangent
    )
    new: Any = SimpleNamespace(discretisation=SimpleNamespace(stability=Stability.MULTIPLIERS))
    control, ds = ArclengthControl(), 0.2
    found = list(stepbounds.bound_ratios(base, new, ds, control, 1e-6))
    largest = np.arccos(0.8)
    exact = np.sqrt(max(apart - 2e-5, 0.0) / (0.1 * ds))
    assert [each.size for each in found] == pytest.approx([0.1 / largest, exact, 0.25, 0.2 / largest])
    assert [each.ahead for each in found] == pytest.approx([0.1 / largest, exact, 0.5, 0.2 / largest])
    new.discretisation.stability = Stability.EIGENVALUES
    assert len(list(stepbounds.bound_ratios(base, new, ds, control, 1e-6))) == 3


@pytest.mark.parametrize(
    ("before", "after", "motion", "curable", "taken"),
    [
        ("ab", "ab", 0.0, 1e-6, True),
        ("ab", "ba", 0.0, 1e-6, True),
        ("ab", "aab", 0.0, 1e-6, False),
        ("ab", "a", 0.0, 1e-6, False),
        ("ab", "ab", 0.0, 1.1e-6, False),
        ("ab", "aab", np.inf, 1e-6, True),
    ],
)
def test_orbit_over_changes_to_the_tolerance(
    before: str, after: str, motion: float, curable: float, taken: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a mesh made for it keeps its events, in whatever order, and that it meets the tolerance."""

    def orbit(events: str) -> Any:
        error = SimpleNamespace(motion=motion, curable=curable)
        return SimpleNamespace(
            ok=True, error=error, orbit=SimpleNamespace(mesh=SimpleNamespace(events=events))
        )

    better = orbit(after)
    monkeypatch.setattr(overchanges, "refined", lambda solver, new, fixed: better if fixed else None)
    own: Any = SimpleNamespace(solver=SimpleNamespace(tolerance=SimpleNamespace(orbit=1e-6)))
    given = orbit(before)
    expected = (better if np.isfinite(motion) else given) if taken else None
    assert overchanges._Way._accurate(own, given) is expected
    better.ok = False
    assert (overchanges._Way._accurate(own, given) is None) is bool(np.isfinite(motion))
