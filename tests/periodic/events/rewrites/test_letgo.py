"""Releases of two sliders that meet because one of them just reaches its limit at a turn of the strain."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along, joint

from periodic.events.rewrites.ends import Excursion
from periodic.events.rewrites.letgo import slip_that_joins
from periodic.events.rewrites.table import GRAZING, SWAP
from periodic.orbit.mesh import EventNode
from periodic.system import STUCK, Kind

PLACES = (0.5, 1.5, 1.75, 2.0, 3.0, 4.0, 4.3, 5.0, 0.5 + 2 * np.pi)


def turning(top: float, bottom: float) -> Any:
    """A strain that turns at 1.5 and 4, a bit short of 1 and -1, and is back there at 2 and 5."""
    values = (-1.0, 1.0 - top, 0.6, 1.0, 1.0, -1.0 + bottom, -0.6, -1.0, -1.0)

    def states(tau: Any) -> Any:
        at = np.mod(np.asarray(tau) - 0.5, 2 * np.pi) + 0.5
        k = np.clip(np.searchsorted(PLACES, at, side="right") - 1, 0, len(values) - 2)
        begin, end, first, last = (np.asarray(v)[k + d] for v in (PLACES, values) for d in (0, 1))
        strain = first + (last - first) * (1 - np.cos(np.pi * (at - begin) / (end - begin))) / 2
        return np.column_stack([np.zeros_like(strain), strain])

    return states


def sliders() -> Any:
    """Two of one guard: the first is strained half as much as the second, whose limits are 1 and -1."""
    weights = [[1.0, 0.0], [0.0, 0.5], [0.0, 0.5], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]]
    surfaces = [joint(k, 3 * k, Kind.SLIDER) for k in range(2)]
    return Surfaces(surfaces, weights, [0.0, -1.0, 1.0, 0.0, -1.0, 1.0])


BOTH = (0, STUCK), (3, STUCK)
NODES = [
    (EventNode(0, 1, modes=BOTH), 0.5),
    (EventNode(1, 1), 1.0),
    (EventNode(0, -1, modes=((0, STUCK),)), 1.5),
    (EventNode(1, 1), 2.0),
    (EventNode(4, 1), 2.0001),
    (EventNode(0, -1, modes=BOTH), 3.0),
    (EventNode(2, -1), 3.5),
    (EventNode(0, 1, modes=((0, STUCK),)), 4.0),
    (EventNode(2, -1), 5.0),
    (EventNode(5, -1), 5.0001),
]
"""The first slider slips, stops at a turn, and slips again where the second one first does, either way."""


@pytest.mark.parametrize(("top", "bottom"), [(1e-6, 2e-6), (2e-6, 1e-6)])
@pytest.mark.parametrize(("segment", "switch", "turn"), [(3, 4, 2), (8, 5, 7)])
def test_the_slip_is_the_one_before_the_releases_that_meet(
    segment: int, switch: int, turn: int, top: float, bottom: float
) -> None:
    """Assert that it begins at the turn before them, and not where the releases the other way would meet.

    Its value is how far the second slider is from its limit there, over the largest distance, 2.
    """
    orbit = along(turning(top, bottom), NODES, intervals=8 * len(NODES))
    site = slip_that_joins(sliders(), orbit, Excursion(SWAP, segment))
    assert site is not None and site.switch == switch
    assert [node for node, _ in site.replaced] == [turn]
    assert site.value == pytest.approx((top if switch == 4 else bottom) / 2, rel=0.02)


def test_other_events_that_meet_join_nothing() -> None:
    """Assert none for a release beside a stop, and for what is no swap."""
    orbit = along(turning(1e-6, 1e-6), NODES, intervals=8 * len(NODES))
    assert slip_that_joins(sliders(), orbit, Excursion(SWAP, 4)) is None
    assert slip_that_joins(sliders(), orbit, Excursion(GRAZING, 3)) is None
