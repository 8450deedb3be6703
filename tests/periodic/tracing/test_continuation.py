"""Continuation: user points, bounds, both directions, and the named reason for every stop."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.kept import kept
from support.numpy_systems import BrokenOscillator, LinearOscillator
from support.traces import DUFFING_A, FINE, STANDARD, duffing, duffing_system, largest_multiplier

import periodic as per
import symbolic as sym

Label, Reason = per.Label, per.Reason
RANGE = (0.3, 3.0)
SYSTEM = duffing_system(*DUFFING_A)
VALUES = (0.5, 1.0, 1.44, 1.6, 1.8, 2.0, 2.2, 2.5)
"""Frequencies asked for; the middle five lie between the folds, on three sheets."""


def labelled(branch: per.Branch, label: per.Label) -> list[float]:
    """Parameter values of the points of one label."""
    return [point.parameter for point in branch.labelled(label)]


@kept
def both_ways() -> per.Branch:
    """Traced from inside the range to both of its ends, the start asked for too."""
    return per.trace(SYSTEM, "Omega", RANGE, start=1.0, at=(1.0, 1.8))


def test_user_points_on_every_sheet() -> None:
    """Assert that every value asked for is hit exactly, once on each sheet, in order along the branch."""
    inside = [value for value in VALUES if 1.4386701455 < value < 2.2119353170]
    expected = [
        *[v for v in VALUES if v < 2.2119353170],
        *inside[::-1],
        *[v for v in VALUES if v > 1.4386701455],
    ]
    assert labelled(duffing(at=VALUES), Label.USER) == expected


def test_user_points_near_a_fold() -> None:
    """Assert that a value 1e-6 inside a fold has its points on all sheets, one 1e-6 outside on one alone."""
    fold = duffing().labelled(Label.FOLD)[0].parameter
    assert (
        labelled(per.trace(SYSTEM, "Omega", (0.9, 2.4), at=(fold - 1e-6,)), Label.USER) == [fold - 1e-6] * 3
    )
    assert labelled(per.trace(SYSTEM, "Omega", (0.9, 2.4), at=(fold + 1e-6,)), Label.USER) == [fold + 1e-6]


def test_many_user_points() -> None:
    """Assert that none of eighty values is missed on a branch without folds."""
    values = tuple(np.linspace(0.41, 1.59, 80))
    branch = per.trace(LinearOscillator(), "Omega", (0.4, 1.6), at=values)
    assert labelled(branch, Label.USER) == list(values)


def test_user_points_are_accurate() -> None:
    """Assert that user points are as accurate as all others."""
    for point in duffing(at=VALUES).labelled(Label.USER):
        assert point.error.worst <= STANDARD.value


def test_value_asked_for_twice() -> None:
    """Assert that a value given twice has one point on each sheet."""
    branch = per.trace(LinearOscillator(), "Omega", (0.4, 1.6), at=(0.8, 0.8))
    assert labelled(branch, Label.USER) == [0.8]


@pytest.mark.parametrize("bounds", [(0.3, 3.0), (3.0, 0.3)])
def test_bounds_are_reached_exactly(bounds: tuple[float, float]) -> None:
    """Assert that a branch begins at its first bound and ends at the other, both labelled EP."""
    branch = duffing(bounds=bounds)
    assert (branch[0].parameter, branch[-1].parameter) == bounds
    assert labelled(branch, Label.END) == list(bounds)
    assert branch.stop.reason is Reason.BOUND and branch.stop_backwards is None


def test_branch_that_returns_to_its_bound() -> None:
    """Assert that a branch which turns back at a fold ends where it leaves the range again."""
    branch = per.trace(
        SYSTEM, "Omega", (1.7, 2.9), start=1.7, guess=duffing(at=(1.7,)).labelled(Label.USER)[0].orbit
    )
    assert len(branch.labelled(Label.FOLD)) == 1
    assert labelled(branch, Label.END) == [1.7, 1.7]
    assert branch.stop.reason is Reason.BOUND
    assert branch.stop.detail == "lower end of the range, where it began: it turned back"
    assert [p.stable for p in branch.labelled(Label.END)] == [True, False]


def test_both_ways_from_inside() -> None:
    """Assert that tracing from inside the range joins two halves into one branch from bound to bound."""
    branch = both_ways()
    assert (branch[0].parameter, branch[-1].parameter) == RANGE
    assert labelled(branch, Label.FOLD) == pytest.approx(labelled(duffing(), Label.FOLD), rel=1e-8)
    assert branch.stop.reason is Reason.BOUND
    assert branch.stop_backwards is not None and branch.stop_backwards.reason is Reason.BOUND
    assert "upper" in str(branch.stop) and "lower" in str(branch.stop_backwards)


def test_joined_branch_has_no_gap() -> None:
    """Assert that neighbours on a joined branch are neighbours indeed, and the start appears once."""
    values = both_ways().values
    start = int(np.flatnonzero(values == 1.0)[0])
    assert (np.diff(values[: start + 1]) >= 0).all()
    assert [p.label for p in both_ways() if p.parameter == 1.0].count(Label.END) == 1


def test_start_that_is_asked_for() -> None:
    """Assert that a user value equal to the start has one point, also where two halves meet."""
    assert labelled(both_ways(), Label.USER) == [1.0, 1.8, 1.8, 1.8]


def test_slope_follows_the_branch() -> None:
    """Assert that the slope has the sign in which the parameter goes on along the branch."""
    for branch in (duffing(), both_ways()):
        for here, after in zip(branch.points[:-1], branch.points[1:], strict=True):
            beside = after if here.label is Label.FOLD else here
            assert (after.parameter - here.parameter) * beside.slope >= 0


def test_residuals_and_errors_are_small() -> None:
    """Assert that no point is accepted with a residual or an error estimate above the tolerance."""
    for point in duffing():
        assert point.residual < 1e-5
        assert point.error.worst <= STANDARD.value
        assert largest_multiplier(point) < np.inf


def test_guess_gives_the_sheet() -> None:
    """Assert that tracing from an orbit of the upper sheet stays on that sheet."""
    high, _, low = (p for p in duffing(at=VALUES).labelled(Label.USER) if p.parameter == 1.8)
    for point in (high, low):
        first = per.trace(SYSTEM, "Omega", (1.8, 1.9), guess=point.orbit)[0]
        assert first.peak_to_peak("x") == pytest.approx(point.peak_to_peak("x"), rel=1e-10)


def test_guess_takes_the_scheme_of_the_settings() -> None:
    """Assert that an orbit of another scheme is carried over to the scheme asked for."""
    scheme = per.Scheme(per.Family.GAUSS, 3)
    orbit = duffing(at=VALUES)[0].orbit
    branch = per.trace(SYSTEM, "Omega", (0.3, 0.35), guess=orbit, method=per.Collocation(scheme=scheme))
    assert {point.orbit.mesh.scheme for point in branch} == {scheme}


@pytest.mark.parametrize("count", [1, 7])
def test_largest_number_of_points(count: int) -> None:
    """Assert that the number of points is limited, and the stop says so."""
    branch = per.trace(SYSTEM, "Omega", RANGE, control=per.ArclengthControl(max_points=count))
    assert len(branch) == count
    assert branch.stop.reason is Reason.MAX_POINTS and branch.stop.reason.numerical
    assert str(branch.stop) == f"largest number of points reached: {count} points"


def test_equations_that_are_not_numbers() -> None:
    """Assert that a system of NaN ends with a named reason and no point."""
    branch = per.trace(BrokenOscillator(), "Omega", (0.4, 1.2))
    assert len(branch) == 0
    assert branch.stop.reason is Reason.NO_START and branch.stop.reason.numerical
    assert "not finite" in str(branch.stop)


def test_equations_that_cease_to_be_numbers() -> None:
    """Assert that a branch whose equations end inside the range ends there, its last point labelled MX."""
    branch = per.trace(BrokenOscillator(limit=0.7), "Omega", (0.4, 1.2))
    assert branch.stop.reason is Reason.SMALL_STEP
    assert branch[-1].label is Label.FAILED
    assert 0.699 < branch[-1].parameter <= 0.7
    assert all(np.isfinite(point.multipliers).all() for point in branch)


def test_tolerance_out_of_reach() -> None:
    """Assert that a first orbit which misses the tolerance is no branch, and that the reason is named."""
    method = per.Collocation(ntst=8, ntst_max=8, scheme=per.Scheme(per.Family.RADAU, 2))
    branch = per.trace(SYSTEM, "Omega", RANGE, tol=per.Tolerance(orbit=1e-12), method=method)
    assert len(branch) == 0
    assert branch.stop.reason is Reason.INACCURATE and branch.stop.reason.numerical


@pytest.mark.parametrize("start, reached", [(None, 5), (1.0, 5), (1.0, 50)])
def test_interruption_keeps_the_points(start: float | None, reached: int) -> None:
    """Assert that an interrupt in either half carries the branch so far, every point reported in it."""
    seen: list[per.Point] = []

    def progress(point: per.Point) -> None:
        seen.append(point)
        if len(seen) == reached:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as interrupted:
        per.trace(SYSTEM, "Omega", RANGE, start=start, watch=per.Watch(progress=progress))
    assert isinstance(interrupted.value, per.Interrupted)
    branch = interrupted.value.branch
    assert branch.stop.reason is Reason.INTERRUPTED and not branch.stop.reason.numerical
    assert {point.parameter for point in branch} <= {point.parameter for point in seen}
    assert len(seen) == reached and len(branch) in (reached, reached - 1)


def test_progress_sees_every_point() -> None:
    """Assert that progress is called once for each point, in the order of tracing."""
    seen: list[per.Point] = []
    branch = per.trace(SYSTEM, "Omega", (0.3, 0.6), watch=per.Watch(progress=seen.append))
    assert tuple(seen) == branch.points


def test_run_is_a_generator() -> None:
    """Assert that points come one at a time, and that a run which the caller leaves has no reason to stop."""
    run = per.continuation(per.Problem(SYSTEM, "Omega", RANGE))
    points = iter(run)
    first = [next(points) for _ in range(3)]
    assert run.stop is None
    assert [point.parameter for point in first] == pytest.approx(duffing().values[:3], rel=1e-2)


def test_any_parameter() -> None:
    """Assert that tracing in the force at 1.8 rad/s meets the three orbits that tracing in frequency has."""
    x = sym.coordinate("x")
    oscillator = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.CubicSpring(x, 1.0)
    system = sym.compile(oscillator + sym.HarmonicForce(x, 0.5, 1.8))
    branch = per.trace(system, "F", (0.05, 1.5), at=(0.5,), tol=FINE)
    found = [point.peak_to_peak("x") for point in branch.labelled(Label.USER)]
    finely = duffing(accuracy=FINE, at=VALUES).labelled(Label.USER)
    known = [p.peak_to_peak("x") for p in finely if p.parameter == 1.8]
    assert found == pytest.approx(known[::-1], rel=1e-9)


def test_the_loop_is_the_users() -> None:
    """Assert that a continuation left goes on where it stood, and ends as one that was not left."""
    run = per.continuation(per.Problem(SYSTEM, "Omega", (0.3, 0.6)))
    for point in run:
        if point.parameter > 0.4:
            break
    assert run.stop is None
    for _ in run:
        pass
    known = per.trace(SYSTEM, "Omega", (0.3, 0.6))
    assert run.stop == known.stop
    assert [p.parameter for p in run.collected] == pytest.approx(known.values, rel=1e-11)
    assert list(run) == []


def test_the_loop_starts_where_the_first_bound_is() -> None:
    """Assert that bounds the other way round begin at the upper one, and progress is told of each point."""
    seen: list[per.Point] = []
    problem, watch = per.Problem(SYSTEM, "Omega", (3.0, 2.8)), per.Watch(progress=seen.append)
    points = list(per.continuation(problem, watch=watch))
    assert points[0].parameter == 3.0 and points[-1].parameter == 2.8
    assert seen == points


def test_the_loop_spends_no_more_than_it_may() -> None:
    """Assert that the largest number of Newton iterations is a named reason there too."""
    run = per.continuation(per.Problem(SYSTEM, "Omega", RANGE), control=per.ArclengthControl(max_newton=40))
    points = list(run)
    assert run.stop == per.Stop.max_newton(40) and 0 < len(run.collected) <= len(points)


def failing(system: per.extend.System, orbit: per.Orbit) -> float:
    """A functional that cannot be called."""
    raise ZeroDivisionError("division by zero")


NEVER = "failed with ZeroDivisionError: division by zero; it must give a number for each orbit"


@pytest.mark.parametrize(
    ("watch", "sentence"),
    [
        (per.Watch(columns={"f": failing}), f"column f {NEVER}"),
        (per.Watch(events={"f": per.Level(failing, 1.0)}), f"event f {NEVER}"),
        (
            per.Watch(events={"f": per.Level(lambda system, orbit: np.nan, 1.0)}),
            "event f gave nan at Omega = 0.3; it must be a finite number",
        ),
    ],
)
def test_functionals_that_fail_are_named(watch: per.Watch, sentence: str) -> None:
    """Assert that a functional of the user's which raises or gives no number is told by its name."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        per.trace(SYSTEM, "Omega", (0.3, 0.6), watch=watch)


@pytest.mark.parametrize(
    ("condition", "sentence"),
    [
        (per.PhaseCondition(), "determined has PhaseCondition(), for orbits whose phase is free; it must be"),
        (
            per.Conservative(),
            "determined has Conservative(), for orbits whose phase is free; it must be left",
        ),
    ],
)
def test_phases_of_excited_systems_are_refused(condition: per.extend.Condition, sentence: str) -> None:
    """Assert that a condition of free oscillations is refused for a system that is excited."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}"):
        per.trace(SYSTEM, "Omega", RANGE, determined={"F": condition})


def test_torus_of_one_state_is_refused() -> None:
    """Assert that a curve of tori is refused where no orbit has two multipliers."""
    system = sym.compile(
        sym.Equations(
            lambda x, p, wave: {"x": p.F * wave.cos - x.x},
            states={"x": 0.0},
            parameters={"Omega": 1.0, "F": 0.5},
            frequency="Omega",
        )
    )
    with pytest.raises(ValueError, match=r"^determined has TorusCondition\(\), which needs two states"):
        per.trace(system, "Omega", (1, 3), determined={"F": per.TorusCondition()})


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"sign": -1}, "sign is -1; from 0.3 it must be 1 to stay in the bounds"),
        ({"watch": per.Watch(journal="kept")}, "watch.journal is 'kept'; only trace keeps a journal"),
        ({"problem": "Omega"}, "problem is 'Omega'; it must be a Problem(system, parameter, bounds)"),
        ({"start": "0.4"}, "start is '0.4'; it must be a number"),
    ],
)
def test_loops_that_are_refused(arguments: dict[str, object], sentence: str) -> None:
    """Assert what a continuation refuses, and in which words."""
    asked = {"problem": per.Problem(SYSTEM, "Omega", RANGE), **arguments}
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        per.continuation(**asked)  # type: ignore[arg-type]


@pytest.mark.parametrize(("asked", "kept"), [({}, False), ({"remesh_below": 0.0}, True)])
def test_meshes_that_are_far_too_fine_are_given_up(asked: dict[str, float], kept: bool) -> None:
    """Assert that 200 intervals, where ten do, are not kept until a new mesh is due, unless asked to."""
    few = per.ArclengthControl(remesh_every=1000, max_points=6, **asked)  # type: ignore[arg-type]
    branch = per.trace(SYSTEM, "Omega", (2.4, 1.3), method=per.Collocation(ntst=200), tol=1e-5, control=few)
    first, last = branch[0].orbit.mesh.ntst, branch[5].orbit.mesh.ntst
    assert first == 200 and (last == first if kept else last <= 32)


def test_continuation_goes_up_from_within_the_range() -> None:
    """Assert the direction that is taken where both are possible and none is given."""
    problem = per.Problem(SYSTEM, "Omega", RANGE)
    inside = RANGE[0] + 0.1 * (RANGE[1] - RANGE[0])
    for sign, ahead in ((None, True), (1, True), (-1, False)):
        run = per.continuation(problem, start=inside, sign=sign)
        first, second = next(run), next(run)
        assert (second.parameter > first.parameter) is ahead
