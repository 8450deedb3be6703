"""The leading multipliers of many states against all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.cantilevers import cantilever, cubic

import periodic as per
import symbolic as sym
from periodic.condensed import floquet, subspace
from periodic.condensed.condensedcollocation import CondensedCollocation
from periodic.condensed.floquet import ModalFloquet
from periodic.condensed.operator import CondensedOperator


@pytest.mark.parametrize(("elements", "states"), [(17, 68), (100, 400)])
def test_leading_multipliers_are_the_largest(elements: int, states: int) -> None:
    """Assert the eight largest of 68 and of 400 to 10 digits, one of them outside the unit circle."""
    system = cantilever(elements, cubic)
    branch = per.trace(system, "Omega", (3.0, 7.0), tol=1e-4)
    unstable = next(p for p in branch.points if not p.stable and not p.label.critical)
    method = replace(CondensedCollocation().at(1e-6), tolerance=1e-16)  # no mode is left out
    operator = method.linearise(system, unstable.orbit, ())
    assert isinstance(operator, CondensedOperator)
    leading = operator.leading
    every = np.linalg.eigvals(leading.floquet.monodromy)
    assert len(every) == states
    found = np.linalg.eigvals(leading.fundamental[-1])
    assert (np.abs(found) > 1).sum() == (np.abs(every) > 1).sum() == 1
    apart = np.abs(found[:, None] - every).min(axis=1)
    assert apart.max() < 1e-12
    assert np.sort(np.abs(found))[2:] == pytest.approx(np.sort(np.abs(every))[-6:], abs=1e-11)


def test_a_further_multiplier_kept_is_no_torus() -> None:
    """Assert that where a pair of many becomes lightly damped, and is kept from there on, no NS is told."""
    branch = per.trace(cantilever(50, cubic), "Omega", (56.0, 56.6), start=56.0, tol=1e-6)
    assert len(branch[0].multipliers) < len(branch[-1].multipliers)
    assert [point.label.value for point in branch.special_points] == ["EP", "EP"]


def test_of_many_alike_the_leading_tell_the_fold_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that multipliers of one size, of which some are kept, make no BP beside a fold.

    At the fold a pair of them has become real: one of the two leads, the other may be kept or not.
    """
    monkeypatch.setattr(floquet, "ALL_KEPT_UP_TO", 10)
    places = [sym.coordinate(f"q{k}") for k in range(12)]
    model = sym.CubicSpring(places[0], 0.1) + sym.HarmonicForce(places[0], 0.6, 1.6)
    for k, place in enumerate(places):
        model = model + sym.Mass(place, 1.0) + sym.Spring(place, 1.0) + sym.Damper(place, 0.1)
        model = model + sym.Coupling(places[k - 1], place, 0.05) if k else model
    system, method = sym.compile(model), per.Collocation(condense=True)
    found = per.trace(system, "Omega", (1.0, 2.2), start=2.2, tol=1e-6, method=method)
    assert {7, 8} < {len(point.multipliers) for point in found}
    assert [point.label.value for point in found.special_points] == ["EP", "LP", "LP", "EP"]


@pytest.mark.parametrize("tip", [cubic, lambda tip: [sym.OneSidedSpring(tip, 300.0, 0.03)]])
def test_subspace_holds_the_largest_of_every_orbit(
    tip: Callable[[Any], list[sym.Part]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert along a branch that the multipliers kept are the largest of the dense matrix, to 11 digits.

    And that Davidson's method finds them, without the dense matrix.
    """
    found, dense = [], []
    largest, every = subspace._largest, subspace._all

    def remembered(motions: ModalFloquet, count: int) -> Any:
        values, vectors = largest(motions, count)
        found.append((values[:count], np.linalg.eigvals(motions.monodromy)))
        return values, vectors

    monkeypatch.setattr(subspace, "_largest", remembered)
    monkeypatch.setattr(subspace, "_all", lambda *given: (dense.append(given), every(*given))[1])
    system = cantilever(50, tip, force=0.01, damping=0.05)
    per.trace(system, "Omega", (3.2, 3.44), start=3.2, tol=1e-5)
    assert len(found) > 5
    assert len(dense) < 0.1 * len(found)
    for values, whole in found:
        size = max(1.0, np.abs(values[0]))
        assert np.abs(values[:, None] - whole).min(axis=1).max() < 1e-11 * size
        assert np.abs(values) == pytest.approx(np.sort(np.abs(whole))[::-1][: len(values)], abs=1e-11 * size)
