"""A stretch of a branch, in tiles: ranges of the parameter with one orbit for each value, end to end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from periodic.proof import check
from periodic.proof.certificate import Draft, discs
from periodic.proof.check import NotProvedError
from periodic.proof.draft import LEAST, exact, ratio, stepped

FIRST = Fraction(1, 16)
"""Width of the first tile that is tried, as a part of the range."""

WIDER, NARROWER = Fraction(5, 4), Fraction(5, 8)
"""Factors on the width after a tile, and after an attempt in vain."""

NARROWEST = Fraction(1, 100_000)
"""Width at which it ends, as a part of the range."""

MOST_TILES = 2000
"""Tiles at the most."""

ROOM, ATTEMPTS = 1.3, 3
"""Width of boxes over that which the Newton step leads to, and attempts to make them hold it."""

LEAST_BOX = 1e-15
"""Half width of a box at the least, over its centre or 1."""


@dataclass
class Tiling:
    """Tiles from a point to both sides.

    Parameters
    ----------
    draft : Draft
        The orbit at the point, the parameter among its unknowns and not among its anchors.
    over : str
        The parameter, as the text has it.
    low, high : Fraction
        Ends of the range.
    reasons : list of str
        Why an end was not reached, for each that was not.
    """

    draft: Draft
    over: str
    low: Fraction
    high: Fraction
    reasons: list[str] = field(default_factory=list)

    def tiles(self, at: Fraction) -> list[check.Orbit]:
        """Return tiles in order, as far as there are some on both sides of a value."""
        first, width = self._first(at)
        if first is None:
            return []
        below = list(self._onward(first, width, -1))
        above = list(self._onward(first, width, 1))
        return [*below[::-1], first, *above]

    def _first(self, at: Fraction) -> tuple[check.Orbit | None, Fraction]:
        width = FIRST * (self.high - self.low)
        while width > NARROWEST * (self.high - self.low):
            try:
                begin, end = max(near(at - width / 2), self.low), min(near(at + width / 2), self.high)
                return self._tile(begin, end), width
            except NotProvedError as error:
                reason, width = str(error), width * NARROWER
        self.reasons.append(reason)
        return None, width

    def _onward(self, tile: check.Orbit, width: Fraction, way: int) -> Iterator[check.Orbit]:
        """Tiles from one to an end of the range."""
        reason = f"it would take more than {MOST_TILES} ranges"
        for _ in range(MOST_TILES):
            here = fraction(tile.end if way > 0 else tile.begin)
            if here == (self.high if way > 0 else self.low):
                return
            there = min(near(here + width), self.high) if way > 0 else max(near(here - width), self.low)
            try:
                self._predict(tile, (here + there) / 2)
                new = self._tile(min(here, there), max(here, there))
                check.linked(*((tile, new) if way > 0 else (new, tile)))
            except NotProvedError as error:
                reason, width = str(error), width * NARROWER
                if width < NARROWEST * (self.high - self.low):
                    break
                continue
            yield new
            tile, width = new, width * WIDER
        self.reasons.append(f"{'beyond' if way > 0 else 'below'} {float(here):.10g}: {reason}")

    def _predict(self, tile: check.Orbit, at: Fraction) -> None:
        """Give the draft the nodes that a Newton step from a tile leads to, at a value beside it."""
        found = iter(tile.newton(exact(at)))
        self.draft.places = [
            [(s, [a.mid() for a in next(found)]) for s, _ in some] for some in self.draft.places
        ]

    def _tile(self, begin: Fraction, end: Fraction) -> check.Orbit:
        """A tile that is shown, from the draft's nodes. Raises NotProvedError."""
        draft = self.draft
        draft.steps = [
            stepped(draft.problem, piece.sides, places, LEAST[0], draft.fine)
            for piece, places in zip(draft.some, draft.places, strict=True)
        ]
        draft.filled()
        ends = (f"{end.numerator}/{end.denominator}" for end in (begin, end))
        given = {
            **draft.given,
            "claim": "stretch",
            "anchors": [*draft.given["anchors"], [self.over, 0, *ends]],
        }
        orbit = check.Orbit(given)
        for _ in range(ATTEMPTS):
            boxed(given, orbit)
            orbit = check.Orbit(given)
            new = zip(orbit.newton(), orbit.boxes, strict=True)
            if all(b.contains_interior(a) for row, box in new for a, b in zip(row, box, strict=True)):
                return self._claimed(orbit)
        raise NotProvedError("no boxes could be shown to hold the orbits of a range, however short")

    def _claimed(self, orbit: check.Orbit) -> check.Orbit:
        found = discs(orbit)
        orbit.given["claims"] = {"outputs": {}}
        if found is not None and orbit.stable() is not None:
            orbit.given["claims"] |= {"multipliers": found, "stable": orbit.stable()}
        orbit.verify()
        return orbit


def boxed(given: dict[str, Any], orbit: check.Orbit) -> None:
    """Give the nodes boxes about where the Newton step of an orbit leads to."""
    nodes = []
    for row in orbit.newton():
        if not all(a.is_finite() for a in row):
            raise NotProvedError("Newton's step has no bounds")
        radius = [ROOM * float(a.rad()) + LEAST_BOX * max(1.0, abs(float(a.mid()))) for a in row]
        nodes.append({"centre": [ratio(a) for a in row], "radius": [ratio(r) for r in radius]})
    given["nodes"] = nodes


def near(number: Fraction) -> Fraction:
    """The double nearest to a number, so that it can be said in full."""
    return Fraction(float(number))


def fraction(number: Any) -> Fraction:
    """A fraction of python-flint's as Python's."""
    return Fraction(int(number.p), int(number.q))


def certificate(draft: Draft, tiles: list[check.Orbit]) -> dict[str, Any]:
    """Return what a checker needs: the equations once, and for each tile what is its own."""
    own = ("nodes", "pieces", "anchors", "claims")
    rest = {name: each for name, each in draft.given.items() if name not in own}
    each = [{name: tile.given[name] for name in own} for tile in tiles]
    return {**rest, "claim": "stretch", "tiles": each, "pieces": tiles[0].given["pieces"]}
