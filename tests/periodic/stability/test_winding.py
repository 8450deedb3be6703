"""Meetings of pairs of multipliers between orbits of which a few of many multipliers are kept."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from periodic.condensed.floquet import LeadingSpectrum
from periodic.stability.multipliers import Spectrum
from periodic.stability.winding import collisions

TURN = 2 * np.pi


def turning(*pairs: tuple[float, float], mixed: float) -> Any:
    """Matrices over a period of pairs that end with some moduli and arguments, mixed by a fixed turn."""
    size, found = 2 * len(pairs), []
    turn = np.eye(size) + mixed * np.random.default_rng(5).standard_normal((size, size))
    for part in np.linspace(0.0, 1.0, 41):
        whole = np.zeros((size, size))
        for k, (modulus, argument) in enumerate(pairs):
            own = slice(2 * k, 2 * k + 2)
            c, s = modulus**part * np.cos(part * argument), modulus**part * np.sin(part * argument)
            whole[own, own] = [[c, -s], [s, c]]
        found.append(np.linalg.solve(turn, whole @ turn))
    return np.array(found)


def test_meetings_do_not_depend_on_the_basis() -> None:
    """Assert those of two spectra to 10 digits where each is written in a basis of its own."""
    first = turning((0.99, 1.0 + TURN), (0.85, 1.05), mixed=0.1)
    last = turning((0.99, 1.1 + TURN), (0.85, 1.06), mixed=0.15)
    plain = collisions(Spectrum(first), Spectrum(last))
    bases = [np.linalg.qr(np.random.default_rng(k).standard_normal((4, 4)))[0] for k in (1, 2)]
    kept = [
        LeadingSpectrum(b.T @ m @ b, 0, cast(Any, SimpleNamespace(basis=b, states=b[None])))
        for b, m in zip(bases, (first, last), strict=True)
    ]
    found = [(one.place, one.growth) for one in collisions(*kept)]
    assert len(plain) > 0
    assert found == [pytest.approx((one.place, one.growth), rel=1e-10) for one in plain]


def test_subspaces_of_other_sizes_are_compared() -> None:
    """Assert that pairs may meet between orbits with other coordinates and other numbers of multipliers."""
    first = turning((0.99, 1.0 + TURN), (0.85, 1.05), mixed=0.1)
    last = turning((0.99, 1.1 + TURN), (0.85, 1.06), (0.1, 2.0), mixed=0.0)
    ends = []
    for matrix, size in ((first, 7), (last, 9)):
        basis = np.eye(size)[:, : matrix.shape[1]]
        leading = cast(Any, SimpleNamespace(basis=basis, states=basis[None]))
        ends.append(LeadingSpectrum(matrix, 0, leading))
    assert len(collisions(*ends)) > 0
