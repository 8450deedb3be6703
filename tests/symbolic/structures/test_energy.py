"""Energy of modes of a motion: by hand, and the sum of kinetic and elastic energy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symbolic as sym
from symbolic.structures.energy import modal_energy

MASS, STIFFNESS = np.diag([2.0, 0.5]), np.diag([50.0, 2.0])


def test_energy_of_each_mode() -> None:
    """Assert m v^2/2 + k q^2/2 of masses that are modes by themselves, that of omega = 2 before omega = 5."""
    moved, speed = [[3.0, 7.0], [0.0, 1.0]], [[1.0, 4.0], [2.0, 0.0]]
    matrices = sym.Matrices(MASS, None, STIFFNESS)
    expected = np.array([[4.0 + 49.0, 1.0 + 225.0], [1.0, 4.0]])
    assert modal_energy(matrices, moved, speed) == pytest.approx(expected, rel=1e-12)
    assert modal_energy(matrices, moved, speed, 1) == pytest.approx(expected[:, :1], rel=1e-12)
    assert modal_energy(matrices, moved[0], speed[0], 2) == pytest.approx(expected[:1], rel=1e-12)


@pytest.mark.parametrize(("size", "count", "expected"), [(11, None, 11), (14, None, 12), (14, 14, 14)])
def test_how_many_modes(size: int, count: int | None, expected: int) -> None:
    """Assert all up to 12, or as many as are asked for; all together have the energy of the motion."""
    random = np.random.default_rng(2)
    stiffness, mass = np.diag(np.arange(1.0, size + 1)) + 0.1, np.eye(size)
    moved, speed = random.normal(size=(2, 3, size))
    found = modal_energy(sym.Matrices(mass, None, stiffness), moved, speed, count)
    assert found.shape == (3, expected)
    if expected == size:
        whole = ((speed**2).sum(axis=1) + np.einsum("ki,ij,kj->k", moved, stiffness, moved)) / 2
        assert found.sum(axis=1) == pytest.approx(whole, rel=1e-10)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"count": 3}, "count is 3; it must be a whole number from 1 to 2"),
        ({"count": 0}, "count is 0; it must be a whole number of at least 1"),
        ({"displacement": [[1.0]]}, r"displacement has shape \(1, 1\); it must be \(K, 2\), a row for each"),
        ({"velocity": [[[1.0, 2.0]]]}, r"velocity has shape \(1, 1, 2\); it must be \(K, 2\), a row for"),
        ({"velocity": "fast"}, "velocity is 'fast'; it must be an array of numbers"),
        ({"matrices": sym.Matrices(MASS, None, [[1.0, 0.1], [0.0, 1.0]])}, "K is not symmetric; energy per"),
    ],
)
def test_energy_that_is_refused(change: dict[str, Any], said: str) -> None:
    """Assert the sentence."""
    given: dict[str, Any] = {
        "matrices": sym.Matrices(MASS, None, STIFFNESS),
        "displacement": [[1.0, 2.0]],
        "velocity": [[1.0, 2.0]],
    }
    with pytest.raises(ValueError, match=f"^{said}"):
        modal_energy(**given | change)
