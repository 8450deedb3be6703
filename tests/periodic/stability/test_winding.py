"""Meetings of pairs of multipliers between orbits of which a few of many multipliers are kept."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from periodic.condensed.floquet import LeadingSpectrum
from periodic.stability.multipliers import Spectrum
from periodic.stability.winding import FADED, collisions, confined, pair_crossings

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


def coupled(radius: float, argument: float, coupling: float) -> Spectrum:
    """A pair of modulus `radius` at an argument, coupled to its conjugate.

    Its multipliers are r (cos a +- (c^2 - sin^2 a)^(1/2)): a complex pair but where sin a is less than the
    coupling c, where they part and one reaches r (1 + c) at the most.
    """
    cos, sin = np.cos(argument), np.sin(argument)
    return Spectrum(np.array([[[cos + coupling, -sin], [sin, cos - coupling]]]) * radius)


@pytest.mark.parametrize("radius", [1e-2, 0.3, 0.8, 0.97])
@pytest.mark.parametrize(("begin", "end"), [(-0.6, 0.5), (-0.3, 0.6), (-0.5, 0.02)])
def test_pairs_that_may_leave_the_circle_are_told(radius: float, begin: float, end: float) -> None:
    """Assert it of a pair whose greater multiplier, r (1 + c), would reach 1, if it is complex at both ends.

    None that is not coupled may, nor one coupled a hundred times too little.
    """
    needed = 1 / radius - 1
    if needed < np.sin(0.3):
        assert not confined(coupled(radius, begin, needed), coupled(radius, -begin, needed))
    for less in (0.0, 0.01 * min(needed, abs(np.sin(end)))):
        assert confined(coupled(radius, begin, less), coupled(radius, end, less))


def test_pairs_in_other_coordinates_may_leave_the_circle() -> None:
    """Assert it where it cannot be known, whatever their coupling."""
    basis = np.eye(3)[:, :2]
    other = LeadingSpectrum(
        turning((0.9, 0.2), mixed=0.0), 0, cast(Any, SimpleNamespace(basis=basis, states=basis[None]))
    )
    wider = np.eye(4)[:, :2]
    again = LeadingSpectrum(
        turning((0.9, 0.1), mixed=0.0), 0, cast(Any, SimpleNamespace(basis=wider, states=wider[None]))
    )
    assert confined(other, other) and not confined(other, again)


def test_pairs_that_have_faded_pass_unseen() -> None:
    """Assert that a pair that turns past 1 counts where one end is nearer the circle than FADED."""
    first, last, near = (
        Spectrum(turning((part * FADED, argument), mixed=0.0))
        for part, argument in ((0.5, TURN - 0.2), (0.9, TURN + 0.3), (1.1, TURN + 0.3))
    )
    assert pair_crossings(first, last, 1) == [] and confined(first, last)
    (found,) = pair_crossings(first, near, 1)
    assert found[0] == pytest.approx(0.4) and pair_crossings(first, near, -1) == []
