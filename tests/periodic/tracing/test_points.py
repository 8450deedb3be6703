"""How many points a branch takes: as many as the motion calls for, however many modes there are."""

from __future__ import annotations

import pytest

import periodic as per
import symbolic as sym
from reports.benchmarks.work import chain_model

FOLDS = (1.186466, 1.503500, 1.128009, 1.179841)


def oscillator(asides: int) -> sym.CompiledSystem:
    """A forced Duffing oscillator with so many others beside it that nothing excites."""
    x = sym.coordinate("x")
    parts: list[sym.Part] = [
        sym.Mass(x, 1.0),
        sym.Damper(x, 0.1),
        sym.Spring(x, 1.0),
        sym.CubicSpring(x, 1.0),
    ]
    for k in range(asides):
        y = sym.coordinate(f"y{k}")
        parts += [sym.Mass(y, 1.0), sym.Damper(y, 0.01), sym.Spring(y, (1.3 + 0.4 * k) ** 2)]
    return sym.compile(sym.combine([*parts, sym.HarmonicForce(x, 0.5)]))


def test_modes_that_nothing_excites() -> None:
    """Assert that modes which the motion does not excite hardly cost a point, lightly damped as they are."""
    counts = [len(per.trace(oscillator(asides), "Omega", (0.6, 3.0))) for asides in (0, 3)]
    assert counts[1] <= 1.3 * counts[0]


@pytest.mark.parametrize("count", [5, 10])
def test_chains(count: int) -> None:
    """Assert a chain's four folds, to the digits that its length does not change, within 200 points."""
    branch = per.trace(sym.compile(chain_model(count)), "Omega", (1.6, 0.5))
    assert [p.parameter for p in branch.labelled(per.Label.FOLD)] == pytest.approx(FOLDS, abs=2e-5)
    assert len(branch) <= 200
