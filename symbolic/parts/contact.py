"""A contact between rolling bodies: Hertz compression in series with what lies between the surfaces.

The coordinates of a `ContactPair` are the outward displacements of its bodies from their steady position
under the preload, X their sum. With waviness w(tau) on a surface the total compression beyond the steady
one is g = w - X (Mehdigoli et al. 1990, eq. 10), shared by the Hertz deflection and the film.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import casadi as ca

from symbolic.assembly import Assembly
from symbolic.model import Part
from symbolic.variables import Coordinate, Value

DEFAULT = "contact"
"""Name of a contact pair where none is given."""


@dataclass(frozen=True, eq=False)
class ContactPair:
    """A place where bodies touch; Preload, Hertz, Waviness and a film are parts laid on it."""

    coordinates: tuple[Coordinate, ...]
    name: str = DEFAULT

    def __init__(self, *coordinates: Coordinate, name: str = DEFAULT) -> None:
        if not coordinates:
            raise ValueError("a contact pair has 0 coordinates; it needs at least one")
        object.__setattr__(self, "coordinates", coordinates)
        object.__setattr__(self, "name", name)


@dataclass(frozen=True)
class Loaded:
    """A contact under its preload Q (SI): W = K delta^n, delta0 = (Q/K)^(1/n), compression g = w - X."""

    name: str
    preload: ca.SX
    exponent: ca.SX
    delta0: ca.SX
    compression: ca.SX

    def label(self, quantity: str) -> str:
        """Name of a quantity of this contact: bare in the contact of the default name."""
        return quantity if self.name == DEFAULT else f"{self.name} {quantity}"


class Film(Protocol):
    """What lies between the surfaces; it turns the compression g into a load."""

    def close(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """Add the film's states, unknowns and rows; return the load W in N."""


@dataclass
class Junction:
    """What the parts have said of one contact pair (SI symbols); None where they have said nothing yet."""

    pair: ContactPair
    preload: ca.SX | None = None
    stiffness: ca.SX | None = None
    exponent: ca.SX | None = None
    film: Film | None = None
    damping_ratio: ca.SX | None = None
    profile: ca.SX = field(default_factory=lambda: ca.SX(0))

    def close(self, assembly: Assembly) -> None:
        """Join the parts: load on every coordinate, outputs and switches."""
        contact = self._loaded(assembly)
        load = self.film.close(assembly, contact) if self.film else _dry(assembly, contact)
        damping = self._damping(assembly, contact)
        for q in self.pair.coordinates:
            assembly.motion(q).force += load - contact.preload - damping
        assembly.output(contact.label("load"), "N", load)

    def _loaded(self, assembly: Assembly) -> Loaded:
        if self.preload is None or self.stiffness is None or self.exponent is None:
            raise ValueError(f"contact {self.pair.name!r} lacks a part; it needs both Preload and Hertz")
        delta0 = (self.preload / self.stiffness) ** (1 / self.exponent)
        if not 0 < assembly.nominal(delta0) < math.inf:
            raise ValueError(
                f"contact {self.pair.name!r} has no static deflection; preload and stiffness must be positive"
            )
        for q in self.pair.coordinates:
            assembly.suggest_scale(q, assembly.nominal(delta0))
        displacement = sum((assembly.motion(q).position.symbol for q in self.pair.coordinates), ca.SX(0))
        return Loaded(self.pair.name, self.preload, self.exponent, delta0, self.profile - displacement)

    def _damping(self, assembly: Assembly, contact: Loaded) -> ca.SX:
        """2 zeta omega0 mu dX/dt, with omega0^2 = n Q / (delta0 mu), mu the reduced mass of the bodies."""
        if self.damping_ratio is None:
            return ca.SX(0)
        coordinates = self.pair.coordinates
        mu = 1 / sum((1 / assembly.motion(q).mass for q in coordinates), ca.SX(0))
        stiffness = contact.exponent * contact.preload / contact.delta0
        velocity = sum((assembly.speed_of(q) for q in coordinates), ca.SX(0))
        return 2 * self.damping_ratio * ca.sqrt(stiffness * mu) * velocity


def _dry(assembly: Assembly, contact: Loaded) -> ca.SX:
    """W = K max(delta, 0)^n, delta = delta0 + g: no film, no unknown, a kink at both zeros of delta."""
    deflection = contact.delta0 + contact.compression
    assembly.output(contact.label("deflection"), "m", ca.fmax(deflection, 0))
    assembly.switch(f"{contact.name}: delta = 0", deflection / contact.delta0, 0)
    # Not 0: the derivative of 0^n in n would be 0 log 0.
    return contact.preload * ca.fmax(deflection / contact.delta0, 1e-300) ** contact.exponent


def junction_of(assembly: Assembly, pair: ContactPair) -> Junction:
    """Return the junction of a pair, making it at the first call."""
    found = assembly.junctions.setdefault(pair, Junction(pair))
    assert isinstance(found, Junction)
    return found


@dataclass(frozen=True)
class Preload(Part):
    """Constant force Q that presses the bodies of the pair together, in N."""

    pair: ContactPair
    force: Value

    def contribute(self, assembly: Assembly) -> None:
        """Set Q."""
        junction_of(assembly, self.pair).preload = assembly.parameter(self.force, "preload", "N")


@dataclass(frozen=True)
class Hertz(Part):
    """Elastic contact W = K delta^n (Hertz: n = 3/2). K in N/m^n."""

    pair: ContactPair
    stiffness: Value
    exponent: Value = 1.5

    def contribute(self, assembly: Assembly) -> None:
        """Set K and n."""
        junction = junction_of(assembly, self.pair)
        junction.stiffness = assembly.parameter(self.stiffness, "stiffness", "N/m^n")
        junction.exponent = assembly.parameter(self.exponent, "exponent")


@dataclass(frozen=True)
class Waviness(Part):
    """Corrugation a sin(tau), tau = waves * speed * t, on one of the surfaces. a in m, speed in rad/s."""

    pair: ContactPair
    amplitude: Value
    waves: Value
    speed: Value

    def contribute(self, assembly: Assembly) -> None:
        """Add the profile and set the frequency of the excitation."""
        amplitude = assembly.parameter(self.amplitude, "amplitude", "m")
        waves = assembly.parameter(self.waves, "waves")
        assembly.excite(waves * assembly.parameter(self.speed, "speed", "rad/s"))
        junction_of(assembly, self.pair).profile += amplitude * assembly.sine


@dataclass(frozen=True)
class ContactDamping(Part):
    """Viscous damping of the contact's approach, always acting: force 2 zeta omega0 mu dX/dt.

    omega0 is the linear frequency of the dry contact under the preload, mu the bodies' reduced mass; per
    unit mu this is the damper 2 zeta omega0 dX/dt of the impacting-Hertz literature.
    """

    pair: ContactPair
    ratio: Value

    def contribute(self, assembly: Assembly) -> None:
        """Set zeta."""
        junction_of(assembly, self.pair).damping_ratio = assembly.parameter(self.ratio, "damping_ratio")
