"""Rotors of unlike bearings that rub: whatever they touch or leave, they do so on two sides at once."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from support.drawn.machines.drawn import machine

import periodic as per
import symbolic as sym
from periodic.events.rewrites import rewrite
from periodic.events.rewrites.rewrite import Begins
from periodic.events.rewrites.table import GRAZING, IMPACT


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


def test_sites_that_begin_at_once_are_tried_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert the order: those that coincide, the first alone, those that an error parts; none twice."""
    own = SimpleNamespace(row=GRAZING)
    given: Any = SimpleNamespace(site=own)
    for row, coincide, alike, tried in (
        (GRAZING, [1], [1, 2], [[1], [1, 2]]),
        (GRAZING, [1, 2], [1, 2], [[1, 2], [1]]),
        (GRAZING, [1, 2], [1, 2, 3], [[1, 2], [1], [1, 2, 3]]),
        (IMPACT, [1], [1, 2], [[1]]),
        (IMPACT, [1, 2], [1, 2, 3], [[1, 2], [1]]),
    ):
        own.row = row
        monkeypatch.setattr(rewrite, "at_once", lambda *given, found=alike: found)
        assert Begins._choices(given, given, given, coincide) == tried  # type: ignore[arg-type]
