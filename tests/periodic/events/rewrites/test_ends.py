"""What may end in the word of an orbit, and what is left then: the table of rewrites from right to left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, at, joint, three_joints

from periodic.events.rewrites import table
from periodic.events.rewrites.corners import corner, reversed_by_impact
from periodic.events.rewrites.ends import Excursion, ends, excursions, longest_slip, slip_about
from periodic.events.rewrites.first import _name
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.strikes import last_impact
from periodic.events.rewrites.swaps import swapped, swaps
from periodic.events.sideconditions import Clearance, Length, Lengths, Limit, Speed
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import STUCK, Kind
from periodic.system.events import Surface

FRICTION, SLIDER, KINK, MARKER, RELAY, WALL = 0, 3, 6, 7, 8, 9


def system() -> Any:
    """Friction 0 (1, 2), a slider 3 (4, 5) of sin tau; a kink 6, marker 7, relay 8 and wall 9 of cos tau."""
    surfaces = [
        joint(0, FRICTION),
        joint(1, SLIDER, Kind.SLIDER),
        Surface(Kind.KINK, "kink", KINK, column=2),
        Surface(Kind.MARKER, "marker", MARKER),
        Surface(Kind.RELAY, "relay", RELAY, column=3),
        Surface(Kind.IMPACT, "wall", WALL),
    ]
    return Surfaces(surfaces, [[1.0, 0.0]] * 6 + [[0.0, 1.0]] * 4)


def stop(guard: int, way: int) -> EventNode:
    """An event node at which a joint is held."""
    return EventNode(guard, way, modes=((guard, STUCK),))


def word(*events: EventNode) -> Orbit:
    """An orbit with event nodes at 0.5, 1.5, ..."""
    nodes = [(event, 0.5 + k) for k, event in enumerate(events)]
    return along(lambda tau: np.column_stack([np.sin(tau), np.cos(tau)]), nodes, intervals=4 * len(events))


@dataclass(frozen=True)
class Case:
    """A word of two event nodes or three, and the row and site of the segment after the first of them."""

    events: tuple[EventNode, ...]
    row: table.Row
    held: Any
    switch: int
    removed: tuple[int, ...]
    replaced: tuple[tuple[int, EventNode], ...] = ()


KINKS = EventNode(KINK, 1), EventNode(KINK, -1)
CASES = [
    Case(KINKS, table.GRAZING, Clearance(KINK, -1, 1.0), KINK, (0, 1)),
    Case(KINKS[::-1], table.GRAZING, Clearance(KINK, 1, 1.0), KINK, (0, 1)),
    Case(
        (stop(FRICTION, -1), EventNode(2, -1), EventNode(FRICTION, 1)),
        table.CROSSING_SLIDING,
        Limit(0, 2, -1),
        2,
        (1,),
        ((0, EventNode(FRICTION, -1)),),
    ),
    Case(
        (stop(FRICTION, 1), EventNode(1, 1), EventNode(FRICTION, -1)),
        table.CROSSING_SLIDING,
        Limit(0, 1, 1),
        1,
        (1,),
        ((0, EventNode(FRICTION, 1)),),
    ),
    Case(
        (EventNode(FRICTION, 1), stop(FRICTION, -1), EventNode(2, -1)),
        table.SWITCHING_SLIDING,
        Limit(0, 1, -1),
        1,
        (1,),
        ((0, stop(FRICTION, 1)),),
    ),
    Case(
        (EventNode(FRICTION, -1, modes=((7, 1),)), stop(FRICTION, 1), EventNode(1, 1)),
        table.SWITCHING_SLIDING,
        Limit(0, 2, 1),
        2,
        (1,),
        ((0, EventNode(FRICTION, -1, modes=((FRICTION, STUCK), (7, 1)))),),
    ),
    Case((stop(FRICTION, -1), EventNode(1, 1)), table.GRAZING_SLIDING, Clearance(0, 1, 1.0), 0, (0, 1)),
    Case((EventNode(1, 1), stop(FRICTION, -1)), table.ADDING_SLIDING, Clearance(1, -1, 1.0), 1, (0, 1)),
    Case((EventNode(2, -1), stop(FRICTION, 1)), table.ADDING_SLIDING, Clearance(2, 1, 1.0), 2, (0, 1)),
    Case((stop(SLIDER, -1), EventNode(4, 1)), table.GRAZING_SLIDING, Clearance(3, 1, 1.0), 3, (0, 1)),
    Case((EventNode(4, 1), stop(SLIDER, -1)), table.LIMIT_GRAZING, Clearance(4, -1, 1.0), 4, (0, 1)),
    Case((EventNode(RELAY, 1), EventNode(RELAY, -1)), table.RELAY, Speed(0, 0.0), RELAY, ()),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.row.name)
def test_what_a_segment_ends_as(case: Case) -> None:
    """Assert the row, the condition that is 0 there, and what is removed or takes its place."""
    orbit = word(*case.events)
    (own,) = (each for each in excursions(system(), orbit) if each.index == 0)
    assert (own.row, own.segments) == (case.row, ())
    (site,) = ends(system(), orbit, own)
    expected = Site(case.row, case.switch, 0, case.held, 0.0, (), case.removed, case.replaced)
    assert site == expected


LIMIT, ABOUT, SWAP = (row.name for row in (table.LIMIT_GRAZING, table.ADDING_ABOUT, table.SWAP))


@pytest.mark.parametrize(
    ("events", "rows"),
    [
        ((stop(SLIDER, -1), EventNode(5, -1), stop(SLIDER, 1), EventNode(4, 1)), [(1, LIMIT), (3, LIMIT)]),
        ((EventNode(FRICTION, 1), EventNode(FRICTION, -1)), []),
        ((EventNode(MARKER, 1), KINKS[0], EventNode(MARKER, -1), KINKS[1]), []),
        (
            (KINKS[0], EventNode(FRICTION, 1), KINKS[1], EventNode(FRICTION, -1)),
            [(k, SWAP) for k in range(4)],
        ),
        ((stop(FRICTION, 1),), []),
        (
            (EventNode(1, 1), KINKS[0], stop(FRICTION, -1), KINKS[1]),
            [(0, ABOUT), *[(k, SWAP) for k in range(4)]],
        ),
    ],
)
def test_where_something_may_end(
    events: tuple[EventNode, ...], rows: list[tuple[int, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the rows by the event nodes at which they begin: markers, one event and passages have none."""
    monkeypatch.setattr("periodic.events.rewrites.ends._shallow", lambda *_: True)
    found = [(each.index, each.row.name) for each in excursions(system(), word(*events))]
    assert found == rows


def test_two_events_that_change_places() -> None:
    """Assert that the later one takes the phase of the first, and this one lies a length behind it."""
    kink, turn = EventNode(KINK, 1), EventNode(FRICTION, 1)
    orbit = word(kink, turn)
    added = Added(turn, 0.5, 0.0), Added(kink, 0.5, 1.0)
    assert swapped(system(), orbit, 0) == Site(table.SWAP, 0, 0, Length(0, 1.0), 0.0, added, (0, 1))
    back = Added(kink, 1.5, 0.0), Added(turn, 1.5, 1.0)
    rest = 2 * np.pi - 1.0
    assert swapped(system(), orbit, 1) == Site(table.SWAP, 6, 1, Length(1, rest), 0.0, back, (1, 0))


@pytest.mark.parametrize(("before", "after", "bound"), [(-1, 1, False), (STUCK, 1, True), (-1, STUCK, True)])
def test_friction_binds_a_swap_only_where_it_holds(before: int, after: int, bound: bool) -> None:
    """Assert that the stop of a slider of x - y and the event at y change places unless that one is held.

    Where y is held, and x is about to be, x - y is x.
    """
    modes = {STUCK: EventNode(3, -1, modes=((3, STUCK),)), -1: EventNode(3, -1), 1: EventNode(3, 1)}
    slider, other = EventNode(6, 1, modes=((6, STUCK),)), EventNode(0, 1, modes=((0, STUCK),))
    own = EventNode(4, 1) if before == STUCK else modes[after]
    orbit = at((modes[before], 0.5), (own, 1.0), (slider, 1.1), (other, 1.4), (EventNode(9, 1), 4.0))
    assert swaps(three_joints(), orbit, 1) is not bound


@pytest.mark.parametrize(("segment", "early"), [(0, -0.5), (1, 2.5)])
def test_an_impact_keeps_its_phase_in_a_swap(segment: int, early: float) -> None:
    """Assert that the other event goes to its far side: from 1.5 to before 0.5, and to behind 2.5."""
    impact, kink = EventNode(WALL, -1), EventNode(KINK, 1)
    orbit = word(impact, kink, impact)
    site = swapped(system(), orbit, segment)
    pair = (kink, impact) if segment == 0 else (impact, kink)
    assert site.added == (Added(pair[0], early, 0.0), Added(pair[1], early, 1.0))
    nodes = [each.at(1.0) for each in site.added]
    assert (impact, 0.5 if segment == 0 else 2.5) in nodes


@pytest.mark.parametrize(
    ("events", "inner"),
    [
        ((EventNode(1, 1), EventNode(KINK, 1), stop(FRICTION, -1), EventNode(KINK, -1)), (1,)),
        ((EventNode(1, 1), stop(FRICTION, -1), EventNode(KINK, -1)), ()),
        ((EventNode(1, 1), EventNode(KINK, 1), EventNode(FRICTION, -1)), ()),
        ((EventNode(FRICTION, 1), EventNode(KINK, 1), stop(FRICTION, -1)), ()),
        ((EventNode(1, 1), *[EventNode(KINK, 1)] * 3, stop(FRICTION, -1)), ()),
        ((EventNode(1, 1), *[EventNode(KINK, 1)] * 2, stop(FRICTION, -1)), (1, 2)),
        ((EventNode(KINK, 1), EventNode(KINK, -1)), ()),
    ],
)
def test_events_within_a_slip(
    events: tuple[EventNode, ...], inner: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert those between a release and the stop of that joint, up to two; none of a passage."""
    monkeypatch.setattr("periodic.events.rewrites.ends._shallow", lambda *_: True)
    assert slip_about(system(), word(*events), 0) == inner
    monkeypatch.setattr("periodic.events.rewrites.ends._shallow", lambda *_: False)
    assert slip_about(system(), word(*events), 0) == ()


def test_size_of_an_excursion() -> None:
    """Assert the length of its segment, or of all that are its own, and the condition that keeps it."""
    orbit = word(*KINKS, *KINKS)
    one, both = Excursion(table.GRAZING, 1), Excursion(table.MERGING, 1, segments=(0, 3))
    assert one.size(system(), orbit) == pytest.approx(1.0)
    assert both.size(system(), orbit) == pytest.approx(2 * np.pi - 2.0)
    assert (one.held(0.25), both.held(0.25)) == (Length(1, 0.25), Lengths((0, 3), 0.25))
    assert Excursion(table.IMPACT, 1).held(0.25) == Speed(1, 0.25)


@pytest.mark.parametrize(
    ("events", "length"),
    [
        ((EventNode(1, 1), stop(FRICTION, -1)), 1.0),
        ((stop(FRICTION, -1), EventNode(1, 1)), 2 * np.pi - 1.0),
        ((EventNode(1, 1), KINKS[0], stop(FRICTION, -1)), 2.0),
        ((KINKS[0],), 0.0),
        ((EventNode(FRICTION, 1), EventNode(FRICTION, -1)), 2 * np.pi - 1.0),
    ],
)
def test_longest_slip_of_a_joint(events: tuple[EventNode, ...], length: float) -> None:
    """Assert the longest time between its own events, but for what begins with a stop."""
    assert longest_slip(system(), word(*events), 1) == pytest.approx(length)


@pytest.mark.parametrize("soon", [True, False])
def test_end_of_an_impact_that_reverses_friction(soon: bool) -> None:
    """Assert that friction passes its level at grazing, or stops there where it stopped soon after."""
    impact = EventNode(WALL, -1, modes=((FRICTION, 1),))
    nodes = [(impact, 1.0), (stop(FRICTION, -1), 1.2 if soon else 1.4), (EventNode(1, 1), 3.0)]
    orbit = along(lambda tau: np.column_stack([np.sin(tau), np.cos(tau)]), nodes, intervals=12)
    held = Clearance(WALL, 1, 1.0)
    passes = Site(table.IMPACT, WALL, 0, held, 0.0, (Added(EventNode(FRICTION, 1), 1.0, 0.0),), (0,))
    stops = Site(table.IMPACT, WALL, 0, held, 0.0, (Added(stop(FRICTION, 1), 1.0, 0.0),), (0, 1))
    assert last_impact(system(), orbit, 0) == ([stops, passes] if soon else [passes])


@pytest.mark.parametrize("reverses", [True, False])
def test_corner_of_an_impact(reverses: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that an excursion of a kink about an impact ends in its corner where the rate is reversed.

    The kink's switch is cos tau, of which the rate is -sin 1.5 before the impact.
    """
    orbit = word(KINKS[0], EventNode(WALL, -1), KINKS[1])
    monkeypatch.setattr("periodic.events.rewrites.corners.tied", lambda *_: [1])
    rates, start = orbit.node_rates.copy(), int(orbit.mesh.starts[1])
    rates[start] *= -1.0 if reverses else 1.0
    monkeypatch.setitem(vars(orbit), "node_rates", rates)
    for segment in (0, 1):
        assert corner(system(), orbit, segment) == ((0, 2) if reverses else None)
        assert reversed_by_impact(system(), orbit, segment) is reverses
    assert corner(system(), orbit, 2) is None
    same = word(KINKS[0], EventNode(WALL, -1), KINKS[0])
    monkeypatch.setitem(vars(same), "node_rates", rates)
    assert corner(system(), same, 0) is None


@pytest.mark.parametrize(
    ("row", "switch", "last", "said"),
    [
        (table.GRAZING, KINK, False, "the events s6 meet"),
        (table.ADDING_SLIDING, 1, False, "a stop at s0 ends"),
        (table.ADDING_SLIDING, 2, True, "s0 holds all along, at a place that is not determined"),
        (table.RELAY, RELAY, False, "s8 grazes the threshold at which it switches"),
        (table.IMPACT, WALL, False, "the impact at s9 has no speed left"),
        (table.REVERSAL, KINK, False, "an excursion ends where friction turns the motion"),
    ],
)
def test_what_ends_in_words(row: table.Row, switch: int, last: bool, said: str) -> None:
    """Assert the sentence of each kind of end."""
    site = Site(row, switch, 0, Length(0, 1.0), 0.0)
    assert _name(system(), site, last) == said


def test_what_swaps_in_words() -> None:
    """Assert that both events are named, in their order, and one that meets itself once."""
    first, second = Added(EventNode(FRICTION, 1), 0.0, 0.0), Added(EventNode(KINK, 1), 0.0, 1.0)
    site = Site(table.SWAP, 0, 0, Length(0, 1.0), 0.0, (second, first))
    assert _name(system(), site, False) == "the events s0 and s6 meet"
    same = Site(table.SWAP, 0, 0, Length(0, 1.0), 0.0, (first, first))
    assert _name(system(), same, False) == "the events s0 meet"
    alone = Surfaces([joint(alone=True)], [[1.0]] * 3)
    slides = Site(table.ADDING_SLIDING, 1, 0, Length(0, 1.0), 0.0)
    assert _name(alone, slides, True) == "the motion slides along s0 = 0 all the time"  # type: ignore[arg-type]


@pytest.mark.parametrize(("guard", "row"), [(FRICTION, table.ADDING_SLIDING), (SLIDER, table.LIMIT_GRAZING)])
def test_slip_whose_stop_is_another_joint_s_too(
    guard: int, row: table.Row, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that only its release goes where the event node at its end stops another joint as well."""
    other = EventNode(KINK, 1)
    monkeypatch.setattr("periodic.events.rewrites.ends.without", lambda system, event, own: other)
    orbit = word(EventNode(guard + 1, 1), stop(guard, -1))
    (site,) = ends(system(), orbit, Excursion(row, 0))
    held = Clearance(guard + 1, -1, 1.0)
    assert site == Site(row, guard + 1, 0, held, 0.0, (), (0,), ((1, other),))
