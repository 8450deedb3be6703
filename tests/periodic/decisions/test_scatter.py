"""Scatter of parameters against distributions that are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

import periodic as per
import symbolic as sym
from periodic.decisions.scattering.scatter import _curved, _gauss

X = sym.coordinate("x")
SWING = per.PeakToPeak("x")
DAMPING = stats.norm(0.1, 0.005)


def linear() -> sym.CompiledSystem:
    """x'' + c x' + x = F cos(Omega t): the peak is 2 F / (c sqrt(1 - c^2 / 4)) peak to peak."""
    parts = sym.Mass(X, 1.0) + sym.Damper(X, 0.1) + sym.Spring(X, 1.0)
    return sym.compile(parts + sym.HarmonicForce(X, 0.1))


def peak(c: np.ndarray, force: np.ndarray | float = 0.1) -> np.ndarray:
    """The exact peak to peak at resonance."""
    return np.asarray(2 * force / (c * np.sqrt(1 - c**2 / 4)))


def test_a_linear_peak_scatters_as_it_must() -> None:
    """Assert mean, deviation and quantiles of all ways against the distribution of 2 F / c."""
    response = per.Response("Omega", (0.5, 1.5))
    found = per.scatter(linear(), {"c": DAMPING}, {"peak": response.highest(SWING)}, samples=200)
    exact = peak(DAMPING.ppf((np.arange(200000) + 0.5) / 200000))
    mean, deviation = float(exact.mean()), float(exact.std())
    slope = float(peak(np.array(0.1 + 1e-6)) - peak(np.array(0.1 - 1e-6))) / 2e-6
    first = found.first_order("peak")
    assert first[0] == pytest.approx(float(peak(np.array(0.1))), rel=1e-8)
    assert first[1] == pytest.approx(abs(slope) * 0.005, rel=1e-6)
    second = found.second_order("peak")
    assert second[0] == pytest.approx(mean, rel=1e-4)
    assert second[1] == pytest.approx(deviation, rel=1e-2)
    assert found.quadrature is not None
    assert found.quadrature[0][0] == pytest.approx(mean, rel=1e-7)
    assert found.quadrature[1][0] == pytest.approx(deviation, rel=1e-5)
    for part in (0.05, 0.5, 0.95):
        true = float(np.quantile(exact, part))
        estimate = found.quantile("peak", part)
        assert estimate.low <= true <= estimate.high
        assert estimate.value == pytest.approx(true, rel=5e-3)
        assert found.expanded_quantile("peak", part) == pytest.approx(true, rel=5e-3)
    assert found.apart < 1e-7
    assert found.shares("peak") == {"c": pytest.approx(1.0)}
    assert "peak" in found.table() and repr(found).startswith("Scattered(peak over c, 200 samples)")


def test_probabilities_and_shares_of_two_parameters() -> None:
    """Assert the probability that a peak is too high, and whose doing its scatter is."""
    high = per.Response("Omega", (0.5, 1.5)).highest(SWING)
    force = stats.uniform(0.095, 0.01)
    found = per.scatter(linear(), {"c": DAMPING, "F": force}, {"peak": high}, samples=300, seed=1)
    rng = np.random.default_rng(0)
    many = peak(DAMPING.rvs(400000, random_state=rng), force.rvs(400000, random_state=rng))
    estimate = found.probability(high >= 2.1)
    assert estimate.low <= float((many >= 2.1).mean()) <= estimate.high
    squares = {"c": (2.0 / 0.1 * 0.005) ** 2, "F": (2.0 / 0.1 * 0.01 / math.sqrt(12)) ** 2}
    shares = found.shares("peak")
    assert shares["c"] == pytest.approx(squares["c"] / sum(squares.values()), rel=1e-2)


def test_a_jump_that_not_every_machine_has() -> None:
    """Assert that folds that vanish at a cusp are counted as absent, by traces at the same designs."""
    system, response = sym.scene("duffing"), per.Response("Omega", (0.5, 2.6))
    jump = response.place("LP")
    found = per.scatter(system, {"c": stats.truncnorm(-2, 2, 0.3, 0.1)}, {"jump": jump}, samples=40)
    there = np.isfinite(found.samples("jump"))
    assert 0 < found.absent("jump") < 1
    for c, has in list(zip(found.points[:, 0], there, strict=True))[::5]:
        branch = per.trace(system, "Omega", (0.5, 2.6), values={"c": float(c)})
        assert bool(branch.labelled("LP")) == bool(has)
    assert found.probability(jump >= 0.0).value == pytest.approx(1 - found.absent("jump"))
    assert "do not have it" in found.table()


def test_curvature_from_one_side_or_none() -> None:
    """Assert differences of gradients to both sides, to one, and that of neither nothing is said."""
    centre, up, down = np.array([1.0, 2.0]), np.array([1.5, 2.5]), np.array([0.5, 1.5])
    assert _curved(centre, (up, down), 0.5) == pytest.approx([1.0, 1.0])
    assert _curved(centre, (up, None), 0.5) == pytest.approx([1.0, 1.0])
    assert _curved(centre, (None, down), 0.5) == pytest.approx([1.0, 1.0])
    assert _curved(centre, (None, None), 0.5) is None


def test_quadrature_is_gauss() -> None:
    """Assert nodes and weights for normal and uniform distributions against Hermite's and Legendre's."""
    x, w = _gauss(stats.norm(1.0, 0.1))
    nodes, weights = np.polynomial.hermite_e.hermegauss(5)
    assert x == pytest.approx(1 + 0.1 * nodes, abs=1e-10)
    assert w == pytest.approx(weights / weights.sum(), abs=1e-9)
    x, w = _gauss(stats.uniform(0.9, 0.2))
    nodes, weights = np.polynomial.legendre.leggauss(5)
    assert x == pytest.approx(1 + 0.1 * nodes, abs=1e-13)
    assert w == pytest.approx(weights / 2, abs=1e-13)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"scattered": {}}, "scattered is empty"),
        ({"scattered": {"d": DAMPING}}, "a name in scattered is 'd'"),
        ({"scattered": {"c": 0.1}}, "c of scattered is 0.1; it must be one of scipy.stats"),
        ({"quantities": {}}, "it must name quantities"),
        ({"samples": 1}, "samples is 1"),
        ({"scattered": {"m": stats.norm(0.0, 1.0)}}, "m"),
    ],
)
def test_bad_input(arguments: dict[str, object], said: str) -> None:
    """Assert one sentence for what is not allowed."""
    high = per.Response("Omega", (0.5, 1.5)).highest(SWING)
    given = {"scattered": {"c": DAMPING}, "quantities": {"peak": high}, **arguments}
    with pytest.raises(ValueError, match=said):
        per.scatter(linear(), **given)  # type: ignore[arg-type]


def test_bad_questions() -> None:
    """Assert sentences of the result."""
    response = per.Response("Omega", (0.5, 1.5))
    high = response.highest(SWING)
    found = per.scatter(linear(), {"c": DAMPING}, {"peak": high}, samples=4)
    with pytest.raises(ValueError, match="label is 'top'; it must be one of peak"):
        found.samples("top")
    with pytest.raises(ValueError, match="part is 2"):
        found.quantile("peak", 2)
    with pytest.raises(ValueError, match="event is True"):
        found.probability(True)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="it must be of one of highest"):
        found.probability(response.place("LP") <= 1.0)
    with pytest.raises(
        ValueError, match="at the means of the parameters the branch over Omega has no point LP"
    ):
        per.scatter(linear(), {"c": DAMPING}, {"jump": response.place("LP")})
