"""Elastic sliders that are held or carried: their rows and guards in every mode."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import casadi as ca

from symbolic.equations.jumps.sides import Sided
from symbolic.equations.jumps.sliding import RETURN
from symbolic.equations.packed import Packed
from symbolic.equations.surfaces import HELD, MINUS, PLUS, STUCK
from symbolic.equations.terms import Slider


@dataclass(frozen=True)
class Held:
    """Of a slider the switches (up, down) between which it is held, and the index of its state."""

    releases: tuple[int, int]
    place: int


def with_sliders(
    packed: Packed, sliders: Mapping[int, Slider], beside: Sided, guards: ca.SX, first: int
) -> tuple[Sided, ca.SX]:
    """Return the sided residual and the guards with the modes of sliders.

    Parameters
    ----------
    packed : Packed
        The variables.
    sliders : mapping of int to Slider
        By the index of their guard.
    beside : Sided
        The residual with a side for each of them.
    guards : casadi.SX
        All switches.
    first : int
        Index of the first row of the residual that is one of `differential_rows`.
    """
    rows, guards = ca.SX(beside.residual), ca.SX(guards)
    for k, slider in sliders.items():
        side, row = beside.side[beside.jumps.index(k)], first + slider.row
        held, place, plus, minus, *speeds = ca.vertsplit(
            packed.scaled([slider.held, slider.place, *slider.slipping, *slider.speeds])
        )
        modes = {STUCK: held, HELD: held + RETURN * place, PLUS: plus, MINUS: minus}
        for mode, own in modes.items():
            rows[row] = ca.if_else(side == mode, own, rows[row])
        if not ca.is_equal(speeds[0], speeds[1], 10):
            for mode, own in zip((PLUS, MINUS), speeds, strict=True):
                guards[k] = ca.if_else(side == mode, own, guards[k])
    return replace(beside, residual=rows), guards
