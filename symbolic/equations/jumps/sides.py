"""Equations that jump, with the side of the jump as an argument.

Where a sign or a comparison makes the right-hand side jump at the zero of a switch, it must be evaluated at
collocation points on their own side of the jump, even where rounding puts the state on the other.
For each switch with a jump the equations get a number: 1 for s > 0, -1 for s < 0, 0 where the state decides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.branches import JUMPING, nodes
from symbolic.equations.jumps.operations import Operations
from symbolic.equations.jumps.relaysymbols import in_modes
from symbolic.equations.jumps.sliding import EQUAL, Slide, sliding
from symbolic.equations.packed import Packed
from symbolic.equations.samples import Samples, multiples

ZERO_ITERATIONS = 20
"""Newton steps from a sample point to the zero of a switch."""

ZERO_VALUE = 1e-10
"""Value of a switch that counts as 0."""


@dataclass(frozen=True)
class Sided:
    """The residual with sides: a symbol each for the switches with the indices `jumps`, among them sliders.

    slides: the switches along which a motion can slide, each with the two functions one of which changes
    sign where sliding ends: s' with the equations of the positive side and with those of the negative one,
    other jumps being on their given sides. The motion slides as long as 0 lies between the two. alone: those
    along which a motion that slides for the whole period is determined by the equations, without a place.
    """

    residual: ca.SX
    side: ca.SX
    jumps: tuple[int, ...]
    slides: tuple[Slide, ...] = ()
    alone: tuple[int, ...] = ()


def sided(
    packed: Packed,
    residual: ca.SX,
    switches: ca.SX,
    excluded: tuple[int, ...],
    moving: ca.SX | None = None,
    sliders: tuple[int, ...] = (),
    places: Mapping[int, ca.SX] | None = None,
    relays: Mapping[int, tuple[ca.SX, ca.SX]] | None = None,
) -> Sided:
    """Return a residual with the side of every jump as an argument.

    Parameters
    ----------
    packed : Packed
        The variables.
    residual, switches : casadi.SX
        Columns in them.
    excluded : tuple of int
        Switches that are no jumps of the equations: impacts.
    moving : casadi.SX, optional
        Rows that determine all rates, where those of the residual do not.
    sliders : tuple of int
        Further switches that have a side.
    places : mapping of int to casadi.SX, optional
        For switches along which a motion may slide for the whole period: the distance from its given place.
    relays : mapping of int to (casadi.SX, casadi.SX), optional
        For each relay, by its guard: the symbol that stands for it in these expressions, and its side.

    Returns
    -------
    Sided
        With no sides where nothing jumps.
    """
    given, count, none = relays or {}, residual.numel(), ca.SX(0, 1)
    rows = in_modes(residual if moving is None else ca.vertcat(residual, moving), switches, given)
    guards, own = in_modes(switches, switches, given), (*sliders, *given)
    decided = ca.vertcat(none, *[side for _, side in given.values()])
    operations = Operations(rows, _owned(packed, rows, guards, (*excluded, *own), decided))
    symbols = {k: given[k][1] if k in given else ca.SX.sym(f"side_{k}") for k in range(switches.numel())}
    every = operations.switches
    marked = operations.on(symbols)[:count]
    side = ca.vertcat(none, *symbols.values())
    plain = _undecided(guards, decided)
    jumps = [k for k in every if _jumps(packed, marked, side, k, plain[k])]
    columns = sorted({*jumps, *own})
    sides = {k: symbols[k] if k in jumps or k in given else ca.SX(0) for k in (*every, *given)}
    telling = slice(0 if moving is None else count, rows.numel())
    slid, slides, alone = sliding(packed, operations, sides, jumps, guards, telling, places or {})
    return Sided(
        slid[:count], ca.vertcat(none, *[symbols[k] for k in columns]), tuple(columns), slides, alone
    )


def _undecided(rows: ca.SX, sides: ca.SX) -> ca.SX:
    """Rows with the sides of relays at 0, where the state decides."""
    return ca.substitute(rows, sides, ca.SX.zeros(sides.numel()))


def _owned(
    packed: Packed, residual: ca.SX, switches: ca.SX, excluded: tuple[int, ...], decided: ca.SX
) -> dict[int, tuple[ca.SX, int, float]]:
    """Jumping operations by hash, each with the switch that its argument is a multiple of, and the sign."""
    given = ca.vertcat(packed.state, packed.phase, packed.parameter, decided)
    usable = {given[i].element_hash() for i in range(given.numel())}
    operations = [node for node in nodes(residual) if node.op() in JUMPING]
    operations = [n for n in operations if {s.element_hash() for s in ca.symvar(n)} <= usable]
    if not operations or not switches.numel():
        return {}
    arguments = [n.dep(0) if n.op() == ca.OP_SIGN else n.dep(0) - n.dep(1) for n in operations]
    values = Samples(packed).rows(_undecided(ca.vertcat(*arguments, switches), decided))
    found = {}
    for node, own in zip(operations, values, strict=False):
        for k, other in enumerate(values[len(operations) :]):
            if k not in excluded and multiples(own, other):
                ratio = own[0] / np.where(other[0] == 0, np.nan, other[0])
                found[node.element_hash()] = (node, k, float(np.sign(np.nanmedian(ratio))))
                break
    return found


def _jumps(packed: Packed, marked: ca.SX, side: ca.SX, index: int, switch: ca.SX) -> bool:
    """Whether a residual differs on the two sides of the zero of a switch."""
    state, phase, parameter = _on_surface(packed, switch)
    if not state.shape[1]:
        return True
    arguments = [packed.rate, packed.state, packed.unknown, packed.phase, packed.parameter, side]
    function = ca.Function("sides", arguments, [marked])
    draw, count = np.random.default_rng(2), state.shape[1]
    rate, unknown = (draw.normal(size=(v.numel(), count)) for v in (packed.rate, packed.unknown))
    sides = np.zeros((side.numel(), 2))
    sides[index] = (1, -1)
    above, below = (np.array(function(rate, state, unknown, phase, parameter, chosen)) for chosen in sides.T)
    finite = np.isfinite(above) & np.isfinite(below)
    size = 1 + np.maximum(np.abs(above), np.abs(below))
    return bool((np.abs(above - below)[finite] > EQUAL * size[finite]).any())


def _on_surface(packed: Packed, switch: ca.SX) -> tuple[Array, Array, Array]:
    """Points at which a switch vanishes, nearest to sample points: states, phases, parameters."""
    moving = ca.vertcat(packed.state, packed.phase)
    gradient = ca.jacobian(switch, moving).T
    arguments = [packed.state, packed.phase, packed.parameter]
    function = ca.Function("surface", arguments, [switch, gradient])
    state, phase, parameter = Samples(packed).points[0]
    with np.errstate(all="ignore"):
        for _ in range(ZERO_ITERATIONS):
            value, slope = (np.array(a) for a in function(state, phase, parameter))
            change = value * slope / (slope**2).sum(axis=0)
            state, phase = state - change[:-1], phase - change[-1:]
        value = np.array(function(state, phase, parameter)[0])
    there = np.flatnonzero(np.abs(value.ravel()) < ZERO_VALUE)
    return state[:, there], phase[:, there], parameter
