"""Orthogonal collocation on meshes tied to the kinks of the motion: the method for every orbit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial

import numpy as np

from periodic.checks import whole
from periodic.collocation.condensation import condensation
from periodic.collocation.local import relax
from periodic.collocation.multipliers.substeps import SteppedCorrection, stepping
from periodic.collocation.multipliers.unresolved import lost
from periodic.collocation.native import iteration
from periodic.collocation.native.estimate import Estimated, estimated
from periodic.collocation.residual import evaluated
from periodic.collocation.rounding import aside, of_events, of_states
from periodic.correction.change import Change
from periodic.correction.condition import SideCondition
from periodic.correction.discretisation import Discretisation
from periodic.correction.error import UNKNOWN, ErrorEstimate, deferred
from periodic.correction.meshes import Refinement, demand, evenly, wanted_ntst
from periodic.correction.newton import Correction, Linearised, NewtonSettings, in_order, linearised
from periodic.correction.outcome import FAILURES, EventsCrossedError, Outcome
from periodic.correction.problem import Problem
from periodic.events import impacts, motions, tying
from periodic.events.modes import completed, group, of_held
from periodic.events.noderows import event_rows
from periodic.events.rewrites.first import first_change
from periodic.events.tying import Crossing, KinkSettings
from periodic.events.violations import Breach, Violation, violations, word
from periodic.linear.operator import LinearSolver, Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.construction import at_rest, transfer
from periodic.orbit.mesh import EventNode, Mesh, uniform
from periodic.orbit.orbit import Orbit
from periodic.orbit.redistribution import redistribute
from periodic.orbit.scheme import Array, Family, Scheme
from periodic.stability.graded import GradedSpectrum, spectrum_of
from periodic.stability.spectrum import Spectrum
from periodic.system import System

DEGREES = {1e-2: 3, 1e-4: 4, 1e-6: 5, 1e-9: 6, 1e-11: 7}
"""Collocation points in each interval down to a tolerance."""

ASIDE = (1.0, 0.0, 10.0)
"""How far before its kink an event node begins on a new mesh (rad), in tolerances; tried in turn."""

WRONG = {
    Breach.GRAZED: Outcome.GRAZING,
    Breach.THROUGH: Outcome.THROUGH_STOP,
    Breach.HELD: Outcome.SLIDES,
    Breach.REVERSED: Outcome.EVENTS_CROSSED,
}
"""What an orbit that violates its word so is refused as, the first of them."""

FOLLOWED = 1e-8
"""Tolerance with which motions are followed in time for their events."""

SHALLOWER = (10.0, 100.0)
"""How much shallower event nodes are tried where a new mesh fails."""


@dataclass(frozen=True, kw_only=True)
class Collocation(Discretisation):
    """Orthogonal collocation R(x', x, z, tau, p) = 0 at ncol points in each of ntst intervals.

    Parameters
    ----------
    scheme : Scheme, optional
        Family and number of collocation points; default Radau IIA with as many as the tolerance asks for.
    ntst, ntst_min, ntst_max : int
        Intervals to begin with, fewest and most.
    kinks : KinkSettings, optional
        When the mesh is tied to a passage of a switch; default what the tolerance asks for.
    solver : callable
        The linear solver: condensation interval by interval, see `periodic.linear.operator.LinearSolver`.
    condense : bool, optional
        Whether the linear part of the equations is integrated exactly, unknowns left at nonlinear places
        alone; by default where that pays. Results are those of all states all the same, but of many
        multipliers the leading ones.
    tolerance : float
        What meshes are made for; set by the trace.

    References
    ----------
    Ascher, Mattheij & Russell, Numerical Solution of Boundary Value Problems, 1995.
    Doedel, Keller & Kernevez, Int. J. Bifurcation and Chaos 1 (1991) 745.
    """

    scheme: Scheme | None = None
    ntst: int = 24
    ntst_min: int = 8
    ntst_max: int = 1000
    kinks: KinkSettings | None = None
    solver: LinearSolver = condensation
    condense: bool | None = None
    tolerance: float = 1e-7

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

    @property
    def alternatives(self) -> tuple[Discretisation, ...]:
        """The same with other schemes: Newton's way from a rest is a matter of luck."""
        schemes = (Scheme(Family.RADAU, 5), Scheme(Family.GAUSS, 4), Scheme(Family.RADAU, 3))
        return tuple(replace(self, scheme=scheme) for scheme in schemes)

    def at(self, tolerance: float) -> Collocation:
        """Return it with scheme, depth of event nodes and meshes for a tolerance."""
        return replace(
            self,
            scheme=self.scheme or scheme_for(tolerance),
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
        old = near.mesh
        mesh = Mesh(scheme, old.breaks, completed(system, old.events), old.period, old.modes)
        adopted = replace(transfer(near, mesh, near.phases), parameter=parameter, equilibrium=False)
        return relax(system, self._tied(system, adopted))

    def _tied(self, system: System, orbit: Orbit) -> Orbit:
        """A motion that sticks and slips, on a mesh with event nodes where it does: Newton needs them."""
        held = of_held(system)
        if not held or any(group(system, orbit.mesh, k) for k in held):
            return orbit
        settings = (self.kinks or KinkSettings()).at(self.tolerance)
        events, phases = tying.placed(system, orbit, tying.wanted(system, orbit, settings))
        mesh = redistribute(orbit, orbit.mesh.ntst, events, phases, self.shortest)
        return transfer(orbit, mesh, phases)

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the collocation equations and those of the event nodes."""
        if not in_order(orbit):
            raise EventsCrossedError
        return self._equations(system, orbit, free)

    def _equations(
        self, system: System, orbit: Orbit, free: tuple[int, ...], off: Array | None = None
    ) -> Operator:
        """The same, event nodes off their levels by so much."""
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
        """Return what Newton's iteration finds, in one call of C where that is to be had."""
        given = (system, guess, free, conditions, settings)
        found = iteration.corrected(*given) if self._plain else None
        return super().corrected(*given) if found is None else found

    def _beside(
        self,
        system: System,
        orbit: Orbit,
        free: tuple[int, ...],
        conditions: Sequence[SideCondition],
        settings: NewtonSettings,
    ) -> Linearised:
        """Return the equations at an orbit linearised and solved. Raises FAILURES.

        Event nodes are as far beside their levels as rounding may leave them: it is nothing to the orbit, but
        to the multipliers where a contact is shallow.
        """
        off = aside(orbit, event_rows(system, orbit, free))
        given = (system, orbit, free, conditions, settings)
        found = linearised(partial(self._equations, off=off), *given)
        return replace(found, operator=stepping(self.linearise, system, found.orbit, found.operator, 2.0))

    def _breached(self, found: list[Violation], breach: Breach) -> bool:
        """Whether an orbit violates its word in a way, where impacts are farther than the tolerance."""
        least = self.tolerance if breach is Breach.THROUGH else -np.inf
        return any(v.breach is breach and v.depth > least for v in found)

    @property
    def _plain(self) -> bool:
        """Whether its equations are those of the compiled iteration."""
        return self.solver is condensation and type(self) is Collocation

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return it as failed where an event node is not a crossing in its own direction."""
        found = violations(system, correction.orbit)
        wrong = next((outcome for breach, outcome in WRONG.items() if self._breached(found, breach)), None)
        if wrong is not None:
            return replace(correction, outcome=wrong)
        given = {f.name: getattr(correction, f.name) for f in fields(Correction)}
        return SteppedCorrection(**given, system=system, equations=self.linearise)

    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield the orbit with its event nodes a little before their kinks, where they are well defined.

        Past its kink a switch hardly changes, and Newton has nothing to hold on to.
        """
        deep = np.array([a.direction if a.level > 0 else 0.0 for a in mesh.events])
        for before in ASIDE if deep.any() else (0.0,):
            yield relax(system, transfer(orbit, mesh, phases + before * self.tolerance * deep))

    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors by a Newton step on the halved mesh, where it can be in one call of C."""
        system, orbit = problem.system, correction.orbit
        plain = self._plain and not isinstance(spectrum, GradedSpectrum)
        found = estimated(problem, orbit, tangent, spectrum) if plain else None
        if found is None:
            error = deferred(self.linearise, problem, orbit, tangent, spectrum, solved=self._beside)
            found = Estimated(error, error is not UNKNOWN)
        error = found.error
        if error is UNKNOWN:
            return error
        missing = self._missing(system, orbit, error)
        rounding = error.rounding + self._rounding(system, orbit, spectrum)
        unseen = lost(system, orbit) if found.unresolved else 0.0
        multiplier = max(error.multiplier, unseen, missing, rounding)
        return replace(error, orbit=max(error.orbit, missing), multiplier=multiplier, rounding=rounding)

    def _missing(self, system: System, orbit: Orbit, error: ErrorEstimate) -> float:
        """What of the orbit's error is that it slips where it should be held, or the reverse."""
        own = error.orbit if error.curable > self.tolerance else 0.0  # that deep the mesh may be to blame
        return np.inf if any(v.depth > own for v in misplaced(system, orbit)) else 0.0

    def _rounding(self, system: System, orbit: Orbit, spectrum: Spectrum) -> float:
        """What of the multipliers' error is rounding."""
        if len(orbit.mesh.exact_ends) == 0:
            return 0.0
        return of_states(orbit, spectrum) + of_events(orbit, event_rows(system, orbit, ()), spectrum)

    def change(self, system: System, before: Orbit, after: Orbit) -> Change | None:
        """Return where a switch touches its level on the way, or two event nodes meet."""
        return first_change(system, before, after, self.shortest)

    def reworded(self, system: System, orbit: Orbit) -> Orbit | None:
        """Return a guess with the events of the orbit's own motion, where that can be followed."""
        try:
            told = motions.followed(system, orbit, FOLLOWED)
        except FAILURES:
            return None
        return None if told is None else self.guess(system, told.parameter, told)

    def pattern(self, system: System, orbit: Orbit) -> tuple[EventNode, ...] | None:
        """Return the event nodes where the equations change; None where the orbit passes others."""
        return word(system, orbit)

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the multipliers, where motions grow by many decades from the intervals one by one."""
        stepping = correction.stepping if isinstance(correction, SteppedCorrection) else correction.operator
        return spectrum_of(correction.fundamental, stepping, trivial)

    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Say to which events the mesh should be tied, and how many intervals it needs."""
        return CollocationRefinement(self, system, orbit, error)


class CollocationRefinement(Refinement):
    """Meshes for an orbit of `Collocation`."""

    def __init__(self, method: Collocation, system: System, orbit: Orbit, error: ErrorEstimate) -> None:
        super().__init__(orbit, error)
        self.method, self.system = method, system

    @cached_property
    def wanted(self) -> list[Crossing]:
        """The crossings to tie the mesh to, at levels that the orbit is accurate enough for."""
        settings, meaningful = self._settings, tying.DEEPEST * min(self.error.orbit, 1.0)
        deepest = max(settings.deepest or 0.0, meaningful)
        return tying.wanted(self.system, self.orbit, replace(settings, deepest=deepest))

    @property
    def _settings(self) -> KinkSettings:
        return self.method.kinks or KinkSettings()

    @property
    def fits(self) -> bool:
        """Whether the mesh is tied to just the crossings it should be."""
        return tying.fits(self.wanted, self.orbit)

    @property
    def exhausted(self) -> bool:
        """Whether the orbit has the largest number of intervals."""
        return self.orbit.mesh.ntst >= self.method.ntst_max and not self._misplaced

    @property
    def shortfall(self) -> str:
        """Why the error exceeds its bound."""
        brief = "the motion sticks or slips there for too short a while to be followed"
        return brief if self._misplaced else super().shortfall

    @cached_property
    def _misplaced(self) -> bool:
        """Whether the orbit slips where it should stick, which no finer mesh mends."""
        return bool(np.isinf(self.error.orbit)) and bool(misplaced(self.system, self.orbit))

    @property
    def _ntst(self) -> int:
        return self._wanted_ntst(self.orbit.mesh.ntst)

    def _wanted_ntst(self, begun: float) -> int:
        method = self.method
        if self._misplaced:
            return self.orbit.mesh.ntst
        limits = (method.ntst_min, method.ntst_max)
        return wanted_ntst(self.orbit, self.error, method.tolerance, *limits, begun)

    @property
    def _demand(self) -> Array | None:
        """Where the multipliers need more intervals."""
        if self._misplaced:
            return None
        return demand(self.orbit, self.error, self.method.tolerance, self.method.ntst_max)

    def refined(self) -> Mesh:
        """Return a mesh with intervals where the orbit needs them, and its present event nodes.

        It has enough for orbits beside it as well, with kinks elsewhere.
        """
        return self._made(self.orbit.mesh.events, self.orbit.phases)

    def meshes(self) -> Iterator[tuple[Mesh, Array]]:
        """Yield meshes with the right event nodes and number of intervals, then with shallower ones."""
        for chosen in self._choices():
            tied, phases = tying.placed(self.system, self.orbit, chosen)
            yield self._own(tied, phases), phases

    def _made(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The mesh with such event nodes."""
        return self._spread(self._ntst, events, phases)

    def _own(self, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        """The same for this orbit alone."""
        begun = evenly(self.orbit) if self.system.switches else self.orbit.mesh.ntst
        return self._spread(self._wanted_ntst(begun), events, phases)

    def _spread(self, ntst: int, events: tuple[EventNode, ...], phases: Array) -> Mesh:
        return redistribute(self.orbit, ntst, events, phases, self.method.shortest, self._demand)

    def _choices(self) -> Iterator[list[Crossing]]:
        yield self.wanted
        levels = [c.event.level for c in self.wanted if c.event.level > 0]
        for factor in SHALLOWER if levels else ():
            shallower = replace(self._settings, deepest=factor * min(levels))
            yield tying.wanted(self.system, self.orbit, shallower)


def misplaced(system: System, orbit: Orbit) -> list[Violation]:
    """Return where an orbit slips that should be held, or the reverse."""
    return [v for v in violations(system, orbit) if v.breach is Breach.MODE] if of_held(system) else []


def scheme_for(tolerance: float) -> Scheme:
    """Return the scheme for a tolerance."""
    points = (points for least, points in DEGREES.items() if tolerance >= least)
    return Scheme(Family.RADAU, next(points, max(DEGREES.values())))


def check_intervals(ntst: int, ntst_min: int, ntst_max: int) -> None:
    """Raise ValueError for numbers of intervals that are none, or not in order."""
    for name, value in {"ntst": ntst, "ntst_min": ntst_min, "ntst_max": ntst_max}.items():
        whole(name, value)
    if not ntst_min <= ntst <= ntst_max:
        raise ValueError(f"ntst is {ntst}; it must lie from ntst_min = {ntst_min} to ntst_max = {ntst_max}")


def check_scheme(scheme: object) -> None:
    """Raise ValueError for what is no scheme, nor left open."""
    if scheme is not None and not isinstance(scheme, Scheme):
        raise ValueError(f"scheme is {scheme!r}; it must be Scheme(family, ncol)")
