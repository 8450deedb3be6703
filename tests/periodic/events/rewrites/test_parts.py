"""Sites of rewrites on words and orbits that are given: every event node by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites import first, meetings, merging, table, together, twins
from periodic.events.rewrites.sites import Added, Site
from periodic.events.sideconditions import Length, Limit
from periodic.events.switchpolynomials import Extremum
from periodic.events.thresholds import BESIDE_EXTREMUM
from periodic.events.violations import Breach, Violation
from periodic.orbit.mesh import EventNode
from periodic.system import MINUS, PLUS, STUCK, Kind
from periodic.system.events import Surface

WALL = EventNode(3, -1)
UP = EventNode(1, 1)
TURN = EventNode(0, 1)
STOP = EventNode(0, 1, modes=((0, STUCK),))


def friction_and_wall() -> Any:
    """Friction 0 (1, 2) and a wall 3."""
    return Surfaces([joint(), Surface(Kind.IMPACT, "wall", 3)], [[1.0]] * 4)


def word(*events: EventNode) -> Any:
    """An orbit with event nodes at 1, 3, ..."""
    nodes = [(event, 1.0 + 2 * k) for k, event in enumerate(events)]
    return along(lambda tau: np.sin(tau)[:, None], nodes, intervals=4 * len(events))


@pytest.mark.parametrize(
    ("events", "row"),
    [
        ((TURN, WALL), table.BEFORE_IMPACT),
        ((UP, WALL), table.RELEASE_AT_IMPACT),
        ((WALL, TURN), table.AFTER_IMPACT),
        ((WALL, STOP), table.CAUGHT),
        ((WALL, UP), None),
        ((TURN, UP), None),
        ((WALL, WALL), None),
        ((EventNode(0, 1, modes=((9, STUCK),)), WALL), None),
    ],
)
def test_what_meets_an_impact(
    events: tuple[EventNode, EventNode], row: table.Row | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the row of the segment from one event node to the next, by which of both is the impact."""
    impacts = [k for k, event in enumerate(events) if event == WALL]
    monkeypatch.setattr(meetings, "tied", lambda *_: impacts)
    monkeypatch.setattr(meetings, "thrown", lambda *_: impacts)
    assert meetings.meeting(friction_and_wall(), word(*events), 0) is row
    monkeypatch.setattr(meetings, "thrown", lambda *_: [])
    assert meetings.meeting(friction_and_wall(), word(*events), 0) is None


@pytest.mark.parametrize(
    ("first", "modes", "changed"),
    [
        (TURN, (), ((0, PLUS),)),
        (EventNode(0, -1), (), ((0, MINUS),)),
        (TURN, ((0, MINUS),), ()),
        (TURN, ((0, STUCK), (7, PLUS)), ((0, STUCK), (7, PLUS))),
        (UP, (), ((0, PLUS),)),
        (UP, ((0, STUCK),), ()),
        (STOP, (), ((0, STUCK),)),
    ],
)
def test_an_event_that_meets_the_impact_after_it(
    first: EventNode, modes: tuple[tuple[int, int], ...], changed: tuple[tuple[int, int], ...]
) -> None:
    """Assert that the impact leads from the mode before both to that after both, and the other event goes."""
    row = table.BEFORE_IMPACT if first.switch == 0 else table.RELEASE_AT_IMPACT
    impact = EventNode(3, -1, modes=modes)
    site = meetings.met(friction_and_wall(), word(first, impact), row, 0)
    held = Limit(1, first.switch, -first.direction, arriving=True)
    assert site == Site(row, first.switch, 1, held, 0.0, (), (0,), ((1, EventNode(3, -1, modes=changed)),))


@pytest.mark.parametrize("earlier", [PLUS, MINUS])
def test_an_event_that_meets_the_impact_before_it(earlier: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a passage after it goes, and that a stop after it is reached from the other side."""
    monkeypatch.setattr(meetings, "_mode_before", lambda *_: earlier)
    system, changed = friction_and_wall(), EventNode(3, -1, modes=() if earlier == PLUS else ((0, PLUS),))
    after = meetings.met(system, word(WALL, TURN), table.AFTER_IMPACT, 0)
    assert after == Site(table.AFTER_IMPACT, 0, 0, Limit(0, 0, 1), 0.0, (), (1,), ((0, changed),))
    caught = meetings.met(system, word(WALL, STOP), table.CAUGHT, 0)
    other = EventNode(0, -1, modes=STOP.modes)
    assert caught == Site(table.CAUGHT, 0, 0, Length(0, 2.0), 0.0, (), (), ((0, changed), (1, other)))


def beside_impact(monkeypatch: pytest.MonkeyPatch, earlier: int, slopes: tuple[float, float]) -> None:
    """Give the mode before an impact, and the slopes of the guard by the equations of both sides."""
    monkeypatch.setattr(meetings, "_mode_before", lambda *_: earlier)
    monkeypatch.setattr(meetings, "_slopes", lambda *_: slopes)
    monkeypatch.setattr(meetings, "_left", lambda *_: 1e-9)


@pytest.mark.parametrize(
    ("side", "slopes", "modes"),
    [
        (1, (-1.0, -2.0), ()),
        (1, (-1.0, 2.0), ((0, STUCK),)),
        (1, (-1.0, 0.0), ()),
        (1, (1.0, 2.0), None),
        (1, (0.0, 2.0), None),
        (-1, (1.0, 2.0), ()),
        (-1, (1.0, -2.0), ((0, STUCK),)),
        (-1, (-1.0, -2.0), None),
    ],
)
def test_friction_that_turns_just_before_an_impact(
    side: int,
    slopes: tuple[float, float],
    modes: tuple[tuple[int, int], ...] | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Assert that it passes, or sticks where it comes back by the equations of the other side."""
    beside_impact(monkeypatch, side, slopes)
    system, orbit = friction_and_wall(), word(TURN, WALL)
    limit: Any = SimpleNamespace(switch=0, side=side, depth=0.25, arriving=True, at=1)
    site = meetings.begun(system, orbit, system.surfaces[0], limit)
    if modes is None:
        assert site is None
        return
    changed = EventNode(3, -1, modes=((0, side),))
    added = Added(EventNode(0, -side, modes=modes), 3.0, -1.0)
    held = Limit(1, 0, side, 1e-9, arriving=True)
    assert site == Site(table.BEFORE_IMPACT, 0, 1, held, -0.25, (added,), (), ((1, changed),))


@pytest.mark.parametrize(("switch", "side"), [(1, -1), (2, 1)])
def test_friction_that_is_let_go_just_before_an_impact(
    switch: int, side: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the impact leads on from the side to which it is let go, to where it was led before."""
    beside_impact(monkeypatch, STUCK, (0.0, 0.0))
    system, orbit = friction_and_wall(), word(TURN, WALL)
    limit: Any = SimpleNamespace(switch=switch, side=side, depth=0.25, arriving=True, at=1)
    site = meetings.begun(system, orbit, system.surfaces[0], limit)
    changed, added = EventNode(3, -1, modes=((0, STUCK),)), Added(EventNode(switch, -side), 3.0, -1.0)
    held = Limit(1, switch, side, 1e-9, arriving=True)
    row = table.RELEASE_AT_IMPACT
    assert site == Site(row, switch, 1, held, -0.25, (added,), (), ((1, changed),))


@pytest.mark.parametrize(("side", "slope"), [(1, 1.0), (-1, -1.0), (1, -1.0), (-1, 1.0), (1, 0.0)])
def test_friction_that_turns_just_after_an_impact(
    side: int, slope: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it turns where its guard goes on to the side on which it should be, and else none."""
    beside_impact(monkeypatch, side, (slope, 0.0))
    system, orbit = friction_and_wall(), word(TURN, WALL)
    limit: Any = SimpleNamespace(switch=0, side=side, depth=0.25, arriving=False, at=1)
    site = meetings.begun(system, orbit, system.surfaces[0], limit)
    if side * slope <= 0:
        assert site is None
        return
    changed, added = EventNode(3, -1, modes=((0, -side),)), Added(EventNode(0, side), 3.0, 1.0)
    held = Limit(1, 0, side, 1e-9)
    assert site == Site(table.AFTER_IMPACT, 0, 1, held, -0.25, (added,), (), ((1, changed),))


def sliders() -> Any:
    """Sliders 0 (1, 2), 3 (4, 5) and friction 6 (7, 8)."""
    each = [joint(0, 0, Kind.SLIDER), joint(1, 3, Kind.SLIDER), joint(2, 6)]
    return Surfaces(each, [[1.0]] * 9)


def slip(row: table.Row, switch: int, guard: int, phase: float, count: int = 2) -> Site:
    """A site at which a slider is let go at a phase, and held again."""
    release, stop = EventNode(switch, 1), EventNode(guard, -1, modes=((guard, STUCK),))
    added = (Added(release, phase, 0.0), Added(stop, phase, 1.0))[:count]
    return Site(row, switch, Extremum(switch, 0, 0.5, phase, 0.0), Limit(0, switch, 1), 0.0, added)


@pytest.mark.parametrize(
    ("one", "other", "together"),
    [
        ((table.LIMIT_GRAZING, 1.0, 2), (table.LIMIT_GRAZING, 1.0, 2), True),
        ((table.LIMIT_GRAZING, 1.0, 2), (table.LIMIT_GRAZING, 1.0 + 2 * BESIDE_EXTREMUM, 2), False),
        ((table.LIMIT_GRAZING, 1.0, 1), (table.LIMIT_GRAZING, 1.0, 2), False),
        ((table.LIMIT_GRAZING, 1.0, 2), (table.LIMIT_GRAZING, 1.0, 1), False),
        ((table.GRAZING, 1.0, 2), (table.LIMIT_GRAZING, 1.0, 2), False),
        ((table.LIMIT_GRAZING, 1.0, 2), (table.GRAZING, 1.0, 2), False),
    ],
)
def test_sliders_that_slip_at_one_phase(
    one: Any, other: Any, together: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that two of one guard that are let go and held at one phase are one site, and no others."""
    monkeypatch.setattr(twins, "held_in", lambda *_: [])
    monkeypatch.setattr(twins, "twins", lambda system, guard, held: {0: 1, 3: 1})
    pairs = zip((one, other), ((1, 0), (4, 3)), strict=True)
    sites = [slip(row, switch, guard, phase, count) for (row, phase, count), (switch, guard) in pairs]
    found = twins.slipping_together(sliders(), word(UP, UP), sites)
    if not together:
        assert found == sites
        return
    (both,) = found
    release, stop = both.added
    assert release == Added(EventNode(1, 1, modes=((3, 1),)), 1.0, 0.0)
    assert stop == Added(EventNode(0, -1, modes=((0, STUCK), (3, STUCK))), 1.0, 1.0)
    monkeypatch.setattr(twins, "twins", lambda system, guard, held: {guard: 1})
    assert twins.slipping_together(sliders(), word(UP, UP), sites) == sites


@pytest.mark.parametrize(
    ("guard", "at", "joined"),
    [(0, 1.0, True), (0, 1.0 + 2 * BESIDE_EXTREMUM, False), (6, 1.0, False)],
)
def test_a_slider_that_is_held_where_its_twin_is(
    guard: int, at: float, joined: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it stops at the event node of its twin where the strain turns; friction stops by itself."""
    monkeypatch.setattr(twins, "held_in", lambda *_: [])
    monkeypatch.setattr(twins, "holding", lambda *_: {})
    monkeypatch.setattr(twins, "twins", lambda system, guard, held: {guard: 1, 3: 1})
    stop = EventNode(3, -1, modes=((3, STUCK),))
    orbit, site = word(stop, EventNode(4, 1)), slip(table.LIMIT_GRAZING, guard + 1, guard, at)
    found = twins.with_twins(sliders(), orbit, site)
    if not joined:
        assert found == site
        return
    assert found.added == (Added(EventNode(guard + 1, 1), 1.0, 0.0),)
    assert found.replaced == ((0, EventNode(3, -1, modes=((3, STUCK), (guard, STUCK)))),)


@pytest.mark.parametrize(
    ("since", "kind", "found"),
    [(1.5, Kind.SLIDING, 0), (2.5, Kind.SLIDING, None), (1.5, Kind.SLIDER, None)],
)
def test_turn_of_a_strain_that_friction_holds(since: float, kind: Kind, found: int | None) -> None:
    """Assert the stop of friction within whose sticking the strain turns; a slider's must be at the turn."""
    system = Surfaces([joint(0, 0, kind)], [[1.0]] * 3)
    stop = EventNode(0, -1, modes=((0, STUCK),))
    at = Extremum(0, 0, 0.5, 1.0 + since, 0.0)
    assert twins._turn(system, word(stop, UP), at, {0: 1}) == found  # type: ignore[arg-type]
    assert twins._turn(system, word(stop, UP), at, {5: 1}) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("row", "sizes", "ends"),
    [
        (table.GRAZING, (0.1, 0.06), False),
        (table.GRAZING, (0.1, 0.02), True),
        (table.GRAZING, (0.1, 0.1), False),
        (table.GRAZING, (0.1, 0.2), False),
        (table.CROSSING_SLIDING, (0.1, 0.05), False),
        (table.CROSSING_SLIDING, (0.1, 0.009), True),
        (table.CROSSING_SLIDING, (0.1, 0.025), False),
        (table.ADDING_ABOUT, (0.1, 0.05), False),
        (table.ADDING_ABOUT, (0.1, 0.01), True),
    ],
)
def test_when_an_excursion_is_near_its_end(
    row: table.Row, sizes: tuple[float, float], ends: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that after grazing half of the size must be left, else less than the next of the sizes."""
    site = SimpleNamespace(row=row, switch=0)
    monkeypatch.setattr(first, "ends", lambda *_: [site])
    monkeypatch.setattr(first, "_name", lambda *_: "")
    excursion: Any = SimpleNamespace(row=row, unit=2.0, size=lambda system, orbit: 2 * orbit)
    before, after = sizes
    given: Any = before, after
    found = first._ending(None, *given, 1e-9, excursion)  # type: ignore[arg-type]
    assert (found is not None) is ends
    if found is not None:
        half = before if row.gradual else first.VANISHING * before
        assert found.size == 2 * row.size_below(half)
        assert found.part == pytest.approx(row.part(before, after, row.size_below(half)))
        assert not found.final


@pytest.mark.parametrize(
    ("power", "part"), [(table.LINEAR, 0.5), (table.ROOT, 0.75), (table.ROOT, 1.0), (table.LINEAR, 1.0)]
)
def test_part_of_the_way_to_a_size(power: float, part: float) -> None:
    """Assert it from 4 to 0 at 2: half if the size is linear, 12/32 of twice that way if its square is."""
    row = table.Row(name="", grazes=True, power=power, sizes=(2.0, 1.0))
    if part == 1.0:
        assert row.part(4.0, 3.0, 1.0) == 1.0
        return
    exact = 0.5 if power == table.LINEAR else (16 - 4) / (2 * 4 * 4)
    assert row.part(4.0, 0.0, 2.0) == exact
    assert [row.size_below(size) for size in (3.0, 2.0, 1.5, 1.0, 0.5)] == [2.0, 1.0, 1.0, 1.0, 0.5]
    assert row.least == 1.0


@pytest.mark.parametrize(
    "kinds", [(Kind.SLIDER, Kind.SLIDING), (Kind.SLIDING, Kind.SLIDER), (Kind.SLIDER,) * 2]
)
def test_stops_that_merge_and_part(kinds: tuple[Kind, Kind]) -> None:
    """Assert one event node for two stops, that of friction if there is one, and two for one, either way."""
    system: Any = Surfaces([joint(0, 0, kinds[0]), joint(1, 3, kinds[1])], [[1.0]] * 6)
    one, other = EventNode(0, 1, modes=((0, STUCK),)), EventNode(3, -1, modes=((3, STUCK), (9, 1)))
    found = merging.Meeting(0, 2, (0, 1), {0: 1, 3: -1}, ((0,), (3,)))
    ((both,),) = merging._other(system, [one, other], found)
    first, second = (other, one) if kinds[0] is Kind.SLIDER and kinds[1] is Kind.SLIDING else (one, other)
    assert both == EventNode(first.switch, first.direction, modes=(*first.modes, *second.modes))
    stops = EventNode(0, 1, modes=((0, STUCK),)), EventNode(3, -1, modes=((3, STUCK),))
    together = EventNode(3, -1, modes=((0, STUCK), (3, STUCK)))
    assert list(merging._other(system, [together], found)) == [list(stops), list(stops[::-1])]


def test_sliders_in_parallel_stop_at_their_friction() -> None:
    """Assert that of joints of one guard that of friction stops, the others with it, in its own direction."""
    system: Any = Surfaces([joint(0, 0, Kind.SLIDER), joint(1, 3)], [[1.0]] * 6)
    stop = merging._stop(system, (0, 3), {0: 1, 3: -1}, 1)
    assert stop == EventNode(3, -1, modes=((0, STUCK), (3, STUCK)))
    assert merging._stop(system, (0,), {0: -1}, 1) == EventNode(0, -1, modes=((0, STUCK),))


@pytest.mark.parametrize(
    ("modes", "found"),
    [
        ((((0, STUCK),), ((3, STUCK),)), [0, 3]),
        ((((0, STUCK), (3, STUCK)),), [0, 3]),
        ((((0, STUCK), (9, 1)),), []),
        ((((3, STUCK),),), []),
        (((),), []),
    ],
)
def test_guards_that_stop_where_nothing_else_happens(modes: Any, found: list[int]) -> None:
    """Assert the guards that are held, where each event node holds its own and changes nothing more."""
    events = [EventNode((0, 3)[k], 1, modes=each) for k, each in enumerate(modes)]
    assert merging._stopped(events, range(len(events))) == found


@pytest.mark.parametrize(
    ("node", "friction", "stops", "segments"),
    [(4, 4, (5, 6), (4, 5)), (4, 6, (4, 5), (4, 5)), (4, 4, (5,), (4,)), (4, 5, (4,), (4,))],
)
def test_segments_between_stops_that_meet(
    node: int, friction: int, stops: tuple[int, ...], segments: tuple[int, ...]
) -> None:
    """Assert those between the first event node and the last, by the nodes at which they begin."""
    assert merging.Meeting(node, friction, stops, {}, ()).segments == segments


@pytest.mark.parametrize(("longest", "last"), [(0.19, True), (0.2, True), (0.21, False)])
def test_last_slip_of_a_joint(longest: float, last: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that it is an end for good where the longest slip is no more than twice this one."""
    row = table.ADDING_SLIDING
    monkeypatch.setattr(first, "ends", lambda *_: [SimpleNamespace(row=row, switch=1)])
    monkeypatch.setattr(first, "_name", lambda system, site, last: f"last: {last}")
    monkeypatch.setattr(first, "longest_slip", lambda *_: longest)
    excursion: Any = SimpleNamespace(row=row, unit=1.0, size=lambda system, orbit: orbit)
    given: Any = 0.1, 1e-4
    found = first._ending(friction_and_wall(), *given, 1e-9, excursion)
    assert found is not None and found.name == f"last: {last}" and found.final is last
    assert found.size == (first.LONGEST if last else row.size_below(first.VANISHING * 0.1))


@pytest.mark.parametrize(("lowest", "share"), [(0.3, 0.75), (None, 0.6)])
def test_part_of_the_way_to_an_extremum(
    lowest: float | None, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert it by the base's nearest extremum, or by its value at the same place where it has none."""
    at = Extremum(0, 2, 0.5, 1.0, -0.1)
    near = None if lowest is None else Extremum(0, 3, 0.5, 1.1, lowest)
    dense: Any = SimpleNamespace(
        orbit=word(UP, TURN),
        minima=lambda switch, side: [near] * (near is not None),
        nearest=lambda switch, side, phase: near,
        value=lambda place: 0.15 if place.interval == at.interval else np.nan,
    )
    monkeypatch.setattr(first, "SwitchPolynomials", lambda system, orbit: dense)
    monkeypatch.setattr(first, "beside_node", lambda dense, extremum: False)
    monkeypatch.setattr(first, "sliding", lambda system, switch: None)
    past = Violation(Breach.EXCURSION, 0, at, 1, 0.1)
    assert first._share(friction_and_wall(), dense.orbit, past) == pytest.approx(share)


def test_releases_of_a_slider_by_the_events_before_them() -> None:
    """Assert the stop before a release the same way; a motion may have a release alone in its period."""
    stop, up, down = EventNode(0, 1, modes=((0, STUCK),)), EventNode(1, 1), EventNode(2, -1)
    slider = joint(kind=Kind.SLIDER)
    for events, found in (
        ([up], [(0, PLUS, None)]),
        ([stop, up], [(1, PLUS, None)]),
        ([up, stop, up], [(0, PLUS, None), (2, PLUS, 1)]),
        ([up, stop, down], [(0, PLUS, None), (2, MINUS, None)]),
    ):
        nodes = [(event, float(k)) for k, event in enumerate(events)]
        each = [(r.node, r.direction, r.stop) for r in together.Word(None, nodes, []).releases(slider)]
        assert each == found
