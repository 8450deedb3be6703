"""One motion of a system at given parameters, and all of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
import scipy

from periodic.display.htmltables import paragraph, table
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.results.point import Point


class Sort(StrEnum):
    """What a motion is. Sorts are compared by ``==``.

    PERIODIC: it comes back. EQUILIBRIUM: nothing moves. TORUS: quasi-periodic. CHAOTIC: neighbours part.
    OPEN: it does not come back, and which of the two it is was not decided.
    """

    PERIODIC = "periodic"
    EQUILIBRIUM = "equilibrium"
    TORUS = "torus"
    CHAOTIC = "chaotic"
    OPEN = "not periodic"


@dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """A motion of a system.

    Parameters
    ----------
    sort : Sort
        What it is.
    stable : bool
        Whether motions beside it come to it.
    periods : int
        After how many excitation periods it comes back; 1 for a cycle of a system that is not excited, 0 for
        what does not come back.
    found : str
        How it was found.
    sections : ndarray, shape (K, n)
        Scaled states at tau = 0, in each of its periods; of a cycle of a system that is not excited along it.
    point : Point, optional
        The orbit or equilibrium with multipliers and error estimate.
    starts : int
        How many of the starts led to it.
    share, interval : float, (float, float)
        The part of the box that is its basin, by these, with 95 % confidence (Clopper & Pearson).
    exponent : float
        The largest Lyapunov exponent in 1/s, of tori and chaos.
    rotation : float
        The rotation number of a torus in (0, 1/2]: see `Torus.rotation_number`.
    why : str
        What is not known of it, and why.
    images : tuple of int
        Which of the motions found are its images under symmetries of the equations; itself where it is
        symmetric.
    """

    sort: Sort
    stable: bool
    periods: int
    found: str
    sections: Array
    point: Point | None = None
    starts: int = 0
    share: float = 0.0
    interval: tuple[float, float] = (0.0, 1.0)
    exponent: float = float("nan")
    rotation: float = float("nan")
    why: str = ""
    images: tuple[int, ...] = ()

    def __repr__(self) -> str:
        return f"Motion({', '.join(text for text in (self.name, self.tells) if text)}, {self.found})"

    @property
    def orbit(self) -> Orbit | None:
        """The orbit, where it is periodic and completed; a guess for `trace`."""
        return None if self.point is None else self.point.orbit

    @property
    def comes_back(self) -> bool:
        """Whether it is periodic, or rests."""
        return self.sort in (Sort.PERIODIC, Sort.EQUILIBRIUM)

    @property
    def name(self) -> str:
        """What it is, in words."""
        kind = "stable" if self.stable else "unstable"
        if self.sort == Sort.PERIODIC and self.periods > 1:
            return f"{kind}, of {self.periods} periods"
        return f"{kind}, {self.sort}"

    @property
    def tells(self) -> str:
        """What is known of it, in words."""
        if self.why:
            return self.why
        if self.sort == Sort.TORUS and np.isfinite(self.rotation):
            return f"rotation number {self.rotation:.6g}"
        if self.sort == Sort.CHAOTIC:
            return f"Lyapunov exponent {self.exponent:.4g} 1/s"
        if self.point is None or not len(self.point.multipliers):
            return ""
        if self.sort == Sort.PERIODIC:
            return f"largest multiplier {np.abs(self.point.nontrivial).max(initial=0.0):.4g}"
        if self.sort == Sort.EQUILIBRIUM:
            return f"largest growth {self.point.multipliers.real.max():.4g} 1/s"
        return ""


@dataclass(frozen=True, eq=False, repr=False)
class Motions(Sequence[Motion]):
    """All motions that were found, the stable ones first, by their basins.

    Parameters
    ----------
    motions : tuple of Motion
        The motions.
    values : dict
        All parameters (SI), by name.
    box : dict
        The ranges of states (SI) in which motions started, by name.
    starts : int
        How many motions started.
    diverged, undecided : int
        How many grew beyond all bounds, and of how many it is not known where they lead.
    tried : tuple of str
        What was tried, in words.
    units : ndarray, shape (n,)
        SI values of one internal unit of each state.
    """

    motions: tuple[Motion, ...]
    values: dict[str, float]
    box: dict[str, tuple[float, float]]
    starts: int
    diverged: int = 0
    undecided: int = 0
    tried: tuple[str, ...] = ()
    units: Array = field(default_factory=lambda: np.zeros(0))

    def __len__(self) -> int:
        return len(self.motions)

    def __getitem__(self, index: Any) -> Any:
        return self.motions[index]

    def __iter__(self) -> Iterator[Motion]:
        return iter(self.motions)

    @property
    def stable(self) -> tuple[Motion, ...]:
        """Those to which motions come."""
        return tuple(motion for motion in self.motions if motion.stable)

    @property
    def unstable(self) -> tuple[Motion, ...]:
        """Those from which motions part."""
        return tuple(motion for motion in self.motions if not motion.stable)

    def missed(self, share: float = 0.01) -> float:
        """Return the probability that none of the starts was in a basin of a share of the box.

        Parameters
        ----------
        share : float
            The part of the box, between 0 and 1.

        Returns
        -------
        float
            (1 - share) to the power of the number of starts whose end is known.

        Raises
        ------
        ValueError
            For a share that is not between 0 and 1.
        """
        if not 0 < share < 1:
            raise ValueError(f"share is {share!r}; it must lie between 0 and 1")
        return float((1 - share) ** (self.starts - self.undecided))

    def state_of(self, motion: Motion) -> dict[str, float]:
        """Return the states (SI) of a motion at tau = 0, by name.

        Parameters
        ----------
        motion : Motion
            One of these.

        Returns
        -------
        dict
            Of a motion that does not come back those of some moment.
        """
        return dict(zip(self.box, (self.units * motion.sections[0]).tolist(), strict=True))

    def __str__(self) -> str:
        rows = [HEADINGS, *self._rows]
        widths = [max(len(row[k]) for row in rows) for k in range(len(HEADINGS))]
        lines = [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in rows
        ]
        return "\n".join([*lines, *self.tried, self._summary])

    def __repr__(self) -> str:
        return f"Motions({len(self.stable)} stable, {len(self.unstable)} unstable; {self._summary})"

    def _repr_html_(self) -> str:
        told = "".join(paragraph(text) for text in (*self.tried, self._summary))
        return table(HEADINGS, self._rows) + told

    @property
    def _rows(self) -> list[tuple[str, ...]]:
        return [_row(k, motion) for k, motion in enumerate(self.motions)]

    @property
    def _summary(self) -> str:
        told = [f"{self.starts} starts"]
        if self.diverged:
            told.append(f"{self.diverged} diverged")
        if self.undecided:
            told.append(f"{self.undecided} undecided")
        told.append(f"a basin of 1 % is missed with a probability of {self.missed():.2g}")
        return ", ".join(told)


HEADINGS = ("", "motion", "share of the box", "95 %", "tells", "found")
"""Of the table of motions."""


def _row(k: int, motion: Motion) -> tuple[str, ...]:
    low, high = motion.interval
    shares = (f"{100 * motion.share:.1f} %", f"{100 * low:.1f} to {100 * high:.1f} %")
    tells = ", ".join(text for text in (motion.tells, _imaged(k, motion.images)) if text)
    return (str(k + 1), motion.name, *(shares if motion.starts else ("", "")), tells, motion.found)


def _imaged(k: int, images: tuple[int, ...]) -> str:
    """Which motions are images of the k-th, in words."""
    others = ", ".join(str(i + 1) for i in images if i != k)
    own = ["symmetric"] if k in images else []
    return ", ".join([*own, *([f"image of {others}"] if others else [])])


def interval(count: int, of: int, level: float = 0.95) -> tuple[float, float]:
    """Return the interval of a share that `count` of `of` show (Clopper & Pearson, Biometrika 26 (1934))."""
    found = scipy.stats.binomtest(count, of).proportion_ci(level) if of else (0.0, 1.0)
    return float(found[0]), float(found[1])
