"""Meshes with event nodes: places, gradients and excursions computed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.orbit.mesh import EventNode, Mesh, uniform, wrapped
from periodic.orbit.scheme import Scheme

SCHEME = Scheme()
TWO = Mesh(
    SCHEME,
    (np.array([0.0, 0.5, 1.0]), np.array([0.0, 0.25, 0.75, 1.0])),
    (EventNode(0, 1), EventNode(0, -1, level=0.1)),
)
"""Two segments, of 2 and 3 intervals."""

PHASES = np.array([1.0, 3.0])
REST = 2 * np.pi - 2


@pytest.mark.parametrize(
    ("phase", "found"),
    [(0.0, 0.0), (3.0, 3.0), (5.0, -3.0), (-5.0, 3.0), (-4.0, -4.0), (4.0, -4.0), (17.0, 1.0)],
)
def test_differences_of_phases(phase: float, found: float) -> None:
    """Assert them within half a period of 8."""
    assert wrapped(phase, 8.0) == pytest.approx(found, abs=1e-14)


def test_intervals_between_event_nodes() -> None:
    """Assert left ends and widths of segments of the lengths 2 and 2 pi - 2, and the mesh points."""
    grid = TWO.grid(PHASES)
    assert grid.left == pytest.approx([1.0, 2.0, 3.0, 3 + 0.25 * REST, 3 + 0.75 * REST], rel=1e-15)
    assert grid.width == pytest.approx([1.0, 1.0, 0.25 * REST, 0.5 * REST, 0.25 * REST], rel=1e-15)
    assert TWO.nodes(PHASES) == pytest.approx([*grid.left, 1 + 2 * np.pi], rel=1e-15)
    assert TWO.segment_lengths(PHASES) == pytest.approx([2.0, REST], rel=1e-15)
    assert TWO.ntst == 5 and TWO.starts.tolist() == [0, 2]


def test_gradients_in_the_event_nodes_phases() -> None:
    """Assert d left / d phi and d width / d phi: sigma moves with the ends of its segment, linearly."""
    left, width = TWO.gradients
    assert left == pytest.approx(np.array([[1, 0], [0.5, 0.5], [0, 1], [0.25, 0.75], [0.75, 0.25]]))
    assert width == pytest.approx(
        np.array([[-0.5, 0.5], [-0.5, 0.5], [0.25, -0.25], [0.5, -0.5], [0.25, -0.25]])
    )
    assert TWO.ties.tolist() == [[0, 1], [0, 1], [1, 0], [1, 0], [1, 0]]
    own = TWO.tie_gradients
    assert own[0] == pytest.approx(np.array([[1, 0], [0.5, 0.5], [1, 0], [0.75, 0.25], [0.25, 0.75]]))
    assert own[1] == pytest.approx(
        np.array([[-0.5, 0.5], [-0.5, 0.5], [-0.25, 0.25], [-0.5, 0.5], [-0.25, 0.25]])
    )


def test_one_segment_is_as_long_as_the_period() -> None:
    """Assert that with one event node the intervals move but do not stretch, and without any stay."""
    single = Mesh(SCHEME, (np.array([0.0, 0.25, 1.0]),), (EventNode(2, 1),), 4 * np.pi)
    assert single.grid(np.array([1.0])).left == pytest.approx([1.0, 1 + np.pi], rel=1e-15)
    assert single.gradients[0].tolist() == [[1.0], [1.0]]
    assert single.gradients[1].tolist() == [[0.0], [0.0]]
    assert single.ties.tolist() == [[0], [0]]
    fixed = uniform(SCHEME, 4, 4 * np.pi)
    assert fixed.grid(np.zeros(0)).left == pytest.approx(np.pi * np.arange(4), rel=1e-15)
    assert fixed.grid(np.zeros(0)).width == pytest.approx(np.pi, rel=1e-15)
    assert fixed.segment_lengths(np.zeros(0)).tolist() == [4 * np.pi]
    assert fixed.starts.tolist() == [] and fixed.exact_ends.tolist() == [] and fixed.ties.shape == (4, 0)


def test_mean_over_the_period_by_trapezia() -> None:
    """Assert the weights for widths 1, 1, and 2 over 4."""
    grid = Mesh(SCHEME, (np.array([0.0, 0.25, 0.5, 1.0]),), (), 4.0).grid(np.zeros(0))
    assert grid.mean_weights.tolist() == [0.125, 0.25, 0.375, 0.25]


def test_intervals_that_end_at_kinks() -> None:
    """Assert the one before the node of level 0, not the one before that of level 0.1, nor others."""
    assert TWO.exact_ends.tolist() == [4]
    both = Mesh(SCHEME, TWO.breaks, (EventNode(0, 1), EventNode(1, 1)))
    assert both.exact_ends.tolist() == [1, 4]


def nodes(*passages: tuple[int, int]) -> Mesh:
    """A mesh with event nodes of these switches and directions."""
    return Mesh(SCHEME, (np.array([0.0, 1.0]),) * len(passages), tuple(EventNode(*p) for p in passages))


@pytest.mark.parametrize(
    ("passages", "found"),
    [
        (((0, 1), (0, -1)), [(0, 1), (1, 0)]),
        (((0, 1), (1, 1), (2, 1), (0, -1)), [(0, 3), (3, 0)]),
        (((0, 1), (1, 1), (2, 1), (3, 1), (0, -1)), [(4, 0)]),  # three others between, but none the other way
        (((0, 1), (0, 1), (0, -1)), [(1, 2), (2, 0)]),
        (((0, 1), (1, 1)), []),
        (((0, 1),), []),
    ],
)
def test_excursions_have_at_most_two_others_inside(
    passages: tuple[tuple[int, int], ...], found: list[tuple[int, int]]
) -> None:
    """Assert the pairs of event nodes at which a switch passes its level and returns."""
    assert nodes(*passages).excursions == found


def test_modes_beside_a_guard() -> None:
    """Assert that those of one guard are left out."""
    node = EventNode(1, 1, modes=((1, 2), (3, 0), (4, -1)))
    assert node.modes_beside(3) == ((1, 2), (4, -1)) and node.modes_beside(0) == node.modes


def test_halved_mesh_keeps_what_it_is_tied_to() -> None:
    """Assert the middles, and events, period and modes."""
    mesh = Mesh(SCHEME, (np.array([0.0, 0.5, 1.0]),), (EventNode(0, 1),), 4 * np.pi, ((1, -1),))
    half = mesh.bisected()
    assert half.breaks[0].tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert (half.events, half.period, half.modes) == (mesh.events, mesh.period, mesh.modes)
    assert half is mesh.bisected()


def test_meshes_match_by_breaks_events_and_modes() -> None:
    """Assert that each of the three tells meshes apart, and that equal ones match."""

    def made(breaks: tuple[float, ...] = (0.0, 0.5, 1.0), switch: int = 0, mode: int = 1) -> Mesh:
        return Mesh(SCHEME, (np.array(breaks),), (EventNode(switch, 1),), modes=((1, mode),))

    assert made().matches(made())
    assert not made().matches(made((0.0, 0.4, 1.0)))
    assert not made().matches(made((0.0, 0.25, 0.5, 1.0)))
    assert not made().matches(made(switch=1)) and not made().matches(made(mode=-1))
    assert not made().matches(TWO)


def test_a_mesh_without_intervals_is_refused() -> None:
    """Assert that one interval is the least."""
    assert uniform(SCHEME, 1).ntst == 1
    with pytest.raises(ValueError, match="ntst is 0; it must be a whole number of at least 1"):
        uniform(SCHEME, 0)
