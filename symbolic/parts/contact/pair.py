"""A contact between rolling bodies: elastic compression in series with what lies between the surfaces.

The coordinates of a `ContactPair` are the outward displacements of its bodies from their steady position
under the preload, X their sum. With waviness w(tau) on a surface the total compression beyond the steady
one is g = w - X (Mehdigoli et al. 1990, eq. 10), shared by the elastic deflection and the film.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import casadi as ca

from symbolic.checks import typed
from symbolic.equations.assembly import Assembly
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate
from symbolic.parts.contact.law import ContactLaw
from symbolic.parts.contact.preloaded import Preloaded
from symbolic.sketch import at

DISC = 4.0
"""Radius of the discs in the drawing, which shows the place where they touch."""

DEFAULT = "contact"
"""Name of a contact pair where none is given."""


@dataclass(frozen=True, eq=False)
class ContactPair:
    """A place where bodies touch; preload, law, waviness and a film are parts laid on it.

    Parameters
    ----------
    *coordinates : Coordinate
        Outward displacements of the bodies from their steady position.
    name : str
        What its outputs and switches are called by; those of the default name are bare.

    Raises
    ------
    ValueError
        For a pair without coordinates.
    """

    coordinates: tuple[Coordinate, ...]
    name: str = DEFAULT

    def __init__(self, *coordinates: Coordinate, name: str = DEFAULT) -> None:
        if not coordinates:
            raise ValueError("a contact pair has 0 coordinates; it needs at least one")
        object.__setattr__(self, "coordinates", coordinates)
        object.__setattr__(self, "name", name)


@dataclass(frozen=True)
class Loaded:
    """A contact under its preload Q (SI), its law about Q, and the compression g = w - X."""

    name: str
    preload: ca.SX
    law: Preloaded
    compression: ca.SX

    @property
    def delta0(self) -> ca.SX:
        """Deflection under the preload, in m."""
        return self.law.delta0

    def label(self, quantity: str) -> str:
        """Name of a quantity of this contact: bare in the contact of the default name."""
        return quantity if self.name == DEFAULT else f"{self.name} {quantity}"


class Film(Protocol):
    """What lies between the surfaces; it turns the compression g into a load."""

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Add the film's states, unknowns and rows.

        Parameters
        ----------
        assembly : Assembly
            The workbench of the model.
        contact : Loaded
            The contact under its preload.

        Returns
        -------
        casadi.SX
            Load W in N.
        """
        ...


@dataclass
class Junction:
    """What the parts have said of one contact pair (SI symbols); None where they have said nothing yet.

    `ripple` is the part of the profile that a film keeps under the preload, so that it compresses nothing;
    `wave` is the amplitude and the number of the corrugations that are drawn.
    """

    pair: ContactPair
    preload: ca.SX | None = None
    law: ContactLaw | None = None
    film: Film | None = None
    damping_ratio: ca.SX | None = None
    profile: ca.SX = field(default_factory=lambda: ca.SX(0))
    ripple: Callable[[ca.SX], ca.SX] | None = None
    wave: tuple[ca.SX, int] | None = None

    def close(self, assembly: Assembly) -> None:
        """Join the parts: load on every coordinate, outputs and switches."""
        contact = self._loaded(assembly)
        load = self.film.close(assembly, contact) if self.film else _dry(assembly, contact)
        damping = self._damping(assembly, contact)
        for q in self.pair.coordinates:
            assembly.motion(q).force += load - contact.preload - damping
        assembly.output(contact.label("load"), "N", load)

        self._draw(assembly)

    def _draw(self, assembly: Assembly) -> None:
        """Draw two discs, the wavy one below, and the film where they part."""
        of, draw = self.pair.coordinates, assembly.sketch.draw
        if self.film is not None:
            draw("block", of, size=at(0.6), look="film")
        depth, waves = self.wave or (ca.SX(0), 0)
        lower = {"depth": at(0, depth), "waves": waves, "turn": 1 / waves} if waves else {}
        below = at(-DISC, *of[1:2], factor=-1.0)
        draw("disc", of, y=below, size=at(DISC), **lower)
        draw("disc", of, y=at(DISC, of[0]), size=at(DISC))

    def _loaded(self, assembly: Assembly) -> Loaded:
        if self.preload is None or self.law is None:
            raise ValueError(f"contact {self.pair.name!r} lacks a part; it needs both Preload and Hertz")
        law = self.law.preloaded(assembly, self.preload)
        delta0 = assembly.nominal(law.delta0)
        if not 0 < delta0 < math.inf:
            raise ValueError(
                f"contact {self.pair.name!r} has no static deflection; preload and stiffness must be positive"
            )
        for q in self.pair.coordinates:
            assembly.suggest_scale(q, delta0)
        displacement = sum((assembly.motion(q).position.symbol for q in self.pair.coordinates), ca.SX(0))
        transmitted = self.profile if self.ripple is None else self.profile * (1 - self.ripple(self.preload))
        return Loaded(self.pair.name, self.preload, law, transmitted - displacement)

    def _damping(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """2 zeta omega0 mu dX/dt, with omega0^2 = n Q / (delta0 mu), mu the reduced mass of the bodies."""
        if self.damping_ratio is None:
            return ca.SX(0)
        coordinates = self.pair.coordinates
        mu = 1 / sum((1 / assembly.motion(q).mass for q in coordinates), ca.SX(0))
        stiffness = contact.law.exponent * contact.preload / contact.delta0
        velocity = sum((assembly.speed_of(q) for q in coordinates), ca.SX(0))
        return 2 * self.damping_ratio * ca.sqrt(stiffness * mu) * velocity


def _dry(assembly: Assembly, contact: Loaded) -> ca.SX:
    """W = F(delta), delta = delta0 + g: no film, no unknown, a kink at both zeros of delta."""
    deflection = contact.delta0 + contact.compression
    assembly.output(contact.label("deflection"), "m", ca.fmax(deflection, 0))
    assembly.switch(f"{contact.name}: delta = 0", deflection / contact.delta0, 0)
    return contact.preload * contact.law.load(deflection / contact.delta0)


def junction_of(assembly: Assembly, pair: ContactPair) -> Junction:
    """Return the junction of a pair, making it at the first call."""
    typed("pair", pair, ContactPair, "a ContactPair, as symbolic.ContactPair(x) is")
    found = assembly.joints.setdefault(pair, Junction(pair))
    assert isinstance(found, Junction)
    return found


@dataclass(frozen=True)
class FilmPart(Part, ABC):
    """A film as a part of its contact: see `Film`."""

    pair: ContactPair

    def contribute(self, assembly: Assembly) -> None:
        """Put this film into the contact."""
        junction_of(assembly, self.pair).film = self

    @abstractmethod
    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Add the film's states, unknowns and rows; return its load in N."""
