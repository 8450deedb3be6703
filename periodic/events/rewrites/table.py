"""The table of rewrites: transitions that may begin or end in the word of an orbit, by their usual names.

With + and - the sides of a surface, 0 where the motion is held at it, (a b) a transition:

    row                    without             with              held without     with
    grazing                nothing             (+ -)(- +)        clearance        length
    grazing of an impact   nothing             (+ +)             clearance        speed
    grazing-sliding        nothing             (+ 0)(0 +)        clearance        length
    adding-sliding         nothing, in 0       (0 +)(+ 0)        clearance        length
    grazing of a limit     nothing, in 0       (0 +)(+ 0)        clearance        length
    crossing-sliding       (+ -)               (+ 0)(0 -)        limit            length
    switching-sliding      (+ 0)               (+ -)(- 0)        limit            length
    adding-sliding about w w, in 0             (0 +) w (+ 0)     limit            length
    switching about w      (+ 0) w             (+ -) w (- 0)     limit            length
    adding-sliding before  (a b -c)            c a b -c          limit            length
    first slips            0 all along         (0 +)(+ 0) and    clearance        length
                                               (0 -)(- 0)
    first departures       0 all along         (0 +)(+ 0)        clearance        length
    reversal               w                   (+ -) w (- +)     limit            length
    impact in a corner     w                   (+ -) w (- +)     clearance        length
    swap                   a b                 b a               length           length
    swap of three          a b c               c b a             length           length
    round an intersection  a b                 c b a c           length           length
    and held then          a b c0              c b a c0          length           length
    and along it           a b0                c b0 (a c)        length           length
    held up to it          a b                 c0 (a b -c0)      length           length
    merging of stops       a b F               F (a and b)       length           length
    grazing of a relay     nothing             ends              clearance        speed
    corner before impact   I from a            (a b) I from b    limit            length
    corner after impact    I to b              I to a, (a b)     limit            length
    release at an impact   I from 0            (0 b) I from b    limit            length
    caught after impact    I to +, (+ 0)       I to -, (- 0)     length           length

Switching-sliding about w is that of a joint whose force, at its limit, stays as it is until w: of a mass that
rests on one that rests. The length of the slip jumps there, its amplitude and its length beyond w begin at 0.
Where the branch turns back at it, as at any row, it is a non-smooth fold (labelled LP).

Three change places at once where the guard of one is a combination of those of the others, as of two speeds
and their difference; so c is passed twice on one side where it is not passed on the other. c0: held from
there on, -c0: let go. See `rewrites/intersections.py`.

The grazing of a limit is adding-sliding of a slider. A slider that slips, however briefly, forgets where it
was held before, so that the multipliers jump; where friction slips they do not.

I is an impact at which the guard of another surface jumps, as of friction against a belt: it takes that
surface from one mode to another. Where the guard is 0 just before or after the impact the orbit passes the
corner of both surfaces. F is friction between two masses that sticks: two joints on them have the same guard
then, and stop at once. w are the events inside an excursion: of friction at which it turns back, an impact,
or events at other joints while one joint is pulled most. Where a relay just reaches its threshold a branch
ends: past it the relay switches, and the motion is another one. An excursion has size 0 where it begins:
size = c depth^power, the depth being how far the orbit without it would go past its level.

References
----------
Nordmark, J. Sound Vib. 145 (1991) 279. di Bernardo, Budd, Champneys & Kowalczyk, Piecewise-smooth Dynamical
Systems, 2008, chapters 6 to 8. Corners: di Bernardo, Budd & Champneys, Physica D 154 (2001) 171.
"""

from __future__ import annotations

from dataclasses import dataclass

from periodic.events.thresholds import LEAST_CROSSING, LEAST_GRAZING, LONGEST, decades
from periodic.system.precision import CONVERGED

ROOT, LINEAR = 0.5, 1.0
"""Powers of the size in the depth: after the grazing of a level, and after its crossing."""

SHORT = decades(LONGEST, LEAST_GRAZING)
SHORTER = decades(LONGEST, LEAST_CROSSING)[len(SHORT) :]
FLAT = tuple(size ** (2 / 3) for size in decades(LONGEST, LEAST_GRAZING**1.5))
"""Sizes (rad; of impacts speeds, as parts of the range) at which words are exchanged, tried in turn: SHORT
after grazing; SHORTER, further ones after crossings; FLAT of slips between two sticking segments. Slips
change the states by the cube of their length, grazing by the square: FLAT are the sizes of equal effect.
"""


@dataclass(frozen=True, kw_only=True)
class Row:
    """A row of the table.

    name: the usual one. grazes: whether a switch grazes its level there (GR). power: of the size
    in the depth. sizes: at which words are exchanged, tried in turn; spare: tried where those lead to none.
    gradual: whether steps shorten so much on the way that each size is tried as it is passed. by_speed:
    whether the size is the speed with which a level is passed. last: whether no orbits are near beyond it.
    """

    name: str
    grazes: bool
    power: float
    sizes: tuple[float, ...] = SHORT
    spare: tuple[float, ...] = ()
    gradual: bool = False
    by_speed: bool = False
    last: bool = False

    @property
    def least(self) -> float:
        """The least size at which words are exchanged."""
        return self.sizes[-1]

    def size_below(self, size: float) -> float:
        """Return the first of the sizes that is less than `size`, or `size` where there is none.

        An excursion that is held at one of them has that size but for rounding.
        """
        return next((each for each in self.sizes if each < size * (1 - CONVERGED)), size)

    def part(self, now: float, then: float, size: float) -> float:
        """Return the part of the way from the size `now` to the size `then` at which it is `size`."""
        if self.power == ROOT:
            return min((now**2 - size**2) / (2 * now * (now - then)), 1.0)
        return min((now - size) / (now - then), 1.0)


GRAZING = Row(name="grazing", grazes=True, power=ROOT)
IMPACT = Row(name="grazing of an impact", grazes=True, power=ROOT, spare=SHORTER, by_speed=True)
GRAZING_SLIDING = Row(name="grazing-sliding", grazes=True, power=ROOT)
ADDING_SLIDING = Row(name="adding-sliding", grazes=False, power=ROOT, sizes=FLAT)
ADDING_ABOUT = Row(
    name="adding-sliding about another event", grazes=False, power=ROOT, sizes=FLAT, gradual=True
)
TEARING = Row(name="adding-sliding before a release", grazes=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
FIRST_SLIPS = Row(
    name="adding-sliding of what is held all along", grazes=True, power=ROOT, sizes=FLAT, gradual=True
)
FIRST_DEPARTURES = Row(
    name="adding-sliding of what slides all along", grazes=False, power=ROOT, sizes=FLAT, gradual=True
)
LIMIT_GRAZING = Row(name="grazing of a limit", grazes=True, power=ROOT, sizes=FLAT)
CROSSING_SLIDING = Row(name="crossing-sliding", grazes=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
SWITCHING_SLIDING = Row(name="switching-sliding", grazes=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
SWITCHING_ABOUT = Row(name="switching-sliding about another event", grazes=False, power=ROOT)
REVERSAL = Row(name="grazing about a reversal of friction", grazes=True, power=ROOT)
CORNER = Row(name="grazing in the corner of an impact", grazes=True, power=LINEAR)
BEFORE_IMPACT = Row(
    name="corner collision before an impact", grazes=True, power=LINEAR, sizes=(*SHORT, *SHORTER)
)
AFTER_IMPACT = Row(
    name="corner collision after an impact", grazes=True, power=LINEAR, sizes=(*SHORT, *SHORTER)
)
RELEASE_AT_IMPACT = Row(name="release at an impact", grazes=False, power=LINEAR, sizes=(*SHORT, *SHORTER))
CAUGHT = Row(name="caught after an impact", grazes=False, power=LINEAR)
RELAY = Row(
    name="grazing of a relay", grazes=True, power=LINEAR, sizes=SHORTER[-1:], by_speed=True, last=True
)
SWAP = Row(name="two events change places", grazes=False, power=LINEAR)
MERGING = Row(name="two stops become one", grazes=False, power=LINEAR)
