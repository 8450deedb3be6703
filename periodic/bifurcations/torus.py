"""NS: torus bifurcations (Neimark-Sacker), where a complex pair is on the unit circle: mu_i mu_j = 1."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from periodic.bifurcations.doubling import known
from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.solution import Solution
from periodic.stability.multipliers import ERRORS_FROM_ONE, ROUNDED_ONE, Complex
from periodic.stability.winding import collisions
from periodic.system.precision import LARGEST, SMALLEST


def noise(solution: Solution) -> float:
    """Distance from 1 below which a multiplier, or a product of two, cannot be told from 1."""
    return ERRORS_FROM_ONE * solution.error.multiplier + ROUNDED_ONE


def torus(solution: Solution) -> float:
    """prod over i < j of (1 - mu_i mu_j) / (1 + |mu_i mu_j|); 0 where a product is 1 within its error.

    It is also 0 where they are lost to rounding. How many damped ones are known does not change its sign.
    """
    spectrum = solution.spectrum
    return torus_of(spectrum.nontrivial, noise(solution)) if spectrum.known else 0.0


def _sharp(solution: Solution) -> float:
    """The torus test with products taken as exact."""
    spectrum = solution.spectrum
    return torus_of(spectrum.nontrivial, 0.0) if spectrum.known else 0.0


@cache
def _both(count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Indices of the first and of the second in all pairs."""
    return np.triu_indices(count, 1)


def _products(found: Complex) -> Complex:
    """The products of all pairs, their moduli at most LARGEST."""
    first, second = _both(len(found))
    sizes = np.abs(found)
    if sizes.max(initial=0.0) <= np.sqrt(LARGEST):
        return np.asarray(found[first] * found[second])
    known = np.maximum(sizes, SMALLEST)
    logarithms, phases = np.log(known), found / known
    both = np.minimum(logarithms[first] + logarithms[second], np.log(LARGEST))
    return np.asarray(phases[first] * phases[second] * np.exp(both))


def torus_of(found: Complex, noise: float) -> float:
    """The torus test of given multipliers, their products known to within `noise`."""
    products = _products(found)
    if (np.abs(products - 1) < noise).any():
        return 0.0
    return float(np.prod((1 - products) / (1 + np.abs(products))).real)


def nearest_pair(found: Complex) -> list[int]:
    """Return the indices of the two multipliers whose product is nearest 1."""
    first, second = _both(len(found))
    nearest = np.abs(_products(found) - 1).argmin()
    return [int(first[nearest]), int(second[nearest])]


def complex_pair(found: Complex) -> bool:
    """Whether the pair whose product is nearest 1 is complex: else it is a neutral saddle."""
    return bool(found[nearest_pair(found)[0]].imag != 0)


def _genuine(solution: Solution) -> bool:
    return known(solution) and complex_pair(solution.spectrum.nontrivial)


def _pair_nearest_the_circle(solution: Solution) -> float:
    """log |mu| of the complex pair nearest the circle, with the sign of the test; without one the test."""
    found, value = solution.spectrum.nontrivial, torus(solution)
    sizes = np.abs(found[found.imag > 0])
    return float(np.sign(value) * np.abs(np.log(sizes)).min()) if len(sizes) else value


def _dips(base: Solution, new: Solution) -> list[tuple[float, float]]:
    """Where two pairs meet, and |log |mu|| of the nearer to the circle, expected if they do not leave it."""
    return [(m.place, abs(m.growth)) for m in collisions(base.spectrum, new.spectrum)]


TORUS = TestFunction(
    label=Label.TORUS,
    value=torus,
    genuine=_genuine,
    local=_pair_nearest_the_circle,
    sharp=_sharp,
    twice=lambda base, new: bool(_dips(base, new)),
    dips=_dips,
)
