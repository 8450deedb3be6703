"""What forces do to the places, in parts: against the whole matrix."""

from __future__ import annotations

import numpy as np
import pytest

from periodic.condensed.modal.flexibility import Flexibility
from periodic.condensed.modal.quasistatic import Modes
from periodic.condensed.modal.response import Response
from periodic.orbit.mesh import Mesh
from periodic.orbit.scheme import Family, Scheme


def response(breaks: list[float]) -> Response:
    """Five modes, slow and fast, of four states and three forces, on a mesh."""
    random = np.random.default_rng(1)
    exponents = np.array([-0.01 + 1j, -0.1 + 3j, -0.5, -2 + 40j, -90.0])
    inputs, outputs = (random.standard_normal((5, size)) * (1 + 0.3j) for size in (3, 4))
    direct = random.standard_normal((2, 4, 3))
    modes = Modes(exponents, inputs, outputs.T, *direct)
    mesh = Mesh(Scheme(Family.RADAU, 3), (np.array(breaks),))
    return Response(modes, mesh.scheme, mesh.grid(np.zeros(0)), mesh.period)


@pytest.mark.parametrize("breaks", [[0, 0.25, 0.5, 0.75, 1], [0, 0.1, 0.15, 0.4, 0.9, 1]])
@pytest.mark.parametrize("closed", [True, False])
def test_parts_are_those_of_the_whole(breaks: list[float], closed: bool) -> None:
    """Assert products, adjoint products and blocks to 12 digits, in periodic motion and from rest."""
    given = response(breaks)
    flexibility = Flexibility.repeating(given) if closed else Flexibility(given)
    whole, random = flexibility.whole, np.random.default_rng(2)
    count = whole.shape[0]
    forces, weights = random.standard_normal((count, 3, 3, 2)), random.standard_normal((count, 3, 4, 2))
    made = np.einsum("nasmbk,mbkr->nasr", whole, forces)
    assert np.abs(flexibility.applied(forces) - made).max() < 1e-12 * np.abs(made).max()
    pulled = np.einsum("nasmbk,nasr->mbkr", whole, weights)
    assert np.abs(flexibility.pulled(weights) - pulled).max() < 1e-12 * np.abs(pulled).max()
    states, actors, held = np.array([1, 3]), np.array([0, 2]), np.array([0, 2, 3])
    part = flexibility.between(states, actors)
    expected = whole[:, :, states][:, :, :, held][..., actors]
    scale = np.abs(whole).max()
    assert np.abs(part.block(held, everywhere=True) - expected).max() < 1e-12 * scale
    assert np.abs(part.block(held, everywhere=False) - expected[held]).max() < 1e-12 * scale
