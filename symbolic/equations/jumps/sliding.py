"""Motions that slide along jumps of the equations, several at once, as dry friction sticks (Filippov, Utkin).

On the sides sigma_j = 1 or -1 of its jumps s_j the equations are

    M x' + g_0 + sum_j sigma_j g_j = 0,    so that    s_i' = b_i - sum_j A_ij sigma_j.

Where s_i slides, sigma_i is what keeps s_i' = 0: of those that slide together A_SS sigma_S = b_S - A_SN
sigma_N. Jumps whose A_ij vanish by their form do not know of each other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from symbolic.equations.jumps.isolated import isolated
from symbolic.equations.jumps.operations import Operations
from symbolic.equations.packed import Packed
from symbolic.equations.samples import Samples
from symbolic.equations.surfaces import HELD, STUCK

EQUAL = 1e-8
"""What is smaller than this part of its largest value is 0."""

RETURN = 3.0
"""Rate (1/rad) at which what is HELD comes back to its place: it is there on an orbit, whatever the rate."""

Slide = tuple[int, ca.SX, ca.SX]
"""Index of a switch, and the functions at whose zeros its sliding ends: s' on either side."""


def sliding(
    packed: Packed,
    operations: Operations,
    sides: Mapping[int, ca.SX],
    jumps: Sequence[int],
    switches: ca.SX,
    telling: slice,
    places: Mapping[int, ca.SX],
) -> tuple[ca.SX, tuple[Slide, ...], tuple[int, ...]]:
    """Return rows on sides of their jumps, sliding along them among these, and where sliding ends.

    Parameters
    ----------
    packed : Packed
        The variables.
    operations : Operations
        The rows and what jumps in them.
    sides : mapping of int to casadi.SX
        The side of each switch.
    jumps : sequence of int
        Those that jump.
    switches : casadi.SX
        All switches.
    telling : slice
        The rows that tell the rates.
    places : mapping of int to casadi.SX
        Of what may be HELD, how far it is from its place.

    Returns
    -------
    rows : casadi.SX
        On the sides 1, -1, STUCK, or 0 where the state decides.
    slides : tuple of Slide
        Those along which motions slide.
    alone : tuple of int
        Those of them along which a motion that slides all the time is determined, without a place.
    """
    plain, chosen = operations.on(sides), list(jumps)
    while chosen:
        forces = _forces(packed, operations, sides, chosen, telling)
        if forces is None:
            return plain, (), ()
        pull, push = forces.along(packed, switches[chosen], telling)
        left = [k for i, k in enumerate(chosen) if _attracts(packed, pull[i, i], forces.sigma, sides)]
        left = [k for k in left if k not in forces.crossed] if left == chosen else left
        if left == chosen:
            drawn = [_drawn(switches[k], places.get(k)) for k in chosen]
            given = [ca.if_else(sides[k] == 0, ca.sign(switches[k]), sides[k]) for k in chosen]
            sigma, stuck, slides = _slid(sides, chosen, given, drawn, (pull, push))
            rows = _rows(packed, plain, forces, sigma, stuck)
            free = [k for k in chosen if k not in places]
            return rows, slides, tuple(k for k in free if isolated(packed, rows[telling], sides, k))
        chosen = left
    return plain, (), ()


@dataclass(frozen=True)
class _Forces:
    """M, g_0 and the columns g_j; `crossed` are jumps whose g depends on the sides of others."""

    mass: ca.SX
    constant: ca.SX
    gains: ca.SX
    sigma: ca.SX
    crossed: set[int]

    def along(self, packed: Packed, switch: ca.SX, telling: slice) -> tuple[ca.SX, ca.SX]:
        """A and b of some switches."""
        by_state, by_phase = ca.jacobian(switch, packed.state), ca.jacobian(switch, packed.phase)
        loads = ca.horzcat(self.gains, self.constant)[telling, :]
        answer = by_state @ ca.solve(self.mass[telling, :], loads)
        return answer[:, :-1], by_phase - answer[:, -1]


def _forces(
    packed: Packed, operations: Operations, sides: Mapping[int, ca.SX], chosen: list[int], telling: slice
) -> _Forces | None:
    """The rows as affine functions of sigma; None where they do not tell the rates."""
    sigma, rate = ca.SX.sym("sigma", len(chosen)), packed.rate
    rows = operations.on(sides, {k: sigma[i] for i, k in enumerate(chosen)})
    mass = ca.jacobian(rows, rate)
    hidden = ca.depends_on(rows[telling], packed.unknown)
    if not rows.numel() or hidden or ca.depends_on(mass, ca.vertcat(sigma, rate)):
        return None
    still = ca.substitute(rows, rate, ca.SX.zeros(rate.numel()))
    gains, none = ca.jacobian(still, sigma), ca.SX.zeros(len(chosen))
    constant, crossed = ca.substitute(still, sigma, none), set()
    for i, k in enumerate(chosen):
        if ca.depends_on(gains[:, i], ca.vertcat(sigma[:i], sigma[i + 1 :])):
            crossed.add(k)
        elif ca.depends_on(gains[:, i], sigma[i]):  # of two branches that are curved the ends count alone
            ends = [ca.substitute(still, sigma, way * _unit(len(chosen), i)) for way in (1, -1)]
            middle = ca.substitute(still, sigma, none)
            gains[:, i], constant = (ends[0] - ends[1]) / 2, constant + (ends[0] + ends[1]) / 2 - middle
    return _Forces(mass, constant, gains, sigma, crossed)


def _unit(count: int, i: int) -> ca.SX:
    return ca.SX([float(k == i) for k in range(count)])


def _attracts(packed: Packed, pull: ca.SX, sigma: ca.SX, sides: Mapping[int, ca.SX]) -> bool:
    """Whether both sides may lead back to a jump: somewhere s' falls from one to the other."""
    side = ca.vertcat(ca.SX(0, 1), *[s for s in sides.values() if s.is_symbolic()])
    free = ca.vertcat(sigma, side)
    for way in (1.0, -1.0):
        given = ca.vertcat(way * ca.SX.ones(sigma.numel()), ca.SX.zeros(side.numel()))
        values = np.concatenate(Samples(packed).rows(ca.substitute(pull, free, given))[0], axis=None)
        values = values[np.isfinite(values)]
        largest = np.abs(values).max(initial=0.0)
        if largest <= EQUAL or values.max() <= EQUAL * largest:
            return False
    return True


def _drawn(switch: ca.SX, place: ca.SX | None) -> ca.SX:
    """How s falls where it is HELD: s' = -2 a s - a^2 u with u' = s, so that s and u vanish on an orbit.

    Without a place s' = -a s.
    """
    return RETURN * switch if place is None else 2 * RETURN * switch + RETURN**2 * place


def _slid(
    sides: Mapping[int, ca.SX],
    chosen: list[int],
    given: list[ca.SX],
    drawn: list[ca.SX],
    along: tuple[ca.SX, ca.SX],
) -> tuple[ca.SX, list[ca.SX], tuple[Slide, ...]]:
    """sigma of jumps with A and b, given where they do not slide; which do; and where sliding ends."""
    pull, push = along
    held = [sides[k] == HELD for k in chosen]
    stuck = [(sides[k] == STUCK) + one for k, one in zip(chosen, held, strict=True)]
    wanted = [ca.if_else(one, by, 0) for one, by in zip(held, drawn, strict=True)]
    sigma, slides = ca.SX.zeros(len(chosen)), []
    for block in _blocks(pull):
        system = _System(
            pull[block, block],
            push[block],
            [given[i] for i in block],
            [stuck[i] for i in block],
            [wanted[i] for i in block],
        )
        for row, i in enumerate(block):
            sigma[i] = system.solved()[row]
            slides.append((chosen[i], system.slope(row, 1), system.slope(row, -1)))
    return sigma, stuck, tuple(sorted(slides, key=lambda slide: slide[0]))


def _rows(packed: Packed, plain: ca.SX, forces: _Forces, sigma: ca.SX, stuck: list[ca.SX]) -> ca.SX:
    """The rows with what slides."""
    slid = forces.mass @ packed.rate + forces.constant + forces.gains @ sigma
    rows = ca.SX(plain)
    for r in range(plain.numel()):
        own = [i for i in range(len(stuck)) if not forces.gains[r, i].is_zero()]
        if own:
            slides_here = sum((stuck[i] for i in own[1:]), stuck[own[0]])
            rows[r] = ca.if_else(slides_here > 0, slid[r], plain[r])
    return rows


def _blocks(pull: ca.SX) -> list[list[int]]:
    """The sets of jumps that A joins."""
    count = pull.size1()
    joined = np.array([[not pull[i, j].is_zero() for j in range(count)] for i in range(count)], dtype=bool)
    joined = joined | joined.T | np.eye(count, dtype=bool)
    for _ in range(count):
        joined = (joined.astype(int) @ joined) > 0
    return [list(map(int, row.nonzero()[0])) for i, row in enumerate(joined) if row.argmax() == i]


@dataclass(frozen=True)
class _System:
    """s' = b - A sigma of jumps that know of each other; those that are not stuck have given sigma."""

    pull: ca.SX
    push: ca.SX
    given: list[ca.SX]
    stuck: list[ca.SX]
    wanted: list[ca.SX]

    def solved(self, free: Mapping[int, float] | None = None) -> list[ca.SX]:
        """sigma of all, those in `free` not stuck but with a given number."""
        forced = free or {}
        count = len(self.given)
        rows, right = [], []
        for i in range(count):
            if i in forced:
                rows.append([ca.SX(float(i == j)) for j in range(count)])
                right.append(ca.SX(forced[i]))
            else:
                own = [ca.if_else(self.stuck[i], self.pull[i, j], float(i == j)) for j in range(count)]
                rows.append([_sparse(self.pull[i, j], own[j]) if i != j else own[j] for j in range(count)])
                right.append(ca.if_else(self.stuck[i], self.push[i] + self.wanted[i], self.given[i]))
        return _eliminated(rows, right)

    def slope(self, i: int, side: int) -> ca.SX:
        """s_i' on a side of it."""
        return self.push[i] - ca.dot(self.pull[i, :].T, ca.vertcat(*self.solved({i: float(side)})))


def _sparse(entry: ca.SX, value: ca.SX) -> ca.SX:
    return ca.SX(0) if entry.is_zero() else value


def _eliminated(rows: list[list[ca.SX]], right: list[ca.SX]) -> list[ca.SX]:
    """Solve a linear system by Gauss; its principal minors are positive, so no rows are exchanged."""
    count = len(right)
    for p in range(count):
        for r in range(p + 1, count):
            if rows[r][p].is_zero():
                continue
            factor = rows[r][p] / rows[p][p]
            rows[r] = [a if b.is_zero() else a - factor * b for a, b in zip(rows[r], rows[p], strict=True)]
            right[r] = right[r] - factor * right[p]
    for p in reversed(range(count)):
        known = [rows[p][j] * right[j] for j in range(p + 1, count) if not rows[p][j].is_zero()]
        right[p] = (right[p] - sum(known, ca.SX(0))) / rows[p][p]
    return right
