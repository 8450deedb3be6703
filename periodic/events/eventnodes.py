"""Which kinks of an orbit the mesh should be tied to.

A switch crosses a level in pairs: during an excursion it is below the level. The deepest of a switch's levels
that it crosses steeply marks the kink; deeper levels are reached only after the kink. Excursions, and returns
from them, that are shorter than a threshold get no event nodes, as they are too weak to matter: an event node
tied to a crossing that is about to vanish would turn the continuation back on itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from periodic.checks import at_least_0, number
from periodic.events import impacts
from periodic.events.impactmodes import brought_about
from periodic.events.modes import bends, relays, surface_of
from periodic.events.relaycrossings import switched
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import SAME_PHASE
from periodic.orbit.mesh import EventNode, wrapped
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.system import Kind, System, surfaces_of

DEEPEST = 0.1
"""Least positive switch level that gets event nodes, in tolerances."""


MILD = 0.1
"""Length of excursions past the kink of a derivative, over those past a kink of the equations themselves."""


@dataclass(frozen=True)
class Crossing:
    """A crossing of a level by a switch along an orbit.

    slope: the smaller of |ds/dtau| at the collocation points before and after it.
    """

    event: EventNode
    phase: float
    slope: float


@dataclass(frozen=True, kw_only=True)
class KinkSettings:
    """When a crossing of a level by a switch gets an event node.

    Parameters
    ----------
    appear, vanish : float
        Shortest excursion (rad) that gets new event nodes, and below which present ones go.
    deepest : float, optional
        Levels of a switch between 0 and this are not used; below the accuracy of the states themselves a
        level has no meaning. Default a tenth of the tolerance.
    exchange : float
        How many times deeper another level must be to replace the one in use.
    steep : float
        Least slope of a crossing, as a part of the slope at the shallowest level.

    Raises
    ------
    ValueError
        For numbers that are not allowed, in one sentence.
    """

    appear: float = 0.10
    vanish: float = 0.05
    deepest: float | None = None
    exchange: float = 5.0
    steep: float = 0.25

    def __post_init__(self) -> None:
        if not 0 < number("vanish", self.vanish) <= number("appear", self.appear):
            raise ValueError(
                f"vanish is {self.vanish}; it must be positive and at most appear = {self.appear}"
            )
        if self.deepest is not None:
            at_least_0("deepest", self.deepest)
        if not 1 <= number("exchange", self.exchange) < np.inf:
            raise ValueError(f"exchange is {self.exchange}; it must be a number of at least 1")
        if not 0 <= number("steep", self.steep) <= 1:
            raise ValueError(f"steep is {self.steep}; it must lie between 0 and 1")

    def beside(self, level: float) -> KinkSettings:
        """Return the settings for a level.

        Parameters
        ----------
        level : float
            A negative level marks the kink of a derivative of the equations. Such a kink is mild: its event
            nodes appear and vanish with excursions a tenth as long.

        Returns
        -------
        KinkSettings
            With `appear` and `vanish` for the level.
        """
        return replace(self, appear=MILD * self.appear, vanish=MILD * self.vanish) if level < 0 else self

    def at(self, tolerance: float) -> KinkSettings:
        """Return the settings for a tolerance of the orbits.

        Parameters
        ----------
        tolerance : float
            Bound of their error estimates.

        Returns
        -------
        KinkSettings
            With `deepest` chosen, where it was None.
        """
        return replace(self, deepest=DEEPEST * tolerance) if self.deepest is None else self


def exact_crossings(system: System, orbit: Orbit) -> list[Crossing]:
    """Return all crossings, on the whole orbit, by the switches at whose level the equations change.

    Of several crossings at one phase, as of equal switches, only the first switch's is returned.
    """
    dense, found = SwitchPolynomials(system, orbit), list[Crossing]()
    for k in bends(system):
        pairs = switched(system, orbit, k) if k in relays(system) else dense.crossings(k)
        new = [Crossing(*pair, 0.0) for pair in pairs]
        found += [
            c
            for c in new
            if all(abs(wrapped(c.phase - f.phase, orbit.mesh.period)) > SAME_PHASE for f in found)
        ]
    return found


def crossings(system: System, orbit: Orbit) -> list[Crossing]:
    """Return all crossings of all levels by their switches, in order of phase for each level.

    Signs are read at the collocation points alone: only there do the states fulfil the equations exactly,
    and a switch with several levels may stay far closer to one than the interpolation error between them.
    Phases are interpolated linearly.
    """
    tau, flat = orbit.stage_phases.ravel(), (-1, orbit.stages.shape[2])
    state = orbit.stages.reshape(flat)
    values = system.switch(state, tau, orbit.parameter)
    d_state, d_phase, _ = system.switch_gradient(state, tau, orbit.parameter)
    slopes = np.abs(d_phase + np.einsum("tkn,tn->tk", d_state, orbit.knot_rates[:, 1:].reshape(flat)))
    _tied(orbit, values)
    tau = np.append(tau, tau[0] + orbit.mesh.period)
    values, slopes = (np.concatenate([a, a[:1]]) for a in (values, slopes))
    found = []
    elsewhere = _elsewhere(system)
    for k, switch in enumerate(system.switches):
        if k in elsewhere:
            continue
        above = values[:, k, None] > np.array(switch.levels)
        for i, j in np.argwhere(above[1:] != above[:-1]):
            level = switch.levels[j]
            begin, end = values[i, k] - level, values[i + 1, k] - level
            phase = tau[i] + (tau[i + 1] - tau[i]) * begin / (begin - end)
            event = EventNode(k, 1 if end > begin else -1, level)
            found.append(Crossing(event, float(phase), float(slopes[i : i + 2, k].min())))
    return found


def _tied(orbit: Orbit, values: Array) -> None:
    """Set switches (N ncol, s) exactly to their levels at event nodes, so that rounding decides no side."""
    mesh = orbit.mesh
    if mesh.events and mesh.scheme.points[-1] == 1.0:
        last = mesh.starts * mesh.scheme.ncol - 1  # of the first event node the last point of the period
        values[last, [event.switch for event in mesh.events]] = [event.level for event in mesh.events]


def _elsewhere(system: System) -> set[int]:
    """The switches of impacts, of relays and of surfaces at which motions may be held."""
    kinds = (Kind.IMPACT, Kind.RELAY)
    special = [s for s in surfaces_of(system) if s.kind in kinds or s.releases is not None]
    found = {k for s in special for k in (s.switch, s.leaves, *(s.releases or ()))}
    return {k for k in found if k is not None}


def wanted(system: System, orbit: Orbit, settings: KinkSettings) -> list[Crossing]:
    """Return the crossings to which the orbit's mesh should be tied, in order of phase."""
    if not system.switches:
        return []
    sharp, chosen = bends(system), list[Crossing]()
    blunt = [(k, switch) for k, switch in enumerate(system.switches) if k not in sharp]
    found = crossings(system, orbit) if blunt else []
    for k, switch in blunt:
        levels = [v for v in switch.levels if not 0 < v < (settings.deepest or 0.0)]
        kept = [
            _merged(
                [c for c in found if c.event.switch == k and c.event.level == level],
                orbit,
                settings.beside(level),
            )
            for level in levels
        ]
        directions = (switch.direction,) if switch.direction else (-1, 1)
        for excursion in _excursions(kept[0]) if kept else []:
            chosen += [_kink(kept, excursion, d, orbit, settings) for d in directions]
    chosen = _apart(sorted(chosen, key=_phase), orbit, settings)
    others = (*_impacts(system, orbit), *_held(system, orbit))
    begin = orbit.grid.left[0]
    tied = [Crossing(e, begin + (tau - begin) % orbit.mesh.period, slope) for e, tau, slope in others]
    return sorted([*chosen, *tied, *exact_crossings(system, orbit)], key=_phase)


def _impacts(system: System, orbit: Orbit) -> list[tuple[EventNode, float, float]]:
    """Event, phase and |ds/dtau| of an orbit's impacts, with the modes that the impacts cause."""
    found = []
    for i in impacts.tied(system, orbit):
        event = replace(orbit.mesh.events[i], modes=brought_about(system, orbit, i))
        found.append((event, float(orbit.phases[i]), abs(impacts.slope_before(system, orbit, i))))
    return found


def _held(system: System, orbit: Orbit) -> list[tuple[EventNode, float, float]]:
    """An orbit's event nodes at surfaces that hold motions, and at departures from walls, unchanged."""
    found = []
    for event, phase in zip(orbit.mesh.events, orbit.phases, strict=True):
        surface = surface_of(system, event.switch)
        if surface.releases is not None or event.switch == surface.leaves:
            found.append((event, float(phase), 1.0))
    return found


def _phase(crossing: Crossing) -> float:
    return crossing.phase


def _apart(chosen: list[Crossing], orbit: Orbit, settings: KinkSettings) -> list[Crossing]:
    """Drop crossings that lie closer than the threshold to the one before: event nodes cannot coincide."""
    kept: list[Crossing] = []
    for crossing in chosen:
        ends = [kept[-1].phase, kept[0].phase + orbit.mesh.period] if kept else []
        own = settings.beside(crossing.event.level)
        limit = own.vanish if _is_tied(crossing, orbit) else own.appear
        if all(abs(crossing.phase - end) >= limit for end in ends):
            kept.append(crossing)
    return kept


def _kink(
    kept: list[list[Crossing]],
    excursion: tuple[Crossing, Crossing],
    direction: int,
    orbit: Orbit,
    settings: KinkSettings,
) -> Crossing:
    """The crossing within an excursion that marks the kink at its beginning (-1) or end (+1)."""
    edge = excursion[0] if direction < 0 else excursion[1]
    candidates = []
    for level in kept:
        inside = [
            c for c in level if c.event.direction == direction and _inside(c, excursion, orbit.mesh.period)
        ]
        candidates += sorted(inside, key=lambda c: abs(wrapped(c.phase - edge.phase, orbit.mesh.period)))[:1]
    steep = [c for c in candidates if c.slope >= settings.steep * edge.slope]
    deepest = min(steep, key=lambda c: c.event.level)
    reach = settings.exchange * deepest.event.level
    used = [c for c in steep if _is_tied(c, orbit) and c.event.level <= reach]
    return used[0] if used else deepest


def _excursions(kept: list[Crossing]) -> list[tuple[Crossing, Crossing]]:
    """Pair the crossings of one level: each falling one with the rising one that follows."""
    falling = [i for i, c in enumerate(kept) if c.event.direction < 0]
    return [(kept[i], kept[(i + 1) % len(kept)]) for i in falling]


def _inside(crossing: Crossing, excursion: tuple[Crossing, Crossing], period: float) -> bool:
    begin, end = excursion[0].phase, excursion[1].phase
    return bool(
        np.mod(crossing.phase - begin + SAME_PHASE, period) <= np.mod(end - begin, period) + 2 * SAME_PHASE
    )


def _merged(found: list[Crossing], orbit: Orbit, settings: KinkSettings) -> list[Crossing]:
    """Drop pairs of neighbouring crossings that lie closer than the threshold."""
    kept = list(found)
    while len(kept) >= 2:
        phases = np.array([c.phase for c in kept])
        gaps = np.diff(np.append(phases, phases[0] + orbit.mesh.period))
        limits = np.array(
            [_limit(kept[i], kept[(i + 1) % len(kept)], orbit, settings) for i in range(len(kept))]
        )
        short = int(np.argmin(gaps / limits))
        if gaps[short] >= limits[short]:
            break
        drop = {short, (short + 1) % len(kept)}
        kept = [c for i, c in enumerate(kept) if i not in drop]
    return kept


def _limit(a: Crossing, b: Crossing, orbit: Orbit, settings: KinkSettings) -> float:
    return settings.vanish if _is_tied(a, orbit) or _is_tied(b, orbit) else settings.appear


def _is_tied(crossing: Crossing, orbit: Orbit) -> bool:
    return match(crossing, orbit) is not None


def match(crossing: Crossing, orbit: Orbit, tolerance: float = 0.02) -> int | None:
    """Return the index of the orbit's event node that is this crossing, if one is."""
    both = zip(orbit.mesh.events, orbit.phases, strict=True)
    apart = [
        abs(wrapped(crossing.phase - phase, orbit.mesh.period)) if event == crossing.event else np.inf
        for event, phase in both
    ]
    nearest = int(np.argmin(apart)) if apart else 0
    return nearest if apart and apart[nearest] < tolerance else None


def fits(chosen: list[Crossing], orbit: Orbit) -> bool:
    """Whether the orbit's mesh is tied to exactly these crossings."""
    matched = [match(c, orbit) for c in chosen]
    return None not in matched and len(chosen) == len(orbit.phases)


def placed(system: System, orbit: Orbit, chosen: list[Crossing]) -> tuple[tuple[EventNode, ...], Array]:
    """Return event nodes and exact phases of crossings for a new mesh, the first phase in [0, period)."""
    phases = np.array([_exact(system, orbit, c) for c in chosen])
    period = orbit.mesh.period
    return tuple(c.event for c in chosen), phases - period * np.floor(phases[:1] / period)


def _exact(system: System, orbit: Orbit, crossing: Crossing) -> float:
    """The phase of a crossing: the event node's own where the mesh is tied to it, else on the polynomial."""
    index = match(crossing, orbit)
    if index is not None:
        turns = np.round((crossing.phase - orbit.phases[index]) / orbit.mesh.period)
        return float(orbit.phases[index] + turns * orbit.mesh.period)

    if crossing.event.switch in _elsewhere(system):
        return crossing.phase

    def value(tau: float) -> float:
        at = np.array([tau])
        switch = system.switch(orbit.state(at), at, orbit.parameter)[0, crossing.event.switch]
        return float(switch) - crossing.event.level

    reach = orbit.grid.width[orbit.locate(np.array([crossing.phase]))[0][0]]
    begin, end = crossing.phase - reach, crossing.phase + reach
    if value(begin) * value(end) >= 0:
        return crossing.phase
    return float(scipy.optimize.brentq(value, begin, end, xtol=1e-13))
