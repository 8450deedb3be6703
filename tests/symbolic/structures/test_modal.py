"""Modes of a structure, and what those that are left out leave to its stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

import symbolic as sym
from symbolic.arrays import Array, Complex
from symbolic.structures import modal
from symbolic.structures.damping import ModalDamping
from symbolic.structures.linearpart import Modes, like
from symbolic.structures.matrices import dense
from symbolic.structures.modal import ModalForm, holding, modal_form, stiffened


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


def response(form: ModalForm, omega: float) -> Complex:
    """Displacements of harmonic unit forces from modes: half of each and of its conjugate."""
    found = np.zeros((len(form.shapes), len(form.shapes)), dtype=complex)
    for k, exponent in enumerate(form.exponents):
        one = np.outer(form.shapes[:, k], form.inputs[k])
        found += one / (1j * omega - exponent) / 2 + one.conj() / (1j * omega - exponent.conjugate()) / 2
    return found


MASS, STIFFNESS = np.diag([1.0, 2.0]), np.array([[0.3, -0.1], [-0.1, 0.5]])


@pytest.mark.parametrize(
    "damping",
    [
        np.zeros((2, 2)),
        0.1 * MASS,
        0.95 * MASS,
        5.0 * MASS,
        np.array([[0.2, 0.1], [0.1, 0.0]]),
        np.array([[9.0, 0.1], [0.1, 0.0]]),
        np.array([[0.0, 0.3], [-0.3, 0.0]]),
    ],
    ids=["none", "slight", "one beyond", "both beyond", "coupled", "coupled beyond", "gyroscopic"],
)
@pytest.mark.parametrize("omega", [0.25, 0.9])
def test_response_from_modes(damping: Array, omega: float) -> None:
    """Assert (K - omega^2 M + i omega C)^-1, K^-1 and M^-1 of modes that oscillate and such that do not."""
    form = modal_form("s", sym.Matrices(MASS, damping, STIFFNESS), ModalDamping(), 1.0, None)
    exact = np.linalg.inv(STIFFNESS - omega**2 * MASS + 1j * omega * damping)
    assert response(form, omega) == pytest.approx(exact, rel=1e-9, abs=1e-12)
    assert form.static([1, 0]) == pytest.approx(np.linalg.inv(STIFFNESS)[:, [1, 0]], rel=1e-9)
    assert form.mobility([1]) == pytest.approx(np.array([[0.5]]), rel=1e-9)
    assert form.residual([0]).tolist() == [[0.0], [0.0]]


def test_modal_damping_beside_a_stiffness_that_holds() -> None:
    """Assert that the damping ratio is of the structure without it, in coupled and uncoupled modes."""
    matrices = sym.Matrices(np.eye(1), 0.2 * np.eye(1), 4 * np.eye(1))
    form = modal_form("s", matrices, ModalDamping(0.1), 1.0, None, {0: 5.0})
    exact = 1 / (9 - 1.5**2 + 1j * 1.5 * (0.2 + 2 * 0.1 * 2.0))
    assert response(form, 1.5) == pytest.approx(np.array([[exact]]), rel=1e-9)
    coupled = sym.Matrices(np.eye(2), None, 4 * np.eye(2), G=np.array([[0.0, 0.5], [-0.5, 0.0]]))
    damped = modal_form("s", coupled, ModalDamping(0.1), 3.0, None)
    inverse = (4 - 1.5**2) * np.eye(2) + 1.5j * (0.4 * np.eye(2) + 3.0 * np.array([[0, 0.5], [-0.5, 0]]))
    assert response(damped, 1.5) == pytest.approx(np.linalg.inv(inverse), rel=1e-9)
    assert damped.own and modal_form("s", coupled, ModalDamping(), 3.0, None).own and not form.own


def test_stiffness_added_at_some_freedoms() -> None:
    """Assert it of dense and sparse matrices; nothing else changes."""
    for matrices in (
        sym.Matrices(MASS, 0.1 * MASS, STIFFNESS, G=np.zeros((2, 2))),
        sym.Matrices(*(sparse.csr_array(a) for a in (MASS, 0.1 * MASS, STIFFNESS))),
    ):
        found = stiffened(matrices, {1: 2.5})
        assert sparse.issparse(found.K) is sparse.issparse(matrices.K)
        assert dense(found.K - matrices.K).tolist() == [[0, 0], [0, 2.5]]
        assert dense(found.M).tolist() == MASS.tolist() and dense(found.C).tolist() == (0.1 * MASS).tolist()
        assert (found.G is None) is (matrices.G is None)


@pytest.mark.parametrize("others", [[0.0, 0.0], [0.0, 50.0], [40.0, 0.0]])
def test_stiffnesses_that_hold(others: list[float]) -> None:
    """Assert the size of k - m omega^2 + i omega c of each freedom, or the stiffness of others if greater."""
    matrices = sym.Matrices(np.diag([1.0, 2.0]), np.diag([0.5, 0.25]), np.diag([7.0, 5.0]))
    found = holding(matrices, 2.0, [1, 0], np.array(others))
    own = [abs(5 - 8 + 0.5j), abs(7 - 4 + 1j)]
    assert list(found) == [1, 0]
    assert list(found.values()) == pytest.approx(np.maximum(own, others).tolist(), rel=1e-12)


def test_gyroscopic_stiffness_that_holds() -> None:
    """Assert that of G times the speed, of one freedom of two."""
    gyroscopic = np.array([[0.0, 0.5], [-0.5, 0.0]])
    matrices = sym.Matrices(np.eye(2), None, 7 * np.eye(2), G=gyroscopic)
    dynamic = 3 * np.eye(2) + 2j * 2 * gyroscopic
    exact = 1 / abs(np.linalg.inv(dynamic)[0, 0])
    assert holding(matrices, 2.0, [0], np.zeros(1))[0] == pytest.approx(exact, rel=1e-12)


def test_modes_say_by_how_much_they_miss_the_static_flexibility() -> None:
    """Assert rounding of all modes, and of some with their residual; a missing one, and wrong frequencies."""
    stiffness = np.array([[5.0, -1.0], [-1.0, 3.0]])
    matrices = sym.Matrices(np.eye(2), None, stiffness)
    gyroscopic = sym.Matrices(np.eye(2), np.array([[0.1, 0.5], [-0.5, 0.1]]), stiffness)
    for given, count in ((matrices, None), (matrices, 1), (gyroscopic, None)):
        assert modal_form("s", given, ModalDamping(), 1.0, count).error([0, 1]) < 1e-14
    full = modal_form("s", matrices, ModalDamping(), 1.0, None)
    missing = replace(full, exponents=full.exponents[:1], shapes=full.shapes[:, :1], inputs=full.inputs[:1])
    exact = np.linalg.inv(stiffness)
    squares, modes = np.linalg.eigh(stiffness)
    share = np.outer(modes[:, 1], modes[:, 1]) / squares[1]
    assert missing.error([0, 1]) == pytest.approx(abs(share).max() / abs(exact).max(), rel=1e-12)
    assert missing.error([0]) == pytest.approx(abs(share[:, 0]).max() / abs(exact[:, 0]).max(), rel=1e-12)
    off = replace(full, exponents=full.exponents * 1.01)  # as inputs are, by 1 / omega
    assert off.error([0]) == pytest.approx(0.01 / 1.01, rel=1e-9)


def test_structures_that_are_loose() -> None:
    """Assert the sentences, and how many modes are not held."""
    for stiffness, said in ((np.diag([1.0, 0.0]), "1 rigid-body modes"), (-np.eye(2), "2 modes of negative")):
        with pytest.raises(modal.LooseError, match=f"^structure 's' has {said}"):
            modal_form("s", sym.Matrices(np.eye(2), None, stiffness), ModalDamping(), 1.0, None)
    gyroscopic = np.array([[0.0, 1.0], [-1.0, 0.0]])
    with pytest.raises(modal.LooseError, match="^structure 's' has rigid-body modes that forces"):
        modal_form("s", sym.Matrices(np.eye(2), gyroscopic, np.diag([1.0, 0.0])), ModalDamping(), 1.0, None)


def test_modes_that_do_not_span_the_motion() -> None:
    """Assert the sentence for a critically damped mode beside one that is coupled to another."""
    damping = np.array([[2.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, -0.5, 0.0]])
    with pytest.raises(ValueError, match="^structure 's' has modes that do not span its motion"):
        modal_form("s", sym.Matrices(np.eye(3), damping, np.eye(3)), ModalDamping(), 1.0, None)


def test_critically_damped_mode() -> None:
    """Assert that its two exponents are moved apart by 6e-6 of its frequency, and its static answer."""
    form = modal_form("s", sym.Matrices(np.eye(1), 4 * np.eye(1), 4 * np.eye(1)), ModalDamping(), 1.0, None)
    assert form.exponents.real == pytest.approx([-2 + 6e-6, -2 - 6e-6], abs=1e-9)
    assert form.static([0]) == pytest.approx(np.array([[0.25]]), rel=1e-9)


def test_stiffness_that_is_definite_by_rounding_alone() -> None:
    """Assert that modes of a free beam, whose stiffness may pass for definite, are finite: (4.730041)^2."""
    free = sym.beam(length=1.0, bending=1.0, mass_per_length=1.0, elements=7, left="free")
    for digits in range(12, 17):  # some of these have least eigenvalues below 0 and yet a Cholesky factor
        K = dense(free.K) + 10.0**-digits * np.abs(dense(free.K)).max() * np.eye(free.size)
        squares, shapes = modal._undamped(sym.Matrices(free.M, None, K, at=free.at), free.size)
        assert np.isfinite(squares).all() and np.isfinite(shapes).all()
        assert squares[2] == pytest.approx(22.373285**2, rel=1e-3)
