"""Piecewise linear systems with clearances, dry friction and impacts in closed form, event by event.

With z = (y, 1, cos, sin) each mode of the contacts is linear, z' = G z, and a mode lasts while its rows W z
stay positive; no integrator takes part, and what is followed is exact to rounding.

    Stop       G has column row', the mode with row z > 0; column force' where it jumps there
    Friction   G has side column at 1 while it slips, side = sign(row z); while it sticks the column carries
               the part L z of it, |L z| < 1, that keeps row z = 0
    Wall       z becomes reset z where row z falls to 0; with a column, that of its force, z may rest there

An impact slower than SLOW, pressed to the wall, is the last of impacts without number in finite time: z comes
to rest, row z = row z' = 0, by an impulse along the column, and rests until the column's part L z is 0.

Perturbations pass an event, z+ = R z, by S = R + (G+ R - R G-) z row / (row G- z) (di Bernardo et al.,
Piecewise-smooth Dynamical Systems, 2.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

from reference.integration import TWO_PI, Array
from reference.shooting import in_order

SAMPLES = 200
"""Pieces of a period."""

PARTS = 8
"""Parts of a piece in each of which a row has at most one extremum: it may begin at rest, on its zero."""

EVENTS = 400
"""Most events in a period."""

ROUNDING = 1e-14
"""Rows that dip less below 0 do not."""

SMALL = 1e-9
"""Walls so near have just been struck, and may be again however soon."""

SOON = 2.0 ** (-np.arange(120, -1, -1) / 4)
"""Parts of a piece in which they are looked for."""

SLOW = 1e-6
"""Speed of an impact that is the last before a rest: what is left out takes the cube of it in the mean."""

Mode = tuple[int, ...]


@dataclass(frozen=True)
class Stop:
    """A force column max(row z, 0), or column force z where row z > 0. Modes 1 (in contact) and 0."""

    row: Array
    column: Array
    force: Array | None = None


@dataclass(frozen=True)
class Friction:
    """A force column sign(row z). Modes 1, -1, and 0 where it sticks."""

    row: Array
    column: Array


@dataclass(frozen=True)
class Wall:
    """An impact z+ = reset z where row z falls to 0. Mode 1, and 0 at rest on a wall with a column."""

    row: Array
    reset: Array
    column: Array | None = None

    def plastic(self, generator: Array) -> Array:
        """R of the impulse that leaves no speed row z'."""
        assert self.column is not None
        speed = self.row @ generator
        return np.asarray(np.eye(len(speed)) - np.outer(self.column, speed) / (speed @ self.column))


Element = Stop | Friction | Wall


@dataclass(frozen=True)
class Piece:
    """One mode: G, the rows that stay positive with the element of each, which are walls, and exp(G step)."""

    generator: Array
    rows: Array
    owners: list[int]
    walls: Array
    step: float
    flow: Array

    def after(self, z: Array, t: float) -> Array:
        """z a time t later."""
        return np.asarray(expm(self.generator * t) @ z)


@dataclass(frozen=True, eq=False)
class Contact:
    """y' = A y + b + f cos(Omega t) and the elements, all in SI; (n, n), (n,), (n,)."""

    matrix: Array
    constant: Array
    force: Array
    elements: Sequence[Element]
    _pieces: dict[tuple[float, Mode], Piece] = field(default_factory=dict)

    def free(self, Omega: float) -> Array:
        """G without any element."""
        n = len(self.matrix)
        full = np.zeros((n + 3, n + 3))
        full[:n, :n], full[:n, n], full[:n, n + 1] = self.matrix, self.constant, self.force
        full[n + 1, n + 2], full[n + 2, n + 1] = -Omega, Omega
        return full

    def sticking(self, Omega: float, mode: Mode) -> tuple[Array, list[int], Array]:
        """G, the elements that stick, and the rows L of what their columns carry, as parts of 1."""
        G, n = self.free(Omega), len(self.matrix)
        for element, side in zip(self.elements, mode, strict=True):
            if isinstance(element, Stop) and side:
                G += np.outer(element.column, element.row if element.force is None else element.force)
            if isinstance(element, Friction):
                G[:, n] += side * element.column
        stuck = [i for i, e in enumerate(self.elements) if not isinstance(e, Stop) and mode[i] == 0]
        if not stuck:
            return G, stuck, np.zeros((0, len(G)))
        free = self.free(Omega)
        held = [self.elements[i] for i in stuck]
        rows = np.array([e.row @ free if isinstance(e, Wall) else e.row for e in held])
        columns = np.array([self.elements[i].column for i in stuck]).T  # type: ignore[union-attr]
        carried = -np.linalg.solve(rows @ columns, rows @ G)
        return G + columns @ carried, stuck, carried

    def piece(self, Omega: float, mode: Mode) -> Piece:
        """The mode's matrices, kept."""
        if (Omega, mode) not in self._pieces:
            G, stuck, carried = self.sticking(Omega, mode)
            one, rows, owners = np.eye(len(G))[len(self.matrix)], [], []
            for i, (element, side) in enumerate(zip(self.elements, mode, strict=True)):
                if i in stuck and isinstance(element, Wall):
                    rows.append(carried[stuck.index(i)])
                    owners.append(i)
                elif i in stuck:
                    rows += [one - carried[stuck.index(i)], one + carried[stuck.index(i)]]
                    owners += [i, i]
                else:
                    rows.append(element.row if side > 0 else -element.row)
                    owners.append(i)
            fastest = float(np.abs(np.linalg.eigvals(G)).max())
            step = min(TWO_PI / Omega / SAMPLES, 0.5 / fastest)
            walls = np.array([isinstance(self.elements[i], Wall) and bool(mode[i]) for i in owners])
            self._pieces[Omega, mode] = Piece(G, np.array(rows), owners, walls, step, expm(G * step))
        return self._pieces[Omega, mode]

    def begin(self, z: Array) -> Mode:
        """The mode at a state on which no element sticks or is at an event."""
        return tuple(
            1
            if isinstance(e, Wall)
            else int(e.row @ z > 0)
            if isinstance(e, Stop)
            else int(np.sign(e.row @ z))
            for e in self.elements
        )

    def passed(self, Omega: float, mode: Mode, i: int, z: Array) -> tuple[Mode, Array]:
        """The mode after an event of element i, and R."""
        element, same = self.elements[i], np.eye(len(z))
        if isinstance(element, Wall) and mode[i] == 0:
            return _with(mode, i, 1), same
        if isinstance(element, Wall) and self._rests(Omega, mode, i, z):
            return _with(mode, i, 0), element.plastic(self.free(Omega))
        if isinstance(element, Wall):
            after = element.reset @ z
            slips = [isinstance(e, Friction) and abs(e.row @ after) > ROUNDING for e in self.elements]
            each = zip(self.elements, mode, slips, strict=True)
            return tuple(int(np.sign(e.row @ after)) if slip else m for e, m, slip in each), element.reset
        if isinstance(element, Stop):
            return _with(mode, i, 1 - mode[i]), same
        _, stuck, carried = self.sticking(Omega, _with(mode, i, 0))
        needed = float(carried[stuck.index(i)] @ z)
        if mode[i] == 0 or abs(needed) >= 1:
            return _with(mode, i, int(np.sign(needed))), same
        return _with(mode, i, 0), same

    def _rests(self, Omega: float, mode: Mode, i: int, z: Array) -> bool:
        """Whether an impact is so slow that it comes to rest, and its wall has to push."""
        wall, free = self.elements[i], self.free(Omega)
        if not isinstance(wall, Wall) or wall.column is None or abs(wall.row @ free @ z) > SLOW:
            return False
        _, stuck, carried = self.sticking(Omega, _with(mode, i, 0))
        return bool(carried[stuck.index(i)] @ wall.plastic(free) @ z > 0)


def _with(mode: Mode, i: int, side: int) -> Mode:
    return (*mode[:i], side, *mode[i + 1 :])


@dataclass(frozen=True)
class Period:
    """One period: where a state leads, the monodromy matrix, the largest growth on the way, the events."""

    start: Array
    end: Array
    monodromy: Array
    growth: float
    events: list[tuple[int, float]]

    @property
    def multipliers(self) -> NDArray[np.complex128]:
        """Eigenvalues of the monodromy matrix, largest modulus first."""
        return in_order(np.linalg.eigvals(self.monodromy))


def period(system: Contact, Omega: float, start: ArrayLike, phase: float = 0.0) -> Period:
    """Follow y over a period from a phase Omega t on."""
    begin = np.array(start, dtype=float)
    n, span, t = len(begin), TWO_PI / Omega, 0.0
    z = np.concatenate([begin, [1.0, np.cos(phase), np.sin(phase)]])
    mode, perturbed, growth, events = system.begin(z), np.eye(n + 3), 1.0, []
    while span - t > 1e-14 * span:
        piece = system.piece(Omega, mode)
        length = min(piece.step, span - t)
        flow = piece.flow if length == piece.step else expm(piece.generator * length)
        hit = _left(piece, z, flow @ z, length)
        if hit is not None:
            length = hit[1]
            flow = expm(piece.generator * length)
        z, perturbed, t = flow @ z, flow @ perturbed, t + length
        if hit is not None:
            i = piece.owners[hit[0]]
            mode, R = system.passed(Omega, mode, i, z)
            row, after = piece.rows[hit[0]], system.piece(Omega, mode).generator
            jump = after @ R @ z - R @ piece.generator @ z
            speed = float(row @ piece.generator @ z)
            if speed == 0:
                raise ArithmeticError("an event at rest")
            perturbed = (R + np.outer(jump, row) / speed) @ perturbed
            z = at_rest(system.elements[i], R @ z)
            events.append((i, phase + Omega * t))
            if len(events) > EVENTS:
                raise ArithmeticError("too many events")
        growth = max(growth, float(np.linalg.norm(perturbed[:n, :n], 2)))
    return Period(begin, z[:n], perturbed[:n, :n], growth, events)


def at_rest(element: Element, z: Array) -> Array:
    """z where friction turns, sticks or slips: what its row is there but 0 is rounding."""
    if not isinstance(element, Friction):
        return z
    return z - element.row * (element.row @ z) / (element.row @ element.row)


def _left(piece: Piece, z: Array, later: Array, length: float) -> tuple[int, float] | None:
    """The row that is first to fall below 0 within a length, and when."""
    slopes = piece.rows @ piece.generator
    values, first, last, end = piece.rows @ z, slopes @ z, slopes @ later, piece.rows @ later
    found: tuple[int, float] | None = None
    begun = piece.walls & (np.abs(values) < SMALL)
    for k in np.flatnonzero((end < 0) | ((first < 0) & (last > 0) & (values < -first * length)) | begun):
        at = _zero(piece, z, int(k), length)
        if at is not None and (found is None or at < found[1]):
            found = int(k), at
    return found


def _zero(piece: Piece, z: Array, k: int, length: float) -> float | None:
    row, slope = piece.rows[k], piece.rows[k] @ piece.generator

    def value(t: float) -> float:
        return float(row @ piece.after(z, t))

    def rate(t: float) -> float:
        return float(slope @ piece.after(z, t))

    struck = piece.walls[k] and abs(value(0.0)) < SMALL
    places = np.append(0.0, length * SOON) if struck else np.linspace(0.0, length, PARTS + 1)
    turns = [
        float(brentq(rate, a, b, xtol=1e-15))
        for a, b in zip(places[:-1], places[1:], strict=True)
        if rate(a) * rate(b) < 0
    ]
    ends = [0.0, *turns, length]
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        if value(b) < (0.0 if b == length else -ROUNDING):
            return float(brentq(value, a, b, xtol=1e-16, rtol=1e-15)) if value(a) > 0 else a
    return None


def periodic(system: Contact, Omega: float, guess: ArrayLike, phase: float = 0.0) -> Period:
    """Newton on y(T) - y(0) = 0 from a guess of y(0)."""
    state, best, unchanged = np.array(guess, dtype=float), np.inf, 0
    for _ in range(30):
        found = period(system, Omega, state, phase)
        gap = found.end - found.start
        size = float(np.abs(gap).max())
        if size < 1e-13 * max(1.0, found.growth):
            return found
        best, unchanged = min(best, size), unchanged + 1 if size >= best else 0
        if unchanged == 5:
            break
        state = state + np.linalg.solve(np.eye(state.size) - found.monodromy, gap)
    if best < 1e-9:
        return found
    raise ArithmeticError(f"shooting did not converge, {best:.1e} is left")
