"""Increments, metrics, predictions and errors, of orbits that are given: values by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along

from periodic.correction import error as errors
from periodic.correction import identity
from periodic.correction.arclength import ArclengthConstraint
from periodic.correction.error import EXACT, UNKNOWN, ErrorEstimate, _to, shortfall
from periodic.correction.predictor import spaced
from periodic.correction.refinement import Refinement
from periodic.correction.tolerance import Tolerance
from periodic.linear.root import root
from periodic.linear.unknowns import (
    Increment,
    at_fixed_phase,
    length_metric,
    mean_weights,
    metric_weights,
    outer,
    parameter_only,
    size_of,
)
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row

UP, DOWN = EventNode(0, 1), EventNode(0, -1)


def wave(amplitude: float = 1.0, nodes: Any = (), intervals: int = 8) -> Orbit:
    """A sine."""
    return along(lambda tau: amplitude * np.sin(tau)[:, None], nodes, intervals=intervals)


def change(orbit: Orbit, nodes: float, phases: Any = (), parameters: Any = (0.0,)) -> Increment:
    """A change of all states by a number, of phases and of parameters."""
    ones, stages = np.ones_like(orbit.nodes), np.ones_like(orbit.stages)
    return Increment.of(
        orbit,
        nodes * ones,
        nodes * stages,
        np.zeros_like(orbit.algebraic),
        np.array(phases, float),
        np.array(parameters, float),
    )


def test_sums_and_multiples_of_increments() -> None:
    """Assert every part, and the parameters by name."""
    orbit = wave(nodes=[(UP, 0.5), (DOWN, 3.0)])
    both = change(orbit, 1.0, (0.1, 0.2), (3.0, 4.0)) + change(orbit, 2.0, (0.3, 0.4), (1.0, 1.0)).scaled(
        -2.0
    )
    assert both.nodes == pytest.approx(-3.0) and both.stages == pytest.approx(-3.0)
    assert both.phases == pytest.approx([-0.5, -0.6])
    assert both.parameter == 1.0 and both.others.tolist() == [2.0]
    assert sorted(both.save()) == ["algebraic", "nodes", "parameters", "phases", "profile", "stages"]


def test_states_at_fixed_phases() -> None:
    """Assert dx - x' d tau, the mesh points moving with the nodes: all by 0.1 here."""
    orbit = wave(nodes=[(UP, 0.5), (DOWN, 3.0)], intervals=40)
    found = at_fixed_phase(orbit, 2 * np.ones_like(orbit.nodes), np.array([0.1, 0.1]))
    tau = orbit.mesh.nodes(orbit.phases)
    assert found[:, 0] == pytest.approx(2 - 0.1 * np.cos(tau), abs=1e-4)
    still = at_fixed_phase(orbit, orbit.nodes, np.zeros(2))
    assert still == pytest.approx(orbit.nodes)


def test_product_of_increments() -> None:
    """Assert the mean over the period over the size squared, and parameters over their units squared."""
    orbit = wave()
    a, b = change(orbit, 2.0, (), (3.0, 5.0)), change(orbit, 4.0, (), (7.0, 11.0))
    assert a.dot(b, orbit, 2.0) == pytest.approx(8.0 + 21.0 / 4)
    assert a.dot(b, orbit, 2.0, size=2.0) == pytest.approx(2.0 + 21.0 / 4)
    assert a.dot(b, orbit, np.array([2.0, 10.0])) == pytest.approx(8.0 + 21.0 / 4 + 55.0 / 100)
    assert outer(a, change(orbit, 0.0, (), (1.0,)), np.array([2.0, 10.0])) == pytest.approx(0.75)


def test_change_of_the_parameter_alone() -> None:
    """Assert that nothing else changes."""
    found = parameter_only(wave(nodes=[(UP, 1.0)]), 2.5)
    assert found.parameters.tolist() == [2.5] and found.phases.tolist() == [0.0]
    assert not found.nodes.any() and not found.stages.any() and not found.profile.any()


@pytest.mark.parametrize(("amplitude", "size"), [(0.3, 1.0), (1.0, 1.0), (4.0, 4.0)])
def test_unit_of_arclength_is_the_amplitude(amplitude: float, size: float) -> None:
    """Assert that of a sine; at least 1."""
    assert size_of(wave(amplitude, intervals=64)) == pytest.approx(size, rel=1e-2)


def test_steep_parts_of_orbits_with_kinks_count_less() -> None:
    """Assert 1 / (1 + (x' / 5 sizes)^4) of the weight: x' = 5 cos 5 tau there; all of it without kinks."""

    def fast(tau: Any) -> Any:
        return np.sin(10 * tau)[:, None]

    smooth, kinked = along(fast, intervals=80), along(fast, [(UP, 0.0), (DOWN, np.pi)], intervals=80)
    assert metric_weights(smooth) == pytest.approx(mean_weights(smooth), abs=0)
    tau = kinked.mesh.nodes(kinked.phases)
    exact = mean_weights(kinked) / (1 + (10 * np.cos(10 * tau) / 5 / size_of(kinked)) ** 4)
    assert metric_weights(kinked) == pytest.approx(exact, rel=2e-2)


def test_lengths_of_brief_excursions_are_measured() -> None:
    """Assert (0.03 / l)^2 / (1 + (l / 0.02)^4) (d phi_2 - d phi_1), with opposite signs at the two ends."""
    orbit = wave(nodes=[(UP, 1.0), (DOWN, 1.01)])
    weight = (0.03 / 0.01) ** 2 / (1 + 0.5**4)
    rest = 2 * np.pi - 0.01
    other = (0.03 / rest) ** 2 / (1 + (rest / 0.02) ** 4)
    found = length_metric(orbit, np.array([0.1, 0.3]))
    part = weight * 0.2 + other * 0.2
    assert found == pytest.approx([-part, part], rel=1e-9)
    assert length_metric(wave(), np.zeros(0)).shape == (0,)


def test_rate_of_a_number_along_an_increment() -> None:
    """Assert gradient times change, in states, stages, phases and parameters."""
    orbit = wave(nodes=[(UP, 0.5), (DOWN, 3.0)])
    step = change(orbit, 2.0, (0.5, 0.25), (3.0,))
    nodes, stages = np.zeros_like(orbit.nodes), np.zeros_like(orbit.stages)
    nodes[1], stages[0, 0] = 1.0, 10.0
    assert step.rate_of(Row(0.0, nodes, np.array([4.0, 8.0, 100.0]))) == pytest.approx(2 + 2 + 2 + 300)
    assert step.rate_of(Row(0.0, nodes, np.array([4.0, 8.0, 100.0]), stages)) == pytest.approx(326)


def test_increment_on_another_mesh() -> None:
    """Assert the profile interpolated, taken later, and phases only between meshes of the same events."""
    orbit, other = wave(intervals=8), wave(intervals=16)
    ramp = orbit.mesh.nodes(orbit.phases)[:, None]
    step = replace(change(orbit, 0.0, (), (3.0,)), profile=ramp)
    assert step.restricted(orbit, other).profile[:-1, 0] == pytest.approx(other.mesh.nodes(other.phases)[:-1])
    later = step.restricted(orbit, other, np.pi / 2).profile[:, 0]
    assert later[0] == pytest.approx(np.pi / 2) and later[12] == pytest.approx(0.0, abs=1e-12)
    tied = wave(nodes=[(UP, 0.5)])
    moved = change(tied, 0.0, (0.5,), (3.0,))
    assert moved.restricted(tied, tied).phases.tolist() == [0.5]
    assert moved.restricted(tied, tied, 1.0).phases.tolist() == [0.0]
    for other in ([(DOWN, 0.5)], [(UP, 0.5), (DOWN, 2.0)], []):
        blank = moved.restricted(tied, wave(nodes=other)).phases
        assert blank.tolist() == [0.0] * len(other)


def test_arclength_of_a_step() -> None:
    """Assert value and gradient: states that change by 2 all along, the parameter by 3 in units of 10."""
    orbit = wave()
    way = change(orbit, 1.0, (), (0.5,))
    arc = ArclengthConstraint(orbit, way, 0.25, 10.0, 0)
    ahead = replace(orbit, nodes=orbit.nodes + 2.0, parameter=orbit.parameter + 3.0)
    row = arc.linearise(Surfaces([], [[1.0]]), ahead, (0,))  # type: ignore[arg-type]
    assert row.value == pytest.approx(2.0 + 0.5 * 3.0 / 100 - 0.25)
    assert row.nodes.sum() == pytest.approx(1.0) and row.outer == pytest.approx([0.005])
    assert arc.rate(change(orbit, 2.0, (), (3.0,))) == pytest.approx(2.0 + 0.015)
    several = replace(arc, scale=np.array([10.0, 2.0]), direction=change(orbit, 1.0, (), (0.5, 1.0)))
    assert several._rates == pytest.approx([0.005, 0.25])


def test_events_that_merge_are_as_far_apart_as_the_cube() -> None:
    """Assert l (1 + d / 3 l)^3 where a length l = 0.1 changes by d = -0.15: an eighth of it."""
    before = wave(nodes=[(UP, 1.0), (DOWN, 1.1)])
    ahead = replace(before, phases=np.array([1.0, 0.95]))
    found = spaced(before, ahead)
    assert found.phases[1] - found.phases[0] == pytest.approx(0.1 / 8)
    assert before.mesh.segment_lengths(found.phases).sum() == pytest.approx(2 * np.pi)
    for far in (1.05, 0.79):  # in order, and past each other by more than twice the length
        guess = replace(before, phases=np.array([1.0, far]))
        assert spaced(before, guess) is guess
    plain = wave()
    assert spaced(plain, plain) is plain


def test_errors_that_are_compared_with_the_tolerance() -> None:
    """Assert three times the larger of the motion's and the parameter's, and of the multipliers'."""
    error = ErrorEstimate(1e-7, 5e-7, 2e-7, rounding=1e-7, by_orbit=3e-7)
    assert error.motion == pytest.approx(6e-7) and error.worst == pytest.approx(1.5e-6)
    assert error.curable == pytest.approx(1.5e-6) and error.spread == pytest.approx(9e-7)
    lost = replace(error, rounding=2e-7)
    assert lost.curable == pytest.approx(6e-7)
    assert error.blur(5.0, 10.0) == pytest.approx(3 * 2e-7 * 5)
    assert error.blur(-5.0, 10.0) == pytest.approx(3 * 2e-7 * 5)
    assert error.blur(0.0, 10.0) == pytest.approx(3 * 2e-7 * 1)
    assert EXACT.worst == 0.0 and UNKNOWN.worst == np.inf


@pytest.mark.parametrize(
    ("error", "said"),
    [(1e-3, "to 1e-3 only"), (1.1e-3, "to 1e-2 only"), (0.9e-3, "to 1e-3 only"), (np.inf, "not known")],
)
def test_errors_are_said_to_a_power_of_ten(error: float, said: str) -> None:
    """Assert that they are rounded up."""
    assert _to(error) == said


def test_sentence_of_what_falls_short() -> None:
    """Assert how many points, of what, how much, and where."""
    good, bad = ErrorEstimate(1e-9, 1e-9), ErrorEstimate(1e-9, 3e-4)
    assert shortfall([(1.0, good), (2.0, good)], 1e-6, "p") == ""
    assert shortfall([], 1e-6, "p") == ""
    assert (
        shortfall([(1.0, good), (2.0, bad)], 1e-6, "p")
        == "1 of 2 points: multipliers to 1e-3 only, near p = 2"
    )
    far = [(1.0, bad), (2.0, ErrorEstimate(1e-3, 0.0)), (3.0, good)]
    said = "2 of 3 points: orbits to 1e-2 only and multipliers to 1e-3 only, from p = 1 to 2"
    assert shortfall(far, 1e-6, "p") == said


def test_tolerances_that_follow_from_one_number() -> None:
    """Assert Newton's, (1e-2 tol)^(3/4) but not below 1e-7.5, and its share for multipliers."""
    found = Tolerance.of(1e-6)
    assert (found.orbit, found.newton.tolerance) == (1e-6, pytest.approx(1e-6))
    assert found.newton.close == pytest.approx(1e-4) and found.newton.max_iterations == 16
    assert Tolerance.of(1e-10).newton.tolerance == pytest.approx(1e-7 * 10**-0.5)
    assert Tolerance.of(found) is found
    for tol in (0.9e-11, 1.1e-2):
        with pytest.raises(ValueError, match="it must lie between 1e-11 and 0.01"):
            Tolerance.of(tol)
    assert Tolerance.of(1e-2).orbit == 1e-2 and Tolerance.of(1e-11).orbit == 1e-11


@pytest.mark.parametrize("precision", [1e-3, 1e-9])
def test_root_of_a_function(precision: float) -> None:
    """Assert the root of tau^3 - 2 to the precision, few evaluations, and ends that are roots at once."""
    calls: list[float] = []

    def value(tau: float) -> float:
        calls.append(tau)
        return tau**3 - 2

    assert root(value, 0.0, 2.0, precision) == pytest.approx(2 ** (1 / 3), abs=precision)
    assert len(calls) <= 14 and min(calls) >= 0.0 and max(calls) <= 2.0
    assert root(value, 2.0, 0.0, precision) == pytest.approx(2 ** (1 / 3), abs=precision)
    assert root(lambda t: t, 0.0, 1.0, precision) == 0.0 and root(lambda t: t - 1, 0.0, 1.0, precision) == 1.0


def problem_of(*free: float) -> Any:
    """A problem with one free parameter in units."""
    return SimpleNamespace(system=Surfaces([], [[1.0]]), units=lambda _: 2.0, free=(0,), autonomous=False)


def test_distance_of_two_orbits() -> None:
    """Assert the root mean square of the states' difference and the parameters' over its unit, and shifts."""
    one = wave(intervals=64)
    other = replace(one, nodes=one.nodes + 3.0, stages=one.stages + 3.0, parameter=one.parameter + 8.0)
    assert identity.distance(problem_of(), one, other) == pytest.approx(5.0, rel=1e-9)
    cosine = along(lambda tau: np.cos(tau)[:, None], intervals=64)
    assert identity.distance(problem_of(), one, cosine, -np.pi / 2) == pytest.approx(0.0, abs=1e-6)
    assert identity._ahead(problem_of(), one, cosine) == pytest.approx(-0.25, abs=1e-5) or identity._ahead(
        problem_of(), one, cosine
    ) == pytest.approx(0.75, abs=1e-5)


@pytest.mark.parametrize(
    ("error", "apart", "alike"),
    [(1e-4, 5.9e-3, True), (1e-4, 6.1e-3, False), (0.1, 0.099, True), (0.1, 0.101, False)],
)
def test_orbits_that_are_the_same(error: float, apart: float, alike: bool) -> None:
    """Assert thirty errors, at most a twentieth of the peak to peak 2, as the largest distance."""
    one = wave(intervals=64)
    other = replace(one, nodes=one.nodes + apart, stages=one.stages + apart)
    a, b = (SimpleNamespace(orbit=orbit, error=SimpleNamespace(worst=error)) for orbit in (one, other))
    solver = SimpleNamespace(problem=problem_of(), tolerance=SimpleNamespace(orbit=1e-6))
    assert identity.same(solver, a, b) is alike  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("rate", "straight"),
    [(1.0, True), (0.51, True), (0.49, False), (1.99, True), (2.01, False), (-1.0, False)],
)
def test_way_on_which_the_branch_is_straight(
    rate: float, straight: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that d parameter / d arclength changes by no more than a factor of two, and not its sign."""
    found, there = (SimpleNamespace(kernel=SimpleNamespace(parameter=each)) for each in (0.5, 0.5 * rate))
    monkeypatch.setattr(errors._OnBranch, "_moved", lambda *_: None)
    on_branch = errors._OnBranch(problem_of(), lambda _: there, 1.0)  # type: ignore[arg-type, return-value]
    given: Any = None
    assert on_branch._there(found, given) is (there if straight else None)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("ratio", "straight"), [(1.0, True), (1.9, True), (2.0, False), (0.51, True), (0.5, False), (-1.0, False)]
)
def test_way_on_which_a_branch_is_straight(ratio: float, straight: bool) -> None:
    """Assert that d parameter / d arclength changes by less than twice on it."""
    orbit = wave()

    def linearised(rate: float) -> Any:
        return SimpleNamespace(kernel=change(orbit, 0.0, (), (rate,)), orbit=orbit)

    there = linearised(3.0 * ratio)
    problem = SimpleNamespace(system=None, free=(0,))
    on = errors._OnBranch(problem, lambda orbit: there, 1.0)  # type: ignore[arg-type]
    moved = replace(on, solve=lambda given: there)
    patched: Any = moved
    object.__setattr__(patched, "_moved", lambda found, by: orbit)
    assert (patched._there(linearised(3.0), change(orbit, 0.0)) is there) is straight


def test_way_to_where_the_parameter_is_another(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the kernel scaled to it; none where it is more than a tenth of the unit, or an excursion."""
    orbit = wave()
    found: Any = SimpleNamespace(kernel=change(orbit, 2.0, (), (0.5,)), orbit=orbit)
    on: Any = errors._OnBranch(SimpleNamespace(units=lambda orbit: 1.0), None, 1.0)  # type: ignore[arg-type]
    object.__setattr__(on, "_length", lambda found: 4.0)
    way = on._along(found, 0.01)
    assert way is not None and way.parameter == pytest.approx(0.01) and way.nodes == pytest.approx(0.04)
    assert on._along(found, -0.0125) is not None  # 4 * 0.0125 = 0.1 * 0.5
    assert on._along(found, 0.0126) is None and on._along(found, -0.0126) is None
    monkeypatch.setattr(errors, "stretched", lambda orbit, way: 1.1)
    assert on._along(found, 0.01) is None
    still: Any = SimpleNamespace(kernel=change(orbit, 2.0, (), (0.0,)), orbit=orbit)
    assert on._along(still, 0.0) is None


def test_discretisation_without_meshes_of_its_own() -> None:
    """Assert that its orbits are never refined: their mesh fits, and is the finest there is."""
    orbit = wave(intervals=8)
    found = Refinement(orbit, ErrorEstimate(1e-7, 5e-7, 2e-7))
    assert (found.fits, found.mendable, found.exhausted) == (True, True, True)
    assert found.shortfall == "error estimate 6.0e-07 with 8 intervals"
    assert found.refined() is orbit.mesh
