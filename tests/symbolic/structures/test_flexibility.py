"""Dynamic flexibility by hand, of dense and of sparse matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import sparse

import symbolic as sym
from symbolic.structures.flexibility import damping_at, indices, solved

MASS, DAMPING = np.diag([1.0, 2.0, 1.0]), np.diag([0.5, 0.2, 0.1])
STIFFNESS = np.array([[5.0, -1.0, 0.0], [-1.0, 4.0, -2.0], [0.0, -2.0, 6.0]])
GYROSCOPIC = np.array([[0.0, 0.3, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.0, 0.0]])
PLACES = {"left": 0, "right": 2}


@pytest.mark.parametrize("form", [np.array, sparse.csr_array])
def test_flexibility_by_hand(form: Any) -> None:
    """Assert (K + i w (C + Omega G) - w^2 M)^-1 at places in the order given, without a speed C alone."""
    matrices = sym.Matrices(form(MASS), form(DAMPING), form(STIFFNESS), form(GYROSCOPIC), at=PLACES)
    for options, speed in (({}, 0.0), ({"speed": 2.0}, 2.0)):
        found = sym.flexibility(matrices, ["right", 1], [0.0, 1.5, 4.0], **options)
        assert found.shape == (3, 2, 2)
        for answer, w in zip(found, [0.0, 1.5, 4.0], strict=True):
            exact = np.linalg.inv(STIFFNESS + 1j * w * (DAMPING + speed * GYROSCOPIC) - w**2 * MASS)
            assert answer == pytest.approx(exact[np.ix_([2, 1], [2, 1])], rel=1e-10)


@pytest.mark.parametrize("form", [np.array, sparse.csr_array])
def test_no_answer_at_an_undamped_resonance(form: Any) -> None:
    """Assert the sentence, and an answer beside it."""
    matrices = sym.Matrices(form(np.eye(2)), None, form(np.diag([4.0, 9.0])), at={"a": 0})
    assert sym.flexibility(matrices, ["a"], [2.5]).real.tolist() == [[[pytest.approx(1 / (4 - 6.25))]]]
    with pytest.raises(ValueError, match="^omega is 3; it must not be that of an undamped resonance$"):
        sym.flexibility(matrices, ["a"], [2.5, 3.0])
    assert solved(form(np.zeros((2, 2))), np.eye(2)) is None
    assert solved(form(np.array([[1.0, 1.0], [1.0, 1.0]])), np.eye(2)) is None


def test_damping_at_a_speed() -> None:
    """Assert C + Omega G, and C itself where nothing turns."""
    still, turning = (sym.Matrices(MASS, DAMPING, STIFFNESS, g) for g in (None, GYROSCOPIC))
    assert damping_at(still, 3.0) is still.C
    assert np.asarray(damping_at(turning, 3.0)).tolist() == (DAMPING + 3.0 * GYROSCOPIC).tolist()


def test_indices_of_places() -> None:
    """Assert them by name and by index, and the sentences of what names no place, or one twice."""
    matrices = sym.Matrices(MASS, None, STIFFNESS, at=PLACES)
    assert indices(matrices, ["right", 0, 1]).tolist() == [2, 0, 1]
    wrong: list[tuple[Any, str]] = [
        ("right", "a sequence of at least one name or index"),
        ([], "a sequence of at least one name or index"),
        (3, "a sequence of at least one name or index"),
        (["right", 2], "different degrees of freedom"),
        ([1, 0, 1], "different degrees of freedom"),
    ]
    for given, said in wrong:
        with pytest.raises(ValueError, match=f"; it must be {said}$"):
            indices(matrices, given)
    for place in (3, -1, True, 1.0):
        with pytest.raises(ValueError, match="it must be a whole number from 0 to 2$"):
            indices(matrices, [place])  # type: ignore[list-item]
