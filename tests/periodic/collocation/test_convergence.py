"""Observed orders of convergence on the linear oscillator, whose orbit and multipliers are known exactly."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from support.numpy_systems import AlgebraicOscillator, LinearOscillator

import periodic as per
from periodic.correction.newton import Correction, NewtonSettings, correct
from periodic.correction.outcome import Outcome
from periodic.orbit.construction import at_rest
from periodic.orbit.mesh import uniform

PHASES = np.linspace(0.0, 2 * np.pi, 997)
MESHES = {2: (16, 24, 36, 54, 81), 3: (8, 12, 18, 27, 40), 4: (6, 8, 11, 16, 23)}
SCHEMES = [(family, ncol) for family in per.Family for ncol in MESHES]
each_scheme = pytest.mark.parametrize("family, ncol", SCHEMES)


def solved(system: LinearOscillator, scheme: per.Scheme, ntst: int) -> Correction:
    """Newton's result on a uniform mesh, from rest."""
    start = at_rest(system, uniform(scheme, ntst), system.nominal)
    result = correct(per.Collocation().linearise, system, start, settings=NewtonSettings(tolerance=1e-9))
    assert result.outcome is Outcome.CONVERGED
    return result


def multipliers(result: Correction) -> NDArray[np.complex128]:
    """Eigenvalues of the monodromy matrix, positive imaginary part first."""
    values = np.linalg.eigvals(result.monodromy)
    return values[np.argsort(-values.imag)]


@cache
def errors(family: per.Family, ncol: int) -> NDArray[np.float64]:
    """Errors between mesh points, at them, at tau = 0 and of the multipliers, one mesh a row."""
    system = LinearOscillator()
    rows = []
    for ntst in MESHES[ncol]:
        result = solved(system, per.Scheme(family, ncol), ntst)
        orbit = result.orbit
        between = orbit.state(PHASES) - system.exact_state(PHASES)
        at = orbit.nodes - system.exact_state(orbit.mesh.nodes(orbit.phases))
        spectrum = multipliers(result) - system.exact_multipliers()
        rows.append([np.abs(e).max() for e in (between, at, at[0], spectrum)])
    return np.array(rows)


def orders(family: per.Family, ncol: int) -> NDArray[np.float64]:
    """Slopes of a straight line through the logarithms of errors and widths."""
    return -np.polyfit(np.log(MESHES[ncol]), np.log(errors(family, ncol)), 1)[0]


@each_scheme
def test_order_between_mesh_points(family: per.Family, ncol: int) -> None:
    """Assert that the orbit converges with order ncol + 1 between mesh points."""
    assert orders(family, ncol)[0] == pytest.approx(ncol + 1, abs=0.2)


@each_scheme
def test_order_at_mesh_points(family: per.Family, ncol: int) -> None:
    """Assert that it converges with order 2 ncol (Gauss) or 2 ncol - 1 (Radau) at mesh points and at 0."""
    order = 2 * ncol if family is per.Family.GAUSS else 2 * ncol - 1
    assert orders(family, ncol)[1:3] == pytest.approx(order, abs=0.2)


@each_scheme
def test_order_of_multipliers(family: per.Family, ncol: int) -> None:
    """Assert that the multipliers converge with the order of the mesh points."""
    order = 2 * ncol if family is per.Family.GAUSS else 2 * ncol - 1
    assert orders(family, ncol)[3] == pytest.approx(order, abs=0.2)


@pytest.mark.parametrize("family", per.Family)
@pytest.mark.parametrize("ncol", [5, 6, 7])
def test_high_orders_reach_rounding(family: per.Family, ncol: int) -> None:
    """Assert that schemes of many points give orbit and multipliers to 1e-13 on 30 intervals."""
    system = LinearOscillator()
    result = solved(system, per.Scheme(family, ncol), 30)
    exact = system.exact_state(result.orbit.mesh.nodes(result.orbit.phases))
    assert np.abs(result.orbit.nodes - exact).max() < 1e-13
    assert np.abs(multipliers(result) - system.exact_multipliers()).max() < 1e-13


@pytest.mark.parametrize("family", per.Family)
@pytest.mark.parametrize("ncol", [5, 6, 7])
def test_rounding_does_not_grow_with_the_mesh(family: per.Family, ncol: int) -> None:
    """Assert that on 1000 intervals the states are right to 2e-14, of an amplitude of 2.7."""
    system = LinearOscillator()
    orbit = solved(system, per.Scheme(family, ncol), 1000).orbit
    exact = system.exact_state(orbit.mesh.nodes(orbit.phases))
    assert np.abs(orbit.nodes - exact).max() < 2e-14


@pytest.mark.parametrize("family", per.Family)
def test_algebraic_unknown_gives_the_same_orbit(family: per.Family) -> None:
    """Assert that a force written as an algebraic unknown leaves orbit and multipliers unchanged."""
    scheme = per.Scheme(family, 4)
    plain, with_unknown = (solved(s, scheme, 10) for s in (LinearOscillator(), AlgebraicOscillator()))
    assert with_unknown.orbit.nodes == pytest.approx(plain.orbit.nodes, abs=1e-12)
    assert with_unknown.orbit.stages == pytest.approx(plain.orbit.stages, abs=1e-12)
    assert multipliers(with_unknown) == pytest.approx(multipliers(plain), abs=1e-12)
    assert np.sinh(with_unknown.orbit.algebraic[..., 0]) == pytest.approx(
        plain.orbit.stages[..., 0], abs=1e-12
    )


def test_outputs_with_an_unknown_are_not_interpolated() -> None:
    """Assert that an output of the unknown fits the state at any phase, also on a coarse mesh."""
    system = AlgebraicOscillator()
    orbit = solved(system, per.Scheme(per.Family.GAUSS, 2), 5).orbit
    x, force = per.outputs(system, orbit, PHASES).T
    assert x == pytest.approx(orbit.state(PHASES)[:, 0], abs=1e-14)
    assert force == pytest.approx(x, abs=1e-12)


def test_extremes_are_those_of_the_continuous_orbit() -> None:
    """Assert that the extremes of x are its exact amplitude, met at no mesh point."""
    system = LinearOscillator()
    orbit = solved(system, per.Scheme(per.Family.RADAU, 7), 8).orbit
    omega, zeta, force = system.nominal
    amplitude = force / abs(1 - omega**2 + 2j * zeta * omega)
    found = per.extrema(system, orbit)
    assert [-found.minimum[0], found.maximum[0]] == pytest.approx([amplitude, amplitude], rel=1e-7)
    assert np.abs(orbit.knots[..., 0]).max() < amplitude * (1 - 1e-4)


def test_hand_written_system_is_traced() -> None:
    """Assert that a branch of a NumPy system has the exact amplitude and multipliers at its user points."""
    values = (0.5, 0.9, 1.0, 1.3)
    branch = per.trace(LinearOscillator(), "Omega", (0.4, 1.6), at=values, tol=1e-8)
    assert branch.stop.reason is per.Reason.BOUND
    for point, value in zip(branch.labelled(per.Label.USER), values, strict=True):
        exact = LinearOscillator(Omega=value)
        assert np.abs(point.orbit.state(PHASES) - exact.exact_state(PHASES)).max() < 1e-7
        assert sorted(point.multipliers, key=np.imag) == pytest.approx(
            sorted(exact.exact_multipliers(), key=np.imag), abs=1e-8
        )
