"""Hill's method and the number of harmonics: fundamental matrices known otherwise, how many are kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from support.numpy_systems import Array, LinearOscillator, MeissnerOscillator, Quantity

import periodic as per
from periodic.correction.error import ErrorEstimate
from periodic.harmonic import hill
from periodic.harmonic.series import FourierOrbit, mesh_for, series
from periodic.system import System

HB = per.HarmonicBalance


def distance(a: Array, b: Array) -> float:
    """Largest distance of two sets of multipliers in order of size and argument."""
    return float(np.abs(np.sort_complex(a) - np.sort_complex(b)).max())


def constant(matrix: Array) -> System:
    """A system x' = matrix x + cos tau."""
    count = len(matrix)

    class Flow(LinearOscillator):
        states = tuple(Quantity(f"x{k}") for k in range(count))
        outputs = states

        def linearise(self, rate, state, algebraic, phase, parameter, free=()):  # type: ignore[no-untyped-def]
            lines = LinearOscillator.linearise(self, rate, state, algebraic, phase, parameter, ())
            points = len(state)
            return type(lines)(
                rate - state @ matrix.T - np.cos(phase)[:, None],
                np.tile(np.eye(count), (points, 1, 1)),
                np.tile(-matrix, (points, 1, 1)),
                np.zeros((points, count, 0)),
                np.sin(phase)[:, None] * np.ones(count),
                np.zeros((points, count, len(free))),
            )

    return Flow()


MATRICES = {
    "defective": np.array([[-0.3, 1.0, 0.0], [0.0, -0.3, 1.0], [0.0, 0.0, -0.3]]),
    "negative": np.array([[-0.1, 0.5, 0.0], [-0.5, -0.1, 0.0], [0.0, 0.0, -0.2]]),
    "two negative pairs": np.kron(np.diag([1.0, 3.0]), [[-0.1, 0.5], [-0.5, -0.1]]),
    "equal": np.kron(np.eye(2), [[-0.1, 0.7], [-0.7, -0.1]]),
    "fast and stiff": np.array([[0.0, 1.0, 0.0], [-90.0, -0.2, 1.0], [0.0, 0.0, -6.0]]),
}


@pytest.mark.parametrize("harmonics", [8, 40])
@pytest.mark.parametrize("name", MATRICES)
def test_fundamental_matrices(name: str, harmonics: int) -> None:
    """Assert Hill's fundamental matrices where they are matrix exponentials, hard to sort or not."""
    matrix = MATRICES[name]
    mesh = mesh_for(harmonics, 2 * np.pi)
    nodes, stages = np.zeros((mesh.ntst + 1, len(matrix))), np.zeros((mesh.ntst, 2, len(matrix)))
    orbit = FourierOrbit(mesh, nodes, stages, np.zeros((mesh.ntst, 2, 0)), np.zeros(0), np.ones(3))
    found = hill.floquet(constant(matrix), orbit)
    exact = expm(matrix * mesh.nodes(np.zeros(0))[:, None, None])
    assert found.resolved
    # A threefold exponent is known to the cube root of rounding, its invariant subspace far better.
    assert np.abs(found.fundamental(orbit) - exact).max() < 1e-9 * np.abs(exact).max()


def test_large_matrices_are_not_taken_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the same from a Krylov space alone, as from all eigenvalues, to 9 digits."""
    matrix, mesh = MATRICES["two negative pairs"], mesh_for(40, 2 * np.pi)
    nodes, stages = np.zeros((mesh.ntst + 1, 4)), np.zeros((mesh.ntst, 2, 4))
    orbit = FourierOrbit(mesh, nodes, stages, np.zeros((mesh.ntst, 2, 0)), np.zeros(0), np.ones(3))
    with monkeypatch.context() as changed:
        changed.delattr(hill, "_dense")
        found = hill.floquet(constant(matrix), orbit).fundamental(orbit)
    monkeypatch.setattr(hill, "DENSE", 10_000)
    whole = hill.floquet(constant(matrix), orbit).fundamental(orbit)
    assert found == pytest.approx(whole, abs=1e-9 * np.abs(whole).max())


def test_spurious_exponents_of_a_kinked_equation() -> None:
    """Assert that n exponents are found where the spectrum falls slowly, and their error is told."""
    system = MeissnerOscillator()
    orbit = series(per.trace(system, "Omega", (0.8, 0.81))[0].orbit, mesh_for(60, 2 * np.pi))
    found = hill.floquet(system, orbit)
    off = distance(np.linalg.eigvals(found.fundamental(orbit)[-1]), system.exact_multipliers())
    finer = series(orbit, mesh_for(90, 2 * np.pi))
    assert found.resolved
    assert off < 2e-5
    assert found.error(system, finer) > off


@pytest.mark.parametrize(("harmonics", "periods", "least"), [(8, 1, 4), (8, 2, 6), (12, 3, 9), (3, 2, 6)])
def test_fewest_harmonics_are_for_each_period(harmonics: int, periods: int, least: int) -> None:
    """Assert how many an orbit without motion keeps: half of its own, or 3 a period."""
    mesh = mesh_for(harmonics, 2 * np.pi * periods)
    nodes, stages = np.zeros((mesh.ntst + 1, 1)), np.zeros((mesh.ntst, 2, 1))
    orbit = FourierOrbit(mesh, nodes, stages, np.zeros((mesh.ntst, 2, 0)), np.zeros(0), np.ones(3))
    method = HB(harmonics=harmonics).at(1e-6)
    refinement = method.refine(LinearOscillator(), orbit, ErrorEstimate(0.0, 0.0, 0.0))
    assert refinement.refined().ntst == mesh_for(least, mesh.period).ntst


@pytest.mark.parametrize(("least", "expected"), [(4, 9), (12, 12)])
def test_guess_has_the_harmonics_that_are_heard(least: int, expected: int) -> None:
    """Assert as many as one ten-thousandth of the motion's span reaches, and no fewer than asked for."""
    mesh = mesh_for(20, 2 * np.pi)
    tau = np.linspace(0, 2 * np.pi, 4001)
    wave = 100 * np.cos(tau) + np.cos(9 * tau) + 1e-3 * np.cos(15 * tau)
    states = np.column_stack([wave, np.gradient(wave, tau)])
    system = LinearOscillator()
    near = series(per.sampled(tau, states, np.zeros((4001, 0)), system.nominal, system=system), mesh)
    near = replace(near, nodes=near.nodes * [1, 1e-3], stages=near.stages * [1, 1e-3])
    found = HB(harmonics=least).guess(system, system.nominal, near)
    assert isinstance(found, FourierOrbit) and found.harmonics == expected


@pytest.mark.parametrize("resolved", [True, False])
def test_subspace_of_what_has_one_eigenvector(resolved: bool) -> None:
    """Assert that a threefold exponent's subspace is found, and that it is resolved only if all of it was."""
    matrix = np.zeros((4, 4))
    matrix[:3, :3], matrix[3, 3] = MATRICES["defective"], 5.0
    values, vectors = np.linalg.eig(matrix)
    found = hill._spanned(matrix, values, vectors, np.abs(values + 0.3) < 0.1, resolved)
    assert found.resolved is resolved
    assert found.vectors.shape == (4, 3) and found.rate.shape == (3, 3)
    assert np.abs(matrix @ found.vectors - found.vectors @ found.rate).max() < 1e-12
    assert np.abs(found.vectors[3]).max() < 1e-12
    assert np.abs(found.vectors.conj().T @ found.vectors - np.eye(3)).max() < 1e-12


def test_subspace_of_which_more_is_chosen_than_it_has() -> None:
    """Assert that it is not resolved where sorting moves another number of exponents than were chosen."""
    matrix = np.array([[1.0, 1.0], [0.0, 1.0]])
    values, vectors = np.array([1.0, 1.0 + 1e-3]), np.array([[1.0, 1.0], [0.0, 0.0]])
    found = hill._spanned(
        matrix, values.astype(complex), vectors.astype(complex), np.array([True, True]), True
    )
    assert found.resolved
    none = np.array([1.0, 9.0]).astype(complex)
    found = hill._spanned(matrix, none, np.zeros((2, 2), complex), np.array([False, True]), True)
    assert not found.resolved
