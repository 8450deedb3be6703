"""Switches along the whole orbit, not at its collocation points alone: changes of sign, and extremes.

On each interval a switch is represented by the polynomial through its values at the knots. That is exact for
a switch that is linear in the states, and else of the order of the orbit's own error. Bernstein coefficients
bound the polynomial, so that intervals on one side of the level are settled at once. The others are divided
at the zeros of the derivative into monotone pieces, none of which hides a change of sign.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from periodic.events.impactmodes import thrown
from periodic.events.modes import group, mode_after, of_kind, relays, sides, sliding, surface_of, torn
from periodic.events.thresholds import AT_EXTREMUM, AT_LEVEL, NOISE, SHALLOW, SLOW_CROSSING
from periodic.orbit.mesh import EventNode, wrapped
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Scheme
from periodic.system import HELD, STUCK, Kind, SurfaceLike, System, guards, guards_gradient

KEPT = 4
"""Orbits whose switches are kept: of a step its base, its guess, its end, and where its pattern changes."""


@dataclass(frozen=True)
class Extremum:
    """Where a switch is nearest to its level 0, or farthest past it: its value at a place in an interval."""

    switch: int
    interval: int
    theta: float
    phase: float
    value: float


@dataclass(frozen=True)
class Along:
    """One switch at K points around an orbit, in order: the knots and all extremes that may matter.

    sides: on which side of its level it is, 0 within rounding.
    """

    interval: NDArray[np.int_]
    theta: Array
    phase: Array
    value: Array
    sides: NDArray[np.int_]

    def extremum(self, switch: int, index: int) -> Extremum:
        """Return one of the points."""
        at = float(self.theta[index]), float(self.phase[index]), float(self.value[index])
        return Extremum(switch, int(self.interval[index]), *at)


@dataclass(frozen=True)
class _Evaluated:
    """What is known of the switches along an orbit: `along` and `directions` by switch, as far as asked."""

    system: System
    orbit: Orbit
    along: dict[tuple[int, bool], Along] = field(default_factory=dict)
    directions: dict[int, list[int]] = field(default_factory=dict)

    @cached_property
    def modes(self) -> Array:
        """The modes of the surfaces in each interval, shape (N, columns)."""
        return sides(self.system, self.orbit)

    @cached_property
    def knots(self) -> Array:
        """Values at the knots, shape (N, ncol+1, switches)."""
        orbit = self.orbit
        tau = orbit.grid.left[:, None] + orbit.grid.width[:, None] * orbit.mesh.scheme.knots
        flat = orbit.knots.reshape(tau.size, -1)
        side = np.repeat(self.modes, tau.shape[1], axis=0)
        return guards(self.system, flat, tau.ravel(), orbit.parameter, side).reshape(*tau.shape, -1)

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """How steeply switches change along the motion: at the event nodes (k, switches), and at the most."""
        orbit, at = self.orbit, self.orbit.mesh.starts
        flat = (-1, orbit.stages.shape[2])
        states = np.concatenate([orbit.nodes[at], orbit.stages.reshape(flat)])
        rates = np.concatenate([orbit.node_rates[at], orbit.knot_rates[:, 1:].reshape(flat)])
        tau = np.append(orbit.phases, orbit.stage_phases.ravel())
        by_state, by_phase, _ = self.system.switch_gradient(states, tau, orbit.parameter)
        slopes = np.abs(by_phase + np.einsum("psn,pn->ps", by_state, rates))
        return slopes[: len(at)], slopes[len(at) :].max(axis=0)


_LATEST: deque[_Evaluated] = deque(maxlen=KEPT)
"""Of the orbits last looked at."""


@dataclass(frozen=True)
class SwitchPolynomials:
    """The switches of a system along an orbit."""

    system: System
    orbit: Orbit

    @cached_property
    def _known(self) -> _Evaluated:
        """What is known of them; an orbit is looked at several times in a step."""
        latest = tuple(_LATEST)
        known = (each for each in latest if each.orbit is self.orbit and each.system is self.system)
        found = next(known, None)
        if found is None:
            found = _Evaluated(self.system, self.orbit)
            _LATEST.append(found)
        return found

    @property
    def knots(self) -> Array:
        """Values at the knots, shape (N, ncol+1, switches)."""
        return self._known.knots

    @property
    def modes(self) -> Array:
        """The modes of the surfaces in each interval, shape (N, columns)."""
        return self._known.modes

    def turns(self, switch: int, node: int) -> bool:
        """Whether a switch is stationary at an event node."""
        at_nodes, steepest = self._known.slopes
        slope = at_nodes[node, switch]
        return bool(slope <= AT_EXTREMUM * max(slope, steepest[switch]))

    def along(self, switch: int, everywhere: bool = False) -> Along:
        """Return a switch around the orbit, with extremes where it may pass its level, or `everywhere`."""
        known = self._known.along
        if (switch, everywhere) not in known:
            known[switch, everywhere] = self._along(switch, everywhere)
        return known[switch, everywhere]

    def _along(self, switch: int, everywhere: bool) -> Along:
        values, scheme, grid = self.knots[:, :, switch], self.orbit.mesh.scheme, self.orbit.grid
        bounds = values @ _bernstein(scheme).T
        mixed = _changing(bounds) | everywhere
        interval = np.repeat(np.arange(len(values)), scheme.ncol + 1)
        theta = np.tile(scheme.knots, len(values))
        bending = np.flatnonzero(mixed & _changing(np.diff(bounds)))
        which, places = _stationary(scheme, values[bending])
        inside = bending[which]
        interval, theta = np.append(interval, inside), np.append(theta, places)
        value = np.append(values.ravel(), np.einsum("il,il->i", scheme.basis(places), values[inside]))
        order = np.lexsort((theta, interval))
        interval, theta, value = interval[order], theta[order], value[order]
        far = np.isfinite(value) & (np.abs(value) > NOISE * np.abs(values).max())
        sides = np.sign(np.where(far, value, 0.0)).astype(int)
        return Along(interval, theta, grid.left[interval] + theta * grid.width[interval], value, sides)

    def crossings(self, switch: int) -> list[tuple[EventNode, float]]:
        """Return where a switch passes its level, with the phases in order, those of event nodes exact.

        A change of sign that an impact causes is no crossing.
        """
        along = self.along(switch)
        kept = np.flatnonzero(along.sides)
        if len(kept) == 0:
            return []
        found, last = [], len(kept) - 1
        for i in np.flatnonzero(along.sides[kept] != along.sides[np.roll(kept, -1)]):
            a, b = int(kept[i]), int(kept[i + 1 if i < last else 0])
            if not self._struck(along, a, b):
                phase = self._between(switch, along, a, b)
                found.append((EventNode(switch, int(along.sides[b])), phase))
        return found

    def _struck(self, along: Along, a: int, b: int) -> bool:
        """Whether two neighbouring points lie just before and after an impact that maps the state."""
        impacts = {s.switch for s in of_kind(self.system, Kind.IMPACT)}
        events = zip(self.orbit.mesh.starts, self.orbit.mesh.events, strict=True)
        starts = [int(j) for j, event in events if event.switch in impacts]
        later = int(along.interval[b])
        next_to = (later - int(along.interval[a])) % self.orbit.mesh.ntst == 1 % self.orbit.mesh.ntst
        at_end = along.theta[a] == 1.0 and along.theta[b] == 0.0
        return next_to and at_end and later in starts

    def _between(self, switch: int, along: Along, a: int, b: int) -> float:
        """Phase at which a switch passes its level between two points; at those between them it is 0."""
        between = np.arange(a + 1, b if b > a else b + len(along.phase)) % len(along.phase)
        nodes = self._tied(switch)
        for i in between:
            if along.theta[i] == 0.0 and int(along.interval[i]) in nodes:
                return nodes[int(along.interval[i])]
        if len(between):
            return float(along.phase[between[len(between) // 2]])
        j, begin = int(along.interval[a]), float(along.theta[a])
        end = float(along.theta[b]) if along.interval[b] == j and b > a else 1.0
        values, scheme = self.knots[j, :, switch], self.orbit.mesh.scheme

        def value(theta: float) -> float:
            return float(scheme.basis(np.array([theta]))[0] @ values)

        if value(begin) * value(end) < 0:
            begin = scipy.optimize.brentq(value, begin, end, xtol=1e-15)
        return float(self.orbit.grid.left[j] + begin * self.orbit.grid.width[j])

    def _tied(self, switch: int) -> dict[int, float]:
        """Phases of a switch's event nodes, by the intervals that begin there."""
        orbit = self.orbit
        each = zip(orbit.mesh.starts, self._directions(switch), orbit.phases, strict=True)
        return {int(j): float(phase) for j, direction, phase in each if direction}

    def _directions(self, switch: int) -> list[int]:
        """The side to which a switch passes at each event node; 0 where it does not pass its level.

        It also passes at the nodes of other switches that are equal to it.
        """
        known = self._known.directions
        if switch not in known:
            known[switch] = self._directions_of(switch)
        return known[switch]

    def _directions_of(self, switch: int) -> list[int]:
        values, found = self.knots[:, :, switch], []
        surface = surface_of(self.system, switch)
        near = AT_LEVEL * float(np.abs(values).max())
        for j, event in zip(self.orbit.mesh.starts, self.orbit.mesh.events, strict=True):
            before, after = values[j - 1, -2], values[j, 1]
            shared = abs(values[j, 0]) <= near and before * after < 0
            other = int(np.sign(after)) if shared else 0
            found.append(mode_after(surface, event) or (event.direction if event.switch == switch else other))
        return found

    def expected(self, switch: int, otherwise: int) -> NDArray[np.int_]:
        """Side of a switch in each interval by the modes of its surface, `otherwise` without event nodes.

        For an impact it is the side of the motion, for a relay its mode. The guard of a surface has side 0 in
        intervals where the motion is held there, its releases have side 0 in all others.
        """
        mesh, surface = self.orbit.mesh, surface_of(self.system, switch)
        if surface.releases is not None:
            return self._held(switch, surface, otherwise)
        if surface.kind == Kind.RELAY and surface.column is not None:
            return self.modes[:, surface.column].astype(int)
        if surface.kind == Kind.IMPACT and switch == surface.leaves:
            return np.where(self._resting(surface), -1, 0)
        if surface.kind == Kind.IMPACT:
            return np.full(mesh.ntst, -self.system.switches[switch].direction)
        own = [(j, d) for j, d in zip(mesh.starts, self._directions(switch), strict=True) if d]
        sides = np.full(mesh.ntst, otherwise if not own else own[-1][1])
        for start, direction in own:
            sides[start:] = direction
        return sides

    def _resting(self, surface: SurfaceLike) -> NDArray[np.bool_]:
        """In which intervals something rests on a wall."""
        if surface.column is None:
            return np.zeros(self.orbit.mesh.ntst, dtype=bool)
        return self.modes[:, surface.column] == STUCK

    def _held(self, switch: int, surface: SurfaceLike, otherwise: int) -> NDArray[np.int_]:
        assert surface.releases is not None and surface.column is not None
        mode = self.modes[:, surface.column].astype(int)
        held = (mode == STUCK) | (mode == HELD)
        if switch == surface.switch:
            return np.where(held, 0, np.where(mode == 0, otherwise, mode))
        return np.where(held, -1 if switch == surface.releases[0] else 1, 0)

    def size(self, switch: int) -> float:
        """How far the states take a switch: the largest s_x . x along the orbit."""
        orbit = self.orbit
        states, tau = orbit.stages.reshape(-1, orbit.stages.shape[2]), orbit.stage_phases.ravel()
        side = np.repeat(self.modes, orbit.mesh.scheme.ncol, axis=0)
        slope = guards_gradient(self.system, states, tau, orbit.parameter, side)[0][:, switch]
        return float(np.abs(np.einsum("pn,pn->p", slope, states)).max())

    def flat(self, switch: int, part: float) -> bool:
        """Whether a switch varies along the orbit by less than a part of its size."""
        return float(np.ptp(self.knots[:, :, switch])) < part * self.size(switch)

    def side(self, switch: int) -> int:
        """The side of its level on which a switch goes farthest."""
        values = np.nan_to_num(self.knots[:, :, switch])
        return int(np.sign(values.flat[np.abs(values).argmax()])) or 1

    def unmarked(self, switch: int, otherwise: int) -> list[Extremum]:
        """Return the farthest point of each excursion past the level that has no event nodes.

        `otherwise` is the side on which a switch without event nodes is taken to be. An excursion that begins
        or ends at an event node is left out: there the node is not yet, or not quite, at the crossing.
        """
        expected = self.expected(switch, otherwise)
        if self._bounded(switch, expected):
            return []
        along = self.along(switch)
        wrong = along.sides * expected[along.interval] < 0
        if not wrong.any():
            return []
        at_nodes = np.zeros(len(wrong), dtype=bool)
        for j in self._ends(switch):
            first = int(np.searchsorted(along.interval, j))
            at_nodes[[first, first - 1]] = True
        if surface_of(self.system, switch).kind == Kind.IMPACT:
            wrong |= at_nodes  # there it is at its level, and goes past it from there on if the impact ends
        shift = 0 if wrong.all() else int(np.flatnonzero(~wrong)[0])
        order = np.roll(np.arange(len(wrong)), -shift)
        runs = np.split(order, np.flatnonzero(np.diff(wrong[order].astype(int))) + 1)
        held = surface_of(self.system, switch).releases is not None
        attached = self._attached if held else self._beginning
        apart = [run for run in runs if wrong[run[0]] and not attached(along, run, at_nodes)]
        farthest = [run[np.abs(along.value[run]).argmax()] for run in apart]
        found = [along.extremum(switch, int(i)) for i in farthest]
        noise = NOISE * float(np.abs(along.value).max())
        return [e for e in found if np.sign(e.value) * self.value(e) > noise]

    def _bounded(self, switch: int, side: NDArray[np.int_]) -> bool:
        """Whether Bernstein coefficients show a switch on a side (N,) in each interval, within rounding."""
        values = self.knots[:, :, switch]
        coefficients = values @ _bernstein(self.orbit.mesh.scheme).T
        least = (coefficients * side[:, None]).min()
        return bool(least >= -NOISE * np.abs(values).max())

    def _beginning(self, along: Along, run: NDArray[np.int_], at_nodes: NDArray[np.bool_]) -> bool:
        """Whether an excursion begins or ends at an event node of the switch that is not at its crossing."""
        return bool(at_nodes[run].any())

    def _attached(self, along: Along, run: NDArray[np.int_], at_nodes: NDArray[np.bool_]) -> bool:
        """As `_beginning`, or whether it is so brief beside an event node as slow crossings are uncertain."""
        if self._beginning(along, run, at_nodes):
            return True
        at_level = at_nodes & (along.sides == 0)
        beside = at_level[(run[0] - 1) % len(at_level)] or at_level[(run[-1] + 1) % len(at_level)]
        return bool(
            beside
            and np.mod(along.phase[run[-1]] - along.phase[run[0]], self.orbit.mesh.period) < SLOW_CROSSING
        )

    def _ends(self, switch: int) -> list[int]:
        """The intervals that begin at an event node of a switch, or of the surface that it belongs to."""
        surface = surface_of(self.system, switch)
        if surface.leaves is not None:
            left = [
                j
                for j, e in enumerate(self.orbit.mesh.events)
                if e.switch in (surface.switch, surface.leaves)
            ]
            return [int(self.orbit.mesh.starts[j]) for j in left]
        jump = sliding(self.system, switch)
        if jump is None:
            return list(self._tied(switch))
        own = group(self.system, self.orbit.mesh, jump)
        if switch != jump:
            own = [i for i in own if not torn(self.system, surface, self.orbit.mesh.events[i])]
        own += thrown(self.system, self.orbit, surface_of(self.system, jump))
        return [int(self.orbit.mesh.starts[i]) for i in own]

    def value(self, at: Extremum) -> float:
        """Return the switch itself at a point, not the polynomial through its values at the knots."""
        state = self.orbit.mesh.scheme.basis(np.array([at.theta])) @ self.orbit.knots[at.interval]
        side = self.modes[at.interval : at.interval + 1]
        found = guards(self.system, state, np.array([at.phase]), self.orbit.parameter, side)
        return float(found[0, at.switch])

    def nearest(self, switch: int, side: int, phase: float) -> Extremum:
        """Return the minimum of side * s nearest to a phase. Raises FloatingPointError where there is none.

        Polynomials of neighbouring intervals join with a small kink, which may split one minimum into several
        within about an interval: the lowest of these is returned, none beyond an event node of the switch.
        """
        own = sorted(self._tied(switch))

        def between_nodes(e: Extremum) -> int:
            return int(np.searchsorted(own, e.interval, side="right")) % max(len(own), 1)

        def far(e: Extremum, place: float) -> float:
            return abs(wrapped(e.phase - place, self.orbit.mesh.period))

        every = self.minima(switch, side)
        if not every:
            name = self.system.switches[switch].name
            raise FloatingPointError(f"{name} comes nearest to its level nowhere but at its impacts")
        first = min(every, key=lambda e: far(e, phase))
        width, same = (
            abs(self.orbit.grid.width[first.interval]),  # of a guess it may be negative
            [e for e in every if between_nodes(e) == between_nodes(first)],
        )
        return min((e for e in same if far(e, first.phase) <= width), key=lambda e: side * e.value)

    def minima(self, switch: int, side: int) -> list[Extremum]:
        """Return all minima of side * s but at impacts; of relays and held surfaces on that side alone."""
        along = self.along(switch, everywhere=True)
        points = np.flatnonzero(along.theta < 1.0)  # an interval's end is the beginning of the next
        value = side * along.value[points]
        before, after = np.roll(value, 1), np.roll(value, -1)
        low = points[(value <= before) & (value <= after)]
        if surface_of(self.system, switch).kind == Kind.IMPACT:
            impacts = [
                j
                for j, e in zip(self.orbit.mesh.starts, self.orbit.mesh.events, strict=True)
                if e.switch == switch
            ]
            low = low[~(np.isin(along.interval[low], impacts) & (along.theta[low] == 0.0))]
            low = low[~self.at_rest(along, switch)[low]]
        if sliding(self.system, switch) is not None or switch in relays(self.system):
            at_node = np.isin(along.interval[low], self._ends(switch)) & (along.theta[low] == 0.0)
            there = self.expected(switch, side)[along.interval[low]] == side
            low = low[there & ~at_node]
        return [along.extremum(switch, int(i)) for i in low]

    def at_rest(self, along: Along, switch: int) -> NDArray[np.bool_]:
        """Which points along an impact's switch are at rest on the wall, or where something leaves it.

        The distance grows from 0 as slowly as t^3: in the first interval, values below SHALLOW times the one
        at its end are the polynomial's error.
        """
        resting = self._resting(surface_of(self.system, switch))
        left = resting[along.interval - 1] & ~resting[along.interval]
        rises = np.abs(self.knots[along.interval, -1, switch])
        return np.asarray(resting[along.interval] | (left & (np.abs(along.value) <= SHALLOW * rises)))


def _changing(coefficients: Array) -> NDArray[np.bool_]:
    """Where polynomials may have a zero inside their interval, by their Bernstein coefficients."""
    return (coefficients.max(axis=1) > 0) & (coefficients.min(axis=1) < 0)


@cache
def _bernstein(scheme: Scheme) -> Array:
    """Bernstein coefficients of the polynomial through values at the knots: a matrix (ncol+1, ncol+1)."""
    degree, x = scheme.ncol, scheme.knots[:, None]
    each = np.arange(degree + 1)
    polynomials = scipy.special.comb(degree, each) * x**each * (1 - x) ** (degree - each)
    return np.linalg.inv(polynomials).astype(float, copy=False)


@cache
def _monomial(scheme: Scheme) -> Array:
    """Matrix from values at the knots to the derivative's coefficients of powers of theta, lowest first."""
    powers = np.linalg.inv(np.vander(scheme.knots, increasing=True))
    return (powers[1:] * np.arange(1, scheme.ncol + 1)[:, None]).astype(float, copy=False)


def _stationary(scheme: Scheme, values: Array) -> tuple[NDArray[np.int_], Array]:
    """Zeros inside (0, 1) of the derivatives of polynomials through values at the knots (K, ncol+1).

    Returns which polynomial each belongs to, and the zeros themselves.
    """
    roots = _roots(values @ _monomial(scheme).T)
    inside = (np.abs(roots.imag) < AT_EXTREMUM) & (roots.real > 0) & (roots.real < 1)
    return np.nonzero(inside)[0], roots.real[inside]


def _roots(coefficients: Array) -> NDArray[np.complex128]:
    """Roots of polynomials with such coefficients (K, degree+1), lowest first: (K, degree), NaN where fewer.

    They are the eigenvalues of companion matrices, all at once.
    """
    count, most = coefficients.shape
    degree = (np.arange(most) * (coefficients != 0)).max(axis=1, initial=0)
    found = np.full((count, most - 1), np.nan, dtype=np.complex128)
    for d in set(degree.tolist()) - {0}:
        own = coefficients[degree == d, : d + 1]
        companion = np.tile(np.eye(d, k=1), (len(own), 1, 1))
        companion[:, :, 0] -= (own[:, :-1] / own[:, -1:])[:, ::-1]
        found[degree == d, :d] = np.linalg.eigvals(companion)
    return found
