"""Surfaces of a system: what happens where one of its switches vanishes, and the modes beside it.

The mode of a surface is a number: PLUS on the side s > 0 of its guard, MINUS on the other, STUCK where the
motion is held to it, HELD where that lasts all along, at a place that the motion does not determine and a
parameter says; 0 leaves it to the state.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

MINUS, PLUS, STUCK, HELD = -1, 1, 2, 3


class Kind(StrEnum):
    """What happens where the guard of a surface vanishes.

    KINK: the equations are bent. JUMP: they jump. SLIDING: they jump, and a motion may slide along it, as dry
    friction sticks. SLIDER: an elastic slider is held or carried. RELAY: a jump with hysteresis. IMPACT: the
    state is mapped. MARKER: nothing, but meshes should know.
    """

    KINK = "kink"
    JUMP = "jump"
    SLIDING = "sliding"
    SLIDER = "slider"
    RELAY = "relay"
    IMPACT = "impact"
    MARKER = "marker"


@dataclass(frozen=True)
class Surface:
    """A surface s(x, tau, p) = 0.

    Parameters
    ----------
    kind : Kind
        What happens there.
    name : str
        Name of its guard.
    switch : int
        Index of the guard s among the switches.
    releases : tuple of int, optional
        Indices of two further switches (up, down): what is STUCK is held where up < 0 < down, goes on as PLUS
        where up rises to 0, as MINUS where down falls to 0.
    column : int, optional
        Its column in the `side` of equations on given sides; None where they take none.
    place : (int, tuple of float), optional
        Of what may be HELD: the index of the parameter that says where, and the weights (n,) of the scaled
        states in how far it is deflected (SI).
    alone : bool
        Whether it may be HELD without a place, as the equations determine the motion then.
    leaves : int, optional
        Of an impact on which the motion may come to rest: the index of the switch that is negative as long as
        it is pressed to it, and at whose rise to 0 it leaves.
    """

    kind: Kind
    name: str
    switch: int
    releases: tuple[int, int] | None = None
    column: int | None = None
    place: tuple[int, tuple[float, ...]] | None = None
    alone: bool = False
    leaves: int | None = None
