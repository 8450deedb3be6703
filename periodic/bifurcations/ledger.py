"""The ledger of a branch: what changes from point to point, and the labelled points that account for it.

Between two points whose stability is known the number of unstable multipliers changes by as many as the
labelled points between them stand for, and the parameter reverses at folds alone. Changes that they do not
account for are points that were missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.doubling import known as known_spectrum
from periodic.bifurcations.fold import VERTICAL
from periodic.bifurcations.label import Label
from periodic.correction.error import ErrorEstimate
from periodic.correction.solution import Solution
from periodic.stability.multipliers import ERRORS_FROM_ONE, ROUNDED_ONE, Complex
from periodic.system.precision import SMALLEST

CROSSING = {Label.FOLD: 1, Label.DOUBLING: 1, Label.BRANCH: 1, Label.TORUS: 2, Label.HOPF: 2}
"""How many multipliers pass the unit circle, or eigenvalues the imaginary axis, at special points."""

PLAIN = (Label.NONE, Label.USER, Label.PEAK, Label.END, Label.FAILED)
"""Labels that imply nothing of stability: no multiplier passes there. See `Entry.crossing` for the others."""

BESIDE_END = 1e-3
"""Multipliers so near the circle at the end of a branch are on it: it may begin or end at a special point."""


@dataclass(frozen=True)
class Entry:
    """A point in the ledger.

    Parameters
    ----------
    label : Label
        What kind of point it is.
    value : float
        The continuation parameter (SI).
    slope : float
        d parameter / d arclength over the length of the parameter's range.
    growth : ndarray
        log |mu| of the multipliers that are not 1 whatever the parameters; of an equilibrium the real parts
        over the largest eigenvalue.
    noise : float
        Error of `growth`; infinite where it is not known, or where a multiplier is held on the circle.
    blur : float
        Error of the parameter (SI).
    equilibrium : bool
        Whether the point is an equilibrium.
    conservative : bool
        Whether multipliers come in pairs mu, 1/mu.
    grazing : bool
        Whether it is at a grazing, where multipliers jump: `growth` is then that on one side.
    """

    label: Label
    value: float
    slope: float
    growth: np.ndarray
    noise: float
    blur: float = 0.0
    equilibrium: bool = False
    conservative: bool = False
    grazing: bool = False

    @property
    def crossing(self) -> int | None:
        """How many multipliers pass there; None if not known, as where orbits shrink to an equilibrium.

        At folds of conservative orbits no nontrivial multiplier passes.
        """
        if self.label is Label.HOPF and not self.equilibrium:
            return None
        none = self.label in (*PLAIN, Label.GRAZING) or (self.conservative and self.label is Label.FOLD)
        return 0 if none else CROSSING.get(self.label)

    @property
    def unstable(self) -> set[int]:
        """Possible numbers of multipliers outside the unit circle."""
        return self._outside(self.growth, max(self.noise, BESIDE_END if self.label is Label.END else 0.0))

    @property
    def beside(self) -> set[int]:
        """Possible numbers of multipliers outside, without those that pass there."""
        crossing = (self.crossing or 0) * (2 if self.conservative else 1)
        order = np.abs(self.growth).argsort()
        return self._outside(self.growth[order[crossing:]], self.noise)

    @staticmethod
    def _outside(growth: np.ndarray, noise: float) -> set[int]:
        return set(range(int((growth > noise).sum()), int((growth >= -noise).sum()) + 1))

    def after(self, before: set[int], folds: bool = False) -> set[int]:
        """Possible numbers outside after the point, from those before it; empty where they contradict it.

        folds: whether the parameter reverses between the point before it and the one after it.
        """
        if self.label is Label.END:  # a branch that was begun at a special point may change there
            return self.unstable if before & self.unstable else set()
        if self.label in PLAIN:
            return before & self.unstable
        crossing = self.crossing
        if crossing is None:
            return set(range(len(self.growth) + 1))
        if self.grazing:
            return {n + side * crossing for n in before for side in (-1, 1)}
        few = self.beside
        more = {count + crossing for count in few}
        stay = self.label is Label.BRANCH and (folds or abs(self.slope) <= VERTICAL)  # mu touches 1
        up, down = {n + crossing for n in before & few}, {n - crossing for n in before & more}
        return up | down | (before & (few | more) if stay else set())


def growth(multipliers: Complex, equilibrium: bool) -> np.ndarray:
    """Return log |mu|, or of an equilibrium the real parts over the largest eigenvalue."""
    size, tiny = np.abs(multipliers), SMALLEST
    if equilibrium:
        return multipliers.real / max(float(size.max(initial=0.0)), tiny)
    return np.log(np.maximum(size, tiny))


def noise(error: ErrorEstimate, multipliers: Complex) -> float:
    """Return the error of log |mu| near 0."""
    return ERRORS_FROM_ONE * error.multiplier * float(np.abs(multipliers).max(initial=1.0)) + ROUNDED_ONE


def entry(solution: Solution, label: Label) -> Entry:
    """Return the entry of a solution."""
    spectrum, equilibrium = solution.spectrum, solution.orbit.equilibrium
    known = not codim2.marginal(solution.problem) and (equilibrium or known_spectrum(solution))
    return Entry(
        label=label,
        value=solution.value,
        slope=solution.tangent.parameter / solution.problem.scale,
        growth=growth(spectrum.nontrivial, equilibrium),
        noise=noise(solution.error, spectrum.multipliers) if known else np.inf,
        blur=solution.error.motion * abs(solution.value),
        equilibrium=equilibrium,
        conservative=solution.problem.trivial > 1,
    )


@dataclass(frozen=True)
class Gap:
    """A change that no labelled point accounts for, between two values of the parameter (SI)."""

    begin: float
    end: float
    why: str

    def __str__(self) -> str:
        return f"between {self.begin:.10g} and {self.end:.10g} {self.why}"


def gaps(entries: Sequence[Entry], folds: bool = True) -> list[Gap]:
    """Return the changes that no labelled point accounts for, in order along the branch.

    folds: whether folds in the parameter are labelled, as on a branch. A fold that is labelled at a grazing
    may lie just before it.
    """
    entries, found = _with_grazings(entries), []
    folded = {entry.value for entry in entries if entry.grazing and entry.label is Label.FOLD}
    both = zip(pairwise(entries), pairwise(counts(entries)), _folding(entries)[1:], strict=True)
    for (last, entry), (before, after), folding in both:
        if not entry.after(before, folding):
            found.append(Gap(last.value, entry.value, _passed(before, after, entry.label)))
        elif folds and entry.value not in folded and _reversed(last, entry):
            found.append(Gap(last.value, entry.value, "the parameter turns without a labelled point"))
    return found


def _with_grazings(entries: Sequence[Entry]) -> list[Entry]:
    """The entries, marked as grazing where they are: a GR, and labels right after it at the same orbit."""
    found: list[Entry] = []
    for entry in entries:
        last = found[-1] if found else None
        same = last is not None and last.grazing and entry.value == last.value
        found.append(replace(entry, grazing=True) if same or entry.label is Label.GRAZING else entry)
    return found


def counts(entries: Sequence[Entry]) -> list[set[int]]:
    """Return possible numbers of unstable multipliers just after each point, begun anew after a gap."""
    entries = _with_grazings(entries)
    found = [entry.after(set(range(len(entry.growth) + 1))) for entry in entries[:1]]
    for entry, folding in zip(entries[1:], _folding(entries)[1:], strict=True):
        found.append(entry.after(found[-1], folding) or entry.unstable)
    return found


def _folding(entries: Sequence[Entry]) -> list[bool]:
    """Whether the parameter goes one way at the point before each and the other way at the one after it."""
    slopes = [entry.slope for entry in entries]
    inner = [before * after < 0 for before, after in zip(slopes, slopes[2:], strict=False)]
    return [False, *inner, False][: len(slopes)]


def _reversed(last: Entry, entry: Entry) -> bool:
    """Whether the parameter's change between two points contradicts its slopes there."""
    moved = entry.value - last.value
    way = [moved] if abs(moved) > max(last.blur, entry.blur) else []
    way += [point.slope for point in (last, entry) if point.label in PLAIN and abs(point.slope) > VERTICAL]
    return len({bool(direction > 0) for direction in way}) > 1


def _passed(before: set[int], after: set[int], label: Label) -> str:
    begin, end = (" or ".join(map(str, sorted(counts))) for counts in (before, after))
    why = " without a labelled point" if label in PLAIN else f", which {label} does not explain"
    return f"unstable multipliers go from {begin} to {end}{why}"
