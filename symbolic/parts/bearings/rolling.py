"""A rolling bearing: elements between two races, which carry the shaft one after another."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import casadi as ca

from symbolic.checks import refusal, typed, whole
from symbolic.equations.assembly import Assembly
from symbolic.equations.excitation import Order, order_of
from symbolic.equations.interval import POSITIVE, Interval
from symbolic.equations.model import Part
from symbolic.equations.variables import Coordinate, Value, apart
from symbolic.parts.bearings.ranked import ranked
from symbolic.parts.bearings.squeezed import SqueezedElements
from symbolic.parts.bearings.waves import RaceWave, Turns
from symbolic.parts.contact.law import ContactLaw, lawful
from symbolic.parts.films.series import SeriesFilm
from symbolic.parts.rest import steady_force
from symbolic.sketch import at

PASSAGES_ROUNDING = 0.02
"""Relative difference between `passages` and what the race diameters say, up to which it is a rounding."""


PRESSED = 0.01
"""Largest preload, in diameters of an element: beyond, the law of an elastic contact says nothing."""

ASIDE = 0.1
"""Cosine of the angle to the load beyond which an element does not carry the shaft by itself."""

BESIDE = 1e-10
"""By how much, in the scale of x, an element is pressed before it carries: more than Newton's method leaves.

At an event node, where an element is just not pressed, its stiffness d^(n - 1) would else be rounding's: with
d of 1e-14 of a full pressing 3 % of the full one for rollers, n = 10/9.
"""

WEAK = (-1.0,)
"""Level of the switches, not 0: the equations do not change there, only a derivative of theirs does."""


@dataclass(frozen=True)
class RollingBearing(Part):
    """Rolling bearing: force -sum_i F(d_i) (cos theta_i, sin theta_i) on the shaft's centre (x, y).

        d_i = x cos theta_i + y sin theta_i - g + waves,   theta_i = Omega_c t + 2 pi i/n,
        Omega_c = Omega D_i/(D_i + D_o)

    The period is that of the passage of the elements, n Omega_c, after which each is where the next one was;
    with `passages`, that which it has in common with the turns of the shaft. A kink in time lies where the
    number of loaded elements changes.

    Parameters
    ----------
    x, y : Coordinate
        Displacement of the shaft's centre from that of the outer race.
    elements : int
        n.
    law : ContactLaw
        F, of both contacts of an element together: HertzLaw with exponent 3/2 for balls, 10/9 for rollers.
    clearance : float or Parameter
        g in m, radial; negative for a preloaded bearing, down to -1 % of an element's diameter (D_o - D_i)/2.
    speed : float or Parameter
        Omega of the shaft in rad/s.
    inner, outer : float or Parameter
        Diameters of the races D_i and D_o in m.
    waves : sequence of RaceWave
        Waviness of races and elements.
    film : SeriesFilm, optional
        Lubricant film between each element and the races, in series with F; with squeeze it brings a state
        for each element (and one more where n is even), in multiblade coordinates.
    passages, spin : int, float, str or Fraction, optional
        Passages of elements and turns of an element about itself, in one turn of the shaft: rational numbers,
        for the period in common with what turns with the shaft.

    Raises
    ------
    ValueError
        For fewer than one element, diameters that are no races, a clearance or preload beyond the size of the
        elements, and passages that do not fit them.

    References
    ----------
    Fukata, Gad, Kondou, Ayabe & Tamura, Bull. JSME 28 (1985) 899-904; Sunnersjo, J. Sound Vib. 58 (1978)
    363-373.
    """

    EXAMPLE: ClassVar[Mapping[str, object]] = {
        "elements": 8,
        "law": {"kind": "HertzLaw", "stiffness": 1.3e10},
        "clearance": 6e-6,
        "speed": 700.0,
        "inner": 0.04,
        "outer": 0.064,
    }

    x: Coordinate
    y: Coordinate
    elements: int
    law: ContactLaw
    clearance: Value
    speed: Value
    inner: Value
    outer: Value
    waves: Sequence[RaceWave] = ()
    film: SeriesFilm | None = None
    passages: Order | None = None
    spin: Order | None = None

    def __post_init__(self) -> None:
        whole("elements", self.elements, 1)
        apart("y", self.x, self.y)
        lawful(self.law)
        if not isinstance(self.waves, Sequence) or not all(isinstance(w, RaceWave) for w in self.waves):
            raise refusal("waves", self.waves, "a sequence of RaceWave")
        if self.film is not None:
            typed("film", self.film, SeriesFilm, "a SeriesFilm")

    def contribute(self, assembly: Assembly) -> None:
        """Add the forces of all elements, and begin the search for a rest where they carry the load."""
        x, y = assembly.motion(self.x), assembly.motion(self.y)
        g = assembly.parameter(self.clearance, "clearance", self.x.unit, self._room(assembly))
        approaches, places = [], self._places(assembly)
        heights = [sum((w.height(assembly, turns) for w in self.waves), ca.SX(0)) for turns in places]
        for turns, height in zip(places, heights, strict=True):
            along = x.position.symbol * ca.cos(turns.place) + y.position.symbol * ca.sin(turns.place)
            approaches.append(along - g + height)
        rest = Carried(self, g, ca.vertcat(*heights))
        assembly.joints[rest] = rest
        for turns, load in zip(places, self._loads(assembly, approaches, places), strict=True):
            x.force -= load * ca.cos(turns.place)
            y.force -= load * ca.sin(turns.place)
        self._draw(assembly, g)
        if self.film is None:
            for count, approach in enumerate(ranked(approaches), 1):
                assembly.switch(f"{count} loaded", approach / x.position.scale - 1, 0, WEAK)

    def _draw(self, assembly: Assembly, clearance: ca.SX) -> None:
        """Draw the outer race, the elements in it, and the inner race."""
        of, draw, count = (self.x, self.y), assembly.sketch.draw, self.elements
        passage = 1.0 if self.passages is None else float(order_of(self.passages))
        draw("ring", of, size=at(1, clearance), look="fixed")
        draw("disc", of, x=at(0, self.x), y=at(0, self.y), size=at(0.64))
        for i in range(count):
            start, turn = 2 * math.pi * i / count, passage / count
            ball = {"size": at(0.16), "arm": 0.82, "start": start, "turn": turn, "look": "mark"}
            draw("disc", of, x=at(0, self.x, factor=0.5), y=at(0, self.y, factor=0.5), **ball)

    def _loads(self, assembly: Assembly, approaches: list[ca.SX], places: list[Turns]) -> list[ca.SX]:
        if self.film is None:
            pressed = [approach - BESIDE * assembly.motion(self.x).position.scale for approach in approaches]
            for each in pressed:
                assembly.smooth_at(each)  # an element's own kinks have not the period of the passage
            return [self.law.load(assembly, each) for each in pressed]
        if self.film.squeeze is None:
            return [self.film.load(assembly, self.law, approach) for approach in approaches]
        passage = self.elements * places[0].place
        films = SqueezedElements(self.film, self.law)
        return films.loads(assembly, approaches, passage, self._entraining(assembly))

    def _entraining(self, assembly: Assembly) -> ca.SX:
        """Speed of the surfaces through the contacts of an element with either race: Omega_c D_o/2."""
        _, outer = self._races(assembly)
        return self._cage(assembly) * assembly.parameter(self.speed, "speed", "rad/s") * outer / 2

    def _places(self, assembly: Assembly) -> list[Turns]:
        """The angles of all elements."""
        speed = assembly.parameter(self.speed, "speed", "rad/s")
        cage = self._cage(assembly)
        shaft = spin = None
        if self.passages is None:
            assembly.excite(self.elements * cage * speed)
            passage = assembly.angle()
        else:
            order = self._checked(assembly, self.elements * cage)
            assembly.excite(speed)
            passage = float(order_of(order)) * assembly.angle(order)
            shaft = assembly.angle()
            spin = None if self.spin is None else float(order_of(self.spin)) * shaft
            for wave in self.waves:
                assembly.angle(wave.order(order, self.spin))
        turn = 2 * ca.pi / self.elements
        return [Turns(passage / self.elements + turn * i, shaft, spin) for i in range(self.elements)]

    def _cage(self, assembly: Assembly) -> ca.SX:
        """Turns of the cage in one of the shaft."""
        inner, outer = self._races(assembly)
        return inner / (inner + outer)

    def _races(self, assembly: Assembly) -> tuple[ca.SX, ca.SX]:
        """D_i and D_o."""
        inner = assembly.parameter(self.inner, "inner_race", "m", POSITIVE)
        outer = assembly.parameter(self.outer, "outer_race", "m", POSITIVE)
        if assembly.nominal(inner) >= assembly.nominal(outer):
            raise refusal("outer", assembly.nominal(outer), "greater than the diameter of the inner race")
        return inner, outer

    def _room(self, assembly: Assembly) -> Interval:
        """Clearances of a bearing whose elements, of the diameter (D_o - D_i)/2, are pressed elastically."""
        inner, outer = self._races(assembly)
        diameter = assembly.nominal(outer - inner) / 2
        return Interval(-PRESSED * diameter, diameter)

    def _checked(self, assembly: Assembly, exact: ca.SX) -> Order:
        """The passages in one turn of the shaft, which the diameters have to allow."""
        assert self.passages is not None
        expected = assembly.nominal(exact)
        if abs(float(order_of(self.passages)) - expected) > PASSAGES_ROUNDING * expected:
            raise refusal(
                "passages", self.passages, f"about {expected:.6g}, as the diameters of the races say"
            )
        return self.passages


@dataclass(frozen=True, eq=False)
class Carried:
    """The search for a rest begins where the first element that is reached carries the load on the shaft.

    heights: of the races' waves at the elements, in m.
    """

    bearing: RollingBearing
    clearance: ca.SX
    heights: ca.SX

    def close(self, assembly: Assembly) -> None:
        """Set where the search begins, unless the user has."""
        bearing = self.bearing
        load = ca.vertcat(steady_force(assembly, bearing.x), steady_force(assembly, bearing.y))
        size = ca.norm_2(load)
        if not assembly.nominal(size) > 0:
            return
        pressed = bearing.law.preloaded(assembly, size).delta0
        reach = self._gap(assembly, load / size) + pressed
        for q, part in ((bearing.x, load[0]), (bearing.y, load[1])):
            position = assembly.motion(q).position
            if position.rest.is_zero():
                position.rest = reach * part / size

    def _gap(self, assembly: Assembly, along: ca.SX) -> ca.SX:
        """How far the shaft moves in a direction (2,) before an element is touched, the cage at rest."""
        symbols = ca.vertcat(assembly.excitation.symbols, assembly.excitation.angle)
        heights = ca.substitute(self.heights, symbols, ca.SX.zeros(symbols.size1()))
        found = ca.SX(math.inf)
        for i in range(self.bearing.elements):
            turn = 2 * math.pi * i / self.bearing.elements
            part = along[0] * math.cos(turn) + along[1] * math.sin(turn)
            gap = ca.fmax(self.clearance - heights[i], 0)
            found = ca.fmin(found, ca.if_else(part > ASIDE, gap / ca.fmax(part, ASIDE), math.inf))
        return found
