"""Surfaces of a system: what happens where one of its switches vanishes, and the modes beside it.

The mode of a surface is a number: PLUS on the side s > 0 of its guard, MINUS on the other, STUCK where the
motion is held to it, HELD where that lasts all along, at a place that the motion does not determine and a
parameter says; 0 leaves it to the state.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

from symbolic.equations.variables import SwitchInfo

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


def surfaces(
    switches: Sequence[SwitchInfo],
    resets: Container[int],
    jumps: Sequence[int],
    slides: Mapping[int, tuple[int, int]],
    sliders: Container[int] = (),
    places: Mapping[int, tuple[int, tuple[float, ...]]] | None = None,
    relays: Container[int] = (),
    alone: Container[int] = (),
    leaves: Mapping[int, int] | None = None,
) -> tuple[Surface, ...]:
    """Return the surfaces of a system in the order of their guards: every switch belongs to one of them.

    Parameters
    ----------
    switches : sequence of SwitchInfo
        All switches.
    resets : container of int
        Those at which the state is mapped.
    jumps : sequence of int
        Those at which the equations jump, in the order of the columns of `side`.
    slides : mapping of int to tuple of int
        Of those along which motions slide, and of sliders, the two releases.
    sliders : container of int
        Those of elastic sliders.
    places : mapping of int to (int, tuple of float), optional
        Where they may be held: see `Surface`.
    relays : container of int
        Those of relays.
    alone : container of int
        Those of sliding that may be HELD without a place.
    leaves : mapping of int to int, optional
        Of walls, the switches at which what rests on them leaves.
    """
    released = {k for pair in slides.values() for k in pair} | set((leaves or {}).values())

    def kind(k: int) -> Kind:
        if k in resets:
            return Kind.IMPACT
        if k in sliders:
            return Kind.SLIDER
        if k in relays:
            return Kind.RELAY
        if k in jumps:
            return Kind.SLIDING if k in slides else Kind.JUMP
        plain = switches[k].levels == (0.0,) and switches[k].direction == 0
        return Kind.KINK if plain else Kind.MARKER

    return tuple(
        Surface(
            kind(k),
            info.name,
            k,
            slides.get(k),
            jumps.index(k) if k in jumps else None,
            (places or {}).get(k) if k in slides else None,
            k in alone,
            (leaves or {}).get(k),
        )
        for k, info in enumerate(switches)
        if k not in released
    )
