"""A structure as a part: the same equations as masses and springs; what is given, refused in one sentence."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
import scipy

import symbolic as sym
from symbolic.parts.structure import _steepness
from symbolic.structures.damping import ModalDamping

M2, K2 = np.diag([2.0, 1.0]), np.array([[3.0, -1.0], [-1.0, 1.5]])
C2 = 0.05 * K2


def chain() -> sym.CompiledSystem:
    """Two masses by parts: M2, C2, K2 and a cubic spring."""
    q, r = sym.coordinate("q"), sym.coordinate("r")
    parts: list[sym.Part] = [sym.Mass(q, sym.parameter("m1", 2.0)), sym.Mass(r, sym.parameter("m2", 1.0))]
    parts += [sym.Spring(q, sym.parameter("k1", 2.0)), sym.Damper(q, sym.parameter("c1", 0.1))]
    parts += [sym.Spring(r, sym.parameter("k2", 0.5)), sym.Damper(r, sym.parameter("c2", 0.025))]
    parts += [sym.Coupling(q, r, 1.0, 0.05), sym.CubicSpring(r, 0.3), sym.HarmonicForce(q, 0.4, 1.2)]
    return sym.compile(sym.combine(parts))


def structure(**given: Any) -> sym.Structure:
    """The same masses as a structure."""
    return sym.Structure(M2, C2, K2, at={"q": 0, "r": 1}, **given)


def loaded(given: sym.Structure) -> sym.Model:
    """The structure with the cubic spring and the force."""
    return given + sym.CubicSpring(given["r"], 0.3) + sym.HarmonicForce(given["q"], 0.4, 1.2)


def eigenvalues(system: sym.CompiledSystem) -> Any:
    """Eigenvalues about rest, in order."""
    return np.sort_complex(sym.modes(system).eigenvalues)


def test_expanded_structure_has_the_equations_of_its_parts() -> None:
    """Assert that the residual is that of masses, springs and dampers to 14 digits, rows in another order."""
    ours, parts = sym.compile(loaded(structure()), condense=False), chain()
    assert [s.name for s in ours.states] == ["r", "r'", "q", "q'"]
    draw = np.random.default_rng(1)
    rate, state = draw.standard_normal((2, 5, 4))
    phase, none = draw.uniform(0, 6, 5), np.zeros((5, 0))
    order = [2, 3, 0, 1]
    found = ours.residual(rate, state, none, phase, ours.nominal)[:, order]
    given = parts.residual(rate[:, order], state[:, order], none, phase, parts.nominal)
    assert np.allclose(found, given, rtol=1e-14, atol=1e-14)


def test_dampings_of_modes_are_those_given() -> None:
    """Assert damping ratios of .02 and .05, and Rayleigh's C = a M + b K, in the eigenvalues to 10 digits."""
    modal = sym.Structure(M2, None, K2, at={"q": 0, "r": 1}, damping=[0.02, 0.05])
    lowest, highest = eigenvalues(sym.compile(loaded(modal), condense=False))[[2, 0]]
    assert -lowest.real / abs(lowest) == pytest.approx(0.02, rel=1e-12)
    assert -highest.real / abs(highest) == pytest.approx(0.05, rel=1e-12)
    rayleigh = sym.Structure(M2, None, K2, at={"q": 0, "r": 1}, rayleigh=(0.01, 0.03))
    given = sym.Structure(M2, 0.01 * M2 + 0.03 * K2, K2, at={"q": 0, "r": 1})
    both = [eigenvalues(sym.compile(loaded(s), condense=False)) for s in (rayleigh, given)]
    assert np.allclose(*both, rtol=1e-10)


def test_condensed_structure_keeps_its_places() -> None:
    """Assert two states for each place in use, forces there, and the modes of the whole structure."""
    given = sym.Structure(M2, C2, K2, at={"q": 0, "r": 1, "both": [0, 1]})
    model = given + sym.CubicSpring(given["r"], 0.3) + sym.HarmonicForce(given["r"], 0.4, 1.2)
    system = sym.compile(model)
    assert [s.name for s in system.states] == ["r", "r'"]
    assert [s.name for s in system.algebraics] == ["force on r"]
    assert system.linear is not None and system.linear.size == 4
    found = 1.2 * system.linear.modes(system.nominal).exponents
    whole = eigenvalues(sym.compile(loaded(structure()), condense=False))
    assert np.allclose(np.sort_complex(np.concatenate([found, found.conj()])), whole, rtol=1e-12)
    assert given["both"] == (given["q"], given["r"])


def test_gyroscopic_terms_grow_with_the_speed() -> None:
    """Assert that C + Omega G and functions of the speed give the same modes, full or condensed."""
    gyroscopic = np.array([[0.0, 0.3], [-0.3, 0.0]])
    one = sym.Structure(M2, C2, K2, gyroscopic, at={"q": 0, "r": 1})
    other = sym.Structure(M2, lambda speed: C2 + speed * gyroscopic, K2, at={"q": 0, "r": 1})
    systems = [sym.compile(loaded(s)) for s in (one, other)]
    found = [1.2 * s.linear.modes(s.nominal).exponents for s in systems if s.linear is not None]
    assert np.allclose(*found, rtol=1e-13)
    whole = eigenvalues(sym.compile(loaded(one), condense=False))
    assert np.allclose(np.sort_complex(np.concatenate([found[0], found[0].conj()])), whole, rtol=1e-10)


def test_sparse_matrices_are_as_good_as_dense_ones() -> None:
    """Assert the same modes from scipy.sparse."""
    thin = sym.Structure(*map(scipy.sparse.csr_array, (M2, C2, K2)), at={"q": 0, "r": 1})
    both = [sym.compile(loaded(s)) for s in (thin, structure())]
    found = [s.linear.modes(s.nominal).exponents for s in both if s.linear is not None]
    assert np.allclose(*found, rtol=1e-14)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"K": np.ones((2, 3))}, "K has shape (2, 3); it must be square"),
        ({"K": np.eye(3)}, "K is 3 x 3; it must be 2 x 2, as the mass matrix is"),
        ({"K": [[1.0, np.nan], [0.0, 1.0]]}, "K has entries that are not finite"),
        ({"K": None}, "K is None; it must be a square matrix of numbers, or a function of the speed"),
        ({"M": np.diag([1.0, 0.0])}, "M has 0 on its diagonal at degree of freedom 1"),
        ({"at": {"tip": 2}}, "the index of place 'tip' is 2; it must be a whole number from 0 to 1"),
        ({"at": {"tip": "end"}}, "the index of place 'tip' is 'end'; it must be a whole number from 0 to 1"),
        ({"damping": -0.1}, "damping is -0.1; it must be a finite number of at least 0"),
        ({"rayleigh": 0.1}, "rayleigh is 0.1; it must be two numbers (a, b)"),
        (
            {"rayleigh": (1e300, 0.0)},
            "rayleigh is 1e+300; it must be 0, or of a magnitude from 1e-100 to 1e+100",
        ),
        (
            {"damping": [0.1, 1e-200]},
            "damping is 1e-200; it must be 0, or of a magnitude from 1e-100 to 1e+100",
        ),
        ({"modes": 3}, "modes is 3; it must be a whole number from 1 to 2"),
        ({"scale": 0.0}, "scale of 'structure' is 0.0; it must be a positive number"),
    ],
)
def test_bad_input_is_refused(given: dict[str, Any], sentence: str) -> None:
    """Assert one sentence that names the field."""
    with pytest.raises(ValueError, match=re.escape(sentence)):
        sym.Structure(**{"M": M2, "C": None, "K": K2, "at": {"tip": 1}, **given})


def test_unknown_place_is_refused() -> None:
    """Assert one sentence that names the places."""
    with pytest.raises(ValueError, match=re.escape("place is 'hub'; it must be one of q, r")):
        structure()["hub"]


def test_modes_that_places_do_not_hold_are_refused() -> None:
    """Assert a clear reason at compilation, for rigid-body modes and for negative stiffness."""
    for loose, sentence in (
        (0.0, "rigid-body modes that forces"),
        (-1.0, "modes of negative stiffness that"),
    ):
        part = sym.Structure(np.eye(3), None, np.diag([2.0, 2.0, loose]), at={"q": 0, "r": 1})
        with pytest.raises(ValueError, match=re.escape(sentence)):
            sym.compile(loaded(part))


def test_matrices_and_modes_are_kept_by_speed() -> None:
    """Assert it of what varies with the speed, one for all speeds of what does not, and no more than nine."""
    still, turning = structure(), structure(G=np.array([[0.0, 0.1], [-0.1, 0.0]]))
    assert not still.varying and turning.varying and still.size == 2
    assert still.modal(1.0) is still.modal(2.0) and still.matrices(1.0) is still.matrices(2.0)
    first = turning.modal(1.0)
    assert turning.modal(1.0) is first and turning.modal(2.0) is not first
    assert turning.modal(1.0) is first
    assert turning.matrices(1.0) is turning.matrices(2.0)
    for k in range(9):
        turning.modal(3.0 + k)
    assert len(turning._forms) <= 9 and turning.modal(1.0) is not first


def test_matrices_that_are_functions_of_the_speed() -> None:
    """Assert their values and slopes, and those of G times the speed."""
    given = sym.Structure(M2, lambda speed: speed * C2, lambda speed: K2 + speed**2 * np.eye(2))
    assert given.varying
    assert np.asarray(given.matrices(3.0).C).tolist() == (3.0 * C2).tolist()
    assert np.asarray(given.matrices(2.0).K).tolist() == (K2 + 4 * np.eye(2)).tolist()
    assert _steepness(given.K, 3.0, 2) == pytest.approx(6 * np.eye(2), rel=1e-6, abs=1e-6)
    assert _steepness(given.C, 0.0, 2) == pytest.approx(C2, rel=1e-6)
    assert _steepness(given.M, 3.0, 2).tolist() == [[0.0, 0.0], [0.0, 0.0]]


def test_coordinates_of_degrees_of_freedom() -> None:
    """Assert those of places by their names, one for several degrees of freedom, and others by number."""
    given = sym.Structure(np.eye(3), None, np.eye(3), at={"a": 1, "both": [0, 2]}, name="s", scale=0.5)
    assert given.freedom(1) is given["a"] and given["a"].name == "a" and given["a"].scale == 0.5
    assert [q.name for q in given["both"]] == ["both 1", "both 2"]
    assert given["both"][1] is given.freedom(2)
    assert sym.Structure(np.eye(3), None, np.eye(3), name="s").freedom(2).name == "s 3"
    for wrong in (3, -1, True, 1.5):
        with pytest.raises(ValueError, match="it must be a whole number from 0 to 2$"):
            given.freedom(wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({}, (0.0, 0.0, 0.0)),
        ({"damping": 0.1}, (0.1, 0.0, 0.0)),
        ({"damping": [0.1, 0.2]}, ((0.1, 0.2), 0.0, 0.0)),
        ({"rayleigh": (0.3, 0.4)}, (0.0, 0.3, 0.4)),
    ],
)
def test_damping_that_is_given(options: dict[str, Any], expected: tuple[Any, ...]) -> None:
    """Assert ratios, and the factors of M and K."""
    assert structure(**options).modal_damping == ModalDamping(*expected)


def test_places_by_the_names_of_matrices() -> None:
    """Assert that a place is named after places that matrices have, one or several, beside indices."""
    matrices = sym.Matrices(np.eye(3), None, np.eye(3), at={"x0": 0, "y0": 2})
    given = sym.Structure(matrices, at={"end": ("x0", "y0"), "alone": "y0", "mixed": ("x0", 1)})
    assert given.at == {"x0": 0, "y0": 2, "end": (0, 2), "alone": 2, "mixed": (0, 1)}
    with pytest.raises(
        ValueError, match="the index of place 'end' is .*z0.*; it must be a whole number from 0 to 2"
    ):
        sym.Structure(matrices, at={"end": ("x0", "z0")})
