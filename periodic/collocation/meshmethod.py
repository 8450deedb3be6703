"""Collocation on meshes tied to the events of the motion, whatever the unknowns are: settings and events.

Its subclasses are `Collocation`, with all states as unknowns, and `CondensedCollocation`, in which a
linear part has the states at its places alone.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from periodic.checks import whole
from periodic.collocation.elimination import elimination
from periodic.collocation.fastmotions.substeps import SteppedCorrection
from periodic.collocation.local import relax
from periodic.correction.change import Change
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import ErrorEstimate
from periodic.correction.newton import Correction
from periodic.correction.outcome import FAILURES, Outcome
from periodic.events import eventnodes, motions
from periodic.events.eventnodes import KinkSettings
from periodic.events.modes import completed, group, of_held, of_kind, relays
from periodic.events.relaycrossings import switched
from periodic.events.rewrites.first import ENDS_BELOW, first_change
from periodic.events.rewrites.permuted import permuted
from periodic.events.rewrites.sites import Node
from periodic.events.violations import Breach, Violation, refusals, violations, word
from periodic.linear.operator import LinearSolver
from periodic.linear.variation import Variations
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.orbit.shallow import shallow
from periodic.refinement.equidistribution import redistribute
from periodic.system import Kind, System

DEGREES = {1e-2: 3, 1e-4: 4, 1e-6: 5, 1e-9: 6, 1e-11: 7}
"""Number of collocation points in each interval, down to a tolerance."""

WRONG = {
    Breach.GRAZED: Outcome.GRAZING,
    Breach.THROUGH: Outcome.THROUGH_STOP,
    Breach.HELD: Outcome.SLIDES,
    Breach.REVERSED: Outcome.EVENTS_CROSSED,
}
"""Outcome of an orbit that violates its word (see `periodic.events.modes`), the first that applies."""


@dataclass(frozen=True, kw_only=True)
class MeshMethod(Discretisation):
    """A piecewise polynomial in each of ntst intervals, event nodes where the equations change.

    Settings are fields, as `Collocation` describes them.
    """

    scheme: Scheme | None = None
    ntst: int = 24
    ntst_min: int = 8
    ntst_max: int = 1000
    kinks: KinkSettings | None = None
    solver: LinearSolver = elimination
    condense: bool | None = None
    tolerance: float = 1e-7

    ends_below: ClassVar[float] = ENDS_BELOW
    """Length (rad) of an excursion below which a grazing predicted within it may be the end of it."""

    all_states: ClassVar[bool] = True
    """Whether mesh points hold all states, so that each interval alone gives the map across it."""

    def __post_init__(self) -> None:
        if not (self.condense is None or isinstance(self.condense, bool)):
            raise ValueError(f"condense is {self.condense!r}; it must be True, False or None")
        check_intervals(self.ntst, self.ntst_min, self.ntst_max)
        check_scheme(self.scheme)
        if self.kinks is not None and not isinstance(self.kinks, KinkSettings):
            raise ValueError(f"kinks is {self.kinks!r}; it must be KinkSettings(...)")
        if not callable(self.solver):
            raise ValueError(f"solver is {self.solver!r}; it must be a function that makes an Operator")

    @property
    def shortest(self) -> float:
        """Width (rad) below which no interval is halved: what happens within it is below the tolerance."""
        return 0.005 * self.tolerance

    @abstractmethod
    def _scheme_at(self, tolerance: float) -> Scheme:
        """The scheme for a tolerance, where none is chosen."""

    def at(self, tolerance: float) -> Self:
        """Return the method for a tolerance: scheme and least event level, where left open, and meshes."""
        return replace(
            self,
            scheme=self.scheme or self._scheme_at(tolerance),
            kinks=(self.kinks or KinkSettings()).at(tolerance),
            tolerance=tolerance,
        )

    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the orbit at rest, or one carried to this scheme, its hard intervals solved locally."""
        scheme = self.scheme or Scheme()
        if near is None:
            return at_rest(system, uniform(scheme, self.ntst), parameter)
        if near.equilibrium:
            near = transfer(near, uniform(scheme, self.ntst), near.phases)
        near = replace(near, parameter=parameter, equilibrium=False)
        near = self._with_relays(system, self._with_sticking(system, near))
        old = near.mesh
        mesh = Mesh(scheme, old.breaks, completed(system, old.events), old.period, old.modes)
        return relax(system, transfer(near, mesh, near.phases))

    @staticmethod
    def _with_sticking(system: System, orbit: Orbit) -> Orbit:
        """The orbit, or where its mesh says nothing of sticking the motion as integrated in time from it.

        That has event nodes where it sticks and slips, which Newton needs.
        """
        held, mesh = of_held(system), orbit.mesh
        if not held or any(group(system, mesh, k) or k in dict(mesh.modes) for k in held):
            return orbit
        try:
            return motions.followed(system, orbit, motions.FOLLOWED) or orbit
        except FAILURES:
            return orbit

    def _with_relays(self, system: System, orbit: Orbit) -> Orbit:
        """The orbit; where a relay without event nodes switches, on a mesh with event nodes."""
        own = [k for k in relays(system) if not group(system, orbit.mesh, k)]
        if not any(switched(system, orbit, k) for k in own):
            return orbit
        settings = (self.kinks or KinkSettings()).at(self.tolerance)
        events, phases = eventnodes.placed(system, orbit, eventnodes.wanted(system, orbit, settings))
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        return transfer(orbit, mesh, phases)

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return it as failed where an event node is not a crossing in its own direction."""
        found = refusals(system, correction.orbit)
        wrong = (outcome for breach, outcome in WRONG.items() if found and self._breached(found, breach))
        if (first := next(wrong, None)) is not None:
            return replace(correction, outcome=first)
        known = {"system": system, "equations": self.linearise, "tolerance": self.tolerance}
        return SteppedCorrection(**{**shallow(correction), **known})

    def change(self, system: System, before: Orbit, after: Orbit) -> Change | None:
        """Return where a switch grazes its level on the way, or two event nodes meet."""
        return first_change(system, before, after, self.shortest, self.ends_below)

    def reordered(self, system: System, orbit: Orbit, phases: Array) -> tuple[Mesh, Array] | None:
        """Return the mesh with the event nodes in their new order; None where that is no series of swaps."""
        nodes = permuted(system, orbit, phases)
        return None if nodes is None else self.with_nodes(orbit, nodes)

    def eased(self, orbit: Orbit) -> tuple[Mesh, Array] | None:
        """Return the mesh without event nodes at kinks of derivatives, those of negative levels."""
        each = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
        nodes = [(event, phase) for event, phase in each if event.level >= 0]
        return None if len(nodes) == len(each) else self.with_nodes(orbit, nodes)

    def with_nodes(self, orbit: Orbit, nodes: Sequence[Node]) -> tuple[Mesh, Array]:
        """Return the mesh of an orbit with other event nodes, and their phases."""
        events, places = tuple(event for event, _ in nodes), np.array([place for _, place in nodes])
        return redistribute(orbit, orbit.mesh.ntst, events, places, self.shortest), places

    def _misheld(self, system: System, orbit: Orbit, error: ErrorEstimate) -> float:
        """Infinite for an orbit that slips where it should stick, or the reverse; else 0."""
        if not of_held(system):
            return 0.0
        own = error.orbit if error.curable > self.tolerance else 0.0  # up to this the mesh may be to blame
        if self._creeps(system, orbit):
            return np.inf
        return np.inf if any(v.depth > own for v in mode_violations(system, orbit)) else 0.0

    @staticmethod
    def _creeps(system: System, orbit: Orbit) -> bool:
        """Whether an elastic slider has neither event nodes nor a mode for the whole period.

        It then drifts slowly, which none of its modes describes.
        """
        modes = dict(orbit.mesh.modes)
        own = [s.switch for s in of_kind(system, Kind.SLIDER) if s.switch not in modes]
        return any(not group(system, orbit.mesh, switch) for switch in own)

    def reworded(self, system: System, orbit: Orbit, before: int = 0) -> Orbit | None:
        """Return a guess with event nodes from the motion integrated in time; None where that fails."""
        try:
            motion = motions.followed(system, orbit, motions.FOLLOWED, before)
        except FAILURES:
            return None
        return None if motion is None else self.guess(system, motion.parameter, motion)

    def _breached(self, found: list[Violation], breach: Breach) -> bool:
        """Whether there is a violation of one kind; an excursion beyond a stop must exceed the tolerance."""
        least = self.tolerance if breach is Breach.THROUGH else -np.inf
        return any(v.breach is breach and v.depth > least for v in found)

    def variations(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Variations | None:
        """Return the linearised motions about an orbit; None where `periodic.conditions.adjoint` has them."""
        return None

    def pattern(self, system: System, orbit: Orbit) -> tuple[EventNode, ...] | None:
        """Return the event nodes where the modes change; None where the orbit violates its word."""
        return word(system, orbit)


def mode_violations(system: System, orbit: Orbit) -> list[Violation]:
    """Return where an orbit slips that should be held, or the reverse."""
    return [v for v in violations(system, orbit) if v.breach is Breach.MODE] if of_held(system) else []


def scheme_for(tolerance: float) -> Scheme:
    """Return the scheme for a tolerance."""
    points = (points for least, points in DEGREES.items() if tolerance >= least)
    return Scheme(Family.RADAU, next(points, max(DEGREES.values())))


def check_intervals(ntst: int, ntst_min: int, ntst_max: int) -> None:
    """Raise ValueError unless these are positive whole numbers, and in order."""
    for name, value in {"ntst": ntst, "ntst_min": ntst_min, "ntst_max": ntst_max}.items():
        whole(name, value)
    if not ntst_min <= ntst <= ntst_max:
        raise ValueError(f"ntst is {ntst}; it must lie from ntst_min = {ntst_min} to ntst_max = {ntst_max}")


def check_scheme(scheme: object) -> None:
    """Raise ValueError for anything but a Scheme, or None, which leaves it open."""
    if scheme is not None and not isinstance(scheme, Scheme):
        raise ValueError(f"scheme is {scheme!r}; it must be Scheme(family, ncol)")
