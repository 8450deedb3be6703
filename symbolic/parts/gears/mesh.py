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
from symbolic.parts.rest import steady_force


@dataclass(frozen=True)
class GearMesh(Part):
    """Meshing teeth: force -k(tau) B(q) along the line of action, q the dynamic transmission error.

        k(tau) = k (1 - sum_j k_j cos j tau),   B(q) = max(q - b, 0) + min(q + b, 0)

    tau is the phase of the excitation, one turn for each pair of teeth. Kinks in time: q = b and q = -b.
    With a film both flanks carry a load W > 0 at any time, and nothing has a kink: on the driving one
    W/k(tau) = q - b + h, on the other W/k(tau) = -q - b + h.

    Parameters
    ----------
    q : Coordinate
        Deflection of the mesh, r1 theta1 - r2 theta2 less the static transmission error, in m.
    stiffness : float or Parameter
        Mean stiffness k in N/m.
    backlash : float or Parameter
        b in m: half of the backlash.
    variation : sequence of float or Parameter
        k_1, k_2, ..., relative to k.
    film : SeriesFilm, optional
        Lubricant film on either flank, in series with the teeth; with squeeze it brings a state on each.
    entrainment : float or Parameter
        Entraining speed u of the flanks in m/s, where the film is squeezed.

    Raises
    ------
    ValueError
        For a negative stiffness, a backlash or an entraining speed that is not positive, a variation that is
        no sequence, and what is no film.

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

    def __post_init__(self) -> None:
        not_negative("mean stiffness of the mesh", self.stiffness)
        above_zero("backlash", self.backlash)
        above_zero("entrainment", self.entrainment)
        if self.film is not None:
            typed("film", self.film, SeriesFilm, "a SeriesFilm")
        object.__setattr__(self, "variation", several("variation", self.variation))

    def contribute(self, assembly: Assembly) -> None:
        """Add the force."""
        motion = assembly.motion(self.q)
        k = assembly.parameter(self.stiffness, "mesh_stiffness", "N/m", NOT_NEGATIVE)
        b = assembly.parameter(self.backlash, "backlash", self.q.unit, POSITIVE)
        assembly.suggest_scale(self.q, positive("backlash", assembly.nominal(b)))
        varying = ca.SX(1)
        for order, value in enumerate(self.variation, 1):
            varying -= assembly.parameter(value, f"k{order}") * assembly.harmonic(order)
        q, scale = motion.position.symbol, motion.position.scale
        if self.film is None:
            motion.force -= k * varying * (ca.fmax(q - b, 0) + ca.fmin(q + b, 0))
            assembly.switch(f"{self.q.name} = backlash", (q - b) / scale, 0)
            assembly.switch(f"{self.q.name} = -backlash", (q + b) / scale, 0)
        else:
            flanks = Flanks(self.film, Teeth(k * varying), self.entrainment)
            motion.force -= flanks.load(assembly, "driving", q - b) - flanks.load(
                assembly, "coasting", -q - b
            )
        assembly.sketch.wall(self.q, b, 1)
        assembly.sketch.wall(self.q, b, -1)
        engaged = Engaged(self.q, k, b)
        assembly.joints[engaged] = engaged


@dataclass(frozen=True, eq=False)
class Engaged:
    """The search for a rest begins where the mesh carries the mean load F: q = F/k + b sgn F."""

    q: Coordinate
    k: ca.SX
    b: ca.SX

    def close(self, assembly: Assembly) -> None:
        """Set where the search begins, unless the user has."""
        load, position = steady_force(assembly, self.q), assembly.motion(self.q).position
        if position.rest.is_zero():
            position.rest = load / self.k + self.b * ca.sign(load)
