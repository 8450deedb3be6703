"""Rotors of unlike bearings that rub: whatever they touch or leave, they do so on two sides at once."""

from __future__ import annotations

import pytest
from support.drawn.machines.drawn import machine

import periodic as per
import symbolic as sym


@pytest.mark.parametrize("down", [False, True])
def test_contact_all_round_is_lost_on_two_sides_at_once(down: bool) -> None:
    """Assert that a rotor, 13 % stiffer along y and without weight, is traced through, and where it lets go.

    The orbit's own error parts the two places by more than events that coincide are parted by rounding.
    """
    drawn = machine("rubs", 1)
    system = sym.compile(drawn.model)
    branch = per.trace(system, drawn.parameter, drawn.bounds, start=drawn.bounds[int(down)], tol=1e-6)
    assert str(branch.stop) == f"bound reached: {'lower' if down else 'upper'} end of the range"
    places = [point.parameter for point in branch.labelled("GR")]
    assert min(abs(place - 127.943915) for place in places) < 2e-5
