"""Damping mode by mode, and records of Nastran's files."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import symbolic as sym
from symbolic.guarded import DamagedError
from symbolic.structures.damping import ModalDamping
from symbolic.structures.nastran import FILLED, _check_records, _small, op4


def test_rates_of_modes() -> None:
    """Assert 2 ratio omega + a + b omega^2, the last ratio counting for all modes above."""
    omega = np.array([1.0, 2.0, 3.0, 5.0])
    assert ModalDamping(0.1).rates(omega) == pytest.approx(0.2 * omega)
    assert ModalDamping((0.1, 0.3)).rates(omega) == pytest.approx([0.2, 1.2, 1.8, 3.0])
    assert ModalDamping(mass=0.5, stiffness=0.25).rates(omega) == pytest.approx(0.5 + 0.25 * omega**2)
    assert ModalDamping((0.1, 0.2, 0.3, 0.4, 0.5)).rates(omega[:2]) == pytest.approx([0.2, 0.8])


@pytest.mark.parametrize(
    ("given", "none"),
    [((), True), ((0.0,), True), (((0.0, 0.0),), True), (((0.0, 0.1),), False), ((0.0, 0.1), False)],
)
def test_no_damping_at_all(given: tuple[Any, ...], none: bool) -> None:
    """Assert it where all numbers are 0."""
    assert ModalDamping(*given).none is none
    assert not ModalDamping(stiffness=0.1).none


@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf, (), "a", None, (0.1, -0.1), [[0.1]], [[0.1, 0.2]]])
def test_damping_refused(value: Any) -> None:
    """Assert the sentence for numbers that are negative, not finite, none, or a matrix."""
    with pytest.raises(
        ValueError, match="^damping is .*; it must be a finite number of at least 0, or a sequ"
    ):
        ModalDamping(value)


@pytest.mark.parametrize("name", ["mass", "stiffness"])
@pytest.mark.parametrize("value", [-0.1, np.nan])
def test_rayleigh_refused(name: str, value: float) -> None:
    """Assert the sentence."""
    with pytest.raises(
        ValueError, match="^rayleigh is .*; it must be a finite number of at least 0, or a seq"
    ):
        ModalDamping(**{name: value})


def test_matrix_of_damping() -> None:
    """Assert a M + b K, and that a ratio leaves modes uncoupled; the same matrix is computed once."""
    random = np.random.default_rng(3)
    one, two = random.standard_normal((2, 3, 3))
    mass, stiffness = np.eye(3) + 0.1 * one @ one.T, 4 * np.eye(3) + two @ two.T
    own = sym.Matrices(mass, None, stiffness)
    rayleigh = ModalDamping(mass=0.3, stiffness=0.02)
    found = rayleigh.matrix(own)
    assert found == pytest.approx(0.3 * mass + 0.02 * stiffness, abs=1e-12)
    assert rayleigh.matrix(own) is found
    values, shapes = eigh(stiffness, mass)
    ratio = shapes.T @ ModalDamping((0.1, 0.2)).matrix(own) @ shapes
    assert ratio == pytest.approx(np.diag(2 * np.array([0.1, 0.2, 0.2]) * np.sqrt(values)), abs=1e-12)


def record(content: bytes, order: str = "<") -> bytes:
    """A record of Fortran's."""
    length = struct.pack(f"{order}i", len(content))
    return length + content + length


@pytest.mark.parametrize("order", ["<", ">"])
def test_chain_of_records(order: str) -> None:
    """Assert that a whole chain is taken, in either order of bytes."""
    held = record(b"x" * 24, order) + record(b"", order) + record(b"y" * 300, order)
    _check_records(held)
    for count in (1, 3, 4, 7, 8, 12, 300, 304):
        with pytest.raises(DamagedError, match="^it ends within a record$"):
            _check_records(held[:-count])


@pytest.mark.parametrize(
    "spoil",
    [
        lambda held: held[:28] + struct.pack("<i", 23) + held[32:],
        lambda held: held[:32] + struct.pack("<i", -1) + held[36:],
        lambda held: held[:32] + struct.pack("<i", 9999) + held[36:],
        lambda held: held + b"\0\0\0",
    ],
)
def test_records_that_are_damaged(spoil: Any) -> None:
    """Assert a refusal of lengths that differ, are negative or lead beyond the end."""
    held = record(b"x" * 24) + record(b"y" * 40)
    _check_records(held)
    with pytest.raises(DamagedError, match="^it ends within a record$"):
        _check_records(spoil(held))


def test_size_of_dense_matrices() -> None:
    """Assert that they take up to four times their file, and no more rows than it has bytes."""
    held = b"x" * 800
    count = FILLED * len(held) // 8
    assert _small([(count // 10, 10)], held) and not _small([(count // 10, 10), (1, 1)], held)
    assert _small([(800, 0)], held)
    for size in ((801, 0), (0, 801), (-1, 2)):
        with pytest.raises(DamagedError, match="^it declares a matrix that is larger than what it holds$"):
            _small([size], held)


def test_large_matrices_of_nastran_stay_sparse(tmp_path: Path) -> None:
    """Assert it of a binary file of a matrix of zeros but for its diagonal, and a small one dense."""
    op4_of = pytest.importorskip("pyyeti.nastran.op4")
    from scipy import sparse

    for size, thin, how in ((4, False, "dense"), (400, True, "bigmat")):
        file = tmp_path / f"{size}.op4"
        op4_of.write(str(file), {"maa": sparse.csr_array(np.eye(size))}, binary=True, sparse=how)
        (found,) = op4(file, file.read_bytes()).values()
        assert sparse.issparse(found) is thin
        dense = found.toarray() if thin else found
        assert dense.tolist() == np.eye(size).tolist()
