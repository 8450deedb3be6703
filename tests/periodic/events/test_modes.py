"""Modes of surfaces along orbits that are given functions: every value by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events import modes, motions
from periodic.events.heldalong import all_along, placed, still
from periodic.events.relaycrossings import mode_at, switched
from periodic.orbit.mesh import EventNode
from periodic.system import HELD, MINUS, PLUS, STUCK, Kind
from periodic.system.events import Surface

WALL = Surface(Kind.IMPACT, "wall", 0, column=0, leaves=1)
STOP = EventNode(0, -1, modes=((0, STUCK),))
UP, DOWN = EventNode(1, 1), EventNode(2, -1)


def mixed() -> Any:
    """A kink 0, a relay 1, friction 2 (3, 4), an impact 5 that may be left at 6, a marker 7, a jump 8."""
    surfaces = [
        Surface(Kind.KINK, "kink", 0, column=0),
        Surface(Kind.RELAY, "relay", 1, column=1),
        joint(2, 2),
        Surface(Kind.IMPACT, "wall", 5, column=3, leaves=6),
        Surface(Kind.MARKER, "marker", 7),
        Surface(Kind.JUMP, "jump", 8, column=4),
    ]
    return Surfaces(surfaces, [[1.0]] * 9, directions=[0, 0, 0, 0, 0, -1, 0, 0, 0])


def test_switches_by_kinds() -> None:
    """Assert which switches bend the equations, return, hold, and whose surface each is."""
    system = mixed()
    assert modes.bends(system) == [0, 1, 8]
    assert modes.returns(system) == [0, 8]
    assert modes.relays(system) == [1]
    assert modes.of_held(system) == [2]
    assert [modes.surface_of(system, k).switch for k in range(9)] == [0, 1, 2, 2, 2, 5, 5, 7, 8]
    assert [modes.sliding(system, k) for k in range(9)] == [None, None, 2, 2, 2, None, None, None, None]
    assert modes.releases(system, 4) == (3, 4)
    friction = modes.surface_of(system, 2)
    assert (modes.release(friction, 1), modes.release(friction, -1)) == (3, 4)
    assert modes.column(system, 3) == 2
    assert [s.name for s in modes.of_kind(system, Kind.KINK, Kind.MARKER)] == ["kink", "marker"]


def test_modes_after_an_impact_are_those_that_its_node_says() -> None:
    """Assert that a departure leads to its side, and that an impact by itself leaves the mode."""
    assert modes.mode_after(WALL, EventNode(0, -1)) is None
    assert modes.mode_after(WALL, EventNode(0, -1, modes=((0, STUCK),))) == STUCK
    assert modes.mode_after(WALL, EventNode(1, 1)) == 1


def test_modes_along_the_mesh_begin_at_event_nodes() -> None:
    """Assert that friction is stuck from its stop to its release, and goes on around the period."""
    system = Surfaces([joint()], [[1.0], [1.0], [1.0]])
    orbit = along(
        lambda tau: np.sin(tau)[:, None], [(STOP, 1.0), (UP, 2.0), (EventNode(0, -1), 4.0)], intervals=12
    )
    found = modes.sides(system, orbit)[:, 0]
    assert found.tolist() == [STUCK] * 4 + [1] * 4 + [-1] * 4
    shifted = along(
        lambda tau: np.sin(tau)[:, None], [(UP, 1.0), (EventNode(0, -1), 2.0), (STOP, 4.0)], intervals=12
    )
    assert modes.sides(system, shifted)[:, 0].tolist() == [1] * 4 + [-1] * 4 + [STUCK] * 4
    assert modes.group(system, orbit.mesh, 2) == [0, 1, 2]
    assert modes.sticks(system, orbit.mesh, 0, 0) == 1
    assert modes.sticks(system, orbit.mesh, 0, 1) is None
    assert modes.sticks(system, shifted.mesh, 0, 2) == 0


def test_modes_of_an_impact_are_its_rests_alone() -> None:
    """Assert STUCK from a settling impact to the departure, else 0."""
    system = Surfaces([WALL], [[1.0], [1.0]], directions=[-1, 1])
    events = [(EventNode(0, -1, modes=((0, STUCK),)), 1.0), (EventNode(1, 1), 2.0), (EventNode(0, -1), 4.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], events, intervals=12)
    assert modes.sides(system, orbit)[:, 0].tolist() == [STUCK] * 4 + [0] * 8


@pytest.mark.parametrize(
    ("offset", "mode"),
    [(2.0, 1), (-2.0, -1), (0.0, 0), (1 / 1.05 - 1e-3, 0), (0.85, 1), (-0.85, -1), (0.7, 0)],
)
def test_side_of_a_surface_without_event_nodes(offset: float, mode: int) -> None:
    """Assert the side of sin tau + c: it is the state's where an excursion is deeper than a tenth.

    For c = 0.85 the excursion is 0.15 deep, less than a tenth of 1.85; for 0.7 it is 0.3, more than that.
    """
    system = Surfaces([Surface(Kind.KINK, "kink", 0, column=0)], [[1.0]], [offset])
    orbit = along(lambda tau: np.sin(tau)[:, None])
    depth = max(1 - abs(offset), 0.0)
    exact = int(np.sign(offset)) if depth < 0.1 * (1 + abs(offset)) else 0
    assert modes.sides(system, orbit)[:, 0].tolist() == [exact] * 40
    assert exact == mode or offset == 1 / 1.05 - 1e-3


def test_modes_that_the_mesh_says() -> None:
    """Assert that they hold all along, and that a joint without any leaves it to the state."""
    system = Surfaces([joint()], [[1.0], [1.0], [1.0]])
    held = along(lambda tau: 0 * tau[:, None], modes=[(0, HELD)])
    assert set(modes.sides(system, held)[:, 0]) == {HELD}
    assert modes.held_all_along(held.mesh, modes.surface_of(system, 1))
    loose = along(lambda tau: 2 + np.sin(tau)[:, None])
    assert set(modes.sides(system, loose)[:, 0]) == {0}
    assert not modes.held_all_along(loose.mesh, modes.surface_of(system, 1))


@pytest.mark.parametrize(
    ("events", "said"),
    [
        ([STOP, UP, EventNode(0, -1), EventNode(0, 1)], ""),
        ([STOP, UP, STOP, DOWN, EventNode(0, 1)], ""),
        ([STOP, DOWN, STOP, UP], "joint 0 goes to mode 2 from mode -1"),
        ([UP, STOP, UP], "joint 0 goes to mode 1 from mode 1"),
        ([STOP, UP, EventNode(0, 1)], "joint 0 goes to mode 1 from mode 1"),
        ([EventNode(7, 1, modes=((0, 1),)), EventNode(0, -1)], ""),
        ([EventNode(7, 1, modes=((0, -1),)), EventNode(0, -1)], "joint 0 goes to mode -1 from mode -1"),
    ],
)
def test_what_is_no_mode_sequence_is_said(events: list[EventNode], said: str) -> None:
    """Assert where a transition begins in another mode than the one before it ended in."""
    surfaces = [joint(), Surface(Kind.IMPACT, "wall", 7), Surface(Kind.KINK, "kink", 8)]
    system = Surfaces(surfaces, [[1.0]] * 9)
    assert modes.inconsistency(system, events) == said
    system = Surfaces([*surfaces[1:], surfaces[0]], [[1.0]] * 9)
    assert modes.inconsistency(system, events) == said


def test_sticking_of_a_file_without_modes() -> None:
    """Assert that it begins at the guard's node before a release, and at no other."""
    system = Surfaces([joint()], [[1.0]] * 3)
    plain = [EventNode(0, -1), UP, EventNode(0, -1)]
    assert modes.completed(system, plain) == (STOP, UP, EventNode(0, -1))
    given = [EventNode(0, -1, modes=((5, 1),)), UP]
    assert modes.completed(system, given) == tuple(given)


def test_modes_at_a_node_count_what_it_takes_along() -> None:
    """Assert the modes before a stop that lets another joint go at once: its own before, the other after."""
    surfaces = [joint(), joint(1, 3)]
    system = Surfaces(surfaces, [[1.0]] * 6, guards_depend=True)
    stop = EventNode(0, -1, modes=((0, STUCK), (3, 1)))
    nodes = [(EventNode(3, -1, modes=((3, STUCK),)), 0.5), (stop, 1.0), (UP, 2.0), (EventNode(0, -1), 3.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=16)
    assert modes.modes_at(system, orbit, 1, 1).tolist() == [[-1, 1]]  # a release of the stop's own joint
    assert modes.modes_at(system, orbit, 1, 4).tolist() == [[-1, STUCK]]  # one of the other joint
    assert modes.modes_in(system, orbit, 5).tolist() == [[STUCK, 1]]
    alone = Surfaces(surfaces, [[1.0]] * 6)
    assert modes.modes_in(alone, orbit, 5).shape == (1, 0)


def relay(upper: float = 0.5, lower: float = -0.5) -> Any:
    """A relay with thresholds of x: its guard is x - upper while off, x - lower while on."""
    system: Any = Surfaces([Surface(Kind.RELAY, "relay", 0, column=0)], [[1.0]], guards_depend=True)

    def switch(state: Any, phase: Any, parameter: Any, side: Any = None) -> Any:
        return state - np.where(side[:, :1] == PLUS, lower, upper)

    system.switch = switch
    return system


def test_where_a_relay_switches_without_event_nodes() -> None:
    """Assert on at sin tau = 0.5 upwards, off at sin tau = -0.5 downwards."""
    orbit = along(lambda tau: np.sin(tau)[:, None])
    (on, first), (off, last) = switched(relay(), orbit, 0)
    assert (on.direction, off.direction) == (1, -1)
    assert first == pytest.approx(np.pi / 6, abs=1e-6) and last == pytest.approx(7 * np.pi / 6, abs=1e-6)
    (surface,) = relay().surfaces
    each = [mode_at(relay(), orbit, surface, np.array([phase])) for phase in (0.1, 1.0, 3.5, 4.0, 6.0)]
    assert each == [MINUS, PLUS, PLUS, MINUS, MINUS]


def test_a_relay_that_switches_twice_a_way_does_so_once() -> None:
    """Assert that a second passage of the upper threshold changes nothing until the lower one is passed."""
    wave = lambda tau: (np.sin(tau) + 0.45 * np.sin(3 * tau))[:, None]  # noqa: E731
    found = switched(relay(0.9, -0.9), along(wave, intervals=80), 0)
    assert [event.direction for event, _ in found] == [1, -1]
    assert all(abs(abs(float(wave(np.array([at]))[0, 0])) - 0.9) < 1e-6 for _, at in found)


@pytest.mark.parametrize(
    ("amplitude", "mean", "mode"),
    [(0.4, 0.0, MINUS), (0.1, 0.7, PLUS), (0.4, 0.3, PLUS), (0.1, -0.7, MINUS), (0.1, 0.3, MINUS)],
)
def test_a_relay_that_never_switches(amplitude: float, mean: float, mode: int) -> None:
    """Assert that it is on where it is above the upper threshold once and never below the lower one."""
    orbit = along(lambda tau: mean + amplitude * np.sin(tau)[:, None])
    assert set(modes.sides(relay(), orbit)[:, 0]) == {mode}
    assert mode_at(relay(), orbit, relay().surfaces[0], np.array([1.0])) == mode


def test_other_surfaces_keep_their_modes_while_a_relay_is_looked_at() -> None:
    """Assert that two relays with modes all along are told apart, whichever comes first."""
    each = [Surface(Kind.RELAY, "one", 0, column=0), Surface(Kind.RELAY, "two", 1, column=1)]
    for first, second in ((0, 1), (1, 0)):
        system: Any = Surfaces(each, [[1.0], [1.0]], guards_depend=True)

        def switch(state: Any, phase: Any, parameter: Any, side: Any, first: int = first) -> Any:
            own = state[:, 0] - np.where(side[:, first] == PLUS, -0.5, 0.5)
            # The thresholds of the second are out of reach where the first is on.
            far = np.where(side[:, 1 - first] == PLUS, -0.2, 0.2)
            both = own, state[:, 0] - np.where(side[:, first] == PLUS, 9.0, far)
            return np.stack(both if first == 0 else both[::-1], axis=1)

        system.switch = switch
        for mode, count in ((PLUS, 0), (MINUS, 2)):
            orbit = along(lambda tau: np.sin(tau)[:, None], modes=((first, mode),))
            assert len(switched(system, orbit, second)) == count


def test_modes_all_along_that_no_node_changes() -> None:
    """Assert that they are kept, and those whose surface has event nodes are not."""
    system = Surfaces([joint(), joint(1, 3)], [[1.0]] * 6)
    assert still(system, ((0, HELD), (3, HELD)), (EventNode(4, 1),)) == ((0, HELD),)


def test_place_of_a_held_joint_is_midway_between_the_extremes() -> None:
    """Assert (min + max) / 2 of 2 x_0 - x_1, and parameters as they are without a place."""
    states = np.array([[0.0, 1.0], [2.0, 0.0], [1.0, 1.0]])
    parameter = np.array([5.0, 7.0])
    with_place = joint(place=(1, (2.0, -1.0)))
    assert placed(with_place, parameter, states).tolist() == [5.0, 1.5]
    assert placed(joint(), parameter, states).tolist() == [5.0, 7.0]
    assert parameter.tolist() == [5.0, 7.0]


def test_joint_that_slips_no_more_is_held_where_it_stuck() -> None:
    """Assert HELD and the place, of one with a place; of another neither, and no parameters."""
    nodes = [(STOP, 1.0), (UP, 2.0), (EventNode(0, -1), 4.0)]
    system = Surfaces([joint(place=(0, (1.0,)))], [[1.0]] * 3)
    orbit = along(lambda tau: tau[:, None], nodes, intervals=12)
    given, parameter = all_along(system, orbit, ())
    assert given == ((0, HELD),)
    assert parameter is not None and parameter[0] == pytest.approx((1.0 + 1.75) / 2, rel=1e-14)
    free = Surfaces([joint()], [[1.0]] * 3)
    assert all_along(free, orbit, ()) == ((), None)
    assert all_along(system, orbit, orbit.mesh.events) == ((), None)
    assert all_along(Surfaces([joint(alone=True)], [[1.0]] * 3), orbit, ()) == (((0, HELD),), None)


def happened(surface: int, phase: float, before: int, after: int) -> Any:
    """An event of a motion."""
    return SimpleNamespace(surface=surface, phase=phase, before=before, after=after)


def test_events_at_once() -> None:
    """Assert the groups of events nearer than the rounding of a phase, 1e-9 rad."""
    rows = [happened(0, at, 1, -1) for at in (0.0, 0.9e-9, 1.0, 2.0, 2.0 + 1.1e-9)]
    groups = [[event.phase for event in group] for group in motions._at_once(rows)]
    assert groups == [[0.0, 0.9e-9], [1.0], [2.0], [2.0 + 1.1e-9]]
    assert list(motions._at_once([])) == []


def test_friction_that_is_held_all_along() -> None:
    """Assert its guards: not those of sliders, of what slips, and of what changes."""
    surfaces = [joint(k, 3 * k) for k in range(3)] + [joint(3, 9, Kind.SLIDER)]
    system = Surfaces(surfaces, [[1.0]] * 12)
    whole: Any = SimpleNamespace(events=[happened(1, 1.0, STUCK, 1)], modes=[STUCK, STUCK, 1, STUCK])
    assert motions._always(system, whole) == [0]
    assert motions._stuck(surfaces, {0: STUCK, 1: 1, 3: STUCK}) == {0}


def test_causes_come_first() -> None:
    """Assert the ranks: impacts, stops, of sliders after friction, then releases."""
    slider = joint(1, 3, Kind.SLIDER)
    ranks = [
        motions._rank(WALL, happened(0, 0.0, 0, 0)),
        motions._rank(joint(), happened(0, 0.0, -1, STUCK)),
        motions._rank(slider, happened(0, 0.0, -1, STUCK)),
        motions._rank(joint(), happened(0, 0.0, STUCK, 1)),
        motions._rank(slider, happened(0, 0.0, STUCK, 1)),
        motions._rank(WALL, happened(0, 0.0, STUCK, 0)),
    ]
    assert ranks == [0, 1, 2, 3, 4, 3]


def test_switches_that_pass_at_events() -> None:
    """Assert the switch and the direction of stops, releases, passages, impacts and departures."""
    system = Surfaces([WALL, joint(1, 2)], [[1.0]] * 5, directions=[-1, 1])
    wall, friction = system.surfaces
    assert motions._crossed(system, friction, happened(1, 0.0, -1, STUCK)) == (2, 1)
    assert motions._crossed(system, friction, happened(1, 0.0, STUCK, 1)) == (3, 1)
    assert motions._crossed(system, friction, happened(1, 0.0, STUCK, -1)) == (4, -1)
    assert motions._crossed(system, friction, happened(1, 0.0, 1, -1)) == (2, -1)
    assert motions._crossed(system, wall, happened(0, 0.0, 0, 0)) == (0, -1)
    assert motions._crossed(system, wall, happened(0, 0.0, STUCK, 0)) == (1, 1)


def test_word_of_events() -> None:
    """Assert nodes and phases of a stop, a release, and an impact that takes friction to its other side."""
    system = Surfaces([WALL, joint(1, 2)], [[1.0]] * 5, directions=[-1, 1])
    events = [
        happened(1, 2.0, -1, STUCK),
        happened(1, 3.0, STUCK, 1),
        happened(1, 1.0, 1, -1),
        happened(0, 1.0, 0, 0),
    ]
    assert motions.word_of(system, events) == [
        (EventNode(0, -1, modes=((2, -1),)), 1.0),
        (EventNode(2, 1, modes=((2, STUCK),)), 2.0),
        (EventNode(3, 1), 3.0),
    ]


def test_events_that_do_not_cause_each_other_are_put_apart() -> None:
    """Assert 1e-5 rad between simultaneous events of two joints whose guards are different functions."""
    system = Surfaces([joint(), joint(1, 3)], [[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 3)
    first, second = motions.word_of(system, [happened(0, 1.0, 1, -1), happened(1, 1.0, -1, 1)])
    assert first == (EventNode(0, -1), 1.0)
    assert second[0] == EventNode(3, 1) and second[1] == pytest.approx(1.0 + 1e-5, rel=1e-14)
    same = Surfaces([joint(), joint(1, 3)], [[1.0, 0.0]] * 6)
    both = motions.word_of(same, [happened(0, 1.0, 1, STUCK), happened(1, 1.0, 1, STUCK)])
    assert both == [(EventNode(0, -1, modes=((0, STUCK), (3, STUCK))), 1.0)]


def test_middles_of_segments() -> None:
    """Assert the phases midway, the longest segment's first."""
    nodes = [(EventNode(0, 1), 1.0), (EventNode(0, -1), 2.0), (EventNode(0, 1), 4.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=12)
    rest = 2 * np.pi - 3.0
    assert motions.amid(orbit) == pytest.approx([4.0 + rest / 2, 3.0, 1.5], rel=1e-14)
    assert motions.amid(along(lambda tau: np.sin(tau)[:, None])).tolist() == [0.0]


def test_a_motion_begins_off_the_wall() -> None:
    """Assert the middle of the longest segment in front of a wall at x = 0, not of a longer one."""
    system = Surfaces([Surface(Kind.IMPACT, "wall", 0)], [[1.0]], directions=[-1])
    nodes = [(EventNode(0, -1), 1.0), (EventNode(0, -1), 3.0)]
    inside = along(lambda tau: np.where(tau < 3, 1.0, -1.0)[:, None], nodes, intervals=12)
    assert motions._begin(system, inside) == pytest.approx(2.0)
    outside = replace(inside, nodes=-inside.nodes, stages=-inside.stages)
    assert motions._begin(system, outside) == pytest.approx(np.mod(3.0 + (2 * np.pi - 2) / 2, 2 * np.pi))
