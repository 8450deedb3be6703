"""Modes of a structure, and what those that are left out leave to its stiffness."""

from __future__ import annotations

import numpy as np
import pytest

import symbolic as sym


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
