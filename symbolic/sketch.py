"""A drawing of a model: shapes as plain data, and what moves them. Parts say how they look, pages draw it.

Lengths of a drawing are its own, a body about one unit wide; what a coordinate or a clearance adds to them is
magnified, all by one factor.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import casadi as ca

BETWEEN_BODIES = 2.7
"""Distance between the drawings of bodies that are drawn beside each other."""

BODY = 0.6
"""Radius of a rotor, half the width of a block."""


class Coordinate(Protocol):
    """What moves: a coordinate of the model."""

    @property
    def name(self) -> str:
        """What its output is called."""


NameOf = Callable[[ca.SX], str]
"""Gives the name of a parameter by its symbol."""


@dataclass(frozen=True, eq=False)
class Place:
    """A length of a drawing: a fixed one, and coordinates or parameters times factors, magnified."""

    fixed: float = 0.0
    moved: tuple[tuple[Coordinate | ca.SX, float], ...] = ()

    def plain(self, name_of: NameOf, shift: float) -> dict[str, Any]:
        """Return it with names in the place of coordinates and parameters."""
        moved = [[name_of(i) if isinstance(i, ca.SX) else i.name, factor] for i, factor in self.moved]
        return {"fixed": self.fixed + shift, "moved": moved}


def at(fixed: float, *moved: Coordinate | ca.SX, factor: float = 1.0) -> Place:
    """Return a place: a fixed length plus coordinates or parameters, each times a factor."""
    return Place(fixed, tuple((item, factor) for item in moved))


ZERO = at(0.0)


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape of a drawing.

    Parameters
    ----------
    kind : str
        "disc" (radius `size`; with `waves` a corrugation of height `depth`), "ring" (a bore of radius
        `size`), "block" (of half width `size`), "wall" (its face at x, its body towards the sign of `size`),
        "line" (a structure's shape, through `nodes`).
    of : tuple of Coordinate
        The coordinates that it shows: shapes of the same ones are drawn together.
    x, y, size, depth : Place
        Centre, size and height of waves.
    arm, start, turn : float
        Distance from the centre at which the shape is carried round, at the angle start + turn theta, theta
        that of the excitation; a disc shows the angle by a spoke.
    waves : int
        Corrugations around a disc; the phase of the excitation is that of the topmost one.
    look : str
        "body", "fixed", "film" or "mark".
    nodes : tuple of (str, int)
        Of a "line", a structure's shape: names and indices of degrees of freedom, one after another along it.
    structure : str
        Their structure.
    """

    kind: str
    of: tuple[Coordinate, ...]
    x: Place = ZERO
    y: Place = ZERO
    size: Place = ZERO
    depth: Place = ZERO
    arm: float = 0.0
    start: float = 0.0
    turn: float = 0.0
    waves: int = 0
    look: str = "body"
    nodes: tuple[tuple[str, int], ...] = ()
    structure: str = ""


@dataclass
class Sketch:
    """The shapes that parts have drawn so far."""

    shapes: list[Shape] = field(default_factory=list)

    def draw(self, kind: str, of: tuple[Coordinate, ...], **more: Any) -> None:
        """Add a shape."""
        self.shapes.append(Shape(kind, of, **more))

    def wall(self, q: Coordinate, gap: ca.SX, side: int) -> None:
        """Add a wall at a gap from the block of a coordinate, on its upper (1) or lower (-1) side."""
        face = at(side * BODY / 2, gap, factor=float(side))
        self.draw("wall", (q,), x=face, size=at(side), look="fixed")

    def rotor(self, x: Coordinate, y: Coordinate, clearance: ca.SX | None = None) -> None:
        """Add a rotor, in a ring with a clearance."""
        if clearance is not None:
            self.draw("ring", (x, y), size=at(BODY, clearance), look="fixed")
        self.draw("disc", (x, y), x=at(0, x), y=at(0, y), size=at(BODY))

    def structure(self, of: tuple[Coordinate, ...], name: str, nodes: Sequence[tuple[str, int]]) -> None:
        """Add the shape of a structure, which shows all its coordinates."""
        self.draw("line", of, nodes=tuple(nodes), structure=name)

    def plain(
        self, coordinates: Sequence[Coordinate], name_of: NameOf, order: float
    ) -> tuple[Mapping[str, Any], ...]:
        """Return all shapes as plain data, bodies side by side; coordinates that nobody drew are blocks.

        Parameters
        ----------
        coordinates : sequence of Coordinate
            Those of the model.
        name_of : callable
            Gives the name of a parameter by its symbol.
        order : float
            theta in one radian of the phase tau.
        """
        drawn = {q for shape in self.shapes if shape.kind != "wall" for q in shape.of}
        blocks = [Shape("block", (q,), x=at(0, q), size=at(BODY / 2)) for q in coordinates if q not in drawn]
        bent = {q for shape in self.shapes if shape.kind == "line" for q in shape.of}
        shapes = [s for s in self.shapes if s.kind != "wall" or not bent & set(s.of)]
        places: dict[tuple[str, ...], float] = {}
        found: list[Mapping[str, Any]] = []
        for shape in (*shapes, *blocks):
            group = (shape.structure,) if shape.structure else tuple(q.name for q in shape.of)
            shift = places.setdefault(group, BETWEEN_BODIES * len(places))
            plain = {
                "kind": shape.kind,
                "of": [q.name for q in shape.of],
                "look": shape.look,
                "x": shape.x.plain(name_of, shift),
                "y": shape.y.plain(name_of, 0.0),
                "size": shape.size.plain(name_of, 0.0),
                "depth": shape.depth.plain(name_of, 0.0),
                "arm": shape.arm,
                "start": shape.start,
                "turn": shape.turn * order,
                "waves": shape.waves,
                "nodes": [list(node) for node in shape.nodes],
                "structure": shape.structure,
            }
            if plain not in found:
                found.append(plain)
        return tuple(found)
