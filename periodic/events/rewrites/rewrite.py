"""Rewrites: changes of the word of an orbit, at one site or at several at once.

An excursion of depth d past a level has the size c d^power. Where the power is less than 1, the size has no
derivative in the parameter at d = 0. Without the excursion the orbit is a smooth function of the parameter,
with it a smooth function of the size. So a branch is followed without the excursion up to where it begins,
and with it from a small size on; in the other direction likewise.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from periodic.correction.change import Beyond, Change
from periodic.correction.condition import SideCondition
from periodic.events.heldalong import all_along, still
from periodic.events.modes import inconsistency, releases, sliding
from periodic.events.rewrites.ends import Excursion, ends, excursions
from periodic.events.rewrites.grazingonsets import at_once
from periodic.events.rewrites.sites import Site, edited, has, in_order, index_of, ordered
from periodic.events.rewrites.table import CORNER, GRAZING, GRAZING_SLIDING, IMPACT, RELAY
from periodic.events.rewrites.together import together
from periodic.events.sideconditions import Clearance, Length, Lengths, Limit, Speed
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import ALIKE, AT_LEVEL, BESIDE_EXTREMUM, VANISHING
from periodic.events.twinguards import held_throughout
from periodic.events.violations import largest
from periodic.orbit.mesh import MIN_INTERVALS, EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.refinement.equidistribution import density, redistribute, spread
from periodic.system import System
from periodic.system.precision import CONVERGED


@dataclass(frozen=True)
class Begins:
    """An excursion, or another part of the word, begins: beyond, orbits without it violate their word.

    otherwise: the change to try where no orbit is found at which this one begins.
    """

    system: System
    site: Site
    part: float
    shortest: float
    otherwise: Change | None = None

    strict = True
    final = True
    nearer = False

    @property
    def grazes(self) -> bool:
        """Whether a switch grazes its level."""
        return self.site.row.grazes

    @property
    def last(self) -> bool:
        """Whether the branch ends there."""
        return self.site.row.last

    @property
    def condition(self) -> SideCondition:
        """The side condition that holds where it begins."""
        return self.site.held

    @property
    def name(self) -> str:
        """What begins, in words."""
        surface = self.system.switches[self.site.switch].name
        if self.site.row is RELAY:
            return f"{surface} grazes the threshold at which it would switch"
        jump = sliding(self.system, self.site.switch)
        if jump is None or self.site.row is GRAZING_SLIDING:
            return f"{surface} is grazed"
        name = self.system.switches[jump].name
        if isinstance(self.site.at, int):
            return f"a stop at {name} begins or is broken"
        return f"a slip begins while {name} holds"

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield ways on with a small excursion, and with those that begin at once elsewhere by symmetry."""
        sites = [] if self.last else at_once(system, orbit, self.site)
        if not sites:
            return
        row, choices = sites[0].row, self._choices(system, orbit, sites)
        for size in (*row.sizes, *row.spare):
            for chosen in choices:
                events, phases = rewritten(system, orbit, chosen, size)
                node = chosen[0].begin(orbit, size)
                if inconsistency(system, events) or not has(events, phases, node, orbit):
                    continue
                mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
                mesh = replace(mesh, modes=still(system, orbit.mesh.modes, events))
                begin = index_of(events, phases, node, orbit)
                held = self._held(system, orbit, begin, size)
                yield Beyond(mesh, phases, held, grazes=False, spare=size in row.spare)

    def _choices(self, system: System, orbit: Orbit, sites: list[Site]) -> list[list[Site]]:
        """Sites that begin at once, the first alone, and with those that the orbit's error parts from it."""
        alike = at_once(system, orbit, self.site, ALIKE) if self.site.row is GRAZING else sites
        by_size = {len(each): each for each in (alike, sites[:1], sites)}
        return [by_size[count] for count in dict.fromkeys((len(sites), 1, len(alike)))]

    def _held(self, system: System, orbit: Orbit, begin: int, size: float) -> SideCondition:
        """The side condition that keeps the excursion at a size."""
        if self.site.row is IMPACT:
            dense = SwitchPolynomials(system, orbit)
            return Speed(begin, size * float(np.abs(dense.knots[:, :, self.site.switch]).max()))
        return Length(begin, size)


@dataclass(frozen=True)
class Ends:
    """An excursion, or another part of the word, becomes as small as `size`: beyond, it is gone.

    final: whether no smaller size is tried. strict: whether the branch is not followed beyond with it.
    """

    system: System
    excursion: Excursion
    site: Site
    size: float
    final: bool
    strict: bool
    part: float
    shortest: float
    name: str

    otherwise = None

    @property
    def grazes(self) -> bool:
        """Whether a switch grazes its level."""
        return self.last

    @property
    def nearer(self) -> bool:
        """Whether it is smaller than any size at which words are exchanged."""
        return self.size < self.site.row.least * self.excursion.unit * (1 - CONVERGED)

    @property
    def last(self) -> bool:
        """Whether the branch ends there."""
        return self.site.row.last

    @property
    def condition(self) -> SideCondition:
        """The side condition that keeps it at `size`."""
        return self.excursion.held(self.size)

    def beyond(self, system: System, orbit: Orbit) -> Iterator[Beyond]:
        """Yield ways on without it, and without those that are as small elsewhere by symmetry."""
        if self.last:
            return
        for own in ends(system, orbit, self.excursion):
            sites = self._alike(system, orbit, own)
            for chosen in (sites, [own])[: 2 if len(sites) > 1 else 1]:
                events, phases = rewritten(system, orbit, chosen, self.size)
                if inconsistency(system, events):
                    continue
                mesh = self._mesh(orbit, events, phases)
                held = self._held(system, orbit, own, events, phases)
                modes, parameter = all_along(system, orbit, events)
                mesh = replace(mesh, modes=modes)
                yield Beyond(mesh, phases, held, own.row.grazes, parameter=parameter)

    def _alike(self, system: System, orbit: Orbit, own: Site) -> list[Site]:
        """The sites of excursions of the same row that are as small as this one."""
        found = [own]
        for other in excursions(system, orbit):
            if other.row is own.row and abs(other.size(system, orbit) / self.size - 1) < BESIDE_EXTREMUM:
                (site, *_), gone = ends(system, orbit, other), {j for each in found for j in _changed(each)}
                found += [site] if not gone & set(_changed(site)) else []
        return found

    def _mesh(self, orbit: Orbit, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The mesh without it; derivatives within excursions that end are rounding, and do not count."""
        if self.site.row not in (GRAZING, CORNER):
            return redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        gone = MIN_INTERVALS * (len(orbit.mesh.events) - len(events)) // 2
        wanted = np.where(self._brief(orbit), 0.0, density(orbit))
        wanted *= (orbit.mesh.ntst - gone) / float(wanted @ orbit.grid.width)
        return spread(orbit, wanted, events, phases, self.shortest)

    def _brief(self, orbit: Orbit) -> NDArray[np.bool_]:
        """Which intervals are those of excursions about as short as this one."""
        brief = orbit.mesh.segment_lengths(orbit.phases) < self.size / VANISHING
        return np.repeat(brief, [len(breaks) - 1 for breaks in orbit.mesh.breaks])

    def _held(
        self, system: System, orbit: Orbit, own: Site, events: tuple[EventNode, ...], phases: Array
    ) -> SideCondition:
        """The side condition where it ends, short of a level so far that rounding does not decide."""
        held = own.held
        if isinstance(held, Length | Lengths):
            return Length(index_of(events, phases, own.begin(orbit, self.size), orbit), self.size)
        jump = sliding(system, own.switch)
        if jump is not None and own.row is not GRAZING_SLIDING:
            left = AT_LEVEL * largest(SwitchPolynomials(system, orbit), *releases(system, jump))
            assert isinstance(held, Clearance | Limit)
            held = replace(held, level=left)
        if isinstance(held, Limit):
            changed = dict(own.replaced)
            event = changed.get(held.node, orbit.mesh.events[held.node])
            pair = event, float(orbit.phases[held.node])
            held = replace(held, node=index_of(events, phases, pair, orbit))
        return held


def rewritten(
    system: System, orbit: Orbit, sites: Sequence[Site], size: float
) -> tuple[tuple[EventNode, ...], Array]:
    """Return event nodes and phases of an orbit after the edits at some sites, in order."""
    nodes = in_order(edited(orbit, sites, size), orbit)
    modes = still(system, orbit.mesh.modes, tuple(event for event, _ in nodes))
    return ordered(together(system, nodes, size, held_throughout(system, modes)), orbit)


def _changed(site: Site) -> Sequence[int]:
    return (*site.removed, *(j for j, _ in site.replaced))
