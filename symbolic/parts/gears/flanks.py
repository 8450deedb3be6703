"""Lubricated flanks of teeth: a film in series with the spring that the teeth are."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.equations.interval import POSITIVE
from symbolic.equations.variables import Value
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.contact.preloaded import PowerLaw, Preloaded
from symbolic.parts.films.series import SeriesFilm, Squeezed


@dataclass(frozen=True)
class Teeth(ContactLaw):
    """W = k max(delta, 0), k in N/m any function of the phase."""

    stiffness: ca.SX

    def load(self, assembly: Assembly, deflection: ca.SX) -> ca.SX:
        """Return k max(delta, 0)."""
        return self.stiffness * ca.fmax(deflection, 0)

    def preloaded(self, assembly: Assembly, preload: ca.SX) -> Preloaded:
        """Return delta/delta0, delta0 = Q/k."""
        return PowerLaw(preload / self.stiffness, ca.SX(1))


@dataclass(frozen=True)
class Flanks:
    """The film on the flanks of teeth."""

    film: SeriesFilm
    teeth: Teeth
    entrainment: Value

    def load(self, assembly: Assembly, name: str, approach: ca.SX) -> ca.SX:
        """Return the load in N of a flank that approaches by so much (m); a squeezed film adds its state."""
        if self.film.squeeze is None:
            return self.film.load(assembly, self.teeth, approach)
        speed = assembly.parameter(self.entrainment, "entrainment", "m/s", POSITIVE)
        v = assembly.state(f"{name} film", "", 1.0, ca.SX(0)).symbol
        load, row = Squeezed(self.film, assembly, self.teeth).closed(v, approach, speed)
        assembly.differential_rows.append(row)
        return load
