"""Orbits carried to other meshes: polynomials that both meshes hold exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.orbit import extrema, sampling
from periodic.orbit.construction import bisect, constant, transfer
from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array, Family, Scheme


def polynomial(tau: Array) -> Array:
    """Two states of degree 2 and 3."""
    return np.stack([tau**2 - 6 * tau, 1 + tau - 0.1 * tau**3], axis=-1)


def holding(mesh: Mesh, phases: Array) -> Orbit:
    """The polynomial, with an unknown 3 + tau."""
    grid = mesh.grid(phases)
    stages = grid.left[:, None] + grid.width[:, None] * mesh.scheme.points
    unknown = 3 + stages[:, :, None]
    return Orbit(mesh, polynomial(mesh.nodes(phases)), polynomial(stages), unknown, phases, np.array([2.0]))


def test_constant_orbit() -> None:
    """Assert that every point has the state, and that the parameters are a copy."""
    given = np.array([4.0, 5.0])
    orbit = constant(uniform(Scheme(), 3), np.array([1.0, 2.0]), np.array([3.0]), given)
    assert orbit.nodes.tolist() == [[1.0, 2.0]] * 4
    assert orbit.stages.shape == (3, Scheme().ncol, 2) and (orbit.stages == [1.0, 2.0]).all()
    assert orbit.algebraic.shape == (3, Scheme().ncol, 1) and (orbit.algebraic == 3.0).all()
    given[0] = 7.0
    assert orbit.parameter.tolist() == [4.0, 5.0]


def test_halved_orbit_is_the_same_polynomial() -> None:
    """Assert states and unknowns of the halved mesh, to rounding."""
    fine = bisect(holding(uniform(Scheme(), 5), np.zeros(0)))
    exact = holding(uniform(Scheme(), 10), np.zeros(0))
    assert fine.mesh.ntst == 10
    assert fine.nodes == pytest.approx(exact.nodes, abs=1e-12)
    assert fine.stages == pytest.approx(exact.stages, abs=1e-12)
    assert fine.algebraic == pytest.approx(exact.algebraic, abs=1e-12)


def test_transferred_orbit_has_the_states_on_either_side_of_an_event() -> None:
    """Assert an orbit that jumps where the mesh begins, on another mesh: x- before the node, x+ after it.

    The polynomial is not periodic, so it jumps from tau = 2 pi + 1 to 1. Places beside it are moved by 1e-9
    of an interval.
    """
    events, phases = (EventNode(0, 1),), np.array([1.0])
    orbit = holding(Mesh(Scheme(), (np.linspace(0, 1, 5),), events), phases)
    found = transfer(orbit, Mesh(Scheme(), (np.linspace(0, 1, 8),), events), phases)
    tau = 1 + 2 * np.pi * np.linspace(0, 1, 8)
    assert found.nodes[:-1] == pytest.approx(polynomial(tau[:-1]), abs=1e-7)
    assert found.nodes[-1] == pytest.approx(found.nodes[0], abs=1e-7)
    grid = found.grid
    stages = grid.left[:, None] + grid.width[:, None] * Scheme().points
    assert found.stages == pytest.approx(polynomial(stages), abs=1e-7)
    assert found.algebraic == pytest.approx(3 + stages[:, :, None], abs=1e-6)
    assert found.parameter.tolist() == [2.0] and found.phases.tolist() == [1.0]


def test_rows_are_added_and_scaled() -> None:
    """Assert value and gradients, with and without parts at the collocation points."""
    one = Row(1.0, np.array([[2.0]]), np.array([3.0]), np.array([[[4.0]]]))
    two = Row(10.0, np.array([[20.0]]), np.array([30.0]))
    both = one + two.scaled(-0.5)
    assert (both.value, both.nodes.tolist(), both.outer.tolist()) == (-4.0, [[-8.0]], [-12.0])
    assert both.stages is not None and both.stages.tolist() == [[[4.0]]]
    assert (two + two).stages is None
    twice = (one + one).stages
    assert twice is not None and twice.tolist() == [[[8.0]]]


def test_vertex_of_the_parabola_through_the_largest_sample() -> None:
    """Assert (low - high) / (2 (low - 2 top + high)) samples: -0.25 for 1, 2, 0 -> (1 - 0) / (2 (1 - 4))."""
    values = np.zeros((4, extrema.SAMPLES))
    values[0, 3:6] = 1.0, 2.0, 0.0
    values[1, 0] = 1.0  # at the edge of the window
    values[2, 4] = 1.0
    peak = values.argmax(axis=1)  # of the constant ones the first
    assert extrema._offset(values, peak) == pytest.approx([-1 / 6, 0.0, 0.0, 0.0], abs=1e-15)


def test_better_of_two_values() -> None:
    """Assert the larger value with its phase, the known one where they are equal."""
    value, phase = extrema._better(
        np.array([1.0, 2.0, 3.0]), np.zeros(3), np.array([2.0, 2.0, 1.0]), np.ones(3)
    )
    assert value.tolist() == [2.0, 2.0, 3.0] and phase.tolist() == [1.0, 0.0, 0.0]


def test_candidates_are_the_local_maxima_that_may_become_the_highest() -> None:
    """Assert those of a column around the period: one that rises by little above its neighbours is none."""
    values = np.array([[9.0], [0.0], [5.0], [4.9], [0.0], [8.0], [7.0], [8.5]])
    column, index = extrema._candidates(values)
    # 5 + 2 (5 - 0) and 8 + 2 (8 - 0) reach 9; 2.9 + 2 (2.9 - 0) does not.
    assert column.tolist() == [0, 0, 0] and sorted(index.tolist()) == [0, 2, 5]
    low = np.array([[9.0], [0.0], [5.0], [3.1], [0.0], [2.9], [0.0], [0.0]])
    assert sorted(extrema._candidates(low)[1].tolist()) == [0, 2]


def test_short_intervals_do_not_count() -> None:
    """Assert it of an interval of 0.9e-5 rad, not of one of 1.1e-5, and of none where all are as short."""

    def marked(*widths: float) -> list[bool]:
        period = sum(widths)
        breaks = np.append(0.0, np.cumsum(widths)) / period
        mesh: Any = Mesh(Scheme(), (breaks,), (), period)
        return extrema._short(constant(mesh, np.zeros(1), np.zeros(0), np.zeros(0))).tolist()

    assert marked(0.9e-5, 1.1e-5, 1.0) == [True, False, False]
    assert marked(0.9e-5, 0.9e-5) == [False, False]


def test_graded_mesh_follows_the_arclength_of_samples() -> None:
    """Assert that of five intervals on a staircase those where the state rises are short."""
    phase = np.linspace(0, 2 * np.pi, 1001)
    state = np.clip((phase - 3.0) / 0.1, 0, 1)[:, None]  # rises by its peak to peak within 0.1 rad
    mesh = sampling._graded(phase, state, 4)
    # The arclength is 2 pi (phase) beside 2 pi (state); a quarter of the whole is about pi.
    rise = np.hypot(2 * np.pi, 0.1)
    total = 2 * np.pi - 0.1 + rise
    middle = 3.0 + 0.1 * (total / 2 - 3.0) / rise
    later = (
        3.0 + 0.1 * (0.75 * total - 3.0) / rise if 0.75 * total < 3.0 + rise else 0.75 * total - rise + 0.1
    )
    first = 3.0 + 0.1 * (0.25 * total - 3.0) / rise if 0.25 * total > 3.0 else 0.25 * total
    exact = np.array([0.0, first, middle, later, 2 * np.pi]) / (2 * np.pi)
    assert mesh.breaks[0] == pytest.approx(exact, abs=0.002) and mesh.period == 2 * np.pi


@pytest.mark.parametrize(("vibrations", "most"), [(3, 96), (60, 1536), (300, 6144)])
def test_samples_of_many_vibrations_have_a_mesh_for_them(vibrations: int, most: int) -> None:
    """Assert the samples on the first of the meshes that shows them, to a hundredth of the peak to peak."""
    phase = np.linspace(0, 2 * np.pi, 40 * vibrations + 1)
    state = np.column_stack([np.cos(vibrations * phase), np.sin(vibrations * phase)])
    orbit = sampling.sampled(phase, state, parameter=np.zeros(1))
    assert orbit.mesh.ntst <= most
    assert np.abs(orbit.state(phase) - state).max() < 0.02


@pytest.mark.parametrize(
    "phase",
    [
        [0.0, 1.0, 2.0],
        [0.0, 1.0, 2.0, 1.5, 6.3],
        [0.0, 1.0, 2.0, 6.0],
        [0.0, 1.0, 2.0, np.inf],
        [0.0, 0.1, 0.2, 0.3],
    ],
)
def test_samples_that_are_no_period(phase: list[float]) -> None:
    """Assert that too few, falling, and other lengths than whole periods are refused."""
    with pytest.raises(
        ValueError, match="must be at least 4 rising numbers|must last a whole number of them"
    ):
        sampling._periods(np.array(phase))
    assert sampling._periods(np.array([0.0, 1.0, 2.0, 4 * np.pi + 5e-6])) == 2


def test_rates_from_both_sides_of_a_mesh_point() -> None:
    """Assert those of the interval on the right and on the left, with a kink at each mesh point."""
    orbit = along(lambda tau: np.sin(tau)[:, None], intervals=6)
    rates = np.arange(6.0)[:, None, None] + np.linspace(0.1, 0.5, orbit.mesh.scheme.ncol + 1)[:, None]
    vars(orbit)["knot_rates"] = rates
    assert orbit.node_rates[:, 0] == pytest.approx([0.1, 1.1, 2.1, 3.1, 4.1, 5.1, 0.1])
    assert orbit.mesh.scheme.points[-1] == 1.0
    assert orbit.end_rates[:, 0] == pytest.approx([5.5, 0.5, 1.5, 2.5, 3.5, 4.5, 5.5])
    gauss = replace(orbit, mesh=Mesh(Scheme(Family.GAUSS, 4), orbit.mesh.breaks))
    vars(gauss)["knot_rates"] = rates
    assert gauss.end_rates[:, 0] == pytest.approx([0.1, 1.1, 2.1, 3.1, 4.1, 5.1, 0.1])
