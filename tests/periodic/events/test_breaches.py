"""Violations at event nodes, of orbits that are given functions: by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events import twinguards, violations
from periodic.events.modes import sides
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.violations import Breach, Violation
from periodic.orbit.mesh import EventNode
from periodic.orbit.scheme import Array
from periodic.system import HELD, PLUS, STUCK, Kind
from periodic.system.events import Surface

STOP, UP, DOWN = EventNode(0, -1, modes=((0, STUCK),)), EventNode(1, 1), EventNode(2, -1)


def sine(tau: Array) -> Array:
    """x = sin tau."""
    return np.sin(tau)[:, None]


@pytest.mark.parametrize(
    ("kind", "breach"), [(Kind.KINK, Breach.REVERSED), (Kind.JUMP, Breach.HELD), (Kind.IMPACT, Breach.GRAZED)]
)
def test_nodes_at_which_a_switch_goes_the_other_way(kind: Kind, breach: Breach) -> None:
    """Assert the breach and the slope: sin tau rises at 0 with 1, and falls at pi."""
    system = Surfaces([Surface(kind, "s", 0)], [[1.0]], directions=[-1])
    for phase, way, wrong in ((0.0, 1, False), (0.0, -1, True), (np.pi, -1, False), (np.pi, 1, True)):
        found = violations.at_nodes(system, along(sine, [(EventNode(0, way), phase)]))
        assert [(v.breach, v.at, v.side) for v in found] == ([(breach, 0, way)] if wrong else [])
        assert [v.depth for v in found] == pytest.approx([1.0] * wrong, abs=1e-5)


def test_relay_whose_thresholds_are_in_the_wrong_order() -> None:
    """Assert it by the guard in the mode after the node: below 0 where that mode is on."""
    system: Any = Surfaces([Surface(Kind.RELAY, "relay", 0, column=0)], [[1.0]], guards_depend=True)
    for lower, wrong in ((-0.5, False), (0.25, True)):

        def switch(state: Any, phase: Any, parameter: Any, side: Any, lower: float = lower) -> Any:
            return state - np.where(side[:, :1] == PLUS, lower, 0.0)

        system.switch = switch
        orbit = along(sine, [(EventNode(0, 1), 0.0), (EventNode(0, -1), np.pi)])
        found = [v.breach for v in violations.at_nodes(system, orbit) if v.at == 0]
        assert found == ([Breach.HELD] if wrong else [])


@pytest.mark.parametrize(
    ("mode", "arriving", "kept"),
    [
        (STUCK, True, ((1, -1), (2, 1))),
        (HELD, True, ((1, -1), (2, 1))),
        (STUCK, False, ()),
        (1, True, ((0, 1),)),
        (-1, False, ((0, -1),)),
        (0, True, ()),
    ],
)
def test_what_a_mode_requires_beside_an_impact(mode: int, arriving: bool, kept: tuple[Any, ...]) -> None:
    """Assert the limits before it where a joint is held, and the side of the guard where it slips."""
    assert violations._kept(joint(), mode, arriving) == kept
    if mode in (1, -1):
        assert violations._kept(joint(kind=Kind.SLIDER), mode, arriving) == ()


def test_largest_value_of_switches() -> None:
    """Assert that of 3 sin tau beside sin tau, and 1 where all are 0."""
    dense = SwitchPolynomials(
        Surfaces([Surface(Kind.KINK, "s", k) for k in range(3)], [[1.0], [-3.0], [0.0]]), along(sine)
    )
    assert violations.largest(dense, 0, 1) == pytest.approx(3.0, rel=1e-3)
    assert violations.largest(dense, 0) == pytest.approx(1.0, rel=1e-3)
    assert violations.largest(dense, 2) == 1.0


@pytest.mark.parametrize(
    ("after", "mode", "told"),
    [
        ((-1.0, 2.0), 1, True),  # the release up is below 0 on both sides: nothing lets go
        ((1.0, 2.0), 1, False),  # it rises past 0: the joint is torn off
        ((-1.0, 2.0), -1, True),
        ((-1.0, -2.0), -1, False),
        ((1.0, 2.0), STUCK, True),  # the guard is not 0 there
    ],
)
def test_changes_that_a_node_states_but_that_do_not_happen(
    after: tuple[float, float], mode: int, told: bool
) -> None:
    """Assert that a joint let go by another's stop is past a limit after it, and was not before.

    Guard 3 is 1 all along; its releases 4 and 5 are -1 and 2 before the stop, and other values after it.
    """
    system: Any = Surfaces([joint(), joint(1, 3)], [[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 3, guards_depend=True)

    def switch(state: Any, phase: Any, parameter: Any, side: Any) -> Any:
        found = np.tile([0.0, -1.0, 1.0, 1.0, -1.0, 2.0], (len(state), 1))
        stuck = side[:, 0] == STUCK
        found[stuck, 4:] = after
        return found

    system.switch = switch
    event = EventNode(0, -1, modes=((0, STUCK), (3, mode)))
    begun = replace(UP, modes=((3, STUCK if mode != STUCK else 1),))
    nodes = [(event, 1.0), (begun, 2.0), (EventNode(0, -1), 3.0)]
    orbit = along(lambda tau: np.stack([np.sin(tau)] * 2, axis=1), nodes, intervals=12)
    own = system.surfaces[0]
    found = violations._unforced(SwitchPolynomials(system, orbit), 0, own)
    assert [(v.switch, v.at, v.side) for v in found] == ([(3, 0, mode)] if told else [])


def test_limits_at_stops_and_passages() -> None:
    """Assert side * release over the largest: a stop must hold, and a passage must slip on.

    The releases are sin tau - 2 (up) and sin tau + 2 (down), 3 at the most: at 0 the node is well held.
    """
    system = Surfaces([joint()], [[1.0]] * 3, [0.0, -2.0, 2.0])
    orbit = along(sine, [(STOP, np.pi), (UP, 4.0)])
    (limit,) = violations.limits(system, orbit, system.surfaces[0])
    assert (limit.switch, limit.at, limit.side) == (2, 0, 1)
    assert limit.depth == pytest.approx(-2 / 3, rel=1e-3)
    passing = along(sine, [(EventNode(0, -1), np.pi), (EventNode(0, 1), 6.0)])
    first, second = violations.limits(system, passing, system.surfaces[0])
    assert (first.switch, first.side, second.switch, second.side) == (2, -1, 1, 1)
    assert first.depth == pytest.approx(2 / 3, rel=1e-3) and second.depth > 0
    slider = Surfaces([joint(kind=Kind.SLIDER)], [[1.0]] * 3, [0.0, -2.0, 2.0])
    assert violations.limits(slider, orbit, slider.surfaces[0]) == []


def test_words_leave_out_markers_and_phases() -> None:
    """Assert the event nodes in order of their switches, and no word of an orbit that violates its own."""
    surfaces = [Surface(Kind.KINK, "kink", 0), Surface(Kind.MARKER, "mark", 1)]
    system = Surfaces(surfaces, [[1.0], [1.0]])
    nodes = [(EventNode(0, 1), 0.0), (EventNode(1, 1), 1.0), (EventNode(0, -1), np.pi)]
    assert violations.word(system, along(sine, nodes)) == (EventNode(0, -1), EventNode(0, 1))
    lower = Surfaces(surfaces, [[1.0], [1.0]], [0.5, 0.0])
    assert violations.word(lower, along(sine)) is None
    assert violations.word(Surfaces(surfaces, [[1.0], [1.0]], [1.5, 0.0]), along(sine)) == ()


def test_guards_that_are_one_function() -> None:
    """Assert twins with signs: always, and less their parts along guards of joints that are held."""
    surfaces = [joint(k, 3 * k) for k in range(4)]
    weights = [[1.0, 0.0]] * 3 + [[-2.0, 0.0]] * 3 + [[0.0, 1.0]] * 3 + [[1.0, 1.0]] * 3
    system = Surfaces(surfaces, weights)
    assert twinguards.twins(system, 0) == {0: 1, 3: -1}
    assert twinguards.twins(system, 6) == {6: 1}
    assert twinguards.twins(system, 6, [0]) == {6: 1, 9: 1}
    assert twinguards.twins(system, 1) == {1: 1}  # no guard
    assert twinguards.holding(system, 9, [0, 6]) == {0: 1, 6: 1}
    assert twinguards.holding(system, 9, [3, 6]) == {3: -1, 6: 1}
    assert twinguards.holding(system, 9, [0]) == {} == twinguards.holding(system, 9, [])
    assert twinguards.holding(system, 3, [0, 6]) == {0: -1}


def test_friction_that_is_held_about_a_node() -> None:
    """Assert the guards of friction that sticks before a node and after it, and those held all along."""
    system = Surfaces([joint(), joint(1, 3), joint(2, 6, Kind.SLIDER)], [[1.0]] * 9)
    other = EventNode(3, -1, modes=((3, STUCK),))
    events = [STOP, other, UP, EventNode(4, 1), EventNode(0, -1), EventNode(6, -1, modes=((6, STUCK),))]
    assert twinguards.held_at(system, events, 1) == [0]
    assert twinguards.held_at(system, events, 2) == [3]
    assert twinguards.held_at(system, events, 3) == []
    assert twinguards.held_at(system, events, 0, [8]) == [8]
    orbit = along(sine, [(event, 0.5 + k) for k, event in enumerate(events)], intervals=24)
    assert [twinguards.held_in(system, orbit, k) for k in (0, 4, 8, 12)] == [[0], [0, 3], [3], []]


@pytest.mark.parametrize(
    ("mode", "values", "breach"),
    [
        (STUCK, (0.0, 5.0, -5.0), False),
        (STUCK, (0.1, 0.0, 0.0), True),
        (1, (5.0, 0.0, 5.0), False),
        (1, (0.0, 5.0, 0.0), True),
        (-1, (5.0, 5.0, 0.0), False),
        (-1, (0.0, 0.0, 5.0), True),
    ],
)
def test_mode_that_an_event_of_another_joint_brings(
    mode: int, values: tuple[float, float, float], breach: bool
) -> None:
    """Assert that a joint that is held with another has its guard at 0 there, one let go its release.

    Joint 3 (4, 5) changes at an event node of joint 0; the states are constant, its switches the values.
    """
    system = Surfaces([joint(), joint(1, 3)], [[0.0]] * 6, [0.5, 0.5, 0.5, *values])
    event = EventNode(0, -1, modes=((0, STUCK), (3, mode)))
    begun = EventNode(1, 1, modes=((3, STUCK if mode != STUCK else 1),))
    orbit = along(lambda tau: np.sin(tau)[:, None], [(event, 1.0), (begun, 3.0)], intervals=8)
    dense = SwitchPolynomials(system, orbit)  # type: ignore[arg-type]
    found = violations._unforced(dense, 0, system.surfaces[0])
    assert found == ([Violation(Breach.MODE, 3, 0, mode, 1.0)] if breach else [])
    other = violations._unforced(dense, 0, system.surfaces[1])
    assert other == [Violation(Breach.MODE, 0, 0, STUCK, 1.0)]


@pytest.mark.parametrize(
    ("before", "after", "torn"),
    [(-1.0, 2.0, True), (2.0, 3.0, False), (-2.0, -1.0, False), (0.0, 1.0, True)],
)
def test_joint_that_another_tears_off(before: float, after: float, torn: bool) -> None:
    """Assert that it is within its limit in the modes before the event, and past it in those after."""
    system: Any = Surfaces([joint(), joint(1, 3)], [[0.0]] * 6, guards_depend=True)

    def switch(state: Any, phase: Any, parameter: Any, side: Any = None) -> Any:
        release = np.where(np.broadcast_to(side, (len(state), 2))[:, 0] == 1, before, after)
        return np.column_stack([np.ones((len(state), 4)), release, np.ones(len(state))])

    system.switch = switch
    nodes = [
        (EventNode(0, -1, modes=((0, STUCK), (3, 1))), 1.0),
        (EventNode(1, 1, modes=((3, STUCK),)), 3.0),
    ]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=8)
    dense: Any = SimpleNamespace(
        system=system, orbit=orbit, knots=np.ones((8, 5, 6)), modes=sides(system, orbit)
    )
    found = violations._unforced(dense, 0, system.surfaces[0])
    assert found == ([] if torn else [Violation(Breach.MODE, 3, 0, 1, 1.0)])


@pytest.mark.parametrize("value", [0.0, 0.1])
def test_friction_that_passes_with_another_has_no_speed_there(value: float) -> None:
    """Assert it where it slips one way before the event and the other way after: nothing tears it off."""
    system = Surfaces([joint(), joint(1, 3)], [[0.0]] * 6, [0.0, 0.0, 0.0, value, -1.0, 1.0])
    nodes = [(EventNode(0, -1, modes=((3, 1),)), 1.0), (EventNode(3, -1), 3.0)]
    dense = SwitchPolynomials(system, along(sine, nodes, intervals=8))  # type: ignore[arg-type]
    found = violations._unforced(dense, 0, system.surfaces[0])
    assert found == ([Violation(Breach.MODE, 3, 0, 1, 1.0)] if value else [])


@pytest.mark.parametrize(("begin", "unmarked"), [(1.5, True), (2.5, False)])
@pytest.mark.parametrize("torn", [True, False])
def test_limit_passed_before_an_event_that_tears_the_joint_off(
    begin: float, unmarked: bool, torn: bool
) -> None:
    """Assert that an excursion up to there is one: at its own release it would be the node's own error.

    Joint 3 (4, 5) is held from 1 to 2, its limit s5 = begin - x > 0 with x = tau.
    """
    weights = [*[[0.0]] * 5, [-1.0]]
    system = Surfaces([joint(), joint(1, 3)], weights, [0.0, 0.0, 0.0, 0.0, -1.0, begin])
    released = EventNode(0, -1, modes=((3, 1),)) if torn else EventNode(5, -1)
    nodes = [(EventNode(3, 1, modes=((3, STUCK),)), 1.0), (released, 2.0), (EventNode(0, 1), 4.0)]
    orbit = along(lambda tau: np.mod(tau, 2 * np.pi)[:, None], nodes, intervals=12)
    dense = SwitchPolynomials(system, orbit)  # type: ignore[arg-type]
    found = [(e.phase, e.value) for e in dense.unmarked(5, 1)]
    assert found == ([pytest.approx((2.0, begin - 2.0))] if torn and unmarked else [])
