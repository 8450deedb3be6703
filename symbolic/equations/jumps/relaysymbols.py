"""Relays with hysteresis: their symbols and guards in both modes.

A relay is a jump whose guard depends on its own mode: off (MINUS) it is u less the upper threshold, negative
until it goes on; on (PLUS) it is u less the lower one, positive until it goes off.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from symbolic.equations.packed import Packed
from symbolic.equations.surfaces import PLUS
from symbolic.equations.terms import Relay

Decided = Mapping[int, tuple[ca.SX, ca.SX]]
"""Of relays, by the index of their guard: the symbol that stands for one in equations, and its side."""


def decided(relays: Mapping[int, Relay]) -> dict[int, tuple[ca.SX, ca.SX]]:
    """Return the symbol of each relay, and a symbol for its side."""
    return {k: (relay.symbol, ca.SX.sym(f"side_{k}")) for k, relay in relays.items()}


def in_modes(rows: ca.SX, switches: ca.SX, relays: Decided) -> ca.SX:
    """Return rows with the sides of relays in place of their symbols.

    Parameters
    ----------
    rows : casadi.SX
        A column with the symbols of relays.
    switches : casadi.SX
        All switches, with these symbols too; of relays u less the upper threshold.
    relays : mapping of int to (casadi.SX, casadi.SX)
        Symbol and side by the index of the guard, those that others depend on first.

    Returns
    -------
    casadi.SX
        The rows, 1 or -1 for each relay; where its side is 0 it is on above the upper threshold alone.
    """
    for k, (symbol, side) in reversed(list(relays.items())):
        by_state = ca.if_else(side == 0, ca.copysign(1, switches[k]), side)
        rows = ca.substitute(rows, symbol, by_state)
    return rows


def with_relays(
    packed: Packed, relays: Mapping[int, Relay], switches: ca.SX, sides: Decided, guards: ca.SX
) -> ca.SX:
    """Return the guards with those of relays in both modes.

    Parameters
    ----------
    packed : Packed
        The variables.
    relays : mapping of int to Relay
        By the index of their guard.
    switches : casadi.SX
        All switches with the symbols of relays.
    sides : mapping of int to (casadi.SX, casadi.SX)
        Symbol and side of each relay.
    guards : casadi.SX
        All guards.

    Returns
    -------
    casadi.SX
        The guards.
    """
    guards = ca.SX(guards)
    for k, relay in relays.items():
        both = packed.scaled([relay.over, relay.under], relays=True)
        over, under = ca.vertsplit(in_modes(both, switches, sides))
        guards[k] = ca.if_else(sides[k][1] == PLUS, under, over)
    return guards
