"""Equations that jump, with the side of the jump as an argument.

Where a sign or a comparison makes the right-hand side jump at the zero of a switch, collocation points beside
it must take the branch of their own side whatever the last digits of the state say. For each switch with a
jump the equations get a number: 1 for s > 0, -1 for s < 0, 0 where the state decides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.equations.branches import JUMPING, nodes
from symbolic.equations.packed import Packed
from symbolic.equations.samples import Samples, multiples
from symbolic.equations.surfaces import STUCK

ITERATIONS = 20
"""Newton steps from a sample point to the zero of a switch."""

CLOSE = 1e-10
"""Value of a switch that is as good as 0."""

EQUAL = 1e-8
"""Difference of residuals, relative to them, that is none."""


@dataclass(frozen=True)
class Sided:
    """The residual with sides: a symbol each for the switches with the indices `jumps`.

    slides: those along which a motion can slide, with the two functions that pass 0 where it ends: s' on the
    positive side and on the negative one; between them the motion is held.
    """

    residual: ca.SX
    side: ca.SX
    jumps: tuple[int, ...]
    slides: tuple[tuple[int, ca.SX, ca.SX], ...] = ()


def sided(
    packed: Packed, residual: ca.SX, switches: ca.SX, excluded: tuple[int, ...], moving: ca.SX | None = None
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
        Rows that tell all rates, where those of the residual do not.

    Returns
    -------
    Sided
        With no sides where nothing jumps.
    """
    found = _owned(packed, residual, switches, excluded)
    every = sorted({k for _, k, _ in found.values()})
    side = ca.SX.sym("side", len(every))
    names = {k: side[i] for i, k in enumerate(every)}
    branches = {node: _branch(*given, names) for node, given in found.items()}
    count = residual.numel()
    rows = _rebuilt(residual if moving is None else ca.vertcat(residual, moving), branches)
    telling = slice(0 if moving is None else count, rows.numel())
    marked = rows[:count]
    jumps = [k for i, k in enumerate(every) if _jumps(packed, marked, side, i, switches[k])]
    kept = ca.SX.sym("side", len(jumps))
    values = [kept[jumps.index(k)] if k in jumps else ca.SX(0) for k in every]
    rows = ca.substitute(rows, side, ca.vertcat(ca.SX(0, 1), *values))
    slides = []
    for i, k in enumerate(jumps):
        sliding = _sliding(packed, rows, telling, kept, i, switches[k])
        if sliding is not None:
            slides.append((k, *sliding[1:]))
            rows = ca.if_else(kept[i] == STUCK, sliding[0], rows)
    return Sided(rows[:count], kept, tuple(jumps), tuple(slides))


def _sliding(
    packed: Packed, rows: ca.SX, telling: slice, side: ca.SX, index: int, switch: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX] | None:
    """The rows M x' + g0 + sigma g1 of sliding, and s' on either side; None where nothing slides.

    On the sides themselves they are M x' + g0 + g1 and M x' + g0 - g1. sigma keeps s_x x' + s_tau at 0, x'
    being what the `telling` rows say; it must not depend on the sides of other jumps.
    """
    rate = packed.rate
    if not rows.numel() or ca.depends_on(rows[telling], packed.unknown):
        return None
    mass = ca.jacobian(rows, rate)
    if ca.depends_on(mass, ca.vertcat(side, rate)):
        return None
    still = ca.substitute(rows, rate, ca.SX.zeros(rate.numel()))
    above, below = (_with(still, side, index, value) for value in (1, -1))
    mean, half = (above + below) / 2, (above - below) / 2
    by_state, by_phase = ca.jacobian(switch, packed.state), ca.jacobian(switch, packed.phase)
    pushed, pulled = (by_state @ ca.solve(mass[telling, :], g[telling]) for g in (mean, half))
    # Both sides lead back to the jump where s' falls by this from one to the other.
    if ca.depends_on(pulled, side) or not all(row.min() > EQUAL for row in Samples(packed).rows(pulled)[0]):
        return None
    slope = by_phase - pushed
    if ca.depends_on(slope, side):
        return None
    return mass @ rate + mean + slope / pulled * half, slope - pulled, slope + pulled


def _with(expression: ca.SX, side: ca.SX, index: int, value: int) -> ca.SX:
    """An expression on one side of one jump."""
    given = [ca.SX(value) if i == index else side[i] for i in range(side.numel())]
    return ca.substitute(expression, side, ca.vertcat(*given))


def _owned(
    packed: Packed, residual: ca.SX, switches: ca.SX, excluded: tuple[int, ...]
) -> dict[int, tuple[ca.SX, int, float]]:
    """Jumping operations by hash, each with the switch that its argument is a multiple of, and the sign."""
    given = ca.vertcat(packed.state, packed.phase, packed.parameter)
    usable = {given[i].element_hash() for i in range(given.numel())}
    operations = [node for node in nodes(residual) if node.op() in JUMPING]
    operations = [n for n in operations if {s.element_hash() for s in ca.symvar(n)} <= usable]
    if not operations or not switches.numel():
        return {}
    arguments = [n.dep(0) if n.op() == ca.OP_SIGN else n.dep(0) - n.dep(1) for n in operations]
    values = Samples(packed).rows(ca.vertcat(*arguments, switches))
    found = {}
    for node, own in zip(operations, values, strict=False):
        for k, other in enumerate(values[len(operations) :]):
            if k not in excluded and multiples(own, other):
                ratio = own[0] / np.where(other[0] == 0, np.nan, other[0])
                found[node.element_hash()] = (node, k, float(np.sign(np.nanmedian(ratio))))
                break
    return found


def _branch(node: ca.SX, switch: int, sign: float, sides: Mapping[int, ca.SX]) -> ca.SX:
    """What an operation is on a side of its switch, itself where the side is 0."""
    side = sides[switch]
    known = sign * side if node.op() == ca.OP_SIGN else sign * side < 0
    return ca.if_else(side == 0, node, known)


def _rebuilt(rows: ca.SX, replaced: Mapping[int, ca.SX]) -> ca.SX:
    """Return expressions with some of their operations replaced."""
    if not replaced:
        return rows
    new: dict[int, ca.SX] = {}

    def of(node: ca.SX) -> ca.SX:
        return node if node.is_leaf() else new[node.element_hash()]

    for node in nodes(rows):
        key = node.element_hash()
        parts = [of(node.dep(i)) for i in range(node.n_dep())]
        if key in replaced:
            new[key] = replaced[key]
        elif all(a.element_hash() == node.dep(i).element_hash() for i, a in enumerate(parts)):
            new[key] = node
        elif len(parts) == 1:
            new[key] = ca.SX.unary(node.op(), *parts)
        else:
            new[key] = ca.SX.binary(node.op(), *parts)
    return ca.vertcat(*[of(rows[i]) for i in range(rows.numel())])


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
        for _ in range(ITERATIONS):
            value, slope = (np.array(a) for a in function(state, phase, parameter))
            change = value * slope / (slope**2).sum(axis=0)
            state, phase = state - change[:-1], phase - change[-1:]
        value = np.array(function(state, phase, parameter)[0])
    there = np.flatnonzero(np.abs(value.ravel()) < CLOSE)
    return state[:, there], phase[:, there], parameter
