"""Switches along orbits that are given functions, and the sites of rewrites there: every value by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events import sideconditions, violations
from periodic.events.rewrites import ends, merging, sites, strikes, swaps, table, twins
from periodic.events.rewrites.sites import Added, Site
from periodic.events.rewrites.table import GRAZING, IMPACT, SHORT
from periodic.events.sideconditions import Clearance, Length, Lengths, Limit, Speed
from periodic.events.switchpolynomials import Extremum, SwitchPolynomials, _roots
from periodic.events.thresholds import decades
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import STUCK, Kind
from periodic.system.events import Surface

KINK = Surface(Kind.KINK, "kink", 0)


def kinked(offset: float = 0.0) -> Surfaces:
    """A kink at x + offset = 0."""
    return Surfaces([KINK], [[1.0]], [offset])


def sine(tau: Array) -> Array:
    """x = sin tau."""
    return np.sin(tau)[:, None]


def events_of(*nodes: tuple[EventNode, float], kind: Kind = Kind.KINK) -> tuple[Surfaces, Orbit]:
    """The sine with event nodes."""
    return Surfaces([Surface(kind, "s", 0)], [[1.0]], directions=[-1]), along(sine, nodes)


def test_crossings_of_a_sine() -> None:
    """Assert where sin tau passes 0.5, and that event nodes give their own phases."""
    (up, first), (down, last) = SwitchPolynomials(kinked(-0.5), along(sine)).crossings(0)
    assert (up.direction, down.direction) == (1, -1)
    assert (first, last) == (pytest.approx(np.pi / 6, abs=1e-6), pytest.approx(5 * np.pi / 6, abs=1e-6))
    system, orbit = events_of((EventNode(0, 1), 0.0), (EventNode(0, -1), np.pi))
    found = SwitchPolynomials(system, orbit).crossings(0)
    assert [(event.direction, phase) for event, phase in found] == [(-1, np.pi), (1, 0.0)]
    assert SwitchPolynomials(kinked(2.0), along(sine)).crossings(0) == []


def test_a_change_of_sign_at_an_impact_is_no_crossing() -> None:
    """Assert a jump from -1 to 1 at an event node of an impact is left out, and at another kept."""

    def falling(tau: Array) -> Array:
        return (1 - 2 * (tau - 1) / (2 * np.pi))[:, None]

    node = [(EventNode(1, -1), 1.0)]
    surfaces = [KINK, Surface(Kind.IMPACT, "wall", 1)]
    orbit = along(falling, node)
    orbit.nodes[-1] = orbit.nodes[0]
    system = Surfaces(surfaces, [[1.0], [0.0]], [0.0, 1.0], directions=[0, -1])
    found = SwitchPolynomials(system, orbit).crossings(0)
    assert [event.direction for event, _ in found] == [-1]
    plain = Surfaces([KINK, Surface(Kind.MARKER, "mark", 1)], [[1.0], [0.0]], [0.0, 1.0])
    assert sorted(event.direction for event, _ in SwitchPolynomials(plain, orbit).crossings(0)) == [-1, 1]


def test_minima_and_the_nearest_of_them() -> None:
    """Assert those of sin tau + 0.3 sin 3 tau on either side, and the one nearest a phase.

    The derivative cos tau + 0.9 cos 3 tau vanishes where cos^2 tau = 1.7 / 3.6, and at cos tau = 0.
    """
    system = kinked()
    dense = SwitchPolynomials(
        system, along(lambda tau: (np.sin(tau) + 0.3 * np.sin(3 * tau))[:, None], intervals=77)
    )
    low = float(np.arccos(np.sqrt(1.7 / 3.6)))
    found = sorted(e.phase for e in dense.minima(0, 1))
    assert found == pytest.approx([np.pi / 2, np.pi + low, 2 * np.pi - low], abs=1e-4)
    above = sorted(e.phase for e in dense.minima(0, -1))
    assert above == pytest.approx([low, np.pi - low, 1.5 * np.pi], abs=1e-4)
    at = dense.nearest(0, 1, 2.0)
    assert at.phase == pytest.approx(np.pi / 2, abs=1e-4) and at.value == pytest.approx(0.7, abs=1e-7)
    assert dense.value(at) == pytest.approx(0.7, abs=1e-7)


def test_sides_expected_of_a_kink_change_at_its_nodes() -> None:
    """Assert the sides between nodes, and that without any the given one is expected all along."""
    system, orbit = events_of((EventNode(0, 1), 0.0), (EventNode(0, -1), np.pi))
    dense = SwitchPolynomials(system, orbit)
    assert dense.expected(0, -1).tolist() == [1] * 20 + [-1] * 20
    assert SwitchPolynomials(system, along(sine)).expected(0, -1).tolist() == [-1] * 40


def test_sides_expected_of_what_is_held() -> None:
    """Assert the guard on its side, 0 where held; of the releases -1 and 1 there, 0 elsewhere."""
    system = Surfaces([joint()], [[1.0]] * 3)
    word = [(EventNode(0, -1, modes=((0, STUCK),)), 1.0), (EventNode(1, 1), 2.0), (EventNode(0, -1), 4.0)]
    dense = SwitchPolynomials(system, along(sine, word, intervals=12))
    assert dense.expected(0, 1).tolist() == [0] * 4 + [1] * 4 + [-1] * 4
    assert dense.expected(1, 1).tolist() == [-1] * 4 + [0] * 8
    assert dense.expected(2, 1).tolist() == [1] * 4 + [0] * 8


def test_excursions_without_event_nodes() -> None:
    """Assert that of sin tau + 0.5 below 0: 0.5 deep at 3 pi / 2; none where the other side is expected."""
    dense = SwitchPolynomials(kinked(0.5), along(sine))
    (found,) = dense.unmarked(0, 1)
    assert found.phase == pytest.approx(1.5 * np.pi, abs=1e-6)
    assert found.value == pytest.approx(-0.5, abs=1e-7)
    (above,) = dense.unmarked(0, -1)
    assert above.phase == pytest.approx(0.5 * np.pi, abs=1e-6)
    assert dense.side(0) == 1 and SwitchPolynomials(kinked(-0.5), along(sine)).side(0) == -1
    assert SwitchPolynomials(kinked(1.5), along(sine)).unmarked(0, 1) == []
    (breach,) = violations.between_nodes(kinked(0.5), along(sine))
    assert breach.breach is violations.Breach.EXCURSION
    assert (breach.side, breach.depth) == (1, pytest.approx(0.5, abs=1e-7))


def test_how_far_the_states_take_a_switch() -> None:
    """Assert the largest |s_x x| = 2 of 2 x + 1, and that it varies by 4, twice its size."""
    dense = SwitchPolynomials(Surfaces([KINK], [[2.0]], [1.0]), along(sine))
    assert dense.size(0) == pytest.approx(2.0, rel=1e-3)
    assert dense.flat(0, 2.1) and not dense.flat(0, 1.9)


def test_an_orbit_through_a_wall_is_told() -> None:
    """Assert the depth 0.5 past a wall at x = -0.5 that is met downwards, and none of one at -1.5."""
    surface = Surface(Kind.IMPACT, "wall", 0)
    through, clear = (Surfaces([surface], [[1.0]], [place], directions=[-1]) for place in (0.5, 1.5))
    (found,) = violations.refusals(through, along(sine))
    assert found.breach is violations.Breach.THROUGH
    assert (found.side, found.depth) == (1, pytest.approx(0.5, abs=1e-7))
    assert violations.refusals(clear, along(sine)) == []


@pytest.mark.parametrize(
    "coefficients",
    [[-6.0, 11.0, -6.0, 1.0], [2.0, -3.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0], [-2.0, 4.0, 0.0, 0.0]],
)
def test_roots_of_polynomials(coefficients: list[float]) -> None:
    """Assert (x-1)(x-2)(x-3), (x-1)(x-2), none of 0, and 1/2 of 4 x - 2; NaN where there are fewer."""
    exact = {-6.0: [1, 2, 3], 2.0: [1, 2], 0.0: [], -2.0: [0.5]}[coefficients[0]]
    (found,) = _roots(np.array([coefficients]))
    assert sorted(found[np.isfinite(found)].real) == pytest.approx(exact, abs=1e-12)
    assert len(found) == 3


@pytest.mark.parametrize(
    ("most", "least", "found"), [(1.0, 0.01, (1.0, 0.1, 0.01)), (0.5, 0.051, (0.5,)), (0.5, 0.7, (0.5,))]
)
def test_decades(most: float, least: float, found: tuple[float, ...]) -> None:
    """Assert sizes of which each is a tenth of the one before, none but the first below the least."""
    assert decades(most, least) == pytest.approx(found)


def test_lengths_of_segments_as_conditions() -> None:
    """Assert values and gradients of the lengths of segments between three nodes, one around the period."""
    nodes = [(EventNode(0, 1), 1.0), (EventNode(0, -1), 2.0), (EventNode(0, 1), 4.0)]
    system, orbit = events_of(*nodes)
    row = Length(1, 0.5).linearise(system, orbit, (0,))
    assert (row.value, row.outer.tolist()) == (pytest.approx(1.5), [0.0, -1.0, 1.0, 0.0])
    last = Length(2, 0.5).linearise(system, orbit, ())
    assert (last.value, last.outer.tolist()) == (pytest.approx(2 * np.pi - 3.5), [1.0, 0.0, -1.0])
    both = Lengths((0, 1), 1.0).linearise(system, orbit, ())
    assert (both.value, both.outer.tolist()) == (pytest.approx(2.0), [-1.0, 0.0, 1.0])
    assert not both.nodes.any()


def test_clearance_of_an_extremum() -> None:
    """Assert that sin tau + 1.25 is 0.25 from its level at 3 pi / 2, less 0.05, and that it grows with x."""
    system, orbit = kinked(1.25), along(sine)
    row = Clearance(0, 1, 4.5, 0.05).linearise(system, orbit, (0,))
    assert row.value == pytest.approx(0.2, abs=1e-7)
    total = row.nodes.sum() + (0.0 if row.stages is None else row.stages.sum())
    assert total == pytest.approx(1.0, abs=1e-9)
    below = Clearance(0, -1, 1.5).linearise(system, orbit, ())
    assert below.value == pytest.approx(-2.25, abs=1e-7)


def test_limit_at_an_event_node() -> None:
    """Assert side * (x + 0.5) less its level at a node at pi / 6."""
    system = Surfaces([KINK, Surface(Kind.KINK, "other", 1)], [[1.0], [1.0]], [-0.5, 0.5])
    orbit = along(sine, [(EventNode(0, 1), np.pi / 6), (EventNode(0, -1), 5 * np.pi / 6)])
    row = Limit(0, 1, -1, 0.25).linearise(system, orbit, ())
    assert row.value == pytest.approx(-1.25, abs=1e-12)
    assert row.nodes[0, 0] == -1.0 and np.count_nonzero(row.nodes) == 1


def test_speed_at_an_impact() -> None:
    """Assert |cos tau| = sqrt(3) / 2 where sin tau falls through 1/2, less 0.5."""
    system = Surfaces([Surface(Kind.IMPACT, "wall", 0)], [[1.0]], [-0.5], directions=[-1])
    orbit = along(sine, [(EventNode(0, -1), 5 * np.pi / 6)])
    assert sideconditions.speed(system, orbit, 0) == pytest.approx(np.sqrt(3) / 2, abs=1e-6)
    row = Speed(0, 0.5).linearise(system, orbit, ())
    assert row.value == pytest.approx(np.sqrt(3) / 2 - 0.5, abs=1e-6)


def test_added_nodes_lie_by_their_power_of_the_size() -> None:
    """Assert phase + part size^power."""
    event = EventNode(0, 1)
    assert Added(event, 1.0, -0.5).at(0.1) == (event, pytest.approx(0.95))
    assert Added(event, 1.0, 2.0, 2.0).at(0.1) == (event, pytest.approx(1.02))


def test_nodes_are_edited_at_sites() -> None:
    """Assert replaced, removed and added event nodes, in order within the period."""
    a, b, c, d = (EventNode(k, 1) for k in range(4))
    orbit = along(sine, [(a, 1.0), (b, 2.0), (c, 4.0)])
    site = Site(GRAZING, 0, 1, Length(0, 0.0), 0.0, (Added(d, 7.0, 1.0),), (1,), ((0, d),))
    assert sites.edited(orbit, [site], 0.25) == [(d, 1.0), (c, 4.0), (d, 7.25)]
    events, phases = sites.ordered(sites.edited(orbit, [site], 0.25), orbit)
    assert events == (d, d, c)
    assert phases == pytest.approx([7.25 - 2 * np.pi, 1.0, 4.0])
    assert sites.has(events, phases, (c, 4.0), orbit)
    assert not sites.has(events, phases, (c, 4.1), orbit) and not sites.has(events, phases, (a, 4.0), orbit)
    assert sites.index_of(events, phases, (d, 1.0), orbit) == 1
    assert sites.apart(0.1, 2 * np.pi - 0.2, orbit) == pytest.approx(0.3)


def test_change_begins_with_what_is_replaced_or_added() -> None:
    """Assert the first node that is replaced, unless one is added before it, else the first added one."""
    a, b = EventNode(0, 1), EventNode(1, 1)
    orbit = along(sine, [(a, 1.0), (a, 2.0)])
    held = Length(0, 0.0)
    replaced = Site(GRAZING, 0, 1, held, 0.0, (Added(b, 2.0, 1.0),), (), ((1, b),))
    assert replaced.begin(orbit, 0.5) == (b, 2.0)
    early = replace(replaced, added=(Added(b, 2.0, -1.0),))
    assert early.begin(orbit, 0.5) == (b, 1.5)
    assert replace(replaced, replaced=()).begin(orbit, 0.5) == (b, 2.5)


def test_sizes_of_the_table() -> None:
    """Assert the next smaller size, the least one, and how sizes fall on the way.

    After grazing size^2 falls evenly: (1 - 0.25) / (2 * 1 * 0.5) of the way from 1 towards 0.5; after a
    passage the size itself does.
    """
    assert GRAZING.size_below(SHORT[0]) == SHORT[1]
    assert GRAZING.size_below(SHORT[0] * (1 + 1e-14)) == SHORT[1]  # it is held there, but for rounding
    assert GRAZING.size_below(SHORT[-1]) == SHORT[-1] == GRAZING.least
    assert GRAZING.part(1.0, 0.5, 0.5) == pytest.approx(0.75)
    assert table.SWAP.part(1.0, 0.5, 0.75) == pytest.approx(0.5)
    assert table.SWAP.part(1.0, 0.5, 0.25) == 1.0 and GRAZING.part(1.0, 0.9, 0.1) == 1.0


def struck(*after: tuple[EventNode, float]) -> tuple[Surfaces, Orbit]:
    """A wall 3, which is hit at 1.0, and friction 0 that it reverses, with nodes afterwards."""
    surfaces = [joint(), Surface(Kind.IMPACT, "wall", 3)]
    system = Surfaces(surfaces, [[1.0]] * 4, directions=[0, 0, 0, -1])
    return system, along(sine, [(EventNode(3, -1, modes=((0, 1),)), 1.0), *after])


STOPS = EventNode(0, -1, modes=((0, STUCK),))


@pytest.mark.parametrize(("later", "gone"), [(0.29, 1), (0.31, None)])
def test_stop_soon_after_an_impact(later: float, gone: int | None) -> None:
    """Assert that a stop within 0.3 rad may be brought about by the rebound, and goes with the impact."""
    system, orbit = struck((STOPS, 1.0 + later), (EventNode(2, -1), 3.0), (EventNode(0, 1), 4.0))
    assert strikes._stop_after(system, orbit, 0, 0) == gone
    found = strikes.last_impact(system, orbit, 0)
    assert [site.removed for site in found] == ([(0, 1), (0,)] if gone else [(0,)])
    crossing = found[-1].added[0]
    assert (crossing.event, crossing.phase) == (EventNode(0, 1), 1.0)
    if gone:
        assert found[0].added[0].event == EventNode(0, 1, modes=((0, STUCK),))


def test_impact_takes_the_place_of_friction_at_grazing() -> None:
    """Assert the impact's node with the reversal, and the stop after it where friction held the mass."""
    system, _ = struck()
    at: Any = SwitchPolynomials(system, along(sine)).nearest(3, 1, 4.7)
    for held in (False, True):
        node = EventNode(0, 1, modes=((0, STUCK),) if held else ())
        orbit = along(sine, [(node, at.phase), (EventNode(0, -1), 1.0), (EventNode(0, 1), 2.0)])
        site = strikes.first_impact(system, orbit, at, 1, 0.125)
        assert (site.row, site.removed, site.value) == (IMPACT, (0,), 0.125)
        first, *others = [added.event for added in site.added]
        assert first == EventNode(3, -1, modes=((0, 1),))
        assert others == ([EventNode(0, -1, modes=((0, STUCK),))] if held else [])


def test_swaps_are_of_two_surfaces() -> None:
    """Assert that event nodes of one joint, and markers, do not change places, and others do."""
    surfaces = [joint(), joint(1, 3), Surface(Kind.MARKER, "mark", 6)]
    weights = [[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 3 + [[1.0, 1.0]]
    system = Surfaces(surfaces, weights)
    orbit = along(
        lambda tau: np.stack([np.sin(tau), np.cos(tau)], axis=1),
        [(EventNode(0, 1), 1.0), (EventNode(3, 1), 2.0), (EventNode(3, -1), 3.0), (EventNode(6, 1), 4.0)],
    )
    assert [swaps.swaps(system, orbit, k) for k in range(4)] == [True, False, False, False]
    site = swaps.swapped(system, orbit, 0)
    assert site.added[0].at(0.5) == (EventNode(3, 1), 1.0) and site.added[1].at(0.5) == (EventNode(0, 1), 1.5)
    assert site.held == Length(0, 1.0) and site.removed == (0, 1)


def test_event_that_swaps_with_an_impact_goes_to_its_far_side() -> None:
    """Assert that the impact keeps its phase, and the other is as far on its other side."""
    system, _ = struck()
    before = along(sine, [(EventNode(0, 1), 1.0), (EventNode(3, -1), 1.5)])
    site = swaps.swapped(system, before, 0)
    assert [added.at(0.5) for added in site.added] == [(EventNode(3, -1), 1.5), (EventNode(0, 1), 2.0)]
    behind = along(sine, [(EventNode(3, -1), 1.5), (EventNode(0, 1), 2.0)])
    site = swaps.swapped(system, behind, 0)
    assert [added.at(0.5) for added in site.added] == [(EventNode(0, 1), 1.0), (EventNode(3, -1), 1.5)]


def test_rows_of_segments_at_a_joint() -> None:
    """Assert which row each segment is of, by the modes at its ends."""
    system = Surfaces([joint()], [[1.0]] * 3)
    stop, up, down = STOPS, EventNode(1, 1), EventNode(2, -1)
    over, back = EventNode(0, 1), EventNode(0, -1)

    def rows(*events: EventNode) -> list[Any]:
        orbit = along(sine, [(event, 1.0 + k) for k, event in enumerate(events)])
        return [ends._held(system, orbit, k) for k in range(len(events))]

    assert rows(stop, up, back, over) == [table.GRAZING_SLIDING, None, None, table.SWITCHING_SLIDING]
    assert rows(stop, down, over) == [table.CROSSING_SLIDING, None, table.SWITCHING_SLIDING]
    assert rows(stop, up) == [table.GRAZING_SLIDING, table.ADDING_SLIDING]


def test_longest_slip() -> None:
    """Assert the longest time between a node that does not stick and the next, around the period."""
    system = Surfaces([joint()], [[1.0]] * 3)
    word = [(STOPS, 1.0), (EventNode(1, 1), 2.0), (EventNode(0, -1), 3.5), (EventNode(0, 1), 4.0)]
    assert ends.longest_slip(system, along(sine, word), 0) == pytest.approx(2 * np.pi - 3.0)
    assert ends.longest_slip(system, along(sine), 0) == 0


def test_stops_of_joints_are_those_of_plain_nodes() -> None:
    """Assert the guards that stop, and none where a node brings something else about."""
    a, b = STOPS, EventNode(3, 1, modes=((3, STUCK),))
    assert merging._stopped([a, b], [0, 1]) == [0, 3]
    assert merging._stopped([a, replace(b, modes=((3, STUCK), (6, 1)))], [0, 1]) == []
    assert merging._stopped([replace(b, modes=((6, STUCK),))], [0]) == []
    system = Surfaces(
        [joint(k, 3 * k) for k in range(3)], [[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 3 + [[2.0, 0.0]] * 3
    )
    assert merging._groups(system, [0, 3, 6], []) == ((0, 6), (3,))
    assert merging._groups(system, [0, 3, 6], [3]) == ((0, 6), (3,))


def test_sites_of_sliders_that_slip_together_are_one() -> None:
    """Assert that the modes of both stand at the release and at the stop of the first."""
    held = Length(0, 0.0)
    one, other = (
        Site(
            table.LIMIT_GRAZING,
            g,
            0,
            held,
            0.0,
            (Added(EventNode(g + 1, 1), 1.0, 0.0), Added(stop, 1.0, 1.0)),
        )
        for g, stop in ((0, STOPS), (3, EventNode(3, -1, modes=((3, STUCK),))))
    )
    system = Surfaces([joint(), joint(1, 3, Kind.SLIDER)], [[0.0, 1.0]] * 6)
    release, stop = (added.event for added in twins._both(system, one, other).added)
    assert release == EventNode(1, 1, modes=((3, 1),))
    assert stop == EventNode(0, -1, modes=((0, STUCK), (3, STUCK)))


def test_sites_of_sliders_that_stop_at_one_turn_are_one() -> None:
    """Assert that the modes of both stand at their release, and at the event node at which others stop."""
    system = Surfaces([joint(), joint(1, 3, Kind.SLIDER)], [[0.0, 1.0]] * 6)
    turn, held = EventNode(9, -1, modes=((9, STUCK),)), Length(0, 0.0)
    one, other = (
        Site(
            table.LIMIT_GRAZING,
            guard + 1,
            0,
            held,
            0.0,
            (Added(EventNode(guard + 1, 1), 1.0, -1.0),),
            replaced=((4, EventNode(9, -1, modes=((9, STUCK), (guard, STUCK)))),),
        )
        for guard in (0, 3)
    )
    both = twins._both(system, one, other)
    assert [added.event for added in both.added] == [EventNode(1, 1, modes=((3, 1),))]
    assert both.replaced == ((4, EventNode(9, -1, modes=(*turn.modes, (0, STUCK), (3, STUCK)))),)


def test_slider_that_slips_where_others_stop() -> None:
    """Assert that it is held with its twin at the turn of the strain, and that friction is left as it is."""
    surfaces = [joint(), joint(1, 3, Kind.SLIDER), joint(2, 6, Kind.SLIDER)]
    weights = [[0.0, 1.0]] * 3 + [[1.0, 0.0]] * 6
    system = Surfaces(surfaces, weights)
    turn, release = EventNode(3, -1, modes=((3, STUCK),)), EventNode(4, 1)
    orbit = along(
        lambda tau: np.stack([np.sin(tau), np.cos(tau)], axis=1),
        [(turn, 1.0), (release, 3.0)],
        modes=[(6, 3)],
    )
    at = Extremum(7, 0, 0.0, 1.0 + 1e-5, 0.0)
    slip, stop = (
        Added(EventNode(7, 1), 1.00001, 0.0),
        Added(EventNode(6, -1, modes=((6, STUCK),)), 1.00001, 1.0),
    )
    site = Site(table.LIMIT_GRAZING, 7, at, Length(0, 0.0), 0.0, (slip, stop))
    joined = twins.with_twins(system, orbit, site)
    assert joined.added == (replace(slip, phase=1.0),)
    assert joined.replaced == ((0, replace(turn, modes=((3, STUCK), (6, STUCK)))),)
    friction = replace(site, row=table.ADDING_SLIDING, switch=1, at=replace(at, switch=1))
    beside = Surfaces(surfaces, [[1.0, 0.0]] * 9)  # friction in parallel with both
    assert twins.with_twins(beside, orbit, friction) is friction
    far = replace(site, at=replace(at, phase=2.0))
    assert twins.with_twins(system, orbit, far) is far
