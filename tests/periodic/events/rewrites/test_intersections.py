"""Event nodes on the other side of an intersection of surfaces, of words made for it."""

from __future__ import annotations

import pytest
from support.surfaces import Surfaces, at, joint, three_joints

from periodic.events.rewrites import table
from periodic.events.rewrites.ends import excursions
from periodic.events.rewrites.intersections import intersections
from periodic.events.rewrites.swaps import swapped
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind

FAR = (EventNode(9, 1), 4.0), (EventNode(9, -1), 5.0)
"""Events that have nothing to do with it."""


def event(said: str) -> EventNode:
    """An event node: x, y or d (x - y) passes 0 upwards ("+") or downwards, held from there on with a "0"."""
    guard = {"x": 0, "y": 3, "d": 6}[said[0]]
    modes = ((guard, STUCK),) if said.endswith("0") else ()
    return EventNode(guard, 1 if said[1] == "+" else -1, modes=modes)


def near(*events: EventNode, apart: float = 1e-3) -> list[tuple[EventNode, float]]:
    """Event nodes with phases near 1."""
    return [(each, 1.0 + k * apart) for k, each in enumerate(events)]


@pytest.mark.parametrize("segment", [0, 1])
@pytest.mark.parametrize("order", ["x y d", "d x y", "x d y"])
def test_three_events_change_places_where_one_guard_depends_on_the_others(order: str, segment: int) -> None:
    """Assert the reverse order and the gaps in their ratio; the first of them is the size.

    Where two of them are friction they come before ways in which the third one's guard is not crossed.
    """
    one, two, three = (event(f"{guard}+" + "0" * (guard == "d")) for guard in order.split())
    orbit = at((one, 1.0), (two, 1.001), (three, 1.004), (EventNode(9, 1), 4.0))
    site = intersections(three_joints(), orbit, segment)[0]
    assert (site.row, site.removed, site.held.segment) == (table.SWAP, (0, 1, 2), segment)  # type: ignore[attr-defined]
    assert [each.event for each in site.added] == [three, two, one]
    assert [each.at(0.03)[1] for each in site.added] == pytest.approx([1.0, 1.03, 1.04])


@pytest.mark.parametrize(
    "nodes",
    [
        [
            *zip(map(event, ("x+", "y+")), (1.0, 1.1), strict=True),
            (EventNode(9, 1), 1.4),
            (event("d+0"), 4.0),
            (EventNode(9, -1), 5.0),
        ],
        [
            *zip(map(event, ("x+", "y+")), (1.0, 1.1), strict=True),
            (EventNode(7, 1), 1.4),
            (EventNode(9, 1), 3.0),
            (event("d-0"), 4.0),
            (EventNode(9, -1), 5.0),
        ],
        [(event("x+"), 1.0), (EventNode(9, 1), 1.1), (event("d+0"), 1.4), (event("y+"), 4.0)],
        [(event("x+"), 1.0), (event("y+"), 1.1), (event("d+0"), 1.4)],
    ],
    ids=["it is no neighbour", "a release", "of a kink", "no other event"],
)
def test_two_events_change_places_where_no_third_one_meets_them(nodes: list[tuple[EventNode, float]]) -> None:
    """Assert a swap of two."""
    assert intersections(three_joints(), at(*nodes), 0) == []
    assert swapped(three_joints(), at(*nodes), 0).removed == (0, 1)


def test_event_nodes_in_no_order_are_about_no_intersection() -> None:
    """Assert none of four of them, where one that stops y follows after x has been passed and y has."""
    orbit = at(*near(*map(event, ("d+0", "x+", "y+", "y-0"))), *FAR)
    assert {len(site.removed) for site in intersections(three_joints(), orbit, 1)} == {3}


def test_the_nearer_of_two_neighbours_meets_them() -> None:
    """Assert it of x - y on both sides of the events of x and y."""
    words = zip(map(event, ("d+0", "x+", "y+", "d+0")), (0.6, 1.0, 1.1, 1.4), strict=True)
    orbit = at(*words, (EventNode(9, 1), 4.0))
    first = intersections(three_joints(), orbit, 1)[0]
    assert first.removed == (1, 2, 3)


ROUND = [
    ("d- x- y- d+", ["y- x-"]),
    ("y- x- d+ y+", ["d+ x-"]),
    ("d+ y- x- d-0", ["x- y- d+0", "x- y- d+0 y+x"]),
    ("d+ x+0 d-y", ["y+ x+0"]),
    ("x+0 d-y", ["y+ d- x+0", "d- y+ x+0"]),
    ("d-0 x+y+d", ["y+ x+", "x+ y+"]),
    ("y+ d+ x+", ["x+ d+ y+", "x+0 y+d+x"]),
]
"""Words of three joints with friction, and on the other side; d-y, y+x: both pass 0, the third is held."""


@pytest.mark.parametrize(("word", "others"), ROUND, ids=[word for word, _ in ROUND])
def test_the_rays_on_the_other_side(word: str, others: list[str]) -> None:
    """Assert the first sites, of all event nodes near each other."""
    orbit = at(*near(*map(passed, word.split())), *FAR)
    count = len(word.split())
    found = [
        site for site in intersections(three_joints(Kind.SLIDING), orbit, 0) if len(site.removed) == count
    ]
    words = [[each.event for each in site.added] for site in found]
    assert sorted(map(str, words)) == sorted(str(list(map(passed, other.split()))) for other in others)
    assert intersections(three_joints(Kind.SLIDING), orbit, 0)[0] in found


def beside_friction() -> Surfaces:
    """Three joints with friction, and a slider 10 (11, 12) of x - y beside that of x - y."""
    surfaces, weights = three_joints(Kind.SLIDING).surfaces, three_joints().weights
    difference = [[1.0, -1.0]] * 3
    return Surfaces([*surfaces, joint(4, 10, Kind.SLIDER)], [*weights.tolist(), *difference])


X, Y = event("x+"), event("y+")


@pytest.mark.parametrize(
    ("system", "strained"),
    [
        (
            beside_friction(),
            [EventNode(6, -1, modes=((10, STUCK),)), Y, X, EventNode(6, 1), EventNode(11, 1)],
        ),
        (three_joints(), [EventNode(6, -1, modes=((6, STUCK),)), Y, X, EventNode(7, 1)]),
    ],
    ids=["beside friction", "a slider alone"],
)
def test_sliders_that_are_strained_on_one_side_alone_slip_on(
    system: Surfaces, strained: list[EventNode]
) -> None:
    """Assert both words: x passes 0 before y, and a slider of x - y slips on upwards, or is strained between.

    Where the slider is held all along nothing becomes of it, and only x and y change places.
    """
    free = X, Y
    slips = strained[-1], 4.0
    there = intersections(system, at(*near(*free), slips, (EventNode(9, -1), 5.0)), 0)
    assert [each.event for each in there[0].added] == strained
    back = intersections(system, at(*near(*strained), *FAR), 0)
    assert [each.event for each in back[0].added] == list(free)
    assert back[0].removed == tuple(range(len(strained)))
    stuck = EventNode(strained[0].switch, -1, modes=strained[0].modes), 5.0
    held = intersections(system, at(*near(*free), slips, stuck), 0)
    assert all(EventNode(11, 1) not in [each.event for each in site.added] for site in held)


def test_a_slider_beside_friction_that_is_let_go_at_the_intersection_goes_with_it() -> None:
    """Assert it where x - y is held up to there only, and that this is not the end of a stop by itself."""
    stops = EventNode(6, -1, modes=((6, STUCK), (10, STUCK)))
    both = EventNode(0, 1, modes=((3, 1), (6, 1), (10, 1)))
    slips = EventNode(11, 1), 4.0
    there = intersections(beside_friction(), at(*near(X, Y), slips, (EventNode(9, -1), 5.0)), 0)
    assert [stops, both] in [[each.event for each in site.added] for site in there]
    orbit = at(*near(stops, both), *FAR)
    back = intersections(beside_friction(), orbit, 0)
    assert [[each.event for each in site.added] for site in back] == [[Y, X], [X, Y]]
    assert [own.row for own in excursions(beside_friction(), orbit) if own.index == 0] == [table.SWAP]


def passed(said: str) -> EventNode:
    """An event node, also of two guards: as d passes 0 downwards, y does upwards where x is held."""
    both = {
        "d-y": EventNode(6, -1, modes=((3, 1),)),
        "y+x": EventNode(3, 1, modes=((0, 1),)),
        "x+y+d": EventNode(0, 1, modes=((3, 1), (6, 1))),
        "y+d+x": EventNode(3, 1, modes=((6, 1), (0, 1))),
    }
    return both.get(said) or event(said)
