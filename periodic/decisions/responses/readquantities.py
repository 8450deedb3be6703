"""Quantities read at one set of parameters: from branches traced there, or followed from others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from periodic.conditions.extremes import PeakToPeak
from periodic.conditions.functionals import Smooth
from periodic.decisions.responses.feature import Count, Feature
from periodic.decisions.responses.quantity import Quantity
from periodic.decisions.responses.words import called
from periodic.results.branch import Branch
from periodic.results.peaks import PEAK_OF
from periodic.system import System

T = TypeVar("T")


@dataclass(frozen=True)
class Reading:
    """Quantities at given values of free parameters.

    Parameters
    ----------
    values : mapping of str to float
        The free parameters (SI).
    quantities : sequence of Quantity
        What is read.
    features : sequence of sequence of Feature
        What each is made of.
    branches : sequence of Branch
        The branches that were traced for it; none where it was followed.
    """

    values: Mapping[str, float]
    quantities: Sequence[Quantity]
    features: Sequence[Sequence[Feature]]
    branches: Sequence[Branch] = ()

    def at(self, values: Mapping[str, float]) -> Reading:
        """Return the same features at other values. Raises LostError."""
        moved = [[feature.at(values) for feature in each] for each in self.features]
        return Reading(dict(values), self.quantities, moved)

    @cached_property
    def decisive(self) -> tuple[Feature, ...]:
        """The feature that gives each quantity its value: of the largest value, or the least."""
        both = zip(self.quantities, self.features, strict=True)
        return tuple(quantity.decisive(features) for quantity, features in both)

    @property
    def numbers(self) -> tuple[float, ...]:
        """The values of the quantities (SI)."""
        return tuple(feature.value for feature in self.decisive)


def traced(
    system: System,
    quantities: Sequence[Quantity],
    values: Mapping[str, float],
    count: Count,
) -> Reading:
    """Return quantities read off branches that are traced, each response once.

    Raises AbsentError for a branch that does not have what is asked of it.
    """
    features: dict[int, list[Feature]] = {}
    branches = []
    for response in _once(quantity.response for quantity in quantities):
        own = [(k, q) for k, q in enumerate(quantities) if q.response is response]
        functionals = _once(functional for _, quantity in own for functional in quantity.peaks)
        peaks = {_peak(functional): functional for functional in functionals}
        places = sorted({place for _, quantity in own for place in quantity.places})
        branch = response.traced(system, values, peaks, at=places)
        count.orbits += len(branch)
        branches.append(branch)
        way = response.way(system, count)
        features |= {k: quantity.features(way, branch) for k, quantity in own}
    return Reading(dict(values), quantities, [features[k] for k in range(len(quantities))], branches)


def _peak(functional: Smooth) -> str:
    """What the places where a functional is stationary are called, as those of other branches are."""
    of = functional.output if isinstance(functional, PeakToPeak) else called(functional)
    return f"{PEAK_OF}{of}"


def _once(items: Iterable[T]) -> list[T]:
    """Each of several objects once, in order."""
    found: list[T] = []
    for item in items:
        if not any(item is other or item == other for other in found):
            found.append(item)
    return found
