"""The teeth of a gear pair: a spring with backlash whose stiffness varies with the teeth in mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca

from symbolic.checks import positive, typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import NOT_NEGATIVE, POSITIVE
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, above_zero, not_negative, several
from symbolic.parts.films.series import SeriesFilm
from symbolic.parts.gears.flanks import Flanks, Teeth
from symbolic.parts.mechanics.ends import deflection, kink, resist
from symbolic.parts.rest import steady_force


@dataclass(frozen=True)
class GearMesh(Part):
    """Meshing teeth: force -k(tau) B(u) - c u' along the line of action, u the deflection of the mesh.

        k(tau) = k (1 - sum_j k_j cos j tau),   B(u) = max(u - b, 0) + min(u + b, 0)

    tau is the phase of the excitation, one turn for each pair of teeth. Kinks in time: u = b and u = -b.
    With a film both flanks carry a load W > 0 at any time, and nothing has a kink: on the driving one
    W/k(tau) = u - b + h, on the other W/k(tau) = -u - b + h.

    A pair as one coordinate: u = q, the dynamic transmission error, that of the profile as a
    TransmissionError. Two shafts: u = q - r - e, q = r1 theta1 and r = r2 theta2 along the line of action,
    each with the mass I/r1^2 or I/r2^2 and the force of its torque T/r1 or T/r2, and e the static
    transmission error sum_j e_j cos j tau.

    Parameters
    ----------
    q : Coordinate
        The dynamic transmission error r1 theta1 - r2 theta2 less e; with `to`, r1 theta1. In m.
    stiffness : float or Parameter
        Mean stiffness k in N/m.
    backlash : float or Parameter
        b in m: half of the backlash.
    variation : sequence of float or Parameter
        k_1, k_2, ..., relative to k.
    film : SeriesFilm, optional
        Lubricant film on either flank, in series with the teeth; with squeeze it brings a state on each.
    entrainment : float or Parameter
        Entraining speed of the flanks in m/s, where the film is squeezed.
    to : Coordinate, optional
        r2 theta2 of the other wheel, in m.
    damping : float or Parameter
        c in N s/m; it acts whether the teeth touch or not.
    error : sequence of float or Parameter
        e_1, e_2, ... in m.
    frequency : float or Parameter, optional
        Mesh frequency Omega in rad/s, teeth times the speed of a wheel, where no other part says it.

    Raises
    ------
    ValueError
        For a negative stiffness or damping, a backlash or an entraining speed that is not positive, a
        variation or error that is no sequence, and what is no film.

    References
    ----------
    Kahraman & Singh, J. Sound Vib. 142 (1990) 49-75 and 146 (1991) 135-156.
    """

    q: Coordinate
    stiffness: Value
    backlash: Value
    variation: Sequence[Value] = ()
    film: SeriesFilm | None = None
    entrainment: Value = 1.0
    to: Coordinate | None = None
    damping: Value = 0.0
    error: Sequence[Value] = ()
    frequency: Value | None = None

    def __post_init__(self) -> None:
        not_negative("mean stiffness of the mesh", self.stiffness)
        above_zero("backlash", self.backlash)
        above_zero("entrainment", self.entrainment)
        not_negative("damping of the mesh", self.damping)
        if self.film is not None:
            typed("film", self.film, SeriesFilm, "a SeriesFilm")
        for name in ("variation", "error"):
            object.__setattr__(self, name, several(name, getattr(self, name)))

    def contribute(self, assembly: Assembly) -> None:
        """Add the force to both wheels."""
        if self.frequency is not None:
            assembly.excite(assembly.parameter(self.frequency, "Omega", "rad/s"))
        k = assembly.parameter(self.stiffness, "mesh_stiffness", "N/m", NOT_NEGATIVE)
        b = assembly.parameter(self.backlash, "backlash", self.q.unit, POSITIVE)
        for wheel in self._wheels:
            assembly.suggest_scale(wheel, positive("backlash", assembly.nominal(b)))
        u = deflection(assembly, self.q, self.to) - self._error(assembly)
        resist(assembly, self.q, self.to, self._teeth(assembly, u, k, b) + self._damped(assembly, u))
        if self.to is None:
            assembly.sketch.wall(self.q, b, 1)
            assembly.sketch.wall(self.q, b, -1)
        engaged = Engaged(self, k, b)
        assembly.joints[engaged] = engaged

    @property
    def _wheels(self) -> list[Coordinate]:
        return [self.q] if self.to is None else [self.q, self.to]

    def _error(self, assembly: Assembly) -> ca.SX:
        """The static transmission error e."""
        found = ca.SX(0)
        for order, value in enumerate(self.error, 1):
            found += assembly.parameter(value, f"e{order}", self.q.unit) * assembly.harmonic(order)
        return found

    def _teeth(self, assembly: Assembly, u: ca.SX, k: ca.SX, b: ca.SX) -> ca.SX:
        """The force of the teeth; without a film with kinks where they come together and part."""
        varying = ca.SX(1)
        for order, value in enumerate(self.variation, 1):
            varying -= assembly.parameter(value, f"k{order}") * assembly.harmonic(order)
        if self.film is not None:
            flanks = Flanks(self.film, Teeth(k * varying), self.entrainment)
            driving = flanks.load(assembly, "driving", u - b)
            return driving - flanks.load(assembly, "coasting", -u - b)
        kink(assembly, self.q, self.to, "backlash", u - b)
        kink(assembly, self.q, self.to, "-backlash", u + b)
        return k * varying * (ca.fmax(u - b, 0) + ca.fmin(u + b, 0))

    def _damped(self, assembly: Assembly, u: ca.SX) -> ca.SX | float:
        """The force of the damping c u'."""
        if isinstance(self.damping, int | float) and self.damping == 0:
            return 0.0
        c = assembly.parameter(self.damping, "mesh_damping", "N s/m", NOT_NEGATIVE)
        return c * assembly.omega * assembly.rate(u)


@dataclass(frozen=True, eq=False)
class Engaged:
    """The search for a rest begins where the mesh carries the mean load F: u = F/k + b sgn F."""

    mesh: GearMesh
    k: ca.SX
    b: ca.SX

    def close(self, assembly: Assembly) -> None:
        """Set where the search begins, unless the user has."""
        load, position = steady_force(assembly, self.mesh.q), assembly.motion(self.mesh.q).position
        if position.rest.is_zero():
            position.rest = load / self.k + self.b * ca.sign(load)
