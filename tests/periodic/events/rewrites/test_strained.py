"""Which way a slider is strained, by the modes of friction beside it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites import ends, strained
from periodic.events.rewrites.strained import strained_away
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind

SLIDER, FRICTION = 0, 3


def system() -> Any:
    """A slider 0 (1, 2) and friction 3 (4, 5)."""
    return Surfaces([joint(0, SLIDER, Kind.SLIDER), joint(1, FRICTION)], [[1.0]] * 6)


def stopped(way: int) -> Any:
    """An orbit of 8 intervals whose slider slips one way from 0.5 on, and stops at 3.5."""
    begins, stops = EventNode(1 if way > 0 else 2, way), EventNode(SLIDER, -way, modes=((SLIDER, STUCK),))
    nodes = [(begins, 0.5), (stops, 3.5)]
    return along(lambda tau: np.sin(tau)[:, None], nodes, intervals=8)


def extremum(release: int, interval: int) -> Any:
    """An extremum of a release in an interval."""
    return SimpleNamespace(switch=release, interval=interval)


@pytest.mark.parametrize(
    ("way", "release", "strain", "away"),
    [
        (1, 1, -1, True),
        (1, 1, 0, True),
        (1, 1, 1, False),
        (1, 1, None, False),
        (1, 2, -1, False),
        (-1, 2, 1, True),
        (-1, 2, 0, True),
        (-1, 2, -1, False),
        (-1, 1, 1, False),
    ],
)
def test_slider_that_has_left_a_limit(
    way: int, release: int, strain: int | None, away: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that it stopped at that limit, and is strained the other way or not at all since."""
    asked: list[int] = []
    monkeypatch.setattr(strained, "_way", lambda system, orbit, guard, at: asked.append(at) or strain)
    own = system()
    found = strained_away(own, stopped(way), own.surfaces[0], extremum(release, 6))
    assert found is away
    assert asked == ([] if release != (1 if way > 0 else 2) else [4, 5, 6] if away else [4])


def test_slider_that_slips_again_is_not_held(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert none of an extremum while it slips, of friction, and of a slider without event nodes."""
    monkeypatch.setattr(strained, "_way", lambda *_: 0)
    own = system()
    assert not strained_away(own, stopped(1), own.surfaces[0], extremum(1, 2))
    assert not strained_away(own, stopped(1), own.surfaces[1], extremum(4, 6))
    plain = along(lambda tau: np.sin(tau)[:, None], intervals=8)
    assert not strained_away(own, plain, own.surfaces[0], extremum(1, 6))


@pytest.mark.parametrize(
    ("held", "alike", "mode", "way"),
    [
        (True, {FRICTION: 1}, 1, 0),
        (False, {FRICTION: 1}, 1, 1),
        (False, {FRICTION: -1}, 1, -1),
        (False, {FRICTION: -1}, -1, 1),
        (False, {FRICTION: 1}, 0, None),
        (False, {SLIDER: 1}, 1, None),
        (False, {}, 1, None),
    ],
)
def test_way_of_a_strain(
    held: bool, alike: dict[int, int], mode: int, way: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that of friction with the same guard, none where friction holds it, and unknown without."""
    monkeypatch.setattr(strained, "held_in", lambda *_: [])
    monkeypatch.setattr(strained, "holding", lambda *_: {FRICTION: 1} if held else {})
    monkeypatch.setattr(strained, "sides", lambda *_: np.array([[9, 9], [0, mode]]))
    monkeypatch.setattr(strained, "twins", lambda *_: alike)
    assert strained._way(system(), None, SLIDER, 1) == way  # type: ignore[arg-type]


@pytest.mark.parametrize(("offset", "shallow"), [(-0.95, True), (-0.5, False)])
def test_force_that_hardly_exceeds_its_limit(offset: float, shallow: bool) -> None:
    """Assert it of sin tau less most of it, from one event node to another; its least value is far larger."""
    own = Surfaces([joint()], [[1.0]] * 3, [0.0, offset, 0.0])
    nodes = [(EventNode(1, 1), 1.0), (EventNode(0, -1, modes=((0, STUCK),)), 2.0)]
    orbit = along(lambda tau: np.sin(tau)[:, None], nodes, intervals=24)
    assert ends._shallow(own, orbit, 0, 1) is shallow  # type: ignore[arg-type]
