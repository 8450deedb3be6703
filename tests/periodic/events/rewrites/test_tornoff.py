"""Slips before an event that tears a joint off: words made for them, of speeds x and y and of x - y."""

from __future__ import annotations

import pytest
from support.surfaces import at, three_joints

from periodic.events.rewrites import table
from periodic.events.rewrites.ends import ends, excursions
from periodic.events.rewrites.grazingonsets import sites_of
from periodic.events.rewrites.sites import Site
from periodic.events.rewrites.tornoff import thrown_back
from periodic.events.sideconditions import Limit
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind

SYSTEM = three_joints(Kind.SLIDING)
STOP, LATER = (EventNode(6, -1, modes=((6, STUCK),)), 0.5), (EventNode(9, 1), 4.0)
"""x - y is held from 0.5 on; an event that has nothing to do with it."""


def torn(side: int) -> tuple[EventNode, float]:
    """x and y pass 0 upwards at once, and x - y is let go to a side."""
    return EventNode(0, 1, modes=((3, 1), (6, side))), 2.0


def begun(side: int, switch: int) -> Site:
    """The site of a slip to where a release of x - y leads, before it is torn off to a side."""
    orbit = at(STOP, torn(side), LATER)
    (site,) = (s for s in sites_of(SYSTEM, orbit, table.TEARING.name) if s.switch == switch)
    return site


@pytest.mark.parametrize(
    ("side", "switch", "words"),
    [
        # it slips down, so that x < y: y passes 0 first, and x - y comes back upwards
        (1, 8, [EventNode(8, -1), EventNode(3, 1), EventNode(6, 1)]),
        # up: x first
        (-1, 7, [EventNode(7, 1), EventNode(3, 1), EventNode(6, -1)]),
        # the way on which it is torn off anyway
        (1, 7, [EventNode(7, 1), EventNode(3, 1)]),
        (-1, 8, [EventNode(8, -1), EventNode(3, 1)]),
    ],
)
def test_slip_before_a_release(side: int, switch: int, words: list[EventNode]) -> None:
    """Assert the new event nodes, and that x passes 0 by itself, in the order that the slip says."""
    site = begun(side, switch)
    assert [each.event for each in site.added] == words
    assert site.replaced == ((1, EventNode(0, 1)),)
    places = [each.at(1e-2)[1] for each in site.added]
    assert places[0] == pytest.approx(2.0 - 1e-2)
    assert (places[1] < 2.0) == (switch == 8)
    assert [place > 2.0 for place in places[2:]] == [True] * (len(words) == 3)


@pytest.mark.parametrize(("side", "switch"), [(1, 8), (-1, 7)])
def test_the_slip_ends_as_it_began(side: int, switch: int) -> None:
    """Assert that the row read from right to left gives back the word without it."""
    site = begun(side, switch)
    new = sorted(
        [STOP, (EventNode(0, 1), 2.0), *(each.at(1e-2) for each in site.added), LATER], key=lambda n: n[1]
    )
    orbit = at(*new)
    own = next(each for each in excursions(SYSTEM, orbit) if each.row is table.TEARING)
    assert own.index == 1 and own.segments == (1, 2, 3)
    (end,) = ends(SYSTEM, orbit, own)
    assert end.removed == (1, 3, 4)
    assert end.replaced == ((2, torn(side)[0]),) or end.replaced == (
        (2, EventNode(3, 1, modes=((0, 1), (6, side)))),
    )
    assert isinstance(end.held, Limit) and (end.held.switch, end.held.side) == (
        switch,
        1 if switch == 8 else -1,
    )


@pytest.mark.parametrize(
    "nodes",
    [
        [EventNode(8, -1), EventNode(3, 1), EventNode(0, 1), EventNode(6, 1, modes=((6, STUCK),))],
        [EventNode(8, -1), EventNode(9, -1), EventNode(0, 1), EventNode(6, 1)],
        [EventNode(8, -1), EventNode(1, 1), EventNode(0, 1), EventNode(6, 1)],
        [EventNode(6, -1), EventNode(3, 1), EventNode(0, 1), EventNode(6, 1)],
        [EventNode(8, -1), EventNode(3, 1), EventNode(0, 1), EventNode(9, -1), EventNode(6, 1)],
    ],
    ids=["it stops", "a kink between", "a release between", "no release", "three between"],
)
def test_other_slips_are_none_of_these(nodes: list[EventNode]) -> None:
    """Assert that nothing is thrown back there."""
    assert thrown_back(SYSTEM, at(*((node, 1.0 + k) for k, node in enumerate(nodes))), 0) == ()


def test_a_slip_about_one_event() -> None:
    """Assert it of friction at x that turns, where y has no joint that changes; of a slider it is none."""
    nodes = [(EventNode(8, -1), 1.0), (EventNode(0, 1), 1.1), (EventNode(6, 1), 1.2), STOP]
    assert thrown_back(SYSTEM, at(*nodes), 0) == (1,)
    assert thrown_back(three_joints(), at(*nodes), 0) == ()
