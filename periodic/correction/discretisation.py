"""The boundary to discretisations: how an orbit is represented, linearised, refined, and its error estimated.

A new one is one file: a class with the five methods of `Discretisation` that have no body here. Orbits are
`periodic.orbit.orbit.Orbit` (or a subclass): values at mesh points and, in each interval, at the points of a
scheme.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import Protocol, Self, runtime_checkable

from periodic.correction.change import Change
from periodic.correction.condition import SideCondition
from periodic.correction.drift import drifting
from periodic.correction.error import ErrorEstimate
from periodic.correction.meanequilibrium import resting
from periodic.correction.newton import Correction, NewtonSettings, correct
from periodic.correction.problem import Problem
from periodic.correction.refinement import Refinement
from periodic.linear.operator import Operator
from periodic.linear.unknowns import Increment
from periodic.orbit.mesh import EventNode, Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.stability.multipliers import Spectrum, Stability
from periodic.system import System


@runtime_checkable
class Discretisation(Protocol):
    """A method for orbits. Its settings are its fields."""

    @abstractmethod
    def guess(self, system: System, parameter: Array, near: Orbit | None) -> Orbit:
        """Return the orbit from which Newton starts.

        Parameters
        ----------
        system : System
            The equations.
        parameter : ndarray, shape (p,)
            Parameters in SI units.
        near : Orbit or None
            An orbit of any method to carry over; None for the system at rest.

        Returns
        -------
        Orbit
            The guess, in this discretisation's representation.
        """

    @abstractmethod
    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Operator:
        """Return the equations at an orbit, linearised in its unknowns and the free parameters.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            Where they are linearised.
        free : tuple of int
            Indices of the free parameters.

        Returns
        -------
        Operator
            The linearised equations.

        Raises
        ------
        ArithmeticError, numpy.linalg.LinAlgError
            Where that fails; see `periodic.correction.outcome.FAILURES`.
        """

    @abstractmethod
    def transfer(self, system: System, orbit: Orbit, mesh: Mesh, phases: Array) -> Iterator[Orbit]:
        """Yield guesses for an orbit carried to another mesh.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            The orbit on its own mesh.
        mesh : Mesh
            The new mesh.
        phases : ndarray, shape (k,)
            Phases of the new mesh's event nodes, in rad.

        Yields
        ------
        Orbit
            A guess on the new mesh, the best first.
        """

    @abstractmethod
    def error(
        self, problem: Problem, correction: Correction, tangent: Increment, spectrum: Spectrum
    ) -> ErrorEstimate:
        """Estimate the errors of a converged orbit in the plane normal to its branch.

        Parameters
        ----------
        problem : Problem
            What is solved.
        correction : Correction
            The converged Newton iteration.
        tangent : Increment
            Tangent of the branch.
        spectrum : Spectrum
            The orbit's Floquet multipliers.

        Returns
        -------
        ErrorEstimate
            Relative errors of orbit, multipliers and continuation parameter.
        """

    @abstractmethod
    def refine(self, system: System, orbit: Orbit, error: ErrorEstimate) -> Refinement:
        """Return the mesh refinement that an orbit calls for.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            A converged orbit.
        error : ErrorEstimate
            Its errors.

        Returns
        -------
        Refinement
            What to change of its mesh.
        """

    def check(self, problem: Problem) -> None:
        """Refuse a problem to which the method does not apply.

        Parameters
        ----------
        problem : Problem
            What is to be solved.

        Raises
        ------
        ValueError
            Where it does not apply, with the reason in one sentence.
        """
        return

    def corrected(
        self,
        system: System,
        guess: Orbit,
        free: tuple[int, ...],
        conditions: Sequence[SideCondition],
        settings: NewtonSettings,
    ) -> Correction:
        """Return what Newton's iteration finds from a guess; a method may have a faster one of its own.

        Parameters
        ----------
        system : System
            The equations.
        guess : Orbit
            Where it starts.
        free : tuple of int
            Indices of the free parameters.
        conditions : sequence of SideCondition
            Side conditions, one for each free parameter.
        settings : NewtonSettings
            When it is converged.

        Returns
        -------
        Correction
            The orbit, or how the iteration failed.
        """
        return correct(self.linearise, system, guess, free, conditions, settings)

    def change(self, system: System, before: Orbit, after: Orbit) -> Change | None:
        """Return the first change of the pattern of events on the way from one orbit to another, if any.

        Parameters
        ----------
        system : System
            The equations.
        before, after : Orbit
            Orbits on one mesh; the second may be a guess.

        Returns
        -------
        Change or None
            Where a step from the first orbit is to end, and how the branch goes on there.
        """
        return None

    def reordered(self, system: System, orbit: Orbit, phases: Array) -> tuple[Mesh, Array] | None:
        """Return a mesh for an orbit whose events come in another order, with their phases in order.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            The orbit on a mesh in the old order.
        phases : ndarray, shape (k,)
            Where its event nodes go.

        Returns
        -------
        Mesh, ndarray or None
            None where more than the order changes, or nothing.
        """
        return None

    def eased(self, orbit: Orbit) -> tuple[Mesh, Array] | None:
        """Return a mesh without event nodes that accuracy alone has asked for, if there are any.

        Parameters
        ----------
        orbit : Orbit
            An orbit.

        Returns
        -------
        tuple of Mesh and ndarray, or None
            The mesh, and the phases of the event nodes that are left.
        """
        return None

    def rewritten(self, system: System, orbit: Orbit) -> tuple[Mesh, Array] | None:
        """Return a mesh with the events of an orbit's own motion, followed in time, with their phases.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            A guess of an orbit near one with the events that its mesh has.

        Returns
        -------
        Mesh, ndarray or None
            None where the motion cannot be followed, and where a level is grazed between both orbits.
        """
        return None

    def pattern(self, system: System, orbit: Orbit) -> tuple[EventNode, ...] | None:
        """Return the events of an orbit's period at which the equations change, in a fixed order.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            An orbit.

        Returns
        -------
        tuple of EventNode or None
            Those that its mesh is tied to; None where the orbit passes others as well.
        """
        return ()

    def settles(self, system: System) -> bool:
        """Return whether time integration until the motion settles is tried first where Newton fails.

        Parameters
        ----------
        system : System
            The equations.

        Returns
        -------
        bool
            True where it is cheap, and finds orbits that Newton does not.
        """
        return False

    def settled(self, system: System, start: Orbit) -> Iterator[Orbit] | None:
        """Return motions to which a system settles, by a time integration of the method's own.

        Parameters
        ----------
        system : System
            The equations.
        start : Orbit
            An orbit; its parameters are those of the motions.

        Returns
        -------
        iterator of Orbit, or None
            Guesses, each settled further than the one before; None where all states are to be integrated.
        """
        return None

    def resting(self, system: System, start: Orbit) -> Orbit | None:
        """Return the equilibrium under the mean load; see `periodic.correction.meanequilibrium`.

        Parameters
        ----------
        system : System
            The equations.
        start : Orbit
            An orbit; its parameters are those of the equilibrium.

        Returns
        -------
        Orbit or None
            A constant orbit; None where `start` begins at it already, and where none is found.
        """
        return resting(system, start)

    def drifting(self, system: System, parameter: Array) -> list[str]:
        """Return the states that nothing holds; see `periodic.correction.drift`.

        Parameters
        ----------
        system : System
            The equations.
        parameter : ndarray, shape (p,)
            Parameters in SI units.

        Returns
        -------
        list of str
            Their names; none as a rule.
        """
        return drifting(system, parameter)

    @property
    def stability(self) -> Stability:
        """What decides stability, and so which special points there are."""
        return Stability.MULTIPLIERS

    @property
    def trusted(self) -> float:
        """Error of the multipliers above which they are not used to locate special points."""
        return float("inf")

    @property
    def alternatives(self) -> tuple[Discretisation, ...]:
        """Discretisations to try for the first orbit if Newton does not find it with this one."""
        return ()

    def at(self, tolerance: float) -> Self:
        """Return the discretisation with every setting that was left open chosen for a tolerance.

        Parameters
        ----------
        tolerance : float
            Bound of an orbit's error estimate, relative.

        Returns
        -------
        Discretisation
            The same with all settings chosen.

        Raises
        ------
        ValueError
            Where its settings cannot meet the tolerance.
        """
        return self

    def reworded(self, system: System, orbit: Orbit, before: int = 0) -> Orbit | None:
        """Return an orbit with the events of its own motion, followed in time through its period.

        Parameters
        ----------
        system : System
            The equations.
        orbit : Orbit
            An orbit, or a guess of one, whose events may not be those of its motion.
        before : int
            Periods through which it is followed first: joints then stick where the motion has brought them.

        Returns
        -------
        Orbit or None
            A guess; None where the motion cannot be followed, or has the events that the orbit has already.
        """
        return None

    def accepted(self, system: System, correction: Correction) -> Correction:
        """Return a converged correction with its fundamental matrices; a spurious one as failed.

        Parameters
        ----------
        system : System
            The equations.
        correction : Correction
            The converged Newton iteration.

        Returns
        -------
        Correction
            What a solution is made of.
        """
        return correction

    def spectrum(self, correction: Correction, trivial: int) -> Spectrum:
        """Return the Floquet multipliers of a correction.

        Parameters
        ----------
        correction : Correction
            The Newton iteration, with its fundamental matrices.
        trivial : int
            How many multipliers are 1 whatever the parameters.

        Returns
        -------
        Spectrum
            Multipliers and eigenvectors.
        """
        return Spectrum(correction.fundamental, trivial)
