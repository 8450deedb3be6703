"""Squeezed films on the elements of a rolling bearing: a state on each, in multiblade coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca

from symbolic.equations.assembly import Assembly
from symbolic.parts.bearings.multiblade import Multiblade
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.films.series import SeriesFilm, Squeezed


@dataclass(frozen=True)
class SqueezedElements:
    """The films of all elements, each between an element and its races of a law, in series with it."""

    film: SeriesFilm
    law: ContactLaw

    def loads(
        self, assembly: Assembly, approaches: Sequence[ca.SX], passage: ca.SX, speed: ca.SX
    ) -> list[ca.SX]:
        """Add states and rows of the films, of an entraining speed in m/s; return the loads in N."""
        blades = Multiblade.of(assembly, "film", len(approaches), passage)
        film, found = Squeezed(self.film, assembly, self.law), []
        for i, approach in enumerate(approaches):
            load, row = film.closed(blades.element(i), approach, speed)
            assembly.differential_rows.append(row)
            found.append(load)
        assembly.differential_rows.extend(blades.idle())
        return found
