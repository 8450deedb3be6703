"""Functions compared by their values at sample points."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.equations.packed import Packed
from symbolic.equations.samples import PARAMETER_SETS, SAMPLE_POINTS, Samples, constant, multiples

X = sym.coordinate("x")


def laid() -> Assembly:
    """A mass that a spring of no stiffness yet and a harmonic force of 0.3 N act on."""
    stiffness, force = sym.Parameter("k", 0.0, "N/m"), sym.Parameter("F", 0.3, "N")
    assembly = Assembly()
    assembly.lay([sym.Mass(X, 1.3), sym.Spring(X, stiffness), sym.HarmonicForce(X, force, 2.0)])
    assembly.close()
    assembly.with_frequency(assembly.omega)
    return assembly


def test_parameters_are_varied_by_2_to_10_percent() -> None:
    """Assert nominal values first, then others: of a parameter that is 0 too, which stays near."""
    assembly = laid()
    nominal = np.array([p.value for p in assembly.parameters.values()])
    assert 0.0 in nominal and 0.3 in nominal
    sets = [parameter for *_, parameter in Samples(Packed(assembly)).points]
    assert len(sets) == PARAMETER_SETS
    assert sets[0] == pytest.approx(nominal, abs=0, rel=0)
    for other in sets[1:]:
        change = np.where(nominal == 0, other, other / np.where(nominal == 0, 1, nominal) - 1)
        assert ((change >= 0.02) & (change <= 0.1)).all()
    assert (sets[1] != sets[2]).all()


def test_points_are_spread_over_states_and_a_period() -> None:
    """Assert points beside the rest, of sizes over more than a decade, and phases of one period."""
    for state, phase, _ in Samples(Packed(laid())).points:
        assert state.shape[1] == SAMPLE_POINTS and phase.shape == (1, SAMPLE_POINTS)
        assert np.ptp(np.log10(np.abs(state))) > 1 and (state < 0).any() and (state > 0).any()
        assert 0 <= phase.min() < np.pi < phase.max() <= 2 * np.pi


def test_size_of_a_function_is_its_steepness() -> None:
    """Assert it for a scaled sum of states, in units of their scales, and 1 of what does not move."""
    assembly = laid()
    samples, (first, second) = Samples(Packed(assembly)), assembly.states
    row = 3 * first.symbol / first.scale + 4 * second.symbol / second.scale
    assert samples.size(row) == pytest.approx(5.0)
    assert samples.size(ca.SX(7.0)) == 1.0


def test_values_are_taken_for_each_set_of_parameters() -> None:
    """Assert a function of the parameters alone: constant for each, and the parameters' product."""
    assembly = laid()
    samples = Samples(Packed(assembly))
    symbols = {name: symbols[0] for name, (_, symbols) in assembly.numbers.named().items()}
    (found,) = samples.values([symbols["k"] + 2 * symbols["F"]])
    names = list(assembly.parameters)
    for value, (*_, parameter) in zip(found, samples.points, strict=True):
        k, force = parameter[names.index("k")], parameter[names.index("F")]
        assert value == pytest.approx(k + 2 * force)
    assert constant(found)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([[2.0, 2.0], [3.0, 3.0]], True),
        ([[2.0, 2.0], [3.0, 3.1]], False),
        ([[2.0, np.nan, np.inf], [3.0, 3.0, 3.0]], True),
        ([[np.nan, np.inf], [3.0, 3.0]], False),
        ([[1e300, -1e300]], False),
        ([[0.0, 0.0]], True),
    ],
)
def test_constant(values: list[list[float]], expected: bool) -> None:
    """Assert it where each set has a value of its own, of the finite ones, and not where none is finite."""
    assert constant([np.array(each) for each in values]) is expected


@pytest.mark.parametrize(
    ("values", "others", "expected"),
    [
        ([[1.0, 2.0], [1.0, 2.0]], [[2.0, 4.0], [-3.0, -6.0]], True),
        ([[1.0, 2.0], [1.0, 2.0]], [[2.0, 4.0], [3.0, 6.1]], False),
        ([[1.0, 2.0, np.nan]], [[10.0, 20.0, 5.0]], True),
        ([[1.0, 2.0, 7.0]], [[10.0, 20.0, np.inf]], True),
        ([[1.0, np.nan]], [[np.inf, 1.0]], False),
        ([[0.0, 0.0]], [[1.0, 2.0]], False),
        ([[1.0, 2.0]], [[0.0, 0.0]], False),
        ([[1.0, 0.0]], [[0.0, 1.0]], False),
        ([[1e200, 2e200]], [[1e-200, 2e-200]], True),
    ],
)
def test_multiples(values: list[list[float]], others: list[list[float]], expected: bool) -> None:
    """Assert that one factor for each set makes multiples, whatever their size, of what both have finite."""
    found = [[np.array(each) for each in both] for both in (values, others)]
    assert multiples(*found) is expected
