"""Ragged arrays cut into shares."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.surfaces import Surfaces, along

from periodic.orbit.layout import layout_of
from periodic.orbit.mesh import EventNode
from periodic.orbit.scheme import Scheme
from periodic.results import ragged


@pytest.mark.parametrize(
    ("counts", "length", "spans"),
    [([2, 0, 3], 5, [(0, 2), (2, 2), (2, 5)]), ([], 0, []), ([0], 0, [(0, 0)]), ([4], 4, [(0, 4)])],
)
def test_shares_follow_each_other(counts: list[int], length: int, spans: list[tuple[int, int]]) -> None:
    """Assert where each begins and ends, and the pieces of an array."""
    found = ragged._spans(counts, length)
    assert [(span.start, span.stop) for span in found] == spans
    pieces = ragged._cut(np.arange(length) * 10, counts)
    assert [piece.tolist() for piece in pieces] == [list(range(10 * a, 10 * b, 10)) for a, b in spans]


@pytest.mark.parametrize(
    ("counts", "length", "sum_"), [([2, 3], 6, 5), ([2, 3], 4, 5), ([3, -1], 2, 2), ([], 1, 0)]
)
def test_shares_that_do_not_add_up(counts: list[int], length: int, sum_: int) -> None:
    """Assert the sentence, also where one of them is negative."""
    with pytest.raises(ValueError, match=f"^shares add up to {sum_}; they must make {length}$"):
        ragged._spans(counts, length)


def test_rows_are_put_below_each_other() -> None:
    """Assert shapes and order of arrays of more dimensions than the rows have, and of none."""
    one, other = np.arange(12.0).reshape(2, 3, 2), np.arange(4.0).reshape(1, 2, 2)
    assert ragged._rows([one, other], (2,)).tolist() == [*one.reshape(6, 2).tolist(), [0.0, 1.0], [2.0, 3.0]]
    assert ragged._rows([], (3,)).shape == (0, 3)
    assert ragged._rows([np.array([1.0, 2.0]), np.array([3.0])]).tolist() == [1.0, 2.0, 3.0]


def test_modes_of_surfaces_that_are_held() -> None:
    """Assert pairs for each point in turn, and none in files written before there were any."""
    arrays = {
        "period": np.array([6.0, 6.0, 6.0]),
        "held_count": np.array([1, 0, 2]),
        "held_surface": np.array([4, 5, 6]),
        "held_mode": np.array([2, 3, 1]),
    }
    assert ragged._held(arrays) == [((4, 2),), (), ((5, 3), (6, 1))]
    assert ragged._held({"period": arrays["period"]}) == [(), (), ()]


def test_modes_of_event_nodes() -> None:
    """Assert pairs for each node in turn, and none in files written before there were any."""
    switches = np.array([7, 7])
    arrays = {
        "event_switch": switches,
        "event_modes": np.array([0, 2]),
        "mode_surface": np.array([7, 8]),
        "mode_value": np.array([2, -1]),
    }
    assert ragged._modes(arrays) == [(), ((7, 2), (8, -1))]
    assert ragged._modes({"event_switch": switches}) == [(), ()]


def orbits() -> list[Any]:
    """Two orbits on meshes that have nothing in common but their scheme."""
    node = EventNode(0, 1, 0.25, modes=((0, 2), (3, -1)))
    each = along(lambda tau: np.sin(tau)[:, None]), along(cosine, [(node, 1.5)], modes=[(5, 3)])
    layout = layout_of(Surfaces([], [[1.0]]))
    return [replace(orbit, layout=layout) for orbit in each]


def cosine(tau: Any) -> Any:
    """A motion of one state."""
    return np.cos(tau)[:, None]


def test_orbits_there_and_back() -> None:
    """Assert that what is cut is what was put in, bit for bit, with events and modes."""
    given = orbits()
    layout = given[0].layout
    tables = ragged.orbit_tables(given, layout)
    found = ragged.orbits_of(
        {name: array for name, (_, array) in tables.items()}, ragged.scheme_said(given), layout
    )
    for one, other in zip(given, found, strict=True):
        assert other.mesh.matches(one.mesh) and other.equilibrium == one.equilibrium
        assert (other.mesh.events, other.mesh.modes) == (one.mesh.events, one.mesh.modes)
        for name in ("nodes", "stages", "algebraic", "phases", "parameter"):
            assert np.array_equal(getattr(one, name), getattr(other, name)), name


def test_scheme_of_no_orbits() -> None:
    """Assert that it is the usual one, and that of some is theirs."""
    usual = Scheme()
    assert ragged.scheme_said([]) == {"scheme": usual.family.value, "ncol": usual.ncol}
    scheme = orbits()[0].mesh.scheme
    assert ragged.scheme_said(orbits()) == {"scheme": scheme.family.value, "ncol": scheme.ncol}
