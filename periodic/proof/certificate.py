"""A certificate: an orbit known so well that boxes can be shown to hold it, and what is claimed of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from flint import arb, ctx
from scipy.optimize import minimize_scalar

from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.proof import check
from periodic.proof.check import NotProvedError, Problem, value
from periodic.proof.draft import (
    LEAST,
    POINT,
    Fineness,
    Piece,
    Place,
    Steps,
    pieces,
    placed,
    ratio,
    stepped,
)

ITERATIONS = 8
"""Newton's iterations on a draft at the most; they converge quadratically."""

SETTLED = 1e3
"""Newton's iterations end where their increment is less than so many times the width of their enclosure."""

KNOWN = 1e-14
"""Increment at which they end while steps at singularities are long."""

ROOM = 1024.0, 8.0, 5
"""Width of boxes over that of the Newton step's enclosure at their middle; factor on that, attempts."""

LEAST_BOX = 1e-30
"""Half width of a box at the least, and margin of an output that is constant."""

MARGIN = 1e-11
"""Part of its range by which an output's greatest value is claimed to be uncertain."""

WIDER = 16.0, 8
"""Factor on the margin of a greatest value that could not be shown, and attempts."""

SAMPLES = 33
"""Places in a step at which an output is looked at for its greatest value."""

DISC = 1.1
"""A multiplier is claimed to lie in a disc of so many times the width of its enclosure."""


@dataclass
class Draft:
    """A certificate in the making.

    Parameters
    ----------
    given : dict
        The certificate, whose nodes and pieces are filled in.
    some : sequence of Piece
        The orbit's pieces.
    places, steps : list
        Nodes and steps of each.
    anchors : list of (str, int, str)
        What is given at the first node: a name of the text, 1 where its change along v is meant, else 0, and
        the value, or both ends of a range.
    fine : Fineness
        How finely motions are followed.
    """

    given: dict[str, Any]
    some: Sequence[Piece]
    places: list[list[Place]] = field(default_factory=list)
    steps: list[Steps] = field(default_factory=list)
    anchors: list[tuple[str | int, ...]] = field(default_factory=list)
    fine: Fineness = POINT

    @property
    def problem(self) -> Problem:
        """The equations that the checker makes of it."""
        return Problem(self.given)

    @property
    def singular(self) -> bool:
        """Whether some steps are of order 1, as at the ends of a Hertzian contact."""
        return any(order != self.fine.order for steps in self.steps for node in steps for _, order in node)

    def filled(self) -> None:
        """Write nodes, with boxes of no size, and steps."""
        nodes = [y for places in self.places for _, y in places]
        self.given["nodes"] = [{"centre": [ratio(a) for a in y], "radius": ["0/1"] * len(y)} for y in nodes]
        self.given["pieces"] = [
            {"sides": piece.sides, "until": piece.until, "steps": steps}
            for piece, steps in zip(self.some, self.steps, strict=True)
        ]
        self.given["anchors"] = [list(anchor) for anchor in self.anchors]

    def refined(self) -> list[float]:
        """Iterate until the nodes are as good as the steps; return the last enclosure's width by unknown."""
        noise = self._iterated()
        for least in LEAST[1:] if self.singular else ():
            self.steps = [
                stepped(self.problem, piece.sides, places, least, self.fine)
                for piece, places in zip(self.some, self.places, strict=True)
            ]
            noise = self._iterated()
        return noise

    def _iterated(self) -> list[float]:
        self.filled()
        for _ in range(ITERATIONS):
            orbit = check.Orbit(self.given)
            new = orbit.newton()
            both = [
                (a, b)
                for row, old in zip(new, orbit.centres, strict=True)
                for a, b in zip(row, old, strict=True)
            ]
            change = max(float(abs(a - b).upper()) for a, b in both)
            noise = [max(float(row[i].rad()) for row in new) for i in range(len(new[0]))]
            if not np.isfinite([change, *noise]).all():
                raise NotProvedError("Newton's iteration fails: the orbit is at a fold, or too sensitive")
            found = iter(new)
            self.places = [[(s, [a.mid() for a in next(found)]) for s, _ in places] for places in self.places]
            self.filled()
            if change < max(SETTLED * max(noise), KNOWN * self.singular):
                return noise
        raise NotProvedError(f"Newton's iteration does not converge in {ITERATIONS} steps")

    def boxed(self, noise: Sequence[float]) -> check.Orbit:
        """Give the nodes boxes that the Newton step leads into; returns what the checker makes of them."""
        factor, more, attempts = ROOM
        for _ in range(attempts):
            radius = [ratio(max(factor * width, LEAST_BOX)) for width in noise]
            for node in self.given["nodes"]:
                node["radius"] = radius
            orbit = check.Orbit(self.given)
            inside = zip(orbit.newton(), orbit.boxes, strict=True)
            if all(b.contains_interior(a) for row, box in inside for a, b in zip(row, box, strict=True)):
                return orbit
            factor *= more
        raise NotProvedError("no box could be shown to hold the orbit")


def drafted(
    given: dict[str, Any], values: Mapping[str, float], orbit: Orbit, fine: Fineness = POINT
) -> Draft:
    """Return the draft of a certificate of an orbit, with equations and values of all names given."""
    ctx.prec = fine.bits
    given = {**given, "format": check.FORMAT, "bits": fine.bits, "claim": "orbit"}
    some = pieces(Problem({**given, "pieces": [{}]}), values, orbit, given["names"]["impacts"])
    draft = Draft({**given, "pieces": some}, some, fine=fine)
    unknown = [values[name] for name in given["unknown"]]
    both = [placed(draft.problem, orbit, piece, unknown, fine) for piece in some]
    draft.places, draft.steps = [a for a, _ in both], [b for _, b in both]
    return draft


def tangent(draft: Draft, sign: int) -> tuple[int, list[Array]]:
    """Return at each node the eigenvector of the multiplier nearest to sign, and its largest component.

    That component is 1 at the first node.
    """
    draft.filled()
    orbit = check.Orbit(draft.given)
    n, m = orbit.problem.first, orbit.problem.n
    flows = [_floats(by, n) for _, _, by, _ in orbit.flows]
    slaved = np.eye(n)[:, :m]
    if orbit.problem.constraint:
        slopes = _floats(orbit.slopes(orbit.problem.constraint)[0][1], n)[0]
        slaved[m] = -slopes[:m] / slopes[m]
    whole = slaved
    for flow in flows:
        whole = flow @ whole
    eigenvalues, vectors = np.linalg.eig(whole[:m])
    vector = slaved @ vectors[:, np.abs(eigenvalues - sign).argmin()].real
    largest = int(np.abs(vector).argmax())
    found = [vector / vector[largest]]
    for flow in flows[:-1]:
        found.append(flow @ found[-1])
    return largest, found


def _floats(a: Any, n: int) -> Array:
    """The middles of a matrix's first rows and columns, n at the most."""
    return np.array([[float(a[i, j].mid()) for j in range(n)] for i in range(min(n, a.nrows()))])


def extended(draft: Draft, claim: str) -> Draft:
    """Return the draft with the linearised equations beside it, for a fold or a doubling."""
    largest, vectors = tangent(draft, 1 if claim == "fold" else -1)
    problem, remaining = draft.problem, iter(vectors)
    first = problem.free
    places = [
        [(s, [*y[:first], *map(arb, map(float, next(remaining))), *y[first:]]) for s, y in some]
        for some in draft.places
    ]
    new = Draft({**draft.given, "claim": claim, "pieces": draft.some}, draft.some, places)
    new.steps = [
        stepped(new.problem, piece.sides, some, LEAST[0])
        for piece, some in zip(new.some, places, strict=True)
    ]
    new.anchors = [(f"x{largest}", 1, "1/1")]
    return new


def based(orbit: check.Orbit) -> None:
    """Give the nodes bases that keep apart what grows and what decays on the way to them."""
    basis = np.eye(orbit.problem.first)
    for by, node in zip(orbit.transitions(), orbit.given["nodes"][1:], strict=False):
        moved = _floats(by, len(basis)) @ basis
        order = np.argsort(-np.linalg.norm(moved, axis=0), kind="stable")
        basis = np.linalg.qr(moved[:, order])[0]
        node["basis"] = [[repr(float(a)) for a in row] for row in basis]


def discs(orbit: check.Orbit) -> list[list[str]] | None:
    """Return discs around the multipliers, each real and imaginary part and radius; None if not known."""
    try:
        based(orbit)
        orbit.balls = orbit.multipliers()
    except (NotProvedError, ZeroDivisionError, np.linalg.LinAlgError):  # the orbit is there all the same
        orbit.balls = None
        return None
    found: list[list[str]] = []
    for ball in orbit.balls:
        if not ball.is_finite():
            orbit.balls = None
            return None
        radius = DISC * max(float(ball.real.rad()), float(ball.imag.rad()), 1e-30)
        found.append([ratio(ball.real), ratio(ball.imag), ratio(radius)])
    return found


def extremes(orbit: check.Orbit, names: Sequence[str]) -> dict[str, list[list[object]]]:
    """Return for each output (step, place, inner, outer): bounds of its least and of its greatest value.

    In that step, at that place, it is beyond the inner bound.
    """
    values = [step.polynomials() for step, *_ in orbit.steps]
    lengths = [step.h for step, *_ in orbit.steps]
    found = {}
    for name in names:
        polynomials = [own[name] for own in values]
        about = [_greatest(polynomials, lengths, sign) for sign in (-1, 1)]
        least, greatest = (most for most, *_ in about)
        margin = max(MARGIN * max(least + greatest, abs(least) / 100, abs(greatest) / 100), LEAST_BOX)
        found[name] = [
            [k, ratio(place), *_shown(polynomials, lengths, sign, k, place, margin)]
            for sign, (_, k, place) in zip((-1, 1), about, strict=True)
        ]
    return found


def _greatest(
    polynomials: Sequence[list[arb]], lengths: Sequence[arb], sign: int
) -> tuple[float, int, float]:
    """About the greatest value of sign times an output, in which step it is, and where in it."""
    most, where = -np.inf, (0, 0.0, 0.0)
    for k, (p, length) in enumerate(zip(polynomials, lengths, strict=True)):
        at = np.linspace(0.0, float(length), SAMPLES)
        along = sign * np.polynomial.polynomial.polyval(at, [float(c.mid()) for c in p])
        best = int(along.argmax())
        if along[best] > most:
            most, place = float(along[best]), float(at[best])
            where = (k, at[max(best - 1, 0)], at[min(best + 1, SAMPLES - 1)])
    k, a, b = where
    finer = minimize_scalar(
        lambda t: -sign * float(value(polynomials[k], arb(t)).mid()),
        bounds=(a, b),
        method="bounded",
        options={"xatol": 1e-12 * max(b - a, 1e-300)},
    )
    return (-float(finer.fun), k, float(finer.x)) if -float(finer.fun) > most else (most, k, place)


def _shown(
    polynomials: Sequence[list[arb]], lengths: Sequence[arb], sign: int, k: int, place: float, margin: float
) -> tuple[str, str]:
    """A value that an output is beyond at a place of a step, and one that it is beyond nowhere."""
    wider, attempts = WIDER
    reached = sign * value(polynomials[k], arb(place))
    for _ in range(attempts):
        bound = float(reached.upper()) + margin
        try:
            for p, h in zip(polynomials, lengths, strict=True):
                left = [bound - sign * p[0], *(-sign * c for c in p[1:])]
                check.keeps(left, "an output may be beyond a bound", arb(0), h)
        except NotProvedError:
            margin *= wider
            continue
        return ratio(sign * (float(reached.lower()) - margin)), ratio(sign * bound)
    raise NotProvedError("the extremes of an output are not known")
