"""Coordinates at rest on a rigid wall: their rows in that mode, and what lets them go.

A mass that has bounced ever faster and lower, without number in finite time, rests on the wall while it is
pressed to it, s'' < 0 of its free motion, s being its distance. It leaves where that rises to 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.branches import JUMPING, nodes
from symbolic.equations.jumps.sides import Sided
from symbolic.equations.packed import Packed
from symbolic.equations.surfaces import STUCK
from symbolic.equations.terms import Motion, mobility


@dataclass(frozen=True)
class Resting:
    """Of a wall the switch s'' at whose rise to 0 what rests on it leaves, and where the states are.

    row: of the velocity, in the residual. position, velocity: indices of the coordinate's states.
    """

    leaves: int
    row: int
    position: int
    velocity: int


def walls(assembly: Assembly) -> dict[int, tuple[int, ca.SX]]:
    """Return of each wall that a coordinate may rest on, by its switch, the coordinate's place and s'' (SI).

    With M the mass matrix, f the forces without inertia and e the coordinate, q'' = e^T M^-1 f of its free
    motion. None at a condensed structure; nor where friction on the coordinate turns with its own speed, or
    forces jump on coordinates that inertia couples to it.
    """
    found, every = dict[int, tuple[int, ca.SX]](), list(assembly.motions.values())
    held = [id(place.motion) for place in assembly.places]
    for k, (motion, _) in assembly.impacts.items():
        if id(motion) in held or _doubtful(assembly, motion):
            continue
        changed = mobility(every, motion, assembly.omega)
        rates = ca.vertcat(*[each.velocity.derivative for each in every])
        joined = ca.vertcat(*[every[i].force for i in changed])
        forces = ca.substitute(joined, rates, ca.SX.zeros(rates.numel()))
        if len(changed) > 1 and any(node.op() in JUMPING for node in nodes(forces)):
            continue
        free = ca.dot(ca.vertcat(*changed.values()), forces) / assembly.omega**2
        by_position = ca.jacobian(assembly.switches[k][1], motion.position.symbol)
        found[k] = next(i for i, each in enumerate(every) if each is motion), by_position * free
    return found


def _doubtful(assembly: Assembly, motion: Motion) -> bool:
    """Whether the force on a coordinate at rest is not told by its state, as that of what sticks."""
    if ca.depends_on(motion.force, motion.velocity.derivative):
        return True
    speed = motion.velocity.symbol
    stopped = [ca.substitute(s, speed, 0) for _, s in assembly.switches if ca.depends_on(s, speed)]
    return any(ca.simplify(s).is_zero() for s in stopped)


def with_walls(
    packed: Packed, free: Mapping[int, tuple[int, ca.SX]], beside: Sided, guards: ca.SX
) -> tuple[Sided, ca.SX, dict[int, Resting]]:
    """Return the sided residual with what rests on walls, the guards with what lets it go, and where.

    Parameters
    ----------
    packed : Packed
        The variables.
    free : mapping
        As `walls` returns it.
    beside : Sided
        The residual with a side for each of them.
    guards : casadi.SX
        All switches so far.
    """
    rows, states, found = ca.SX(beside.residual), packed.assembly.states, dict[int, Resting]()
    for k, (place, leaving) in free.items():
        motion = list(packed.assembly.motions.values())[place]
        row, velocity = 2 * place + 1, states.index(motion.velocity)
        side = beside.side[beside.jumps.index(k)]
        rows[row] = ca.if_else(side == STUCK, packed.rate[velocity], rows[row])
        found[k] = Resting(guards.numel(), row, states.index(motion.position), velocity)
        guards = ca.vertcat(guards, packed.scaled([leaving]))
    return replace(beside, residual=rows), guards, found
