"""The linear part from a model's own rows: where Omega only scales the time, its modes are found once."""

from __future__ import annotations

import numpy as np
import pytest

from symbolic.arrays import Array, Complex
from symbolic.structures import rowspart
from symbolic.structures.linearpart import Modes
from symbolic.structures.rowspart import RowsPart

SIZE = 4
"""Degrees of freedom; states are these, then their rates by the phase."""


def part(turning: float = 0.0) -> RowsPart:
    """M q'' + (C + Omega G) q' + K q = f at the first, G skew and as large as is said."""
    random = np.random.default_rng(0)
    mass, stiffness, skew = random.standard_normal((3, SIZE, SIZE))
    mass, stiffness = (a @ a.T + np.eye(SIZE) for a in (mass, stiffness))
    damping, skew = 0.02 * stiffness + 0.01 * mass, turning * (skew - skew.T)
    eye, none = np.eye(SIZE), np.zeros((SIZE, SIZE))

    def matrices(parameter: Array) -> tuple[Array, Array]:
        omega, more = parameter
        rates = omega * (damping + omega * skew)
        inertia = np.block([[eye, none], [none, omega**2 * mass]])
        return inertia, np.block([[none, -eye], [stiffness + more * eye, rates]])

    return RowsPart(
        matrices=matrices,
        loads=-np.eye(2 * SIZE)[:, [SIZE]],
        places=(0, SIZE),
        forces=(0,),
        varying=(0, 1),
        scales=np.ones(2 * SIZE),
        rates=(1,),
        moving=tuple(range(SIZE, 2 * SIZE)),
        omega=lambda parameter: float(parameter[0]),
    )


def flexibility(modes: Modes, frequency: float) -> Complex:
    """States by forces that are harmonic: by the modes and their conjugates."""
    found = (modes.outputs / (1j * frequency - modes.exponents)) @ modes.inputs
    other = (modes.outputs.conj() / (1j * frequency - modes.exponents.conj())) @ modes.inputs.conj()
    return np.asarray(found + other) / 2


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[Array]:
    """The matrices whose eigenproblem was solved."""
    found: list[Array] = []

    def counted(state: Array, rates: Array, solve=rowspart._modes) -> rowspart.Eigen:  # noqa: ANN001
        found.append(state)
        return solve(state, rates)

    monkeypatch.setattr(rowspart, "_modes", counted)
    return found


@pytest.mark.parametrize("omega", [0.3, 1.7, 12.0])
def test_time_is_scaled(omega: float, solved: list[Array]) -> None:
    """Assert modes that follow from another Omega against an eigenproblem of their own, to 1e-12."""
    given = part()
    given.modes(np.array([1.0, 0.0]))
    found = given.modes(np.array([omega, 0.0]))
    assert len(solved) == 1
    alone = part().modes(np.array([omega, 0.0]))
    for frequency in (0.2, 1.0, 5.0):
        expected = flexibility(alone, frequency)
        assert np.abs(flexibility(found, frequency) - expected).max() < 1e-12 * np.abs(expected).max()
    order, other = (np.argsort(modes.exponents.imag) for modes in (found, alone))
    np.testing.assert_allclose(found.exponents[order], alone.exponents[other], rtol=1e-12)
    lengths = [np.abs(modes.outputs[:, at]) for modes, at in ((found, order), (alone, other))]
    np.testing.assert_allclose(*lengths, rtol=1e-10)


@pytest.mark.parametrize(("turning", "more"), [(1e-9, 0.0), (0.0, 1e-9)])
def test_what_is_more_than_time_is_solved_anew(turning: float, more: float, solved: list[Array]) -> None:
    """Assert that a gyroscopic matrix or another parameter is not taken for the rate of time."""
    given = part(turning)
    given.modes(np.array([1.0, 0.0]))
    given.modes(np.array([1.5, more]))
    assert len(solved) == 2
