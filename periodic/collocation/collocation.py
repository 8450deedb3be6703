"""Orthogonal collocation on meshes tied to the kinks of the motion: the method for every orbit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from periodic.collocation.elimination import elimination
from periodic.collocation.fastmotions.exponentials import Exponentials
from periodic.collocation.fastmotions.substeps import SteppedCorrection, stepping
from periodic.collocation.fastmotions.unresolved import lost
from periodic.collocation.local import relax
from periodic.collocation.meshmethod import MeshMethod, mode_violations, scheme_for
from periodic.collocation.native import iteration
from periodic.collocation.native.estimate import Estimated, estimated
from periodic.collocation.residual import evaluated
from periodic.collocation.rounding import aside, of_events, of_states
from periodic.correction.condition import SideCondition
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import UNKNOWN, ErrorEstimate, Halving, deferred
from periodic.correction.newton import Correction, Equations, LinearisedEquations, NewtonSettings, in_order
from periodic.correction.outcome import FAILURES, EventsCrossedError
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.events import eventnodes, impacts, motions
from periodic.events.eventnodes import Crossing, KinkSettings
from periodic.events.eventrows import event_rows
from periodic.events.modes import inconsistency, of_held, relays
from periodic.events.resting import bounced, lengthened, neglected
from periodic.events.rewrites.withoutgrazing import without_grazing
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import transfer
from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.refinement.demand import demand, evenly, wanted_ntst
from periodic.refinement.equidistribution import redistribute
from periodic.stability.graded import GradedSpectrum, spectrum_of
from periodic.stability.multipliers import Spectrum
from periodic.stability.vibrating import VibratingSpectrum
from periodic.system import System

NODE_BEFORE_KINK = (1.0, 0.0, 10.0)
"""How far outside its excursion (rad, in tolerances) an event node lies on a new mesh, tried in turn."""

MANY = 10
"""Event nodes or reversals of a state beyond which an orbit may have more intervals than `ntst_max`."""

SHALLOWER = (10.0, 100.0)
"""Factors by which the least event level is raised, in turn, where a new mesh fails."""


@dataclass(frozen=True, kw_only=True)
class Collocation(MeshMethod):
    """Orthogonal collocation R(x', x, z, tau, p) = 0 at ncol points in each of ntst intervals.

    Parameters
    ----------
    scheme : Scheme, optional
        Family and number of collocation points; default Radau IIA with as many as the tolerance asks for.
    ntst, ntst_min, ntst_max : int
        Intervals to begin with, fewest and most: of an orbit of up to ten event nodes, each of whose states
        reverses up to ten times; one of more nodes, whose segments are graded each by itself, or of more
        vibrations has as many more.
    kinks : KinkSettings, optional
        When a crossing of a level by a switch gets an event node; default what the tolerance asks for.
    solver : callable
        The linear solver: elimination interval by interval, see `periodic.linear.operator.LinearSolver`.
    condense : bool, optional
        Whether the linear part of the equations is integrated exactly, so that only the states at nonlinear
        places remain unknowns; by default where that is cheaper. Results still hold all states, but of the
        multipliers, where there are many, only the leading ones.
    tolerance : float
        Bound on the error estimates that meshes are made for; set by the trace.

    References
    ----------
    Ascher, Mattheij & Russell, Numerical Solution of Boundary Value Problems, 1995.
    Doedel, Keller & Kernevez, Int. J. Bifurcation and Chaos 1 (1991) 745.
    """

    @property
    def alternatives(self) -> tuple[Discretisation, ...]:
        """The same with other schemes: whether Newton converges from rest depends on the scheme."""
        schemes = (Scheme(Family.RADAU, 5), Scheme(Family.GAUSS, 4), Scheme(Family.RADAU, 3))
        return tuple(replace(self, scheme=scheme) for scheme in schemes)

    def _scheme_at(self, tolerance: float) -> Scheme:
        """The scheme for a tolerance."""
        return scheme_for(tolerance)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the collocation equations and those of the event nodes."""
        if not in_order(orbit):
            raise EventsCrossedError
        return self._equations(system, orbit, free)

    def _equations(
        self, system: System, orbit: Orbit, free: tuple[int, ...], off: Array | None = None
    ) -> Operator:
        """The same, with `off` (k,) added to the residuals of the event nodes."""
        line, own = evaluated(system, orbit, free), event_rows(system, orbit, free)
        if off is not None:
            own = [replace(row, value=row.value + amount) for row, amount in zip(own, off, strict=True)]
        return self.solver(system, orbit, line, own, impacts.jumps(system, orbit, free))

    def corrected(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        conditions: Sequence[SideCondition],
        settings: NewtonSettings,
    ) -> Correction:
        """Return what Newton's iteration finds, in one call of C where the system has a compiled one."""
        given = (system, guess, free, conditions, settings)
        found = iteration.corrected(*given) if self._plain else None
        return super().corrected(*given) if found is None else found

    def _beside(self, equations: Equations, orbit: Orbit) -> LinearisedEquations:
        """Return the equations at an orbit linearised and solved. Raises FAILURES.

        Event nodes are displaced by the rounding error of their switches. This hardly changes the orbit, but
        where a contact is shallow it changes the multipliers, so that the error estimate contains it.
        """
        system = equations.system
        off = aside(orbit, event_rows(system, orbit, equations.free))
        found = replace(equations, linearise=partial(self._equations, off=off)).solved(orbit)
        given = (self.linearise, system, found.orbit, found.operator)
        followed = stepping(*given, self.tolerance, 2.0)
        if isinstance(followed, Exponentials):
            return replace(found, fundamental=followed.fundamental)
        return replace(found, operator=followed)

    @property
    def _plain(self) -> bool:
        """Whether the linear solver is the default one, which the compiled iteration replaces."""
        return self.solver is elimination

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit on another mesh, its event nodes a little outside the excursions that they bound.

        Inside, past the kink, a switch may hardly change, and the row of its event node is nearly singular.
        """
        deep = np.array([a.direction if a.level > 0 else 0.0 for a in mesh.events])
        for before in NODE_BEFORE_KINK if deep.any() else (0.0,):
            found = relax(system, transfer(orbit, mesh, phases + before * self.tolerance * deep))
            yield bounced(system, orbit, found) if len(mesh.events) > len(orbit.mesh.events) else found

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by a Newton step on the halved mesh, where it can be in one call of C."""
        system, orbit = problem.system, correction.orbit
        vibrating = isinstance(spectrum, VibratingSpectrum)
        plain = self._plain and not vibrating and not isinstance(spectrum, GradedSpectrum)
        found = estimated(problem, orbit, tangent, spectrum) if plain else None
        if found is None:
            error = deferred(self.linearise, problem, orbit, tangent, spectrum, Halving(solved=self._beside))
            found = Estimated(error, error is not UNKNOWN)
        error = found.error
        if error is UNKNOWN:
            return error
        missing = max(self._misheld(system, orbit, error), neglected(system, orbit))
        rounding = error.rounding + self._rounding(system, orbit, spectrum)
        unresolved = lost(system, orbit) if found.unresolved and not vibrating else 0.0
        multiplier = max(error.multiplier, unresolved, missing, rounding)
        return replace(error, orbit=max(error.orbit, missing), multiplier=multiplier, rounding=rounding)

    def rewritten(self, system: System, orbit: Orbit) -> tuple[Mesh, Array] | None:
        """Return the mesh with the events of the orbit's own motion; None where one of them grazes.

        None as well where the orbit itself says which kinks it passes, as its word changes no modes.
        """
        if impacts.tied(system, orbit) or not self.settles(system):
            return None
        try:
            nodes = motions.passed(system, orbit, motions.FOLLOWED)
        except FAILURES:
            return None
        own = list(zip(orbit.mesh.events, map(float, orbit.phases), strict=True))
        if nodes is None or not without_grazing(system, own, nodes, orbit.mesh.period):
            return None
        return None if inconsistency(system, [event for event, _ in nodes]) else self.with_nodes(orbit, nodes)

    def settles(self, system: System) -> bool:
        """Return whether motions may stick or relays switch, whose modes integration in time finds."""
        return bool(of_held(system) or relays(system))

    def _rounding(self, system: System, orbit: Orbit, spectrum: Spectrum) -> float:
        """The part of the multipliers' error that is rounding."""
        if len(orbit.mesh.exact_ends) == 0:
            return 0.0
        return of_states(orbit, spectrum) + of_events(orbit, event_rows(system, orbit, ()), spectrum)

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the multipliers: from the single steps where motions grow by many decades, from exponentials
        where they vibrate faster than the mesh resolves."""
        found = self._stepping(correction)
        if isinstance(found, Exponentials):
            return VibratingSpectrum(found.fundamental, trivial, turning=found.turning)
        return spectrum_of(correction.fundamental, found, trivial)

    @staticmethod
    def _stepping(correction: Correction) -> Operator | Exponentials | None:
        """What says how perturbations of an orbit grow and vibrate."""
        return correction.stepping if isinstance(correction, SteppedCorrection) else correction.operator

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Return what decides which events get nodes of the mesh, and how many intervals it has."""
        return CollocationRefinement(self, system, orbit, error)


class CollocationRefinement(Refinement):
    """Meshes for an orbit of `Collocation`."""

    def __init__(self, method: MeshMethod, system: System, orbit: Orbit, error: ErrorEstimate) -> None:
        super().__init__(orbit, error)
        self.method, self.system = method, system

    @cached_property
    def wanted(self) -> list[Crossing]:
        """The crossings to tie the mesh to, at levels not below the error of the orbit."""
        settings, meaningful = self._settings, eventnodes.DEEPEST * min(self.error.orbit, 1.0)
        deepest = max(settings.deepest or 0.0, meaningful)
        return eventnodes.wanted(self.system, self.orbit, replace(settings, deepest=deepest))

    @property
    def _settings(self) -> KinkSettings:
        return self.method.kinks or KinkSettings()

    @property
    def fits(self) -> bool:
        """Whether the mesh is tied to just the crossings it should be."""
        return self._longer is None and eventnodes.fits(self.wanted, self.orbit)

    @cached_property
    def _longer(self) -> tuple[tuple[EventNode, ...], Array] | None:
        """Event nodes with more of the bounces before a rest, where those left out are too large an error."""
        return lengthened(self.system, self.orbit, self.method.tolerance)

    @property
    def mendable(self) -> bool:
        """Whether other meshes may lessen the error."""
        return not self._in_wrong_mode

    @property
    def exhausted(self) -> bool:
        """Whether the orbit has the largest number of intervals."""
        return self.orbit.mesh.ntst >= self._largest and not self._in_wrong_mode

    @property
    def _largest(self) -> int:
        """The largest number of intervals, in proportion to event nodes or vibrations where they are many."""
        return self.method.ntst_max * max(MANY, len(self.orbit.phases), _reversals(self.orbit)) // MANY

    @property
    def shortfall(self) -> str:
        """Why the error exceeds its bound."""
        brief = "the motion sticks, slips or rests there for too short a while to be followed"
        return brief if self._in_wrong_mode else super().shortfall

    @cached_property
    def _in_wrong_mode(self) -> bool:
        """Whether it slips where it should stick, or rests too early: no finer mesh changes that."""
        if not np.isinf(self.error.orbit):
            return False
        return np.isinf(neglected(self.system, self.orbit)) or bool(mode_violations(self.system, self.orbit))

    @property
    def _ntst(self) -> int:
        return self._wanted_ntst(self.orbit.mesh.ntst)

    def _wanted_ntst(self, begun: float) -> int:
        method = self.method
        if self._in_wrong_mode or self._longer is not None:
            return self.orbit.mesh.ntst
        limits = (method.ntst_min, self._largest)
        return wanted_ntst(self.orbit, self.error, method.tolerance, *limits, begun)

    @property
    def _demand(self) -> Array | None:
        """Where the multipliers need more intervals."""
        if self._in_wrong_mode or self._longer is not None:
            return None
        most = self.method.ntst_max * max(MANY, len(self.orbit.phases)) // MANY
        return demand(self.orbit, self.error, self.method.tolerance, most)

    def refined(self) -> Mesh:
        """Return a mesh with intervals where the orbit needs them, and its present event nodes.

        Their number suffices for neighbouring orbits of the branch too, which have their kinks elsewhere.
        """
        return self._made(self.orbit.mesh.events, self.orbit.phases)

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes with the right event nodes and number of intervals, then with shallower ones."""
        if self._longer is not None:
            yield self._own(*self._longer), self._longer[1]
            return
        for chosen in self._choices():
            tied, phases = eventnodes.placed(self.system, self.orbit, chosen)
            yield self._own(tied, phases), phases

    def _made(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The mesh with such event nodes."""
        return self._spread(self._ntst, events, phases)

    def _own(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The same for this orbit alone, which may need fewer intervals if they are redistributed."""
        begun = evenly(self.orbit) if self.system.switches else self.orbit.mesh.ntst
        return self._spread(self._wanted_ntst(begun), events, phases)

    def _spread(self, ntst: int, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        return redistribute(self.orbit, ntst, events, phases, self.method.shortest, self._demand)

    def _choices(self) -> Iterator[list[Crossing]]:
        yield self.wanted
        levels = [c.event.level for c in self.wanted if c.event.level > 0]
        for factor in SHALLOWER if levels else ():
            shallower = replace(self._settings, deepest=factor * min(levels))
            yield eventnodes.wanted(self.system, self.orbit, shallower)


def _reversals(orbit: Orbit) -> int:
    """Return how often the state that does so most changes its way from one mesh point to the next."""
    ways = np.sign(np.diff(orbit.nodes, axis=0))
    return int((ways[:-1] * ways[1:] < 0).sum(axis=0).max(initial=0))
