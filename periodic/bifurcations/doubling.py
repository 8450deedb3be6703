"""PD: period doublings (flips), where a Floquet multiplier is -1: prod (mu + 1) = 0."""

from __future__ import annotations

import math

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.testfunction import TestFunction
from periodic.correction.solution import Solution
from periodic.stability.multipliers import Complex
from periodic.stability.winding import FADED, confined, pair_crossings


def product_test(found: Complex, at: int) -> float:
    """prod (1 - at mu) / (1 + |mu|) of given multipliers, at = 1 or -1.

    Factors are scaled so that none overflows. Only a real multiplier beyond `at` makes one negative, so the
    sign does not depend on how many damped ones are known where only the leading multipliers are.
    """
    return float(math.prod(_factors(found, at)).real)


def nearest(found: Complex, at: int) -> float:
    """The product of the two smallest moduli of factors of `product_test`, with its sign.

    These are of the pair about to pass `at`; the product of all dips wherever one of many pairs turns by.
    """
    factors = _factors(found, at)
    return math.copysign(math.prod(sorted(map(abs, factors))[:2]), math.prod(factors).real)


def _factors(found: Complex, at: int) -> list[complex]:
    return [(1 - at * mu) / (1 + abs(mu)) for mu in found.tolist()]


def dips(base: Solution, new: Solution, at: int) -> list[tuple[float, float]]:
    """Where complex pairs turn past `at` between two orbits, and `nearest` there if they stay complex."""
    found = pair_crossings(base.spectrum, new.spectrum, at)
    return [(place, ((1 - modulus) / (1 + modulus)) ** 2) for place, modulus in found]


def doubling(solution: Solution) -> float:
    """prod (mu + 1) / (1 + |mu|); 0 where it is not known."""
    spectrum = solution.spectrum
    return product_test(spectrum.nontrivial, -1) if spectrum.known else 0.0


def known(solution: Solution) -> bool:
    """Whether the multipliers are known despite rounding, and well enough to locate special points."""
    return solution.spectrum.known and trusted(solution)


def trusted(solution: Solution) -> bool:
    """Whether the error of the multipliers is below the method's limit for locating special points."""
    limit = solution.discretisation.trusted
    return limit == np.inf or solution.error.multiplier < limit


def doubles_twice(base: Solution, new: Solution) -> bool:
    """Whether two period doublings may lie within a step, so that the test has one sign at both its ends.

    A complex pair turns past -1, or two multipliers at one end are real and negative: either may pass -1.
    """
    return _two_negative(base, new) or bool(pair_crossings(base.spectrum, new.spectrum, -1))


def _two_negative(*ends: Solution) -> bool:
    """Whether an orbit has two real negative multipliers."""
    found = [end.spectrum.multipliers for end in ends]
    return max(int(((mu.imag == 0) & (mu.real < -FADED)).sum()) for mu in found) > 1


def kept_from_doubling(base: Solution, new: Solution) -> bool:
    """Whether pairs that turn past -1 between two orbits are seen not to reach it."""
    return not _two_negative(base, new) and confined(base.spectrum, new.spectrum)


DOUBLING = TestFunction(
    label=Label.DOUBLING,
    value=doubling,
    genuine=known,
    twice=doubles_twice,
    dips=lambda base, new: dips(base, new, -1),
    confined=kept_from_doubling,
    local=lambda solution: nearest(solution.spectrum.nontrivial, -1),
)
