"""Numbers that are known from elsewhere, computed here: a check of all that a trace needs, of two seconds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import periodic as per
import symbolic as sym

Numbers = tuple[list[float], list[float]]
"""What is found, and what is known."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """The largest relative error of some numbers, and what is allowed."""

    name: str
    error: float
    allowed: float
    seconds: float
    failure: str = ""

    @property
    def right(self) -> bool:
        """Whether the numbers are right."""
        return self.error <= self.allowed

    def __str__(self) -> str:
        said = "right" if self.right else "WRONG"
        why = self.failure or f"error {self.error:.1e}, allowed {self.allowed:.0e}"
        return f"{said} ({why}), {self.seconds:.2f} s"


def checks() -> list[Check]:
    """Return the checks, made."""
    return [_made(name, allowed, numbers) for name, (allowed, numbers) in CHECKS.items()]


def _made(name: str, allowed: float, numbers: Callable[[], Numbers]) -> Check:
    """Make a check; whatever goes wrong on the way is told as its outcome."""
    begun = time.perf_counter()
    try:
        found, known = map(np.array, numbers())
        if found.shape != known.shape:
            raise ValueError(f"{len(found)} found, {len(known)} known")
        error, failure = float(np.abs(found / known - 1).max()), ""
    except Exception as problem:
        error, failure = np.inf, f"{type(problem).__name__}: {problem}"
    seconds = time.perf_counter() - begun
    return Check(name=name, error=error, allowed=allowed, seconds=seconds, failure=failure)


def _linear() -> Numbers:
    """x'' + 0.1 x' + x = cos(Omega t): the amplitude is 1 / |1 - Omega^2 + 0.1 i Omega|."""
    x = sym.coordinate("x", unit="m")
    model = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.HarmonicForce(x, 1.0)
    branch = per.trace(sym.compile(model), "Omega", (0.8, 1.2), at=[1.0])
    known = 1 / np.abs(1 - branch.values**2 + 0.1j * branch.values)
    return list(branch.peak_to_peak("x") / 2), list(known)


def _duffing() -> Numbers:
    """Folds of x'' + 0.1 x' + x + x^3 = 0.5 cos(Omega t), by single shooting with DOP853 at 1e-13."""
    branch = per.trace(sym.scene("duffing"), "Omega", (0.3, 3.0))
    return [p.parameter for p in branch.labelled("LP")], [2.211935317020, 1.438670145514]


def _multipliers() -> Numbers:
    """The product of the multipliers is exp(-c T / m) on every orbit of Duffing's oscillator (Liouville)."""
    branch = per.trace(sym.scene("duffing"), "Omega", (0.9, 1.4))
    found = [float(np.prod(p.multipliers).real) for p in branch]
    return found, [float(np.exp(-0.1 * p.orbit.period)) for p in branch]


def _gears() -> Numbers:
    """Folds of the gear pair, whose teeth part, by shooting from contact to contact."""
    branch = per.trace(sym.scene("gear-pair"), "Omega", (0.55, 0.9), start=0.9)
    return [p.parameter for p in branch.labelled("LP")], [0.598153117, 0.835837679]


CHECKS: dict[str, tuple[float, Callable[[], Numbers]]] = {
    "resonance of a linear oscillator": (1e-6, _linear),
    "folds of Duffing's oscillator": (1e-7, _duffing),
    "product of its multipliers": (1e-6, _multipliers),
    "folds of a gear pair": (1e-7, _gears),
}
"""What is allowed, and what computes it; the tolerance of all orbits is 1e-6."""
