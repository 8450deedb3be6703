"""Numbers of orbits and how they are picked, of orbits that are given: by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator
from support.surfaces import along

import periodic as per
from periodic.conditions import extremes
from periodic.conditions.functionals import Component, apart, output_index
from periodic.conditions.twoparameter import augmented
from periodic.conditions.variations import weighted
from periodic.orbit.gradients import collocation_points
from periodic.orbit.row import Row
from periodic.tracing.watch import _rising, slack


@pytest.mark.parametrize(
    ("angle", "value", "level", "found"),
    [
        (False, 3.0, 5.0, -2.0),
        (True, 3.0, -3.0, 6.0 - 2 * np.pi),
        (True, -3.0, 3.0, 2 * np.pi - 6.0),
        (True, 1.0, 0.5, 0.5),
    ],
)
def test_distance_from_a_level(angle: bool, value: float, level: float, found: float) -> None:
    """Assert value - level, of angles between -pi and pi."""
    functional: Any = SimpleNamespace(angle=angle) if angle else SimpleNamespace()
    assert apart(functional, value, level) == pytest.approx(found, abs=1e-14)


def test_outputs_by_name() -> None:
    """Assert the index, and that another name is refused with those there are."""
    system: Any = SimpleNamespace(outputs=[SimpleNamespace(name=name) for name in ("x", "force")])
    assert output_index(system, "force") == 1
    with pytest.raises(
        ValueError, match="output is 'y'; it must be one of x, force|output is 'y'; it must be"
    ):
        output_index(system, "y")


@pytest.mark.parametrize(
    ("order", "phase", "value"),
    [
        (0.0, 0.0, 1.5),
        (1.0, 0.0, 2.0),
        (1.0, np.pi / 2, 3.0),
        (2.0, 0.0, 0.0),
        (3.0, np.pi / 2, -1.0),
        (1.0, np.pi, -2.0),
    ],
)
def test_harmonics_of_a_wave(order: float, phase: float, value: float) -> None:
    """Assert those of 1.5 + 2 cos tau + 3 sin tau - sin 3 tau, to the quadrature of 40 intervals."""
    orbit = along(lambda tau: np.sin(tau)[:, None])
    points = collocation_points(orbit)
    tau = points.phase
    wave = 1.5 + 2 * np.cos(tau) + 3 * np.sin(tau) - np.sin(3 * tau)
    assert wave @ Component("x", order, phase)._weights(orbit, points) == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(("begin", "found"), [(1.0004, 1.0), (1.002, 1.002), (1.0, 1.0)])
def test_stationary_phase_near_another(begin: float, found: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that of cos(tau - 1) by Newton's steps, and the phase itself where there is none within 1e-3."""
    orbit = along(lambda tau: np.sin(tau)[:, None])
    monkeypatch.setattr(extremes.measure, "outputs", lambda system, orbit, tau: np.cos(tau - 1.0)[:, None])
    given: Any = None
    assert extremes._stationary(given, orbit, 0, begin) == pytest.approx(found, abs=1e-8)


@pytest.mark.parametrize(
    ("ends", "rising"),
    [
        ((0.0, 1.0), True),
        ([0, 1], True),
        ((1.0, 1.0), False),
        ((1.0, 0.0), False),
        ((0.0, np.inf), False),
        ((0.0, 1.0, 2.0), False),
        (3.0, False),
        (("a", "b"), False),
    ],
)
def test_limits_are_two_rising_numbers(ends: object, rising: bool) -> None:
    """Assert what is taken for limits."""
    assert _rising(ends) is rising
    assert slack(-5.0) == pytest.approx(5e-12)


@pytest.mark.parametrize("count", [0, -1, True, 1.5])
def test_counts_at_which_a_trace_stops(count: Any) -> None:
    """Assert that they are whole numbers of at least 1."""
    with pytest.raises(ValueError, match="it must be a whole number of at least 1"):
        per.Watch(stop={"LP": count})
    assert per.Watch(stop={"LP": 1}).stop == {"LP": 1}


def test_start_within_the_limits() -> None:
    """Assert that an orbit at a limit, to rounding, may be begun from, and none beyond it."""
    system: Any = SimpleNamespace(parameters=[SimpleNamespace(name="F")])
    watch = per.Watch(limits={"F": (1.0, 2.0)})

    def begun(value: float) -> Any:
        return SimpleNamespace(parameter=np.array([value]))

    for value in (1.0 - 0.9e-12, 1.5, 2.0 + 1.9e-12):
        watch.check(system, begun(value))
    for value in (1.0 - 1.1e-12, 2.0 + 2.1e-12, 0.0):
        with pytest.raises(ValueError, match="F is .* at the start; its limits are 1.0 to 2.0"):
            watch.check(system, begun(value))


def test_limits_as_test_functions() -> None:
    """Assert that each is 0 where the parameter is beyond its limit by rounding, and named by its side."""
    system = LinearOscillator()
    lower, upper = per.Watch(limits={"F": (-3.0, 5.0)}).tests()
    assert [test.name for test in (lower, upper)] == ["lower limit of F", "upper limit of F"]
    assert {test.label for test in (lower, upper)} == {per.Label.END}

    def at(value: float) -> Any:
        orbit = replace(along(lambda tau: np.sin(tau)[:, None]), parameter=np.array([0.8, 0.05, value]))
        return SimpleNamespace(problem=SimpleNamespace(full=system, expand=lambda it: it), orbit=orbit)

    assert [lower.value(at(-3.0)), upper.value(at(5.0))] == pytest.approx([3e-12, -5e-12], rel=1e-3)
    assert [lower.value(at(0.0)), upper.value(at(0.0))] == pytest.approx([3.0, -5.0], rel=1e-11)


@pytest.mark.parametrize(("multiplier", "slope"), [(1.0, 2.0), (-1.0, 0.5)])
def test_singular_with_a_side_condition(
    multiplier: float, slope: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert g and its gradient of K = [slope] beside [4]: g b c = -s1 s2 in the singular directions.

    By hand for the matrix diag(slope, 4), whose least singular direction is the first: bordered there by +-1,
    g = -slope, v = e_1 and w = e_1; the gradient of K is taken with the sign that g has.
    """
    asked: dict[str, Any] = {}

    def gradient(right: Any, left: Any, source: Row, free: tuple[int, ...]) -> Row:
        asked.update(right=right, left=left, source=source, free=free)
        return Row(0.25, np.full((1, 1), 3.0), np.array([7.0]), np.full((1, 1, 1), 5.0))

    closed = SimpleNamespace(
        matrix=np.array([[slope, 0.0]]), functional=lambda row: row.outer, gradient=gradient
    )
    monkeypatch.setattr(augmented, "variations", lambda *_: SimpleNamespace(repeating=lambda mu: closed))
    held = SimpleNamespace(
        linearise=lambda *_: Row(0.0, np.zeros((1, 1)), np.array([0.0, 4.0]), np.zeros((1, 1, 1)))
    )
    given: Any = SimpleNamespace(free=(1,), conditions=[held])
    orbit: Any = SimpleNamespace(equilibrium=False)
    found = augmented._Singular(multiplier, given).linearise(None, orbit, (0,))  # type: ignore[arg-type]
    assert found.value == pytest.approx(-slope - 0.25)
    assert found.stages is not None
    assert [found.nodes[0, 0], found.outer[0], found.stages[0, 0, 0]] == [-3.0, -7.0, -5.0]
    assert np.abs(asked["right"]) == pytest.approx([1.0, 0.0])
    assert np.abs(asked["left"]) == pytest.approx([1.0])
    assert asked["source"].outer == pytest.approx([0.0, 0.0]) and asked["free"] == (0,)


def test_weighted_sum_of_rows() -> None:
    """Assert values, gradients and weights of two rows, and none of none."""
    rows = [Row(2.0, np.full((2, 1), 3.0), np.array([4.0])), Row(-1.0, np.ones((2, 1)), np.array([5.0]))]
    found = weighted(rows, np.array([0.5, -2.0]))
    assert found is not None and found.value == 3.0
    assert found.nodes.tolist() == [[-0.5], [-0.5]] and found.outer.tolist() == [-8.0]
    one = weighted(rows[:1], np.array([3.0]))
    assert one is not None and one.value == 6.0
    assert weighted([], np.zeros(0)) is None
    with pytest.raises(ValueError, match="shorter|longer"):
        weighted(rows, np.ones(1))
