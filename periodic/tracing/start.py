"""The first orbit of a branch: from its guess, by other methods, a simulation, or another branch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from periodic.bifurcations.switching import away
from periodic.conditions.phase import open_phase
from periodic.correction.outcome import FAILURES, Outcome
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver, SpentError
from periodic.correction.tolerance import COARSEST, Accuracy
from periodic.display.meter import say
from periodic.linear.variation import UnknownVariationsError
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.refinement.adaptation import MOST_MESHES, refined
from periodic.results.stop import Reason
from periodic.stability.multipliers import Stability
from periodic.tracing.collapse import collapsed
from periodic.tracing.eventsfrommotion import worded
from periodic.tracing.follow import Follow
from periodic.tracing.heldplaces import amid, unplaced
from periodic.tracing.settling import held, nowhere, settled, settled_or_none

ELSEWHERE = (1.5, 2.0, 3.0, 0.5, 0.25)
"""Parameters, over the wanted one, from which a branch to the first orbit is traced, tried in turn."""

SOUGHT = "looking for a first orbit"
"""What a bar says of it before what is being tried."""

BESIDE_BOUND = 1e-6
"""How far outside the bounds, as a part of their range, an orbit at a fold on a bound may be."""

GROWN = 300
"""Largest number of steps in which another parameter is raised from 0."""

SPENT = (
    "more iterations, another start or guess=per.sampled(...), a motion from a simulation, may lead to one"
)
"""What the user can do where no orbit was found in the iterations allowed."""


@dataclass
class Start:
    """The search for the first orbit.

    search: whether an orbit that Newton does not find may be approached along a branch, by `follow`.
    shortfall: why such a branch ended, where the method cannot resolve its orbits. tried: what was tried
    besides the guess.
    """

    solver: Solver
    follow: Follow
    search: bool = True
    shortfall: str = field(default="", init=False)
    tried: list[str] = field(default_factory=list, init=False)

    def found(self, guess: Orbit, sign: float) -> Solution:
        """Find the first orbit: from the guess itself, else along a branch that comes from elsewhere.

        Raises SpentError where the iterations allowed are spent before.
        """
        try:
            first = self._found(guess, sign)
            if not first.ok:
                return first
            if nowhere(self.solver.problem.system, first.orbit):
                return first.failed(Outcome.HELD)
            loose = unplaced(self.solver.problem.system, first.orbit, guess.mesh)
            return amid(self.solver, first, loose, sign)
        except SpentError:
            raise SpentError(f"all before a first orbit: {self._sought}; {SPENT}") from None

    @property
    def _sought(self) -> str:
        """The sentence that says from which guesses no orbit has been found so far."""
        also = f", nor yet from {', '.join(self.tried)}" if self.tried else ""
        return f"none was found at the start itself{also}"

    def _found(self, guess: Orbit, sign: float) -> Solution:
        """The first orbit."""
        solver = self.solver
        say(f"{SOUGHT}: at the start itself")
        first = self._fixed(guess, sign)
        settles = solver.discretisation.settles(solver.problem.system)
        slips = settles and first.ok and np.isinf(first.error.motion)  # violates its word
        if first.ok and not slips and not collapsed(guess, first):
            return first
        if not self.search:
            return self._read(guess, sign) or self._at_fold(guess, sign, first)
        others = self._other_guesses(guess)
        if slips:
            last = worded(solver, first.orbit, sign)
            if last.ok and np.isfinite(last.error.motion):
                return last
        if settles:
            for motion in iter(lambda: next(others, None), None):
                if (last := self._worded(motion, sign)).ok:
                    return last
        if (rest := self._rest(guess)) is not None:
            self._try("rest under the mean load")
            if (last := self._fixed(rest, sign)).ok:
                return last
            guess = rest
        say(f"{SOUGHT}: other methods")
        other = self._by_others(guess, sign)
        if other is not None and other.ok:
            return other
        self._try(f"other values of {solver.problem.parameter}")
        for factor in ELSEWHERE:
            orbit = self._approached(guess, factor)
            if orbit is not None:
                return refined(solver, solver.at_parameter(orbit, sign), fixed=True)
            if self.shortfall:
                return first
        for orbit in others:
            if orbit is not None and (last := self._worded(orbit, sign)).ok:
                return last
        return first

    def _try(self, what: str) -> None:
        """Note what is tried next, and say so to whom it may concern."""
        self.tried.append(what)
        say(f"{SOUGHT}: {what}")

    def _read(self, guess: Orbit, sign: float) -> Solution | None:
        """The orbit near a guess with the word of its own motion; None where there is none."""
        changed = self.solver.discretisation.reworded(self.solver.problem.system, guess)
        found = None if changed is None else worded(self.solver, changed, sign)
        return found if found is not None and found.ok else None

    def why_not(self, outcome: Outcome, parameter: Array) -> str:
        """Say why there is no first orbit at parameters (p,), what was tried, and what else there is."""
        problem = self.solver.problem
        method, system = self.solver.discretisation, problem.system
        held = ""
        if not (problem.autonomous or method.stability is Stability.EIGENVALUES):
            why = open_phase(system, parameter, problem.parameter)
            held = f"; {why}" if why else ""
        if not self.tried:
            return outcome.value + held
        free = [] if problem.autonomous else method.drifting(system, parameter)
        held += f"; nothing holds {' and '.join(free)}" if free else ""
        return (
            f"{outcome.value}{held}; nor was one found from {', '.join(self.tried)}; "
            f"guess=per.sampled(...) takes a motion from a simulation"
        )

    def _other_guesses(self, guess: Orbit) -> Iterator[Orbit | None]:
        """Guesses at the wanted parameters, each computed only when those before have failed.

        First a settled motion, and one settled further, then None, then `_grown`; no more after a motion that
        friction holds at an undetermined place.
        """
        system, method = self.solver.problem.system, self.solver.discretisation
        for motion in self._settled(guess):
            if names := held(system, motion):
                place = "at a place that is not determined"
                self.tried[-1] += f": {' and '.join(names)} holds all along, {place}"
                return
            yield method.guess(system, motion.parameter, motion)
        yield None
        yield from self._grown(guess)

    def _rest(self, guess: Orbit) -> Orbit | None:
        """Equilibrium under the mean load; None where the guess begins there or `_settled` yields none."""
        problem, method = self.solver.problem, self.solver.discretisation
        if problem.autonomous or method.stability is Stability.EIGENVALUES:
            return None
        rest = method.resting(problem.system, guess)
        return None if rest is None else self._adopted(self.solver, rest)

    def _settled(self, guess: Orbit) -> Iterator[Orbit]:
        """A simulation run until it settles; none for free oscillations and equilibria."""
        problem, method = self.solver.problem, self.solver.discretisation
        if problem.autonomous or method.stability is Stability.EIGENVALUES:
            return
        self._try("a simulation left to settle")
        try:
            yield from settled(method, problem.system, guess)
        except FAILURES as failed:
            self.tried[-1] += f" ({failed})"

    def _grown(self, guess: Orbit) -> Iterator[Orbit | None]:
        """Guesses on branches in another parameter that begin where it is 0: forcing, friction or load."""
        problem = self.solver.problem
        for k, quantity in enumerate(problem.system.parameters):
            if k in problem.free or guess.parameter[k] == 0:
                continue
            parameter = guess.parameter.copy()
            parameter[k] = 0.0
            other = replace(problem, parameter=quantity.name, bounds=(0.0, float(guess.parameter[k])))
            solver = replace(self.solver, problem=other)
            near = replace(guess, parameter=parameter)
            first = solver.at_parameter(self._rest(near) or near, 1.0)
            if first.ok:
                self._try(f"{quantity.name} grown from 0")
                sign = int(np.sign(guess.parameter[k]))
                orbit, stop = self.follow(solver, first.orbit, sign, GROWN)
                if orbit is not None and other.value(orbit) == guess.parameter[k]:
                    yield orbit
                elif orbit is not None and stop.reason is not Reason.MAX_NEWTON:
                    self.tried[-1] += f" (to {other.value(orbit):.4g}: {stop.detail})"

    def _worded(self, motion: Orbit, sign: float) -> Solution:
        """The orbit near a motion; one that becomes another on a finer mesh is no less a first orbit."""
        found = worded(self.solver, motion, sign)
        for _ in range(MOST_MESHES):
            if found.outcome is not Outcome.MOVED:
                break
            found = worded(self.solver, found.orbit, sign)
        return found

    def _fixed(self, guess: Orbit, sign: float) -> Solution:
        return refined(self.solver, self.solver.at_parameter(guess, sign), fixed=True)

    def _by_others(self, guess: Orbit, sign: float) -> Solution | None:
        """Find the first orbit from that of another discretisation; None where none is found."""
        solver, system = self.solver, self.solver.problem.system
        loose = self._loosely(solver, COARSEST)
        for method in solver.discretisation.alternatives:
            other = replace(loose, discretisation=method.at(loose.tolerance.orbit))
            near = other.discretisation.guess(system, guess.parameter, guess)
            found = refined(other, other.at_parameter(near, sign), fixed=True)
            if found.ok:
                own = solver.discretisation.guess(system, guess.parameter, found.orbit)
                return self._fixed(own, sign)
        return None

    @staticmethod
    def _loosely(solver: Solver, least: float) -> Solver:
        """The solver with a looser tolerance of orbits."""
        tolerance = replace(solver.tolerance, orbit=max(least, solver.tolerance.orbit))
        return replace(solver, tolerance=tolerance, discretisation=solver.discretisation.at(tolerance.orbit))

    def _at_fold(self, guess: Orbit, sign: float, first: Solution) -> Solution:
        """Find an orbit at a fold of the branch, where the parameter cannot be held."""
        failed = first.failed(Outcome.COLLAPSED) if first.ok else first
        problem = self.solver.problem
        try:
            kernel = away(problem.system, guess, 1, problem.autonomous).scaled(sign)
        except (*FAILURES, UnknownVariationsError):
            return failed
        found = refined(self.solver, self.solver.on(guess, self.solver.constraint(guess, kernel, 0.0)))
        aside = BESIDE_BOUND * problem.scale
        within = problem.low - aside <= found.value <= problem.high + aside
        return found if found.ok and within else failed

    def _approached(self, guess: Orbit, factor: float) -> Orbit | None:
        """Trace from `factor` times the wanted parameter to it; None where the branch does not get there."""
        problem = self.solver.problem
        wanted = problem.value(guess)
        parameter = guess.parameter.copy()
        parameter[problem.index] = far = factor * wanted
        sign = int(np.sign(wanted - far))
        near = replace(guess, parameter=parameter)
        if far == wanted or not (first := self._there(near, float(sign))).ok:
            return None
        nearer = replace(problem, bounds=(min(wanted, far), max(wanted, far)))
        own = replace(self.solver, problem=nearer)
        solver = self._loosely(own, Accuracy.STANDARD) if own.tolerance.orbit < Accuracy.STANDARD else own
        begin = first.orbit if solver is own else self._adopted(solver, first.orbit)
        orbit, stop = self.follow(solver, begin, sign, None)
        if stop.reason is Reason.INACCURATE and orbit is not None:
            self.shortfall = f"at {problem.value(orbit):.6g}, on the way there, {stop.detail}"
            orbit, _ = self.follow(self._loosely(solver, COARSEST), orbit, sign, None)
        if orbit is None or problem.value(orbit) != wanted:
            return None
        return orbit if solver is own else self._adopted(own, orbit)

    def _there(self, near: Orbit, sign: float) -> Solution:
        """An orbit elsewhere: from rest, or from a motion that has settled there."""
        solver, system = self.solver, self.solver.problem.system
        first = self._fixed(self._rest(near) or near, sign)
        if not solver.discretisation.settles(system) or first.ok and np.isfinite(first.error.motion):
            return first
        motions = settled_or_none(solver.discretisation, system, near)
        found = (self._worded(self._adopted(solver, motion), sign) for motion in motions)
        return next((last for last in found if last.ok), first)

    @staticmethod
    def _adopted(solver: Solver, orbit: Orbit) -> Orbit:
        """An orbit as a guess in the solver's discretisation."""
        return solver.discretisation.guess(solver.problem.system, orbit.parameter, orbit)
