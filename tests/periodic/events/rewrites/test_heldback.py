"""How long a slip that begins before an event goes on after it, against guards integrated by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.events.rewrites.heldback import after
from periodic.events.thresholds import TOGETHER
from periodic.orbit.mesh import EventNode

NODE = 1.0
"""Phase of the event."""


def dense(falls: float, rises: float, jump: float = 0.0, side: int = 1) -> Any:
    """A limit that is reached at rate `falls`, where it jumps back and goes on away at rate `rises`."""
    orbit = along(lambda tau: np.cos(tau)[:, None], [(EventNode(5, 1), NODE)])
    grid, scheme, start = orbit.grid, orbit.mesh.scheme, int(orbit.mesh.starts[0])
    tau = grid.left[:, None] + grid.width[:, None] * scheme.knots
    values = np.full((*tau.shape, 3), np.nan)
    values[:, :, 1] = side * (jump + rises * (tau - NODE))
    values[start - 1, :, 1] = -side * falls * grid.width[start - 1] * (scheme.knots - 1.0)
    return SimpleNamespace(orbit=orbit, knots=values)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("falls", "rises"), [(2.0, 0.5), (0.3, 0.3), (0.1, 40.0)])
def test_force_that_begins_to_fall(falls: float, rises: float, side: int) -> None:
    """Assert that the guard, whose rate grows to the event and falls from there, is 0 there again."""
    part, power = after(dense(falls, rises, side=side), 0, 1, side)
    assert power == 1.0
    for length in (0.01, 0.2):
        later = part * length**power
        guard = falls * length**2 / 2 + falls * length * later - rises * later**2 / 2
        assert guard == pytest.approx(0.0, abs=1e-12) and later > 0


@pytest.mark.parametrize("side", [1, -1])
def test_force_that_falls_at_once(side: int) -> None:
    """Assert a L^2 / 2J, to the first order: the force that is left changes little in so short a time."""
    part, power = after(dense(2.0, 0.5, 8.0, side), 0, 1, side)
    assert (part, power) == (pytest.approx(0.125, rel=1e-9), 2.0)


@pytest.mark.parametrize(("jump", "power"), [(0.1, 1.0), (10.0, 2.0)])
def test_jumps_that_are_rounding_are_none(jump: float, power: float) -> None:
    """Assert the threshold as a part of the largest value."""
    given = dense(2.0, 0.5)
    most = float(np.abs(given.knots[:, :, 1]).max())
    assert after(dense(2.0, 0.5, jump * TOGETHER * most), 0, 1, 1)[1] == power


@pytest.mark.parametrize(("falls", "rises"), [(-1.0, 0.5), (2.0, -0.5), (0.0, 1.0), (2.0, 0.0)])
def test_forces_that_do_not_fall_back(falls: float, rises: float) -> None:
    """Assert the guess that is left where the limit is not left again, or not reached."""
    assert after(dense(falls, rises), 0, 1, 1) == (1.0, 2.0)
