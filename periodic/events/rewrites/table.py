"""The table of rewrites: what may begin or end in the word of an orbit, by its name in the literature.

With + and - the sides of a surface, 0 where the motion is held at it, (a b) a transition:

    row                    without             with              held without     with
    grazing                nothing             (+ -)(- +)        clearance        length
    grazing of an impact   nothing             (+ +)             clearance        speed
    grazing-sliding        nothing             (+ 0)(0 +)        clearance        length
    adding-sliding         nothing, in 0       (0 +)(+ 0)        clearance        length
    crossing-sliding       (+ -)               (+ 0)(0 -)        limit            length
    switching-sliding      (+ 0)               (+ -)(- 0)        limit            length
    the same about w       w, in 0             (0 +) w (+ 0)     limit            length
    reversal               w                   (+ -) w (- +)     limit            length
    impact in a corner     w                   (+ -) w (- +)     clearance        length
    swap                   a b                 b a               length           length
    grazing of a relay     nothing             ends              clearance        speed

w are events of friction at which an excursion turns back, an impact in its midst, or what happens at another
joint where one is pulled most. Where a relay just reaches its threshold a branch ends: past it the relay
switches, and the motion is another one. What begins is of no
size there: size = c depth^power, the depth being how far the orbit without it would go past its level.

References
----------
Nordmark, J. Sound Vib. 145 (1991) 279. di Bernardo, Budd, Champneys & Kowalczyk, Piecewise-smooth Dynamical
Systems, 2008, chapters 6 to 8.
"""

from __future__ import annotations

from dataclasses import dataclass

ROOT, LINEAR = 0.5, 1.0
"""Powers of the size in the depth: of what touches, and of what passes."""

SHORT = (1e-2, 1e-3, 1e-4)
"""Lengths (rad) at which patterns are exchanged, tried in turn; of impacts speeds, as parts of the range."""

SHORTER = (1e-5, 1e-6)
"""Those tried where these lead to none, or lie beyond more folds than one."""

FLAT = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
"""The same of slips between two stretches of sticking, whose size falls as the cube of their length."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """A row of the table.

    name: in the literature. touches: whether a switch just touches its level there (GR). power: of the size
    in the depth. sizes: at which words are exchanged, tried in turn; spare: tried where those lead to none.
    gradual: whether steps shorten so much on the way that each size is looked at as it is passed. by_speed:
    whether the size is the speed with which a level is passed. last: whether no orbits are near beyond it.
    """

    name: str
    touches: bool
    power: float
    sizes: tuple[float, ...] = SHORT
    spare: tuple[float, ...] = ()
    gradual: bool = False
    by_speed: bool = False
    last: bool = False

    @property
    def least(self) -> float:
        """The size below which nothing is looked at."""
        return self.sizes[-1]

    def size_below(self, size: float) -> float:
        """Return the first of the sizes that is less than this one, or it where there is none."""
        return next((each for each in self.sizes if each < size), size)

    def part(self, now: float, then: float, size: float) -> float:
        """Return at which part of the way from one size to another it has a third."""
        if self.power == ROOT:
            return min((now**2 - size**2) / (2 * now * (now - then)), 1.0)
        return min((now - size) / (now - then), 1.0)


GRAZING = Row(name="grazing", touches=True, power=ROOT)
IMPACT = Row(name="grazing of an impact", touches=True, power=ROOT, spare=SHORTER, by_speed=True)
GRAZING_SLIDING = Row(name="grazing-sliding", touches=True, power=ROOT)
ADDING_SLIDING = Row(name="adding-sliding", touches=False, power=ROOT, sizes=FLAT)
ADDING_ABOUT = Row(
    name="adding-sliding about another event", touches=False, power=ROOT, sizes=FLAT, gradual=True
)
CROSSING_SLIDING = Row(name="crossing-sliding", touches=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
SWITCHING_SLIDING = Row(name="switching-sliding", touches=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
REVERSAL = Row(name="grazing about a reversal of friction", touches=True, power=ROOT)
CORNER = Row(name="grazing in the corner of an impact", touches=True, power=LINEAR)
RELAY = Row(
    name="grazing of a relay", touches=True, power=LINEAR, sizes=SHORTER[-1:], by_speed=True, last=True
)
SWAP = Row(name="two events change places", touches=False, power=LINEAR)
