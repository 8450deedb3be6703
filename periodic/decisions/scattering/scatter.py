"""What the scatter of parameters does to a response: quantiles of peaks and folds, and probabilities.

Parameters p_i are independent, of any distributions. Each feature f of a response has, from its exact
gradients at the means m and at one standard deviation from them on either side, with d = p - m,

    f(p) = f_0 + g d + d' H d / 2,

and a quantity is the largest (least) of its features: to first order, to second order, and by samples, for
each of which every feature is followed by Newton's method.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from periodic.checks import named, one_of, shown, whole
from periodic.decisions.responses.feature import Count, LostError
from periodic.decisions.responses.quantity import AbsentError, Quantity
from periodic.decisions.responses.readquantities import Reading, traced
from periodic.decisions.scattering.scattered import Quadratic, Scattered, drawn
from periodic.display.meter import meter
from periodic.orbit.scheme import Array
from periodic.system import System, check_system, check_value, index_of

FEW = 3
"""Largest number of parameters for which means are also found by quadrature."""

GAUSS = 5
"""Points of the quadrature in each parameter."""

PANEL = 40
"""Points in each panel on which a distribution is integrated for its quadrature."""

TRACED = 10
"""Of how many samples one is traced as well, to see whether followed features miss any."""


def scatter(
    system: System,
    scattered: Mapping[str, Any],
    quantities: Mapping[str, Quantity],
    *,
    samples: int = 200,
    seed: int = 0,
) -> Scattered:
    """Return how quantities of responses scatter with parameters.

    Parameters
    ----------
    system : System
        The equations.
    scattered : mapping of str to distribution
        Independent parameters with their distributions (SI), frozen ones of `scipy.stats`: norm(1, 0.05),
        uniform(0.9, 0.2).
    quantities : mapping of str to Quantity
        {"peak": response.highest(PeakToPeak("x")), "jump": response.place("LP")}.
    samples : int
        Number of sampled designs (of a Latin hypercube).
    seed : int
        Of the samples.

    Returns
    -------
    Scattered
        Means, deviations, quantiles and probabilities.

    Raises
    ------
    ValueError
        In one sentence, for what is not allowed, and where the response has nothing of what is asked, or no
        derivatives of it, at the means of the parameters.
    """
    check_system(system)
    names = _checked(system, scattered)
    named("quantities", quantities, "quantities")
    if not quantities or not all(isinstance(q, Quantity) for q in quantities.values()):
        raise ValueError(
            f"quantities is {shown(quantities)}; it must name quantities, as response.highest(...)"
        )
    draws = _Draws(system, names, [scattered[name] for name in names], list(quantities.values()))
    try:
        middle = draws.traced(draws.means)
    except AbsentError as error:
        raise ValueError(f"at the means of the parameters {error}") from None
    points = drawn(draws.distributions, whole("samples", samples, 2), whole("seed", seed, 0))
    try:
        surrogates = tuple(draws.quadratics(middle))
    except LostError as error:
        raise ValueError(f"at the means of the parameters there are no derivatives of {error}") from None
    found, apart = draws.sampled(middle, points)
    return Scattered(
        distributions={name: scattered[name] for name in names},
        labels=tuple(quantities),
        quantities=tuple(quantities.values()),
        middle=middle.numbers,
        surrogates=surrogates,
        points=points,
        values=found,
        apart=apart,
        quadrature=draws.quadrature(middle) if len(names) <= FEW else None,
        orbits=draws.count.orbits,
    )


def _checked(system: System, scattered: Any) -> list[str]:
    """The names of the parameters. Raises ValueError."""
    for name, given in named("scattered", scattered, "distributions").items():
        one_of("a name in scattered", name, [p.name for p in system.parameters])
        if not (hasattr(given, "ppf") and np.isfinite([given.mean(), given.std()]).all() and given.std() > 0):
            raise ValueError(
                f"{name} of scattered is {shown(given)}; it must be one of scipy.stats, as norm(1, 0.1)"
            )
        parameter = system.parameters[index_of(system, name)]
        for part in (0.001, 0.999):
            check_value(parameter, float(given.ppf(part)))
    if not scattered:
        raise ValueError("scattered is empty; it must name parameters with their distributions")
    return list(scattered)


class _Draws:
    """Designs (SI, in the order of the names), and quantities read there."""

    def __init__(
        self,
        system: System,
        names: Sequence[str],
        distributions: Sequence[Any],
        quantities: Sequence[Quantity],
    ) -> None:
        self.system, self.names, self.distributions = system, names, distributions
        self.quantities, self.count = quantities, Count()

    @property
    def means(self) -> Array:
        """Means of the parameters."""
        return np.array([float(given.mean()) for given in self.distributions])

    @property
    def deviations(self) -> Array:
        """Their standard deviations."""
        return np.array([float(given.std()) for given in self.distributions])

    def values(self, design: Array) -> dict[str, float]:
        """Return parameters by name."""
        return dict(zip(self.names, design.tolist(), strict=True))

    def traced(self, design: Array) -> Reading:
        """Return quantities of branches traced at a design. Raises AbsentError."""
        return traced(self.system, self.quantities, self.values(design), self.count)

    def at(self, middle: Reading, design: Array) -> tuple[float, ...]:
        """Return quantities followed from the middle to a design, else traced; NaN what is not there."""
        try:
            return middle.at(self.values(design)).numbers
        except LostError:
            return self._each(design)

    def _each(self, design: Array) -> tuple[float, ...]:
        found: list[float] = []
        for quantity in self.quantities:
            try:
                found += traced(self.system, [quantity], self.values(design), self.count).numbers
            except AbsentError:
                found.append(np.nan)
        return tuple(found)

    def sampled(self, middle: Reading, points: Array) -> tuple[Array, float]:
        """Return quantities (samples, q), and the largest relative difference of followed and traced ones."""
        found: list[Array] = []
        apart = 0.0
        with meter("sampling", "designs", len(points)) as show:
            for k, design in enumerate(points):
                numbers = np.array(self.at(middle, design))
                if k % TRACED == 0:
                    anew = np.array(self._each(design))
                    both = np.isfinite(numbers) & np.isfinite(anew)
                    size = np.maximum(np.abs(anew[both]), np.finfo(float).tiny)
                    apart = max(apart, float(np.max(np.abs(numbers - anew)[both] / size, initial=0.0)))
                    numbers = anew
                found.append(numbers)
                show(1, "")
        return np.array(found), apart

    def quadratics(self, middle: Reading) -> Iterator[tuple[Quadratic, ...]]:
        """Yield for each quantity its features to second order. Raises LostError.

        A feature that is lost on one side of the means has a one-sided difference of its gradients; of one
        that is lost on both the curvature is not known.
        """
        centre = self._slopes(middle)
        ends = [
            [self._moved(middle, self.means + side * step) for side in (1.0, -1.0)]
            for step in np.diag(self.deviations)
        ]
        for q, features in enumerate(middle.features):
            each = []
            for f, feature in enumerate(features):
                own = centre[q][f]
                sides = [[(None if end is None else end[q][f]) for end in pair] for pair in ends]
                rows = [_curved(own, pair, h) for pair, h in zip(sides, self.deviations, strict=True)]
                curved = None if any(row is None for row in rows) else np.array(rows)
                symmetric = None if curved is None else (curved + curved.T) / 2
                each.append(Quadratic(feature.value, self.means, own, symmetric))
            yield tuple(each)

    def _moved(self, middle: Reading, design: Array) -> list[list[Array]] | None:
        """Gradients of all features at a design; None where one of them is lost on the way."""
        try:
            return self._slopes(middle.at(self.values(design)))
        except LostError:
            return None

    def _slopes(self, reading: Reading) -> list[list[Array]]:
        return [
            [np.array([feature.gradient[name] for name in self.names]) for feature in features]
            for features in reading.features
        ]

    def quadrature(self, middle: Reading) -> tuple[Array, Array] | None:
        """Return means and deviations by Gauss's quadrature; None where a quantity is not everywhere."""
        rules = [_gauss(given) for given in self.distributions]
        values, parts = [], []
        for chosen in product(*(zip(*rule, strict=True) for rule in rules)):
            values.append(self.at(middle, np.array([node for node, _ in chosen])))
            parts.append(float(np.prod([weight for _, weight in chosen])))
        found, weights = np.array(values), np.array(parts)
        if not np.isfinite(found).all():
            return None
        mean = weights @ found
        return mean, np.sqrt(weights @ (found - mean) ** 2)


def _curved(centre: Array, pair: Sequence[Array | None], step: float) -> Array | None:
    """The derivative of a gradient in a parameter, from those a step to either side, or to one."""
    plus, minus = pair
    if plus is None and minus is None:
        return None
    first, last = (centre if minus is None else minus), (centre if plus is None else plus)
    return (last - first) / (step * (2 - (plus is None or minus is None)))


def _gauss(distribution: Any) -> tuple[Array, Array]:
    """Nodes and weights of Gauss's quadrature for a distribution: Stieltjes' recurrence on its quantiles.

    The measure is taken as Gauss and Legendre's in the probability, cut into panels that end at its tails.
    """
    inner, weight = np.polynomial.legendre.leggauss(PANEL)
    edges = np.concatenate(
        [[0.0], 10.0 ** np.arange(-12.0, 0.0), 1 - 10.0 ** np.arange(-1.0, -13.0, -1.0), [1.0]]
    )
    edges = np.unique(np.append(edges, np.linspace(0.1, 0.9, 9)))
    half, middle = np.diff(edges)[:, None] / 2, (edges[:-1] + edges[1:])[:, None] / 2
    x, w = distribution.ppf((middle + half * inner).ravel()), (half * weight).ravel()
    mean, deviation = float(distribution.mean()), float(distribution.std())
    z = (x - mean) / deviation
    diagonal, below = np.zeros(GAUSS), np.zeros(GAUSS)
    before, now = np.zeros_like(z), np.ones_like(z)
    for k in range(GAUSS):
        size = float(w @ now**2)
        diagonal[k] = float(w @ (z * now**2)) / size
        below[k] = size
        before, now = now, (z - diagonal[k]) * now - (below[k] / below[k - 1] if k else 0.0) * before
    jacobi = np.diag(diagonal) + np.diag(np.sqrt(below[1:] / below[:-1]), 1)
    nodes, vectors = np.linalg.eigh(jacobi, UPLO="U")
    return mean + deviation * nodes, vectors[0] ** 2
