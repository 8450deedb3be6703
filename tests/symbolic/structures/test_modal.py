"""Modes of a structure, and what those that are left out leave to its stiffness."""

from __future__ import annotations

import numpy as np
import pytest

import symbolic as sym
from symbolic.structures import modal
from symbolic.structures.linearpart import Modes, like


def test_flexibility_of_modes_left_out() -> None:
    """Assert that of a cantilever of 2000 degrees of freedom at its tip, a 2e8th of the whole, to 3 digits.

    Mode j of the continuum adds 4 / omega_j^2, omega_j = ((j - 1/2) pi)^2 for all but the first.
    """
    beam = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=1000)
    form, tip = sym.Structure(beam, damping=0.05).modal(1.0), beam.at["tip"]
    assert len(form.exponents) == 200
    left = 4 / ((np.arange(201, 100_000) - 0.5) * np.pi) ** 4
    assert form.residual([tip])[tip, 0] == pytest.approx(left.sum(), rel=1e-3)
    assert form.static([tip])[tip, 0] == pytest.approx(1 / 3, rel=1e-3)


def test_modes_followed_in_the_speed() -> None:
    """Assert the order of nearby modes, and the same largest input: what is left of outputs times inputs."""
    given = Modes(
        exponents=np.array([1j, 3j, 5j]),
        inputs=np.array([[1.0, 4.0], [2.0, 1.0], [0.5, 0.0]], dtype=complex),
        outputs=np.ones((4, 3), dtype=complex),
        direct=np.zeros((4, 2)),
        direct_rate=np.zeros((4, 2)),
    )
    other = Modes(
        exponents=np.array([5.1j, 0.9j, 3.2j]),
        inputs=np.array([[0.0, 0.0], [3.0, 2.0], [-8.0, 6.0]], dtype=complex),
        outputs=np.arange(12.0).reshape(4, 3).astype(complex),
        direct=np.full((4, 2), 7.0),
        direct_rate=np.full((4, 2), 9.0),
    )
    found = like(given, other)
    assert found.exponents.tolist() == [0.9j, 3.2j, 5.1j]
    assert found.inputs.tolist() == [[6.0, 4.0], [2.0, -1.5], [0.0, 0.0]]
    assert (
        found.outputs.tolist() == (np.arange(12.0).reshape(4, 3)[:, [1, 2, 0]] / [2.0, -0.25, 1.0]).tolist()
    )
    assert found.direct is other.direct and found.direct_rate is other.direct_rate


def test_modes_that_meet_are_not_followed() -> None:
    """Assert that two modes next to one are told."""
    zero = np.zeros((2, 1))

    def two(*exponents: complex) -> Modes:
        return Modes(np.array(exponents), zero.astype(complex), zero.T.astype(complex), zero[:1], zero[:1])

    with pytest.raises(ArithmeticError, match="modes of the structure cannot be followed in the speed"):
        like(two(1j, 1.2j), two(1.1j, 9j))


@pytest.mark.parametrize(("size", "refused"), [(2, False), (3, False), (4, True)])
def test_coupled_modes_of_large_structures(size: int, refused: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that gyroscopic terms are taken up to the size of dense matrices, and refused beyond it."""
    monkeypatch.setattr(modal, "DENSE", 3)
    gyroscopic = np.tri(size, k=-1) - np.tri(size, k=-1).T
    structure = sym.Structure(np.eye(size), None, np.diag(np.arange(1.0, size + 1)), G=gyroscopic)
    if not refused:
        assert len(structure.modal(1.0).exponents) >= size
        return
    with pytest.raises(
        ValueError, match="^structure 'structure' has 4 degrees of freedom and damping or gyros"
    ):
        structure.modal(1.0)
