"""Passages that get event nodes, and those that get none: on switches and orbits given as functions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.numpy_systems import Switch
from support.surfaces import Surfaces, along

from periodic.events.eventnodes import (
    MILD,
    Crossing,
    KinkSettings,
    _apart,
    _excursions,
    _inside,
    _kink,
    _merged,
    crossings,
    fits,
    match,
    placed,
    wanted,
)
from periodic.orbit.mesh import EventNode
from periodic.orbit.orbit import Orbit

FALLS, RISES = EventNode(0, -1), EventNode(0, 1)
PERIOD = 2 * np.pi
SETTINGS = KinkSettings(deepest=0.0)


def levels(*own: float, direction: int = 0) -> Any:
    """A system of one switch, the state x, with levels."""
    system = Surfaces([], [[1.0]])
    system.switches = (Switch("s", direction, own),)  # type: ignore[assignment]
    return system


def cosine(mean: float = 0.0, nodes: Any = (), intervals: int = 40) -> Orbit:
    """x = mean + cos tau."""
    return along(lambda tau: mean + np.cos(tau)[:, None], nodes, intervals=intervals)


def at(phase: float, direction: int = -1, level: float = 0.0, slope: float = 1.0) -> Crossing:
    """A passage."""
    return Crossing(EventNode(0, direction, level), phase, slope)


@pytest.mark.parametrize("level", [0.0, 0.6, -0.8])
def test_passages_of_a_cosine(level: float) -> None:
    """Assert phase, direction and the least slope beside both passages of a level."""
    first = np.arccos(level)
    found = sorted(crossings(levels(level), cosine()), key=lambda c: c.phase)
    assert [c.event for c in found] == [EventNode(0, -1, level), EventNode(0, 1, level)]
    assert [c.phase for c in found] == pytest.approx([first, PERIOD - first], abs=2e-3)
    width = PERIOD / 40
    for crossing in found:
        assert crossing.slope == pytest.approx(np.sin(first), abs=width)
        assert crossing.slope <= np.abs(np.sin(first)) + 1e-3 or level == 0


def test_passages_of_several_levels_and_round_the_period() -> None:
    """Assert four passages in order of levels, one of them from the last point to the first."""
    shifted = along(lambda tau: np.cos(tau + 0.5 * np.pi - 0.02)[:, None])
    found = crossings(levels(0.0, 0.5), shifted)
    falls = [c.phase % PERIOD for c in found if c.event.level == 0.0 and c.event.direction < 0]
    assert falls == pytest.approx([0.02], abs=2e-3)
    assert sorted(c.event.level for c in found) == [0.0, 0.0, 0.5, 0.5]
    assert crossings(levels(1.5), cosine()) == []


def test_passages_paired_to_excursions() -> None:
    """Assert each falling passage with the rising one after it, round the period too."""
    down, up, second, last = at(1.0), at(2.0, 1), at(3.0), at(4.0, 1)
    assert _excursions([down, up, second, last]) == [(down, up), (second, last)]
    assert _excursions([up, down]) == [(down, up)]
    assert _excursions([]) == []


@pytest.mark.parametrize(
    ("phase", "inside"),
    [(1.5, True), (1.0, True), (2.0, True), (0.99, False), (2.01, False), (1.5 + PERIOD, True)],
)
def test_passage_within_an_excursion(phase: float, inside: bool) -> None:
    """Assert it of its ends too, whichever period they are counted in."""
    assert _inside(at(phase), (at(1.0), at(2.0, 1)), PERIOD) is inside
    assert _inside(at(phase + 5.0), (at(6.0), at(7.0 - PERIOD, 1)), PERIOD) is inside


@pytest.mark.parametrize(
    ("gap", "tied", "kept"),
    [(0.11, False, 4), (0.09, False, 2), (0.09, True, 4), (0.06, True, 4), (0.04, True, 2)],
)
def test_short_excursions_are_left_out(gap: float, tied: bool, kept: int) -> None:
    """Assert that a pair goes that lies closer than `appear`, or where it has event nodes than `vanish`."""
    found = [at(1.0), at(1.0 + gap, 1), at(3.0), at(4.0, 1)]
    orbit = cosine(nodes=[(FALLS, 1.0), (RISES, 1.0 + gap)] if tied else ())
    left = _merged(found, orbit, SETTINGS)
    assert len(left) == kept and left[-2:] == found[-2:]


def test_shortest_of_several_goes_first() -> None:
    """Assert that two passages close to each other go, and those beside them then make one excursion."""
    found = [at(1.0), at(1.08, 1), at(1.12), at(1.2, 1)]
    assert _merged(found, cosine(), SETTINGS) == [found[0], found[3]]
    round_the_end = [at(0.02, 1), at(1.0), at(2.0, 1), at(PERIOD - 0.02)]
    assert _merged(round_the_end, cosine(), SETTINGS) == round_the_end[1:3]


@pytest.mark.parametrize(
    ("gap", "level", "kept"), [(0.11, 0.0, 2), (0.09, 0.0, 1), (0.09, -1.0, 2), (0.009, -1.0, 1)]
)
def test_event_nodes_do_not_coincide(gap: float, level: float, kept: int) -> None:
    """Assert that the second of two close ones goes; of mild kinks a tenth of the distance is enough."""
    found = [at(1.0, level=level), at(1.0 + gap, 1, level)]
    assert _apart(found, cosine(), SETTINGS) == found[:kept]
    around = [at(0.0, level=level), at(PERIOD - gap, 1, level)]
    assert _apart(around, cosine(), SETTINGS) == around[:kept]


@pytest.mark.parametrize(
    ("slopes", "chosen"),
    [((1.0, 1.0, 1.0), -2.0), ((1.0, 1.0, 0.24), -1.0), ((1.0, 0.1, 0.25), -2.0), ((1.0, 0.1, 0.1), 0.0)],
)
def test_deepest_level_that_is_passed_steeply(slopes: tuple[float, ...], chosen: float) -> None:
    """Assert it of slopes from a quarter of that at the shallowest level on."""
    depths = (0.0, -1.0, -2.0)
    down = [
        [at(1.0 + 0.1 * k, -1, level, slope)]
        for k, (level, slope) in enumerate(zip(depths, slopes, strict=True))
    ]
    both = [[each[0], at(3.0 - 0.1 * k, 1, each[0].event.level)] for k, each in enumerate(down)]
    found = _kink(both, (both[0][0], both[0][1]), -1, cosine(), SETTINGS)
    assert found.event.level == chosen and found.event.direction == -1
    end = _kink(both, (both[0][0], both[0][1]), 1, cosine(), SETTINGS)
    assert end == both[2][1]


@pytest.mark.parametrize(("exchange", "level"), [(5.0, 0.001), (20.0, 0.01)])
def test_level_in_use_stays_unless_another_is_far_deeper(exchange: float, level: float) -> None:
    """Assert that a level ten times as deep replaces the one in use if that is more than asked for."""
    each = [[at(1.0, -1, 0.01), at(3.0, 1, 0.01)], [at(1.1, -1, 0.001), at(2.9, 1, 0.001)]]
    orbit = cosine(nodes=[(EventNode(0, -1, 0.01), 1.0), (EventNode(0, 1, 0.01), 3.0)])
    own = KinkSettings(deepest=0.0, exchange=exchange)
    assert _kink(each, (each[0][0], each[0][1]), -1, orbit, own).event.level == level


def test_settings_for_levels_and_tolerances() -> None:
    """Assert a tenth of both lengths at negative levels alone, a tenth of the tolerance as the deepest."""
    own = KinkSettings(appear=0.2, vanish=0.1)
    assert own.beside(0.0) is own and own.beside(0.5) is own
    mild = own.beside(-1e-9)
    assert (mild.appear, mild.vanish) == (pytest.approx(0.2 * MILD), pytest.approx(0.1 * MILD))
    assert own.at(1e-6).deepest == pytest.approx(1e-7)
    assert KinkSettings(deepest=0.3).at(1e-6).deepest == 0.3


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"vanish": 0.0}, "vanish is 0.0; it must be positive and at most appear = 0.1"),
        ({"vanish": 0.11}, "vanish is 0.11; it must be positive and at most appear = 0.1"),
        ({"exchange": 0.99}, "exchange is 0.99; it must be a number of at least 1"),
        ({"exchange": np.inf}, "exchange is inf; it must be a number of at least 1"),
        ({"steep": -0.01}, "steep is -0.01; it must lie between 0 and 1"),
        ({"steep": 1.01}, "steep is 1.01; it must lie between 0 and 1"),
    ],
)
def test_settings_refused(given: dict[str, float], said: str) -> None:
    """Assert the sentences, and that the bounds themselves are allowed."""
    with pytest.raises(ValueError) as refused:
        KinkSettings(**given)
    assert str(refused.value) == said
    KinkSettings(vanish=0.1, exchange=1.0, steep=0.0)
    KinkSettings(steep=1.0)


@pytest.mark.parametrize(
    ("mean", "own", "direction", "expected"),
    [
        (0.0, (0.0,), 0, [(-1, 0.0), (1, 0.0)]),
        (0.0, (0.0,), 1, [(1, 0.0)]),
        (0.0, (0.0,), -1, [(-1, 0.0)]),
        (0.0, (0.5, 0.0), 0, [(-1, 0.0), (1, 0.0)]),
        (0.99, (0.5, 0.0), 0, [(-1, 0.5), (1, 0.5)]),
        (0.999, (0.0,), 0, []),
        (1.5, (0.0,), 0, []),
    ],
)
def test_event_nodes_of_a_cosine(
    mean: float, own: tuple[float, ...], direction: int, expected: list[tuple[int, float]]
) -> None:
    """Assert both ends of the excursion below the deepest level, or the one of the switch's direction."""
    found = wanted(levels(*own, direction=direction), cosine(mean), SETTINGS)
    assert [(c.event.direction, c.event.level) for c in found] == expected
    assert [c.phase for c in found] == sorted(c.phase for c in found)


def test_levels_of_no_meaning_get_none() -> None:
    """Assert that positive levels below the deepest that is used are left out, and 0 is not."""
    own = KinkSettings(deepest=0.01)
    found = wanted(levels(0.5, 0.005), cosine(), own)
    assert {c.event.level for c in found} == {0.5}
    assert {c.event.level for c in wanted(levels(0.5, 0.0), cosine(), own)} == {0.0}
    assert {c.event.level for c in wanted(levels(0.5, 0.01), cosine(), own)} == {0.01}
    none = levels()
    none.switches = ()
    assert wanted(none, cosine(), own) == []


def test_nodes_are_found_again() -> None:
    """Assert the nearest node of the same event within 0.02 rad, round the period, and no other."""
    orbit = cosine(nodes=[(FALLS, 0.01), (RISES, 3.0), (FALLS, 0.02 + 3.0)])
    assert match(at(0.0), orbit) == 0 and match(at(PERIOD - 0.005), orbit) == 0
    assert match(at(3.011), orbit) == 2 and match(at(3.011, 1), orbit) == 1
    assert match(at(0.031), orbit) is None and match(at(1.0), orbit) is None
    assert match(at(0.01, -1, 0.5), orbit) is None
    assert match(at(0.0), cosine()) is None
    assert match(at(0.05), orbit, tolerance=0.05) == 0


def test_mesh_that_fits_its_passages() -> None:
    """Assert that it has a node at each, and no more."""
    orbit = cosine(nodes=[(FALLS, 1.0), (RISES, 3.0)])
    assert fits([at(1.0), at(3.0, 1)], orbit)
    assert not fits([at(1.0)], orbit)
    assert not fits([at(1.0), at(2.0, 1)], orbit)
    assert fits([], cosine()) and not fits([at(1.0)], cosine())


def test_nodes_are_placed_on_the_polynomials() -> None:
    """Assert exact phases of new ones, those of present ones as they are, the first within the period."""
    events, phases = placed(levels(0.0), cosine(), [at(1.57), at(4.71, 1)])
    assert events == (FALLS, RISES)
    assert phases == pytest.approx([np.pi / 2, 3 * np.pi / 2], abs=1e-7)
    tied = cosine(nodes=[(FALLS, 1.575), (RISES, 4.71)])
    assert placed(levels(0.0), tied, [at(1.57), at(4.71, 1)])[1].tolist() == [1.575, 4.71]
    later = placed(levels(0.0), cosine(), [at(4.71 + PERIOD, 1), at(1.57 + 2 * PERIOD)])[1]
    assert later == pytest.approx([3 * np.pi / 2, np.pi / 2 + PERIOD], abs=1e-7)
