"""Excursions of an orbit past a switch's level, as the event nodes of its mesh have them."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.scheme import Scheme

STOP, SPEED, RELEASE, OTHER = range(4)


@pytest.mark.parametrize(
    ("events", "excursions"),
    [
        ([], []),
        ([(STOP, 1)], []),
        ([(STOP, 1), (STOP, -1)], [(0, 1), (1, 0)]),
        ([(STOP, 1), (OTHER, 1), (STOP, -1), (OTHER, -1)], [(0, 2), (1, 3), (2, 0), (3, 1)]),
        ([(STOP, 1), (SPEED, -1), (RELEASE, -1), (STOP, -1), (SPEED, 1)], [(0, 3), (1, 4), (3, 0), (4, 1)]),
        ([(STOP, 1), (OTHER, 1), (SPEED, -1), (RELEASE, -1), (STOP, -1)], [(4, 0)]),
        ([(STOP, 1), (OTHER, 1), (STOP, 1), (STOP, -1)], [(2, 3), (3, 0)]),
    ],
)
def test_excursions(events: list[tuple[int, int]], excursions: list[tuple[int, int]]) -> None:
    """Assert what begins and ends an excursion: the next node of its switch, two others between at most."""
    breaks = tuple(np.array([0.0, 1.0]) for _ in events or [()])
    mesh = Mesh(Scheme(), breaks, tuple(EventNode(*event) for event in events))
    assert mesh.excursions == excursions
