"""What may begin in the word of an orbit: the table of rewrites from left to right."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites import grazingonsets, table
from periodic.events.rewrites.reversals import Reversal, held, reversals, short_of
from periodic.events.rewrites.rewrite import Begins
from periodic.events.rewrites.sites import Added, Site, apart, edited, has, index_of, ordered
from periodic.events.rewrites.strikes import first_impact
from periodic.events.rewrites.wholeorbit import whole_orbit
from periodic.events.sideconditions import Clearance, Limit
from periodic.events.switchpolynomials import Extremum
from periodic.events.thresholds import AT_LEVEL
from periodic.events.violations import Breach, Violation, violations
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.system import HELD, STUCK, Kind
from periodic.system.events import Surface

FRICTION, SLIDER, KINK, RELAY, WALL = 0, 3, 6, 7, 8
SIDES = [1, -1]


def system() -> Any:
    """Friction 0 (1, 2), a kink 6, a relay 7 and a wall 8 of sin tau, a slider 3 (4, 5) of cos tau."""
    surfaces = [
        joint(0, FRICTION),
        joint(1, SLIDER, Kind.SLIDER),
        Surface(Kind.KINK, "kink", KINK, column=2),
        Surface(Kind.RELAY, "relay", RELAY, column=3),
        Surface(Kind.IMPACT, "wall", WALL),
    ]
    return Surfaces(surfaces, [[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 3 + [[1.0, 0.0]] * 3)


def stop(guard: int, way: int) -> EventNode:
    """An event node at which a joint is held."""
    return EventNode(guard, way, modes=((guard, STUCK),))


def sine(*nodes: tuple[EventNode, float], modes: Any = ()) -> Orbit:
    """The orbit of sin tau and cos tau with event nodes."""
    return along(lambda tau: np.column_stack([np.sin(tau), np.cos(tau)]), nodes, modes, intervals=40)


def grazed(switch: int, side: int, orbit: Orbit) -> Site:
    """The site of an extremum of a switch at pi / 2."""
    surface = next(s for s in system().surfaces if switch in (s.switch, *(s.releases or ())))
    at = Extremum(switch, 9, 0.5, np.pi / 2, -0.25)
    return grazingonsets._at_extremum(system(), orbit, surface, at, side, -0.5)


@pytest.mark.parametrize("side", SIDES)
def test_grazing_of_a_kink(side: int) -> None:
    """Assert an excursion half before and half after the extremum, whose length is held."""
    site, tau = grazed(KINK, side, sine()), np.pi / 2
    added = Added(EventNode(KINK, -side), tau, -0.5), Added(EventNode(KINK, side), tau, 0.5)
    assert site == Site(table.GRAZING, KINK, site.at, Clearance(KINK, side, tau), -0.5, added)


@pytest.mark.parametrize("side", SIDES)
def test_grazing_of_a_relay_and_of_a_wall(side: int) -> None:
    """Assert that a relay ends the branch without event nodes, and that a wall has one impact."""
    tau, held_at = np.pi / 2, Clearance(RELAY, side, np.pi / 2)
    site = grazed(RELAY, side, sine())
    assert site == Site(table.RELAY, RELAY, site.at, held_at, -0.5)
    site = grazed(WALL, side, sine())
    impact = (Added(EventNode(WALL, -side), tau, 0.0),)
    assert site == Site(table.IMPACT, WALL, site.at, Clearance(WALL, side, tau), -0.5, impact)


@pytest.mark.parametrize("side", SIDES)
def test_grazing_of_a_joint_that_slips(side: int) -> None:
    """Assert a stop before the extremum, and the release to the side on which it slips: friction's at it."""
    tau = np.pi / 2
    for guard, (early, late) in ((FRICTION, (-1.0, 0.0)), (SLIDER, (-1 / 3, 2 / 3))):
        release = EventNode(guard + (1 if side > 0 else 2), side)
        site = grazed(guard, side, sine())
        added = Added(stop(guard, -side), tau, early), Added(release, tau, late)
        assert site == Site(table.GRAZING_SLIDING, guard, site.at, Clearance(guard, side, tau), -0.5, added)


@pytest.mark.parametrize(("guard", "row"), [(FRICTION, table.ADDING_SLIDING), (SLIDER, table.LIMIT_GRAZING)])
@pytest.mark.parametrize("side", SIDES)
def test_grazing_of_a_limit(guard: int, row: table.Row, side: int) -> None:
    """Assert a release and a stop about the extremum, or up to it, as far short of the limit as rounding."""
    tau, switch = np.pi / 2, guard + 1
    early, late = (-1.0, 0.0) if guard == SLIDER else (-1 / 3, 2 / 3)
    site = grazed(switch, side, sine())
    added = Added(EventNode(switch, -side), tau, early), Added(stop(guard, side), tau, late)
    assert site.added == added and site.row is row
    assert isinstance(site.held, Clearance)
    assert (site.held.switch, site.held.side, site.held.phase) == (switch, side, tau)
    assert site.held.level == pytest.approx(AT_LEVEL, rel=3e-2)


@pytest.mark.parametrize(
    ("switch", "modes", "name"),
    [
        (KINK, (), "grazing"),
        (WALL, (), "grazing of an impact"),
        (RELAY, (), "grazing of a relay"),
        (FRICTION, (), "grazing-sliding"),
        (1, (), "adding-sliding"),
        (4, (), "grazing of a limit"),
        (1, ((FRICTION, HELD),), "adding-sliding of what slides all along"),
    ],
)
def test_row_of_an_extremum(switch: int, modes: Any, name: str) -> None:
    """Assert it by the kind of the surface, and whether it is its guard."""
    surface = next(s for s in system().surfaces if switch in (s.switch, *(s.releases or ())))
    assert grazingonsets.row_of(sine(modes=modes), surface, switch) == name
    assert grazingonsets.row_of(sine(), Surface(Kind.MARKER, "marker", 9), 9) == ""


@pytest.mark.parametrize("place", [None, (0, ())])
def test_first_slips_of_what_is_held_all_along(place: Any) -> None:
    """Assert that a joint with a place slips, and that one without departs."""
    own = joint(0, FRICTION, place=place)
    found = grazingonsets.row_of(sine(modes=[(FRICTION, HELD)]), own, 1)
    assert found == (table.FIRST_DEPARTURES if place is None else table.FIRST_SLIPS).name


@pytest.mark.parametrize("way", SIDES)
def test_passage_that_begins_to_be_held(way: int) -> None:
    """Assert that it stops and is released after it the same way; others that change there still do."""
    event = EventNode(FRICTION, way, modes=((9, 1),))
    orbit = sine((event, 1.0), (EventNode(FRICTION, -way), 3.0))
    switch = 1 if way > 0 else 2
    limit = Violation(Breach.MODE, switch, 0, -way, 0.25)
    site = grazingonsets.begins(system(), orbit, limit)
    stops = EventNode(FRICTION, way, modes=((FRICTION, STUCK), (9, 1)))
    added = (Added(EventNode(switch, way), 1.0, 1.0),)
    held_at = Limit(0, switch, -way, site.held.level) if site and isinstance(site.held, Limit) else None
    assert held_at is not None and held_at.level == pytest.approx(AT_LEVEL, rel=1e-2)
    assert site == Site(table.CROSSING_SLIDING, switch, 0, held_at, -0.25, added, (), ((0, stops),))


@pytest.mark.parametrize("way", SIDES)
def test_stop_that_breaks(way: int) -> None:
    """Assert that it passes, and stops after it the other way."""
    event = EventNode(FRICTION, way, modes=((FRICTION, STUCK), (9, 1)))
    orbit = sine((event, 1.0), (EventNode(1, 1), 3.0))
    limit = Violation(Breach.MODE, 2, 0, 1, 0.25)
    site = grazingonsets.begins(system(), orbit, limit)
    passes, added = EventNode(FRICTION, way, modes=((9, 1),)), (Added(stop(FRICTION, -way), 1.0, 1.0),)
    assert site is not None
    expected = Site(table.SWITCHING_SLIDING, 2, 0, site.held, -0.25, added, (), ((0, passes),))
    assert site == expected


@pytest.mark.parametrize("breach", [b for b in Breach if b not in (Breach.EXCURSION, Breach.MODE)])
def test_violations_that_no_row_is_for(breach: Breach) -> None:
    """Assert that there is no site."""
    assert grazingonsets.begins(system(), sine(), Violation(breach, KINK, 0, 1, 0.1)) is None


@pytest.mark.parametrize(("offset", "side"), [(-0.9, -1), (0.9, 1)])
def test_excursion_that_a_word_leaves_out(offset: float, side: int) -> None:
    """Assert that a shallow excursion past a kink, found as a violation, is the grazing that begins there."""
    kink: Any = Surfaces([Surface(Kind.KINK, "kink", 0, column=0)], [[1.0, 0.0]], [offset])
    (found,) = violations(kink, sine())
    site = grazingonsets.begins(kink, sine(), found)
    assert site is not None and site.row is table.GRAZING
    assert site.value == pytest.approx(-0.1, abs=1e-6)
    phase = np.pi / 2 if offset < 0 else 3 * np.pi / 2
    assert [each.event.direction for each in site.added] == [-side, side]
    assert [each.phase for each in site.added] == pytest.approx([phase] * 2, abs=1e-6)
    assert isinstance(site.at, Extremum) and site.at.phase == pytest.approx(phase, abs=1e-6)
    every = [each.value for each in grazingonsets.sites_of(kink, sine(), "grazing")]
    assert every and every == pytest.approx([-0.1 / 1.9] * len(every), abs=1e-6)
    assert list(grazingonsets.sites_of(kink, sine(), "grazing of an impact")) == []


@pytest.mark.parametrize(
    ("beside", "modes", "removed", "stops"),
    [
        (0.0, ((FRICTION, 1),), (0,), 0),
        (0.0, ((FRICTION, 1),), (0,), 1),
        (0.1, (), (), 0),
    ],
)
def test_friction_at_grazing_of_a_wall(
    beside: float, modes: Any, removed: tuple[int, ...], stops: int
) -> None:
    """Assert that its event gives way to the impact, after which it stops again where it was stopped."""
    tau = np.pi / 2
    event = stop(FRICTION, 1) if stops else EventNode(FRICTION, 1)
    orbit = sine((event, tau + beside), (EventNode(FRICTION, -1), 4.0))
    at = Extremum(WALL, 9, 0.5, tau, -0.25)
    site = first_impact(system(), orbit, at, 1, -0.25)
    back = (Added(stop(FRICTION, -1), tau, 1.0),) if stops else ()
    impact = Added(EventNode(WALL, -1, modes=modes), tau, 0.0)
    assert site == Site(table.IMPACT, WALL, at, Clearance(WALL, 1, tau), -0.25, (impact, *back), removed)


def turning() -> Any:
    """Friction 0 (1, 2) of cos tau, the speed; a kink 3 of sin tau."""
    surfaces = [joint(0, FRICTION), Surface(Kind.KINK, "kink", 3, column=1)]
    return Surfaces(surfaces, [[0.0, 1.0]] * 3 + [[1.0, 0.0]])


def moving(*nodes: tuple[EventNode, float]) -> Orbit:
    """The orbit of sin tau and its speed."""
    return along(lambda tau: np.column_stack([np.sin(tau), np.cos(tau)]), nodes, intervals=60)


def test_excursion_about_a_reversal_of_friction() -> None:
    """Assert the one from 1 to 2 about the reversal at pi / 2, and none where it is not the kink's turn."""
    into, out, turn = EventNode(3, 1), EventNode(3, -1), EventNode(FRICTION, -1)
    back = EventNode(FRICTION, 1)
    orbit = moving((into, 1.0), (turn, np.pi / 2), (out, 2.0), (back, 3 * np.pi / 2))
    assert reversals(turning(), orbit) == [Reversal(0, (1,), 2), Reversal(2, (3,), 0)]
    off = moving((into, 1.0), (turn, 1.4), (out, 2.0), (back, 4.0))
    assert reversals(turning(), off) == []
    sticking = moving((into, 1.0), (stop(FRICTION, -1), np.pi / 2), (EventNode(2, -1), 1.7), (out, 2.0))
    assert reversals(turning(), sticking) == [Reversal(0, (1, 2), 3)]
    assert reversals(turning(), moving((into, 1.0), (out, 2.0))) == []


@pytest.mark.parametrize(
    ("phase", "found"),
    [
        (1.6, (np.pi / 2, 1.7)),
        (np.pi / 2, (np.pi / 2, 1.7)),
        (1.8, (1.8, 1.8)),
        (1.0, (1.0, 1.0)),
    ],
)
def test_sticking_about_a_phase(phase: float, found: tuple[float, float]) -> None:
    """Assert from where to where friction holds a turn of the kink; the phase itself where it does not."""
    orbit = moving((stop(FRICTION, -1), np.pi / 2), (EventNode(2, -1), 1.7), (EventNode(FRICTION, 1), 4.0))
    assert held(turning(), orbit, 3, phase) == pytest.approx(found, abs=1e-12)


def test_grazing_where_friction_reverses_is_short_of_its_level() -> None:
    """Assert a part of the largest value there, and 0 elsewhere."""
    orbit = moving((EventNode(FRICTION, -1), np.pi / 2), (EventNode(FRICTION, 1), 3 * np.pi / 2))
    assert short_of(turning(), orbit, 3, np.pi / 2) == pytest.approx(AT_LEVEL, rel=1e-2)
    assert short_of(turning(), orbit, 3, 1.0) == 0.0
    free: Any = Surfaces([Surface(Kind.KINK, "kink", 0)], [[1.0, 0.0]])
    assert short_of(free, sine(), 0, np.pi / 2) == 0.0


@pytest.mark.parametrize(
    ("row", "switch", "at", "said"),
    [
        (table.RELAY, RELAY, None, "s7 grazes the threshold at which it would switch"),
        (table.GRAZING, KINK, None, "s6 is grazed"),
        (table.GRAZING_SLIDING, FRICTION, None, "s0 is grazed"),
        (table.CROSSING_SLIDING, 1, 0, "a stop at s0 begins or is broken"),
        (table.ADDING_SLIDING, 2, None, "a slip begins while s0 holds"),
    ],
)
def test_what_begins_in_words(row: table.Row, switch: int, at: int | None, said: str) -> None:
    """Assert the sentence of each kind of beginning."""
    place = Extremum(switch, 0, 0.5, 0.0, 0.0) if at is None else at
    site = Site(row, switch, place, Clearance(switch, 1, 0.0), 0.0)
    begins = Begins(system(), site, 0.5, 1e-6)
    assert begins.name == said
    assert (begins.grazes, begins.last) == (row.grazes, row.last)


def test_event_nodes_after_edits() -> None:
    """Assert that what is removed goes, what is replaced keeps its phase, and what is new is in order."""
    kinks = EventNode(KINK, 1), EventNode(KINK, -1)
    orbit = sine((kinks[0], 1.0), (kinks[1], 2.0), (EventNode(WALL, -1), 4.0))
    new = Added(EventNode(1, 1), 0.1, -2.0, 0.5), Added(stop(FRICTION, -1), 3.0, 1.0)
    held_at = Clearance(KINK, 1, 0.0)
    site = Site(table.GRAZING, KINK, 0, held_at, 0.0, new, (0,), ((2, EventNode(WALL, -1, modes=((0, 1),))),))
    events, phases = ordered(edited(orbit, [site], 0.04), orbit)
    assert phases == pytest.approx([2.0, 3.04, 4.0, 2 * np.pi - 0.3])
    wall = EventNode(WALL, -1, modes=((0, 1),))
    assert events == (kinks[1], stop(FRICTION, -1), wall, EventNode(1, 1))
    node = wall, 4.0 + 2 * np.pi
    assert has(events, phases, node, orbit) and index_of(events, phases, node, orbit) == 2
    assert not has(events, phases, (wall, 4.1), orbit) and not has(events, phases, (kinks[0], 4.0), orbit)
    assert apart(0.1, 2 * np.pi - 0.1, orbit) == pytest.approx(0.2)
    assert site.begin(orbit, 0.04) == (EventNode(1, 1), pytest.approx(0.1 - 0.4))
    later = Site(table.GRAZING, KINK, 0, held_at, 0.0, new[1:], (), ((2, wall),))
    assert later.begin(orbit, 0.04) == (wall, 4.0)


@pytest.mark.parametrize("ripple", [0.0, 1e-7, 1e-3])
def test_grazing_of_a_whole_orbit(ripple: float) -> None:
    """Assert that a switch that is constant but for ripples is held twice these from its level; else none."""
    kink: Any = Surfaces([Surface(Kind.KINK, "kink", 0)], [[1.0]], [-0.9])
    orbit = along(lambda tau: 1 + ripple * np.sin(tau)[:, None])
    at = Extremum(0, 3, 0.5, 1.0, -0.1)
    limit = Violation(Breach.EXCURSION, 0, at, 1, 0.1)
    found = whole_orbit(kink, orbit, limit, 0.25)
    if ripple != 1e-7:
        assert found is None
        return
    assert found is not None and (found.name, found.part) == ("s0 is grazed", 0.25)
    assert (found.condition.switch, found.condition.side, found.condition.phase) == (0, 1, 1.0)
    assert found.condition.level == pytest.approx(4e-7, rel=1e-2)
    assert whole_orbit(kink, orbit, Violation(Breach.MODE, 0, at, 1, 0.1), 0.25) is None
    wall: Any = Surfaces([Surface(Kind.IMPACT, "wall", 0)], [[1.0]], [-0.9])
    assert whole_orbit(wall, orbit, limit, 0.25) is None
    beyond = list(found.beyond(kink, orbit))
    assert [each.condition.side for each in beyond] == [-1] * len(table.SHORT)  # type: ignore[attr-defined]
    assert [each.condition.level for each in beyond] == pytest.approx(table.SHORT, rel=1e-3)  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("one", "other", "distance"),
    [
        ((KINK, 1.0), (KINK, 1.5), 0.5),
        ((KINK, 0.1), (KINK, 2 * np.pi - 0.1), 0.2),
        ((KINK, 1.0), (WALL, 1.0), np.inf),
        ((KINK, 2), (KINK, 2), 0.0),
        ((KINK, 2), (KINK, 3), np.inf),
        ((KINK, 2), (KINK, 1.0), np.inf),
    ],
)
def test_distance_of_sites(one: Any, other: Any, distance: float) -> None:
    """Assert the distance of extrema of one switch, and that other sites are one or of another kind."""

    def site(given: tuple[int, Any]) -> Any:
        switch, at = given
        place = Extremum(switch, 0, 0.0, at, 0.0) if isinstance(at, float) else at
        return SimpleNamespace(switch=switch, at=place, row=table.IMPACT, replaced=())

    assert grazingonsets._distance(site(one), site(other), sine()) == pytest.approx(distance)
    same = distance < 1e-3
    assert grazingonsets._same(system(), sine(), site(one), site(other)) is same


def test_sliders_whose_strain_friction_holds_slip_at_once() -> None:
    """Assert one site for two sliders at their limits from 2 to 3, as long as friction holds their strain.

    It is greatest anywhere between these; they are let go before 2, and stop there with the friction.
    """
    kinds = Kind.SLIDER, Kind.SLIDER, Kind.SLIDING
    surfaces = [joint(k, 3 * k, kind) for k, kind in enumerate(kinds)]
    rate, strain = [1.0, 0.0], [0.0, 1.0]
    weights = [rate, strain, strain] * 2 + [rate, [0.0, 0.0], [0.0, 0.0]]
    system: Any = Surfaces(surfaces, weights, [0.0, -1.0, 2.0] * 2 + [0.0, -1.0, 1.0])
    both = (0, STUCK), (3, STUCK)
    nodes = [
        (EventNode(0, 1, modes=both), 0.5),
        (EventNode(6, -1, modes=((6, STUCK),)), 2.0),
        (EventNode(8, -1), 3.0),
        (EventNode(2, -1, modes=((3, -1),)), 5.0),
    ]

    def states(tau: Any) -> Any:
        far = np.where(tau < 2.0, 2.0 - tau, np.minimum(3.0 - tau, 0.0))
        return np.column_stack([2 * far, 1.0 - far**2])

    orbit = along(states, nodes)
    sites = grazingonsets.sites_of(system, orbit, table.LIMIT_GRAZING.name)
    every = [site for site in sites if site.switch in (1, 4)]
    assert len(every) > 4
    for own in (every[0], every[-1]):
        (site,) = grazingonsets.at_once(system, orbit, own)
        (added,) = site.added
        assert {added.event.switch, *(k + 1 for k, _ in added.event.modes)} == {1, 4}
        assert added.at(0.1)[1] == pytest.approx(1.9)
        ((node, stops),) = site.replaced
        assert node == 1 and dict(stops.modes) == {6: STUCK, 0: STUCK, 3: STUCK}
