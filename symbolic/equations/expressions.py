"""The scaled expressions of a system: what its kernels are generated from.

With x the scaled states, z the algebraic unknowns and ' = d/dtau, the residual has the rows

    q_i' - v_i = 0,    m omega^2 v_i' - sum of forces = 0,    rows of the parts' own states,    0 = g

The two rows of a condensed structure's place are empty: its motion follows from the forces on the structure,
which are unknowns, each with the row force - sum of forces = 0 in g.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from symbolic.equations.assembly import Assembly
from symbolic.equations.jumps.relaysymbols import decided, in_modes, with_relays
from symbolic.equations.jumps.resting import Resting, walls, with_walls
from symbolic.equations.jumps.sides import Sided, sided
from symbolic.equations.jumps.sliders import Held, with_sliders
from symbolic.equations.packed import Packed
from symbolic.meter import counted


@dataclass(frozen=True)
class Expressions:
    """The scaled symbolic system.

    `waved` are residual and outputs in terms of the symbols `waves` of the excitation, sin(k tau) and
    cos(k tau) for each k of `harmonics`; `unexcited` is the residual without them and at tau = 0. `guards`
    are the switches on given sides of the jumps, `switches` those where the state decides. `moved` is where
    an `increment` takes the unknowns.
    """

    rate: ca.SX
    state: ca.SX
    algebraic: ca.SX
    phase: ca.SX
    parameter: ca.SX
    residual: ca.SX
    sided: Sided
    places: dict[int, tuple[str, tuple[float, ...]]]
    unexcited: ca.SX
    harmonics: tuple[int, ...]
    waves: ca.SX
    waved: ca.SX
    frequency: ca.SX
    outputs: ca.SX
    switches: ca.SX
    guards: ca.SX
    sliders: dict[int, Held]
    relays: tuple[int, ...]
    resting: dict[int, Resting]
    resets: dict[int, ca.SX]
    rest_state: ca.SX
    rest_algebraic: ca.SX
    increment: ca.SX
    moved: ca.SX


def expressed(assembly: Assembly) -> Expressions:
    """Return the expressions of all that the parts have laid down.

    Raises ValueError for a coordinate without mass and for an excitation without a positive frequency.
    """
    rows = _motion_rows(assembly) + assembly.differential_rows + assembly.algebraic_rows
    rows += [place.unknown - place.motion.force / place.unit_force for place in assembly.places]
    _check_frequency(assembly)
    packed = Packed(assembly)
    outputs = [expression for _, expression in assembly.described]
    unknowns, excitation = assembly.unknowns, assembly.excitation
    moved = packed.scaled([u.moved for u in unknowns])
    moving = _moving_rows(assembly)
    both = packed.scaled(rows + moving, relays=True)  # at once: what they share stays the same
    residual = both[: len(rows)]
    switches = packed.scaled([expression for _, expression in assembly.switches], relays=True)
    modes = decided(assembly.relays)
    _check_relays(assembly, outputs)
    resets, telling = tuple(assembly.resets), both[len(rows) :] if moving else None
    at = {k: packed.scaled([place]) for k, (_, place) in assembly.places_held.items()}
    free = walls(assembly)
    beside = sided(packed, residual, switches, resets, telling, (*assembly.sliders, *free), at, modes)
    own = with_relays(packed, assembly.relays, switches, modes, in_modes(switches, switches, modes))
    guards = ca.vertcat(own, *(s for _, *both in beside.slides for s in both))
    first = len(rows) - len(assembly.differential_rows) - len(assembly.algebraic_rows) - len(assembly.places)
    beside, guards = with_sliders(packed, assembly.sliders, beside, guards, first)
    beside, guards, resting = with_walls(packed, free, beside, guards)
    return Expressions(
        rate=packed.rate,
        state=packed.state,
        algebraic=packed.unknown,
        phase=packed.phase,
        parameter=packed.parameter,
        residual=ca.substitute(beside.residual, beside.side, ca.SX.zeros(beside.side.numel()))
        if modes
        else residual,
        sided=beside,
        places=_places(packed, assembly),
        unexcited=ca.substitute(
            packed.scaled(rows, ca.SX.zeros(packed.waves.size1())), packed.phase, ca.SX(0)
        ),
        harmonics=tuple(int(order / excitation.fundamental) for order in excitation.orders),
        waves=packed.waves,
        waved=packed.scaled([*rows, *outputs], packed.waves),
        frequency=packed.scaled([assembly.omega]),
        outputs=packed.scaled(outputs),
        switches=ca.substitute(guards, beside.side, ca.SX.zeros(beside.side.numel())),
        guards=guards,
        sliders={k: Held(s.releases, assembly.states.index(s.state)) for k, s in assembly.sliders.items()},
        relays=tuple(assembly.relays),
        resting=resting,
        resets={
            k: ca.vertcat(
                *(
                    packed.scaled([to[s] / s.scale]) if s in to else x
                    for s, x in zip(assembly.states, ca.vertsplit(packed.state), strict=True)
                )
            )
            for k, to in assembly.resets.items()
        },
        rest_state=packed.scaled([s.rest / s.scale for s in assembly.states]),
        rest_algebraic=packed.scaled([u.rest for u in unknowns]),
        increment=packed.increment,
        moved=ca.substitute(moved, ca.vertcat(*[u.increment for u in unknowns]), packed.increment),
    )


def _check_relays(assembly: Assembly, outputs: list[ca.SX]) -> None:
    """Refuse outputs and resets that depend on whether a relay is on: they are functions of the state."""
    symbols = ca.vertcat(ca.SX(0, 1), *[relay.symbol for relay in assembly.relays.values()])
    for (variable, _), expression in zip(assembly.described, outputs, strict=True):
        if ca.depends_on(expression, symbols):
            raise ValueError(
                f"output {variable.name!r} depends on a relay; it must be a function of the state alone"
            )
    for k, to in assembly.resets.items():
        if ca.depends_on(ca.vertcat(*to.values()), symbols):
            raise ValueError(f"reset {assembly.switches[k][0].name!r} depends on a relay; it must not")


def _places(packed: Packed, assembly: Assembly) -> dict[int, tuple[str, tuple[float, ...]]]:
    """Of what may be held all along the parameter's name, and the weights of scaled states in it (SI)."""
    found = {}
    for k, (name, place) in assembly.places_held.items():
        slope = ca.jacobian(packed.scaled([place]), ca.vertcat(packed.state, packed.parameter))
        row = np.array(ca.DM(slope)).ravel() if slope.is_constant() else np.zeros(0)
        if row.size:
            n = packed.state.numel()
            found[k] = name, tuple(float(w) for w in -row[:n] / row[n:].min())
    return found


def _motion_rows(assembly: Assembly) -> list[ca.SX]:
    rows: list[ca.SX] = []
    held = [id(place.motion) for place in assembly.places]
    motions = list(assembly.motions.items())
    for k in counted(len(motions), "compiling", "coordinates"):
        coordinate, motion = motions[k]
        if id(motion) in held:
            rows += [ca.SX(0), ca.SX(0)]
            continue
        inertia = motion.mass * assembly.omega**2
        if motion.mass.is_zero() or not assembly.nominal(motion.mass) > 0:
            raise ValueError(f"coordinate {coordinate.name!r} has no mass; add a Mass on it")
        if not rows:
            _check_frequency(assembly)
        scale = assembly.nominal(inertia) * motion.position.scale
        rows.append((motion.position.derivative - motion.velocity.symbol) / motion.position.scale)
        rows.append((inertia * motion.velocity.derivative - motion.force) / scale)
    return rows


def _moving_rows(assembly: Assembly) -> list[ca.SX]:
    """Rows of all rates, for structures whose acceleration is known where they are condensed; else none."""
    if not any(place.coasting for place in assembly.places):
        return []
    rows = [row for row in _motion_rows(assembly) if not row.is_zero()]
    rows += [row for row in assembly.differential_rows if not row.is_zero()]
    omega = assembly.omega
    for place in assembly.places:
        motion, scale = place.motion, place.motion.position.scale
        rows.append((motion.position.derivative - motion.velocity.symbol) / scale)
        beside = [other.motion.force for other in assembly.places if other.structure is place.structure]
        rate = motion.velocity.derivative
        if place.coasting is not None:
            rows.append(place.coasting.derivative / place.coasting.scale)
            pushed = sum((m * force for m, force in zip(place.mobility, beside, strict=True)), ca.SX(0))
            rate = rate - place.coasting.symbol - pushed / omega**2
        rows.append(rate / scale)
    return rows


def _check_frequency(assembly: Assembly) -> None:
    """Refuse a nominal omega that is not positive; a model without excitation gets omega as a parameter."""
    omega = assembly.nominal(assembly.omega)
    if not 0 < omega < math.inf:
        raise ValueError(
            f"the frequency of the excitation is {omega} rad/s; its nominal value must be greater than 0"
        )
