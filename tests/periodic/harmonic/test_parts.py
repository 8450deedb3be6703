"""Functions of harmonic balance on series that are given: by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.condensed.modal.quasistatic import Modes
from periodic.harmonic import harmonicbalance, splitbalance
from periodic.harmonic.balance import Balance, on_coefficients, projected
from periodic.harmonic.harmonicbalance import AIM, LEAST_HARMONICS, FourierRefinement, needed
from periodic.harmonic.hill import centroids, in_window
from periodic.harmonic.series import (
    FourierOrbit,
    basis,
    basis_slope,
    harmonics_of,
    mesh_for,
    series,
    transform,
)
from periodic.orbit.row import Row
from periodic.orbit.scheme import Array


def wave(coefficients: Array, period: float = 2 * np.pi) -> FourierOrbit:
    """The orbit with coefficients a_0, a_1..a_H, b_1..b_H of each state, shape (2H+1, n)."""
    harmonics, n = len(coefficients) // 2, coefficients.shape[1]
    mesh = mesh_for(harmonics, period)
    of = transform(harmonics)
    stages = (of.values @ coefficients).reshape(mesh.ntst, 2, n)
    return FourierOrbit(
        mesh, of.nodes @ coefficients, stages, np.zeros((mesh.ntst, 2, 0)), np.zeros(0), np.ones(1)
    )


@pytest.fixture
def coefficients() -> Array:
    """Those of two states and three harmonics."""
    return np.random.default_rng(4).standard_normal((7, 2))


@pytest.mark.parametrize("period", [2 * np.pi, 4 * np.pi])
def test_samples_carry_their_coefficients(coefficients: Array, period: float) -> None:
    """Assert values, slopes and coefficients of a sum of three harmonics at samples and mesh points."""
    orbit, of, w = wave(coefficients, period), transform(3), 2 * np.pi / period
    assert orbit.harmonics == 3 == harmonics_of(orbit.mesh) and orbit.frequency == pytest.approx(w)
    tau = orbit.stage_phases.ravel()
    k = np.arange(1, 4)
    cosine, sine = np.cos(w * np.outer(tau, k)), np.sin(w * np.outer(tau, k))
    exact = coefficients[0] + cosine @ coefficients[1:4] + sine @ coefficients[4:]
    assert orbit.stages.reshape(-1, 2) == pytest.approx(exact, abs=1e-12)
    assert of.analysis @ orbit.stages.reshape(-1, 2) == pytest.approx(coefficients, abs=1e-12)
    slope = (
        -np.sin(np.outer(w * tau, k)) * k @ coefficients[1:4]
        + np.cos(np.outer(w * tau, k)) * k @ coefficients[4:]
    )
    assert of.slopes @ coefficients == pytest.approx(slope, abs=1e-12)


def test_basis_and_its_slope() -> None:
    """Assert 1, cos, sin of two harmonics and their derivatives at 0 and a quarter turn."""
    angle = np.array([0.0, np.pi / 2])
    assert basis(2, angle) == pytest.approx(np.array([[1, 1, 1, 0, 0], [1, 0, -1, 1, 0]]), abs=1e-15)
    assert basis_slope(2, angle) == pytest.approx(np.array([[0, 0, 0, 1, 2], [0, -1, 0, 0, -2]]), abs=1e-15)


@pytest.mark.parametrize("frequency", [1.0, 0.5])
def test_equations_in_coefficients(frequency: float) -> None:
    """Assert E x' + A x of matrices that vary over the period, for a random wave, harmonic by harmonic."""
    random, harmonics, n = np.random.default_rng(7), 3, 2
    of, samples = transform(harmonics), 4 * (harmonics + 1)
    tau = (1 + np.arange(samples)) * 2 * np.pi / samples
    one, two = (random.standard_normal((3, n, n)) for _ in range(2))
    shape = np.stack([np.ones(samples), np.cos(tau), np.sin(tau)])
    E, A = (np.einsum("kij,ks->sij", each, shape) for each in (one, two))
    x = random.standard_normal((2 * harmonics + 1, n))
    values, rates = of.values @ x, frequency * of.slopes @ x
    whole = np.einsum("sij,sj->si", E, rates) + np.einsum("sij,sj->si", A, values)
    found = projected(E, A, frequency) @ x.ravel()
    assert found.reshape(-1, n) == pytest.approx(of.analysis @ whole, abs=1e-12)


def test_rows_in_coefficients(coefficients: Array) -> None:
    """Assert a row's gradient along a random change of mesh points, samples and a parameter."""
    random, orbit, of = np.random.default_rng(9), wave(coefficients), transform(3)
    nodes, stages = random.standard_normal(orbit.nodes.shape), random.standard_normal(orbit.stages.shape)
    for row in (Row(2.5, nodes, np.array([0.25])), Row(2.5, nodes, np.array([0.25]), stages)):
        change = random.standard_normal(coefficients.shape)
        found = on_coefficients(orbit, row)
        expected = (nodes * (of.nodes @ change)).sum()
        if row.stages is not None:
            expected += (stages.reshape(-1, 2) * (of.values @ change)).sum()
        assert found[0] == 2.5 and found[-1] == 0.25 and len(found) == 1 + 14 + 1
        assert found[1:-1] @ change.ravel() == pytest.approx(expected)


def test_effect_of_parameters(coefficients: Array) -> None:
    """Assert the largest derivative of each equation in each of two parameters, of whichever sign."""
    columns = np.zeros((16, 2, 1 + 4 + 2))
    columns[3, 0, 5], columns[7, 1, 6], columns[2, 0, 4], columns[1, 1, 0] = -3.0, 2.0, 9.0, 8.0
    samples: Any = SimpleNamespace(columns=columns, residual=0.5)
    own = Balance(wave(coefficients), samples)
    assert own.effect.tolist() == [3.0, 2.0] and own.residual == 0.5
    assert own.fundamental.shape == (1, 2, 2) and np.isnan(own.fundamental).all()


def spectrum(decay: float, harmonics: int = 16) -> FourierOrbit:
    """A state whose amplitudes are exp(-decay k)."""
    return wave(
        np.concatenate([[0.0], np.exp(-decay * np.arange(1, harmonics + 1)), np.zeros(harmonics)])[:, None]
    )


@pytest.mark.parametrize("decay", [0.5, 1.0])
def test_harmonics_that_bring_an_error_down(decay: float) -> None:
    """Assert as many more as the spectrum needs to fall by as much, from half to twice as many."""
    orbit = spectrum(decay)
    top, last = orbit.amplitudes.max(), orbit.amplitudes[-4:].max()
    rate = np.log(top / last) / 16
    assert rate == pytest.approx(decay * 12 / 16, rel=1e-9)
    for factor in (1.1, 2.5, 0.4, 17.0):
        assert needed(orbit, 1e-6 * factor, 1e-6) == int(np.ceil(16 + np.log(factor) / rate))
    assert needed(orbit, 1e9, 1e-6) == 32 and needed(orbit, 1e-60, 1e-6) == 8
    assert needed(orbit, np.inf, 1e-6) == 32 == needed(orbit, np.nan, 1e-6)
    assert needed(orbit, 0.0, 1e-6) == 8


def test_harmonics_of_a_flat_spectrum() -> None:
    """Assert that one which does not fall is taken to fall by a hundredth a harmonic."""
    orbit = spectrum(0.0)
    assert needed(orbit, 1.01e-6, 1e-6) == 17
    assert needed(orbit, np.exp(0.045) * 1e-6, 1e-6) == 21


class Given:
    """A method with bounds on harmonics."""

    tolerance, harmonics, most = 1e-6, 5, 20


def refinement(harmonics: int, error: float, period: float = 2 * np.pi) -> FourierRefinement:
    """That of an orbit, whose spectrum falls by e a harmonic."""
    given: Any = SimpleNamespace(worst=error, motion=error)
    orbit = spectrum(1.0, harmonics)
    mesh = mesh_for(harmonics, period)
    return FourierRefinement(Given(), replace(orbit, mesh=mesh), given)  # type: ignore[arg-type]


def test_number_of_harmonics_within_bounds() -> None:
    """Assert the least and the most, for each period of the excitation, and when there are no more."""
    assert refinement(6, 1e-60)._wanted == LEAST_HARMONICS
    assert refinement(19, np.inf)._wanted == 20
    assert refinement(19, np.inf, 4 * np.pi)._wanted == 38
    assert refinement(3, 1e-60, 4 * np.pi)._wanted == 2 * LEAST_HARMONICS
    assert refinement(20, 1.0).exhausted and not refinement(19, 1.0).exhausted
    assert not refinement(20, 1.0, 4 * np.pi).exhausted
    exact = refinement(10, AIM * 1e-6)
    assert exact._wanted == 10 and harmonics_of(exact.refined()) == 10


def test_meshes_on_the_way_to_a_number_of_harmonics() -> None:
    """Assert the wanted one first, others between it and the present one, and one where nothing changes."""
    own = refinement(10, np.inf)
    counts = [harmonics_of(mesh) for mesh, _ in own.meshes()]
    assert counts[0] == 20 and all(10 < count <= 20 for count in counts)
    assert counts == [10 + round(10 * part) for part in harmonicbalance.WAYS]
    assert [harmonics_of(mesh) for mesh, _ in refinement(10, AIM * 1e-6).meshes()] == [10]


def test_shortfall_in_words() -> None:
    """Assert tail, harmonics, error and tolerance."""
    said = refinement(6, 1e-3).shortfall
    assert said.startswith("the spectrum's tail is ")
    assert said.endswith(" at 6 harmonics (error estimate 1.0e-03); the tolerance is 1e-06")


@pytest.mark.parametrize(("harmonic", "sign"), [(1, 1), (3, 1), (2, -1)])
def test_centroid_of_one_harmonic(harmonic: int, sign: int) -> None:
    """Assert that exp(i k tau) in one state is at k, and the mean of squares where there are two."""
    vector = np.zeros((9, 2, 2), dtype=complex)
    vector[harmonic, 0, 0], vector[4 + harmonic, 0, 0] = 1.0, sign * 1j
    vector[:, :, 1] = vector[:, :, 0]
    vector[0, 1, 1] = 2.0
    found = centroids(vector.reshape(18, 2), 2)
    assert found == pytest.approx([sign * harmonic, sign * harmonic / 5])


@pytest.mark.parametrize(
    ("places", "n", "chosen", "told"),
    [
        ([-1.0, 0.0, 1.0], 1, [1], True),
        ([-0.9, 0.1, 1.1], 1, [1], True),
        ([-1.0, -0.7, 0.0, 0.3, 1.0, 1.3], 2, [2, 3], True),
        ([-0.6, 0.4, 1.4, -0.4, 0.6], 2, [0, 3], True),
        ([0.0, 0.1, 0.2, 7.0], 1, [1], False),
        ([9.0, 8.0], 1, [1], False),
    ],
)
def test_window_about_0(places: list[float], n: int, chosen: list[int], told: bool) -> None:
    """Assert which of copies that are 1 apart are chosen, and whether these could be told."""
    window, found = in_window(np.array(places), n)
    assert np.flatnonzero(window).tolist() == chosen and found is told


def test_series_on_other_meshes(coefficients: Array) -> None:
    """Assert that more harmonics carry the same, and that fewer leave out the last ones."""
    orbit = wave(coefficients)
    more = series(orbit, mesh_for(8, 2 * np.pi))
    assert more.amplitudes[3:].max() < 1e-12
    assert more.amplitudes[:3] == pytest.approx(orbit.amplitudes[:3])
    assert series(more, mesh_for(3, 2 * np.pi)).nodes == pytest.approx(orbit.nodes, abs=1e-12)


def modes(random: np.random.Generator) -> Any:
    """Three modes of two states and one force."""
    exponents = np.array([-0.1 + 2j, -0.5, -0.3 + 7j])
    inputs = random.standard_normal((3, 1)) * (1 + 0.5j)
    outputs = random.standard_normal((2, 3)) * (1 - 0.2j)
    direct, rate = random.standard_normal((2, 2, 1))
    return Modes(exponents, inputs, outputs, direct, rate)


def test_flexibility_of_modes() -> None:
    """Assert the answer to exp(i w tau) of z' = x z + b f, u = Re C z + D f + E f', solved as it stands."""
    own, w = modes(np.random.default_rng(5)), np.array([0.0, 1.0, 2.5])
    found = splitbalance.flexibility(own, w)
    for k, each in enumerate(w):
        once, both = own.exponents, own.exponents.conj()
        z = own.inputs / (1j * each - once)[:, None]
        other = own.inputs.conj() / (1j * each - both)[:, None]
        exact = (own.outputs @ z + own.outputs.conj() @ other) / 2 + own.direct + 1j * each * own.direct_rate
        assert found[k] == pytest.approx(exact, rel=1e-12)


def test_flexibility_of_modes_that_change() -> None:
    """Assert its derivative by differences, of exponents, inputs, outputs and what is direct."""
    random, w, step = np.random.default_rng(6), np.array([0.0, 1.0, 2.5]), 1e-6
    own = modes(random)
    names = ("exponents", "inputs", "outputs", "direct", "direct_rate")
    parts = [random.standard_normal(getattr(own, name).shape) for name in names]
    turned = [part * (1 + 0.3j) if k < 3 else part for k, part in enumerate(parts)]
    change = Modes(*turned)
    ends = [
        splitbalance.flexibility(
            Modes(
                *(getattr(own, name) + way * step * part for name, part in zip(names, turned, strict=True))
            ),
            w,
        )
        for way in (1, -1)
    ]
    found = splitbalance.flexibility_slope(own, change, w)
    assert found == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-6, abs=1e-7)


def test_factors_of_harmonics() -> None:
    """Assert the map of a_0, a_k, b_k that is a product with complex amplitudes a_k - i b_k."""
    random, count = np.random.default_rng(8), 4
    factors = random.standard_normal((count, 2, 3)) + 1j * random.standard_normal((count, 2, 3))
    waves = random.standard_normal((2 * count - 1, 3))
    found = np.einsum("isjk,jk->is", splitbalance.on_harmonics(factors), waves)
    amplitudes = np.concatenate([waves[:1] + 0j, waves[1:count] - 1j * waves[count:]])
    exact = np.einsum("hsk,hk->hs", factors, amplitudes)
    assert found[0] == pytest.approx(factors[0].real @ waves[0])
    assert found[1:count] == pytest.approx(exact[1:].real) and found[count:] == pytest.approx(-exact[1:].imag)
