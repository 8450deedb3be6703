"""The result of a scatter of parameters: means, deviations, quantiles, probabilities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import binom, binomtest, qmc

from periodic.checks import between, one_of, shown
from periodic.decisions.responses.quantity import Constraint, Quantity
from periodic.orbit.scheme import Array
from periodic.results.plots.frame import fresh

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SURROGATE = 2**15
"""Points at which the second-order expansion is sampled."""

CONFIDENCE = 0.95
"""Of intervals that say how well few samples tell a quantile or a probability."""


@dataclass(frozen=True)
class Quadratic:
    """A feature to second order about a design m: f + g d + d' H d / 2, d = p - m; H may not be known."""

    value: float
    centre: Array
    gradient: Array
    curvature: Array | None

    def __call__(self, designs: Array) -> Array:
        """Return its values at designs of shape (N, n)."""
        d, curvature = designs - self.centre, self.curvature
        assert curvature is not None  # as `curved` tells
        return self.value + d @ self.gradient + 0.5 * np.einsum("ij,jk,ik->i", d, curvature, d)


def drawn(distributions: Sequence[Any], count: int, seed: int) -> Array:
    """Return designs drawn from independent distributions by a Latin hypercube, shape (count, n)."""
    parts = qmc.LatinHypercube(len(distributions), rng=np.random.default_rng(seed)).random(count)
    return np.stack([given.ppf(column) for given, column in zip(distributions, parts.T, strict=True)], axis=1)


@dataclass(frozen=True)
class Estimate:
    """A number with an interval that holds it with a confidence of 95 %.

    Parameters
    ----------
    value : float
        The number.
    low, high : float
        Ends of the interval.
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.6g} [{self.low:.6g}, {self.high:.6g}]"


@dataclass(frozen=True, repr=False, kw_only=True)
class Scattered:
    """How quantities scatter with parameters.

    Parameters
    ----------
    distributions : mapping of str to distribution
        Those of the parameters, by name.
    labels : tuple of str
        Names of the quantities.
    quantities : tuple of Quantity
        The quantities.
    middle : tuple of float
        Their values at the means of the parameters (SI).
    surrogates : tuple of tuple of Quadratic
        The features of each, to second order.
    points : ndarray, shape (samples, n)
        The sampled designs (SI).
    values : ndarray, shape (samples, q)
        The quantities there (SI), NaN where a response does not have one.
    apart : float
        Largest relative difference of quantities that were followed and those of branches traced anew, over
        the samples for which both were found.
    quadrature : tuple of ndarray, optional
        Means and deviations by quadrature, of few parameters.
    orbits : int
        How many orbits were solved for.
    """

    distributions: Mapping[str, Any]
    labels: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    middle: tuple[float, ...]
    surrogates: tuple[tuple[Quadratic, ...], ...]
    points: Array
    values: Array
    apart: float
    quadrature: tuple[Array, Array] | None
    orbits: int

    def __repr__(self) -> str:
        over = ", ".join(self.distributions)
        return f"Scattered({', '.join(self.labels)} over {over}, {len(self.values)} samples)"

    def __str__(self) -> str:
        return self.table()

    def samples(self, label: str) -> Array:
        """Return the sampled values of a quantity (SI), shape (samples,); NaN where there is none.

        Parameters
        ----------
        label : str
            Its name.

        Returns
        -------
        Array
            One for each of `points`.
        """
        return self.values[:, self._index(label)]

    def first_order(self, label: str) -> tuple[float, float]:
        """Return mean and standard deviation to first order (SI): of the feature that decides at the means.

        Parameters
        ----------
        label : str
            Name of the quantity.

        Returns
        -------
        tuple of float
            Mean and deviation.
        """
        decisive = self._decisive(self._index(label))
        return decisive.value, float(np.linalg.norm(decisive.gradient * self._deviations))

    def second_order(self, label: str) -> tuple[float, float]:
        """Return mean and standard deviation of the expansions to second order (SI).

        Parameters
        ----------
        label : str
            Name of the quantity.

        Returns
        -------
        tuple of float
            Mean and deviation.
        """
        found = self._second_order(label)
        return float(found.mean()), float(found.std())

    def shares(self, label: str) -> dict[str, float]:
        """Return which part of the variance comes from each parameter, to first order.

        Parameters
        ----------
        label : str
            Name of the quantity.

        Returns
        -------
        dict of str to float
            Parts by parameter; their sum is 1.
        """
        squares = (self._decisive(self._index(label)).gradient * self._deviations) ** 2
        total = float(squares.sum()) or 1.0
        return dict(zip(self.distributions, (squares / total).tolist(), strict=True))

    def quantile(self, label: str, part: float) -> Estimate:
        """Return the value (SI) below which a quantity lies in a part of the samples that have it.

        Parameters
        ----------
        label : str
            Name of the quantity.
        part : float
            Between 0 and 1.

        Returns
        -------
        Estimate
            The quantile of the samples; the interval is that of order statistics, as of independent samples.
        """
        between("part", part, 0.0, 1.0)
        found = np.sort(self.samples(label)[np.isfinite(self.samples(label))])
        if not len(found):
            raise ValueError(f"label is {label!r}, which none of the samples has")
        n, outside = len(found), (1 - CONFIDENCE) / 2
        low, high = (int(binom.ppf(q, n, part)) for q in (outside, 1 - outside))
        ends = float(found[max(low - 1, 0)]), float(found[min(high, n - 1)])
        return Estimate(float(np.quantile(found, part)), *ends)

    def expanded_quantile(self, label: str, part: float) -> float:
        """Return the same quantile (SI) by the expansions to second order.

        Parameters
        ----------
        label : str
            Name of the quantity.
        part : float
            Between 0 and 1.

        Returns
        -------
        float
            The quantile.
        """
        return float(np.quantile(self._second_order(label), between("part", part, 0.0, 1.0)))

    def probability(self, *events: Constraint) -> Estimate:
        """Return the probability that constraints are all met, by the samples.

        Parameters
        ----------
        *events : Constraint
            As response.place("LP") <= 1.3, of quantities that were asked for; one that a response does not
            have meets none.

        Returns
        -------
        Estimate
            With Wilson's interval.
        """
        met = np.ones(len(self.values), dtype=bool)
        for event in events:
            if not isinstance(event, Constraint):
                raise ValueError(f"event is {shown(event)}; it must be a quantity <= or >= a number")
            known = [k for k, quantity in enumerate(self.quantities) if quantity == event.quantity]
            if not known:
                raise ValueError(
                    f"event is {event}; it must be of one of {', '.join(map(str, self.quantities))}"
                )
            column = self.values[:, known[0]]
            met &= np.isfinite(column) & (event.side * np.nan_to_num(column) <= event.side * event.bound)
        ends = binomtest(int(met.sum()), len(met)).proportion_ci(CONFIDENCE, method="wilson")
        return Estimate(float(met.mean()), float(ends.low), float(ends.high))

    def absent(self, label: str) -> float:
        """Return the part of the samples whose response does not have a quantity.

        Parameters
        ----------
        label : str
            Its name.

        Returns
        -------
        float
            From 0 to 1.
        """
        return float(np.mean(~np.isfinite(self.samples(label))))

    def plot(self, label: str | None = None, axes: Axes | None = None) -> Axes:
        """Plot the distribution of a quantity: of the samples, and of the expansion to second order.

        Parameters
        ----------
        label : str, optional
            Name of the quantity; by default the first.
        axes : matplotlib.axes.Axes, optional
            Where to plot; by default in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.
        """
        name = self.labels[0] if label is None else label
        sampled = self.samples(name)
        found = np.sort(sampled[np.isfinite(sampled)])
        axes = fresh(axes)
        parts = (np.arange(len(found)) + 0.5) / len(sampled)
        axes.step(found, parts, where="mid", label=f"{len(sampled)} samples")
        if self._is_curved(self._index(name)):
            expanded = np.sort(self._second_order(name))
            axes.plot(expanded, (np.arange(len(expanded)) + 0.5) / len(expanded), label="to second order")
        axes.set(ylabel="probability of no more", ylim=(0, 1))
        axes.set_xlabel(f"{name}: {self.quantities[self._index(name)]}", parse_math=False)
        axes.legend()
        return axes

    def table(self) -> str:
        """Return a line for each quantity: means and deviations, quantiles, what most of it is from.

        Returns
        -------
        str
            A heading and the lines, of one width.
        """
        head = [
            "quantity",
            "at the means",
            "first order",
            "second order",
            "quadrature",
            "samples",
            "5 %",
            "95 %",
            "mostly",
        ]
        rows = [head, *(self._row(k) for k in range(len(self.labels)))]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        lines = ["  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows]
        flat = [label for k, label in enumerate(self.labels) if not self._is_curved(k)]
        lines += [f"{label}: to second order not known, as it is lost beside the means" for label in flat]
        gone = [f"{label}: {self.absent(label):.1%} of the samples do not have it" for label in self.labels]
        return "\n".join(
            [*lines, *(text for text, label in zip(gone, self.labels, strict=True) if self.absent(label))]
        )

    def _row(self, k: int) -> list[str]:
        label = self.labels[k]
        found = self.samples(label)[np.isfinite(self.samples(label))]
        by_quadrature = (
            "" if self.quadrature is None else _pair(*(float(part[k]) for part in self.quadrature))
        )
        sampled = (
            [_pair(float(found.mean()), float(found.std())), f"{np.quantile(found, 0.05):.5g}"]
            if len(found)
            else ["", ""]
        )
        last = f"{np.quantile(found, 0.95):.5g}" if len(found) else ""
        shares = self.shares(label)
        first = max(shares, key=lambda name: shares[name])
        return [
            label,
            f"{self.middle[k]:.5g}",
            _pair(*self.first_order(label)),
            _pair(*self.second_order(label)) if self._is_curved(k) else "",
            by_quadrature,
            *sampled,
            last,
            f"{first} ({shares[first]:.0%})",
        ]

    def _is_curved(self, k: int) -> bool:
        """Whether all features of a quantity are known to second order."""
        return all(feature.curvature is not None for feature in self.surrogates[k])

    def _second_order(self, label: str) -> Array:
        """A quantity by its expansions at many designs. Raises ValueError where they are not known."""
        k = self._index(label)
        if not self._is_curved(k):
            raise ValueError(f"label is {label!r}, which is lost beside the means; samples({label!r}) has it")
        each = np.array([feature(self._many) for feature in self.surrogates[k]])
        return np.asarray(each.max(axis=0) if self.quantities[k].sign > 0 else each.min(axis=0))

    @property
    def _deviations(self) -> Array:
        return np.array([float(given.std()) for given in self.distributions.values()])

    def _decisive(self, k: int) -> Quadratic:
        sign = self.quantities[k].sign
        return max(self.surrogates[k], key=lambda feature: sign * feature.value)

    @cached_property
    def _many(self) -> Array:
        """Designs at which expansions are read."""
        return drawn(list(self.distributions.values()), SURROGATE, 0)

    def _index(self, label: str) -> int:
        return self.labels.index(one_of("label", label, self.labels))


def _pair(mean: float, deviation: float) -> str:
    return f"{mean:.5g} +- {deviation:.2g}"
