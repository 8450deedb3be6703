"""Matrices of linear structures: what they must be, beams, files there and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy

import symbolic as sym
from symbolic.structures.beam import bending_element, chained
from symbolic.structures.matrices import modes
from symbolic.structures.modal import LooseError, ModalForm
from symbolic.structures.rounding import hidden, uncertainty

BEAM = {"length": 2.0, "bending": 3.0, "mass_per_length": 5.0}


@pytest.mark.parametrize(
    ("ends", "first"),
    [
        (("clamped", "free"), 1.8751040687119611),
        (("clamped", "clamped"), 4.730040744862704),
        (("pinned", "pinned"), np.pi),
        (("clamped", "pinned"), 3.9266023120479185),
    ],
)
def test_beam_converges_to_its_closed_form(ends: tuple[Any, Any], first: float) -> None:
    """Assert the first frequency (beta L)^2 sqrt(EI/(rho A L^4)), and order four in the elements."""
    exact = first**2 * np.sqrt(3.0 / 5.0) / 2.0**2
    errors = []
    for elements in (4, 8, 16):
        beam = sym.beam(**BEAM, elements=elements, left=ends[0], right=ends[1])
        errors.append(2 * np.pi * beam.first_frequency / exact - 1)
    assert 0 < errors[2] < 1e-5
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.15)


def test_beam_has_its_mass_and_its_static_tip() -> None:
    """Assert rho A L of the free beam and L^3/(3 EI) at the tip of the clamped one, to rounding."""
    free = sym.beam(**BEAM, elements=7, left="free")
    deflections = [k for name, k in free.at.items() if name.startswith("w")]
    lift = np.zeros(free.size)
    lift[deflections] = 1
    assert lift @ free.M @ lift == pytest.approx(10.0, rel=1e-13)
    assert free.first_frequency > 0.1  # the two rigid-body modes do not count
    clamped = sym.beam(**BEAM, elements=7)
    load = np.zeros(clamped.size)
    load[clamped["tip"]] = 1
    assert np.linalg.solve(clamped.K, load)[clamped["tip"]] == pytest.approx(8 / 9, rel=1e-12)


def test_long_structures_are_sparse() -> None:
    """Assert that many elements make sparse matrices, which begin as those of few elements as long."""
    discs = [sym.ShaftDisc(node=1, mass=2.0, diametral=0.1, polar=0.2)]
    few, many = 6, 300
    for name in ("M", "K", "G"):
        short, long = (
            getattr(sym.shaft(length=0.1 * k, diameter=0.05, elements=k, discs=discs), name)
            for k in (few, many)
        )
        assert scipy.sparse.issparse(long) and not scipy.sparse.issparse(short)
        assert long.nnz < 40 * long.shape[0]
        np.testing.assert_allclose(long[:20, :20].toarray(), short[:20, :20], rtol=1e-12)
    short_beam, long_beam = (
        sym.beam(length=0.1 * k, bending=3.0, mass_per_length=5.0, elements=k) for k in (few, many)
    )
    assert scipy.sparse.issparse(long_beam.M) and scipy.sparse.issparse(long_beam.C)
    for a, b in ((long_beam.M, short_beam.M), (long_beam.K, short_beam.K)):
        np.testing.assert_allclose(a[:8, :8].toarray(), b[:8, :8], rtol=1e-12)


def test_lanczos_finds_what_the_full_problem_has() -> None:
    """Assert the lowest modes of a large sparse chain, its rigid-body mode included."""
    n = 1500
    ends = np.r_[1.0, np.full(n - 2, 2.0), 1.0]
    stiffness = scipy.sparse.diags_array([-np.ones(n - 1), ends, -np.ones(n - 1)], offsets=[-1, 0, 1])
    squares, shapes = modes(stiffness.tocsr(), scipy.sparse.eye_array(n).tocsr(), 6)
    exact = (2 * np.sin(np.arange(6) * np.pi / (2 * n))) ** 2
    np.testing.assert_allclose(squares, exact, atol=1e-12)
    np.testing.assert_allclose(shapes.T @ shapes, np.eye(6), atol=1e-9)


@pytest.mark.parametrize(("left", "first"), [("clamped", 1.8751040687119611), ("free", 4.730040744862704)])
@pytest.mark.parametrize(("elements", "error"), [(1000, 1e-5), (5000, 2e-3)])
def test_fine_meshes_have_their_first_frequency(left: Any, first: float, elements: int, error: float) -> None:
    """Assert the closed form to what rounding of the matrices leaves, the same each time."""
    fine = sym.beam(**BEAM, elements=elements, left=left)
    exact = first**2 * np.sqrt(3.0 / 5.0) / 2.0**2 / (2 * np.pi)
    assert fine.first_frequency == pytest.approx(exact, rel=error)
    assert sym.beam(**BEAM, elements=elements, left=left).first_frequency == fine.first_frequency
    squares, shapes = modes(fine.K, fine.M, 5)
    unsure = uncertainty(fine.K, shapes)
    elastic = ~hidden(fine.K, squares, shapes)
    assert elastic.tolist() == [left == "clamped"] * 2 + [True] * 3
    k = int(np.flatnonzero(elastic)[0])
    assert abs(np.sqrt(squares[k]) / (2 * np.pi) / exact - 1) < unsure[k] / squares[k]  # the estimate sees it


def test_meshes_too_fine_are_refused() -> None:
    """Assert the sentences, of a beam and of a user's own matrices of 20,000 degrees of freedom."""
    with pytest.raises(ValueError, match="^elements is 5001; it must be at most 5000: rounding of K hides"):
        sym.beam(**BEAM, elements=5001)
    stiffness, mass = (chained(m, 10000, 2)[2:, 2:] for m in bending_element(2e-4, 3.0))
    own = sym.Structure(mass, K=stiffness, at={"tip": 19998}, modes=4)
    with pytest.raises(LooseError, match="^structure 'structure' has 1 modes that rounding of K, of a free"):
        own.modal(0.0)
    matrices = sym.Matrices(mass, None, stiffness, at={"middle": 10000, "tip": 19998})
    lost = "^the stiffness, right to rounding, does not tell 1 of the modes with the places held to 1%; take"
    with pytest.raises(ValueError, match=lost):
        sym.craig_bampton(matrices, ["middle"], 4)
    assert sym.craig_bampton(matrices, ["middle", "tip"], 2).matrices.size == 4


@pytest.mark.parametrize(("error", "said"), [(0.0123, "by 1.2 %, where 1 % is taken"), (2.0, "by 2e.02 %")])
def test_modes_that_miss_the_flexibility_are_refused(
    error: float, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert the sentence where a model is compiled."""
    monkeypatch.setattr(ModalForm, "error", lambda self, freedoms: error)
    structure = sym.Structure(sym.beam(**BEAM), at={"x": "tip"})
    with pytest.raises(ValueError, match=f"^the modes of structure 'structure' miss its static .* {said}"):
        sym.compile(structure + sym.HarmonicForce(structure["x"], 1.0))


def test_uncertainty_by_rounding() -> None:
    """Assert eps (sum (phi_i K_ij phi_j)^2)^(1/2) of two masses, by hand, dense and sparse."""
    stiffness, shape = np.array([[3.0, -2.0], [-2.0, 2.0]]), np.array([[0.5], [2.0]])
    by_hand = np.finfo(float).eps * np.sqrt((3 * 0.25) ** 2 + 2 * 2.0**2 + 8.0**2)
    for each in (stiffness, scipy.sparse.csr_array(stiffness)):
        assert uncertainty(each, shape) == pytest.approx([by_hand], rel=1e-14)
        below, above = (hidden(each, np.array([by_hand * 100 * f]), shape) for f in (0.99, 1.01))
        assert below.tolist() == [True] and above.tolist() == [False]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"M": np.ones((2, 3))}, r"^M has shape \(2, 3\); it must be square$"),
        ({"C": np.eye(3)}, "^C is 3 x 3; it must be 2 x 2, as the mass matrix is$"),
        (
            {"K": np.diag([1, np.nan])},
            "^K has entries that are not finite; all of them must be finite numbers$",
        ),
        ({"K": np.eye(2) * 1j}, "^K is complex; it must be real$"),
        ({"K": "stiff"}, "^K is 'stiff'; it must be a square matrix of numbers$"),
        ({"M": np.array([[1.0, 0.2], [0.0, 1.0]])}, "^M is not symmetric; a mass matrix must be"),
        (
            {"M": np.diag([1.0, 0.0])},
            "^M has 0 on its diagonal at degree of freedom 1; a mass matrix must be",
        ),
        ({"M": np.array([[1.0, 2.0], [2.0, 1.0]])}, "^M is singular or indefinite; a mass matrix must be"),
        ({"M": scipy.sparse.csr_array([[1.0, 1.0], [1.0, 1.0]])}, "^M is singular or indefinite"),
        ({"at": {"tip": 2}}, "^the index of place 'tip' is 2; it must be a whole number from 0 to 1$"),
        ({"at": {"tip": 1.0}}, "^the index of place 'tip' is 1.0; it must be a whole number from 0 to 1$"),
        ({"at": {"tip": "a"}}, "^the index of place 'tip' is 'a'; it must be a whole number from 0 to 1$"),
        ({"at": {"tip": -1}}, "^the index of place 'tip' is -1; it must be a whole number from 0 to 1$"),
        ({"at": {"tip": True}}, "^the index of place 'tip' is True; it must be a whole number from 0 to 1$"),
        ({"at": 3}, "^at is 3; it must be a mapping"),
    ],
)
def test_what_is_no_structure_is_refused(given: dict[str, Any], said: str) -> None:
    """Assert one sentence for each."""
    with pytest.raises(ValueError, match=said):
        sym.Matrices(**({"M": np.eye(2), "C": None, "K": np.eye(2)} | given))


def test_large_mass_that_is_indefinite_is_refused() -> None:
    """Assert that the sparse factorisation sees one negative direction among thousands."""
    n = 2000
    mass = scipy.sparse.eye_array(n).tolil()
    mass[700, 701] = mass[701, 700] = 1.5
    with pytest.raises(ValueError, match="^M is singular or indefinite"):
        sym.Matrices(mass.tocsr(), None, scipy.sparse.eye_array(n))


def test_places_are_known_by_name() -> None:
    """Assert the index of a place, and what an unknown one is told."""
    beam = sym.beam(**BEAM, elements=2)
    assert beam["tip"] == beam["w2"] == 2
    with pytest.raises(ValueError, match="^place is 'top'; it must be one of w1, slope1, w2, slope2, tip$"):
        beam["top"]
    assert repr(beam).startswith("<Matrices: 4 degrees of freedom, first natural frequency 0.108")


@pytest.fixture(scope="module")
def known() -> sym.Matrices:
    """A beam with damping."""
    beam = sym.beam(**BEAM, elements=3)
    return sym.Matrices(beam.M, 0.01 * beam.K, beam.K)


def same(found: sym.Matrices, known: sym.Matrices, names: str = "MCK") -> None:
    """Assert the same matrices to 15 digits."""
    for name in names:
        a, b = (getattr(m, name) for m in (found, known))
        np.testing.assert_allclose(a.toarray() if scipy.sparse.issparse(a) else a, b, rtol=1e-15)


def test_one_file_of_several_matrices(known: sym.Matrices, tmp_path: Path) -> None:
    """Assert .npz, .mat and .op4, under their own names and under others."""
    np.savez(tmp_path / "a.npz", M=known.M, C=known.C, K=known.K)
    scipy.io.savemat(
        tmp_path / "a.mat", {"MAA": known.M, "CAA": known.C, "KAA": scipy.sparse.csc_array(known.K)}
    )
    others = {"M": "MAA", "C": "CAA", "K": "KAA"}
    same(sym.read_matrices(tmp_path / "a.npz"), known)
    same(sym.read_matrices(tmp_path / "a.mat", names=others), known)


def test_nastran(known: sym.Matrices, tmp_path: Path) -> None:
    """Assert OUTPUT4 as pyyeti writes it, binary and text."""
    from pyyeti.nastran import op4

    others = {"M": "MAA", "C": "BAA", "K": "KAA"}
    for binary in (True, False):
        op4.write(str(tmp_path / "a.op4"), {"maa": known.M, "baa": known.C, "kaa": known.K}, binary=binary)
        same(sym.read_matrices(tmp_path / "a.op4", names=others), known)


def test_one_file_for_each_matrix(known: sym.Matrices, tmp_path: Path) -> None:
    """Assert Matrix Market, sparse .npz and Abaqus' COORDINATE and MATRIX INPUT (lower triangle)."""
    scipy.io.mmwrite(tmp_path / "m.mtx", scipy.sparse.coo_array(known.M), precision=17)
    scipy.sparse.save_npz(tmp_path / "c.npz", scipy.sparse.csr_array(known.C))
    entries = [(i, j, known.K[i, j]) for i in range(known.size) for j in range(known.size) if known.K[i, j]]
    (tmp_path / "k.mtx").write_text("".join(f"{i + 1} {j + 1} {v!r}\n" for i, j, v in map(plain, entries)))
    files: dict[str, Any] = {"M": tmp_path / "m.mtx", "C": tmp_path / "c.npz"}
    same(sym.read_matrices(**files, K=tmp_path / "k.mtx"), known)
    # Two freedoms (2 and 6) at each of the nodes 11, 12, 13.
    lower = [(11 + i // 2, 2 + 4 * (i % 2), 11 + j // 2, 2 + 4 * (j % 2), v) for i, j, v in entries if i >= j]
    text = "".join(f"{a},{b}, {c},{d}, {v:.17e}\n" for a, b, c, d, v in lower)
    (tmp_path / "input.mtx").write_text(text)
    same(sym.read_matrices(**files, K=tmp_path / "input.mtx"), known)


def plain(entry: tuple[int, int, float]) -> tuple[int, int, float]:
    """The entry as Python's numbers."""
    return entry[0], entry[1], float(entry[2])


SUBSTRUCTURE = """** ABAQUS/STANDARD SUBSTRUCTURE MATRIX OUTPUT
*USER ELEMENT,NODES={nodes},LINEAR
** ELEMENT NODES
**   1,   2
2
*MATRIX,TYPE=STIFFNESS
{stiffness}
*MATRIX,TYPE=MASS
{mass}
"""


def test_abaqus_substructure(tmp_path: Path) -> None:
    """Assert stiffness and mass of `*SUBSTRUCTURE MATRIX OUTPUT` (lower triangle by rows)."""
    path = tmp_path / "sub.mtx"
    path.write_text(SUBSTRUCTURE.format(nodes=2, stiffness="4.0, -1.0, 3.0,", mass="2.0, 0.5, 1.0,"))
    found = sym.read_matrices(path)
    np.testing.assert_array_equal(found.K, [[4, -1], [-1, 3]])
    np.testing.assert_array_equal(found.M, [[2, 0.5], [0.5, 1]])


def test_files_that_do_not_fit_are_refused(known: sym.Matrices, tmp_path: Path) -> None:
    """Assert one sentence for each."""
    np.savez(tmp_path / "a.npz", M=known.M, stiffness=known.K)
    (tmp_path / "b.npz").write_text("no archive")
    (tmp_path / "empty.npz").write_bytes(b"")
    (tmp_path / "c.mtx").write_text("1 2\n3 4\n")
    (tmp_path / "d.mtx").write_text("0 1 2.0\n1 1 3.0\n")
    for given, said in [
        (
            {"file": tmp_path / "a.npz"},
            "a.npz' has no matrix 'K'; mass M and stiffness K are needed, see names=",
        ),
        (
            {"file": tmp_path / "a.txt"},
            "a.txt' is no file of matrices; its name must end in .npz, .mat, .mtx, .op4$",
        ),
        ({"file": tmp_path / "empty.npz"}, "empty.npz' cannot be read as a .npz file: "),
        ({"file": tmp_path / "none.npz"}, "none.npz' does not exist$"),
        ({"file": tmp_path / "b.npz"}, "b.npz' cannot be read as a .npz file: "),
        ({"K": tmp_path / "c.mtx"}, "its lines have 2 numbers; 3 or 5 are known$"),
        ({"K": tmp_path / "d.mtx"}, "its indices begin below 1$"),
        ({"K": tmp_path / "a.npz"}, "a.npz' holds M, stiffness; say which is meant by names=$"),
        ({}, "^M is missing; mass M and stiffness K are needed"),
        ({"names": {"X": "M"}}, "^a key of names is 'X'; it must be one of M, C, K, G$"),
    ]:
        arguments: Any = given
        with pytest.raises(ValueError, match=said):
            sym.read_matrices(**arguments)


@pytest.mark.parametrize("count", [0, 4])
def test_numbers_of_modes_that_there_are_not(count: int) -> None:
    """Assert that no modes, and more than degrees of freedom, are refused."""
    with pytest.raises(ValueError, match=f"^modes is {count}; it must be a whole number"):
        modes(scipy.sparse.eye_array(3).tocsr(), scipy.sparse.eye_array(3).tocsr(), count)
