"""Fast vibrations about slow orbits: multipliers by exponentials, against DOP853 and closed forms."""

from __future__ import annotations

from itertools import accumulate
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.linalg import expm

import periodic as per
import symbolic as sym
from periodic.collocation.fastmotions import exponentials as module
from periodic.collocation.fastmotions.exponentials import _Matrices, _moments, exponentials, vibrates
from periodic.collocation.fastmotions.unresolved import jacobians
from periodic.orbit.orbit import Orbit
from periodic.stability.multipliers import Spectrum
from periodic.stability.vibrating import VibratingSpectrum


def coupled(omega: float, ratio: float = 0.0, cubic: float = 0.5) -> sym.CompiledSystem:
    """A forced Duffing oscillator that moves a fast one, by a cubic spring between both, damped lightly."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, object]:
        stretch = cubic * (x.x - x.y / 2) ** 3
        slow = -x.x - 0.1 * x.v - stretch + wave.cos
        return {
            "x": x.v,
            "v": slow,
            "y": x.w,
            "w": -(omega**2) * x.y - 2 * ratio * omega * x.w + stretch / 2 * omega,
        }

    rest = dict.fromkeys("xvyw", 0.0)
    return sym.compile(
        sym.Equations(rates, rest, {"Omega": 0.8}, frequency="Omega", scales={"y": 1e-2, "w": 1e-2 * omega})
    )


def first(system: sym.CompiledSystem, tol: float = 1e-7) -> per.Point:
    """The orbit at the nominal frequency."""
    few = per.ArclengthControl(max_points=1)
    return per.trace(system, "Omega", (0.8, 1.0), tol=tol, control=few)[0]


def monodromy(system: sym.CompiledSystem, orbit: Orbit) -> np.ndarray:
    """The monodromy matrix along an orbit, by DOP853."""
    n = orbit.nodes.shape[1]

    def rates(tau: float, flat: np.ndarray) -> np.ndarray:
        states = orbit.state(np.array([tau % (2 * np.pi)]))
        line = system.linearise(np.zeros((1, n)), states, np.zeros((1, 0)), np.array([tau]), orbit.parameter)
        return (np.linalg.solve(line.d_rate[0], -line.d_state[0]) @ flat.reshape(n, n)).ravel()

    found = solve_ivp(rates, (0, 2 * np.pi), np.eye(n).ravel(), "DOP853", rtol=1e-13, atol=1e-14)
    return found.y[:, -1].reshape(n, n)


@pytest.mark.parametrize(("omega", "ratio"), [(150.7, 1e-3), (150.7, 0.0), (400.1, 0.0)])
def test_multipliers_of_a_fast_vibration(omega: float, ratio: float) -> None:
    """Assert multipliers to what they claim against DOP853, on the mesh that the slow motion needs."""
    system = coupled(omega, ratio)
    point = first(system)
    assert point.orbit.mesh.ntst <= 48
    assert point.error.multiplier < 3e-8
    expected = np.linalg.eigvals(monodromy(system, point.orbit))
    assert apart(point.multipliers, expected) < max(1.5 * point.error.multiplier, 1e-9)
    assert np.abs(np.abs(point.multipliers) - np.exp(-2 * np.pi * ratio * omega / 0.8)).min() < 1e-2


def test_same_as_a_mesh_that_resolves_it() -> None:
    """Assert multipliers and orbit of collocation alone on a mesh for the vibration, to what both claim."""
    system = coupled(40.3, 1e-3)
    point = first(system)
    fine = per.trace(
        system,
        "Omega",
        (0.8, 1.0),
        method=per.Collocation(ntst=700, ntst_min=700),
        control=per.ArclengthControl(max_points=1),
    )[0]
    assert fine.orbit.mesh.ntst == 700
    claimed = 3 * (point.error.multiplier + fine.error.multiplier)
    assert claimed < 1e-7
    assert apart(point.multipliers, fine.multipliers) < claimed
    assert point.peak_to_peak("x") == pytest.approx(fine.peak_to_peak("x"), rel=1e-7)


def test_error_is_below_the_tolerance() -> None:
    """Assert that to a tolerance of 1e-3, 1e-5, 1e-7 multipliers are off by less than a third of it."""
    system = coupled(150.7)
    orbit = first(system).orbit
    expected = np.linalg.eigvals(monodromy(system, orbit))
    for tolerance in (1e-3, 1e-5, 1e-7):
        found = exponentials(system, orbit, tolerance)
        assert found is not None
        assert apart(np.linalg.eigvals(found.fundamental[-1]), expected) < tolerance / 3


def apart(one: np.ndarray, two: np.ndarray) -> float:
    """The larger difference of the sums of multipliers and of half their squares."""
    return max(abs((one**power).sum() - (two**power).sum()) / power for power in (1, 2))


def test_constant_matrix_is_exact() -> None:
    """Assert exp(A h) of a linear system, whatever it turns by in an interval, and the turn of its pairs."""
    omega = 97.0
    system = coupled(omega, 1e-3, cubic=0.0)
    orbit = first(system).orbit
    found = exponentials(system, orbit, 1e-10)
    assert found is not None
    matrix = found.turning[0] / orbit.grid.width[0]
    steps = expm(matrix * orbit.grid.width[:, None, None])
    expected = np.array(list(accumulate(steps, lambda x, step: step @ x, initial=np.eye(4))))
    assert found.fundamental == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
    pairs = VibratingSpectrum(found.fundamental, turning=found.turning).pairs
    turned = sorted(abs(pair.rotated) for pair in pairs)
    assert turned == pytest.approx([2 * np.pi / 0.8 * s for s in (np.sqrt(1 - 0.05**2), omega)], rel=1e-2)
    aliased = max(abs(pair.rotated) for pair in Spectrum(found.fundamental).pairs)
    assert aliased < 0.5 * turned[1]


@pytest.mark.parametrize("z", [0.0, 0.3 - 0.2j, 0.999, 1.001j, -3 + 40j, 25.0, 300j])
def test_moments(z: complex) -> None:
    """Assert the integrals of u^p exp(z u), p < 4, by quadrature."""
    found = _moments(np.array([[z]], dtype=complex), 4)[:, 0, 0]
    for p in range(4):
        parts = [
            quad(lambda u, p=p, part=part: part(u**p * np.exp(z * u)), -1, 1, limit=400)[0]
            for part in (np.real, np.imag)
        ]
        assert found[p] == pytest.approx(complex(*parts), rel=1e-11, abs=1e-11 * np.exp(abs(np.real(z))))


def test_when_it_vibrates() -> None:
    """Assert it where the scheme loses a vibration that lasts, not where it is damped out or resolved."""
    for omega, ratio, expected in ((150.7, 1e-3, True), (150.7, 0.2, False), (6.0, 1e-3, False)):
        system = coupled(omega, ratio)
        orbit = first(system).orbit
        exponents = np.linalg.eigvals(jacobians(system, orbit) * orbit.grid.width[:, None, None])
        assert vibrates(orbit.mesh.scheme, exponents, 1e-7) is expected
        assert not vibrates(orbit.mesh.scheme, exponents, 1e9)


def test_vibration_that_is_gone_at_once() -> None:
    """Assert that one does not count that dies within an interval, however fast, without an overflow."""
    scheme = per.Scheme()
    for rate, expected in ((-1e3, False), (-40.0, False), (-1e-3, True)):
        assert vibrates(scheme, np.array([[rate + 50j, rate - 50j]]), 1e-7) is expected


def test_normal_mode_of_a_beam() -> None:
    """Assert 24 intervals at the most for the first mode of a cantilever with a cubic spring at its tip.

    Of two elements; the last mode is 62 times as fast: with a mesh for its multipliers there are 611. All
    multipliers have modulus 1, the pair of 1 to the root of their error.
    """
    h = 0.5
    stiff = np.array([[12, 6 * h, -12, 6 * h], [0, 4 * h * h, -6 * h, 2 * h * h], [0, 0, 12, -6 * h]])
    stiff = np.vstack([stiff, [0, 0, 0, 4 * h * h]]) / h**3
    heavy = np.array([[156, 22 * h, 54, -13 * h], [0, 4 * h * h, 13 * h, -3 * h * h], [0, 0, 156, -22 * h]])
    heavy = np.vstack([heavy, [0, 0, 0, 4 * h * h]]) * h / 420
    whole = np.zeros((2, 6, 6))
    for k, element in enumerate((stiff, heavy)):
        for begin in (0, 2):
            whole[k, begin : begin + 4, begin : begin + 4] += element + np.triu(element, 1).T
    mass, stiffness = whole[1, 2:, 2:], whole[0, 2:, 2:]
    pull, push = np.linalg.solve(mass, stiffness), np.linalg.solve(mass, [0, 0, 10.0, 0])

    def rates(x: Any, p: Any) -> dict[str, object]:
        q, v = ([getattr(x, f"{name}{k}") for k in range(4)] for name in "qv")
        forces = [sum(float(a) * b for a, b in zip(row, q, strict=True)) for row in pull]
        found = {f"v{k}": -forces[k] - float(push[k]) * q[2] ** 3 - p.c * v[k] for k in range(4)}
        return {**{f"q{k}": v[k] for k in range(4)}, **found}

    rest = {f"{name}{k}": 0.0 for name in "qv" for k in range(4)}
    system = sym.compile(sym.Equations(rates, rest, {"c": 0.0}, scales={f"v{k}": 3.5 for k in range(4)}))
    still = per.trace(system, "c", (0, 1), method=per.Equilibrium())[0].orbit
    guess = per.normal_mode(system, still, "c")
    begin = float(guess.parameters["omega"])
    assert begin == pytest.approx(3.5177, rel=1e-3)
    free = {"determined": {"c": per.Conservative()}, "control": per.ArclengthControl(max_points=4)}
    branch = per.trace(system, "omega", (begin, 1.3 * begin), guess=guess, **free)
    for point in branch:
        assert point.orbit.mesh.ntst <= 24
        assert point.error.multiplier < 1e-8
        assert np.abs(point.multipliers) == pytest.approx(np.ones(8), abs=1e-4)


def test_rigid_body_has_no_modes() -> None:
    """Assert none where the mean matrix has no basis of eigenvectors."""

    def rates(x: Any, p: Any, wave: Any) -> dict[str, object]:
        return {"x": x.v, "v": wave.cos, "y": x.w, "w": -(90.0**2) * x.y - 0.1 * x.w}

    system = sym.compile(
        sym.Equations(
            rates, dict.fromkeys("xvyw", 0.0), {"Omega": 0.8}, frequency="Omega", scales={"w": 90.0}
        )
    )
    orbit = first(coupled(90.0, cubic=0.0)).orbit
    assert exponentials(system, orbit, 1e-7) is None


def test_stiff_motion_beside_it() -> None:
    """Assert none, without a warning, beside one that decays by e^-30000 in an interval, all with e^-3."""
    for rate, known in ((1e5, False), (8.0, True)):

        def rates(x: Any, p: Any, wave: Any, rate: float = rate) -> dict[str, object]:
            force = 0.5 * (x.x - x.y / 2) ** 3
            fast = {"y": x.w, "w": -(150.7**2) * x.y + 75.0 * force}
            return {"x": x.v, "v": -x.x - 0.1 * x.v - force + wave.cos, **fast, "u": rate * (x.x**2 - x.u)}

        given = {"frequency": "Omega", "scales": {"y": 1e-2, "w": 1.507}}
        system = sym.compile(sym.Equations(rates, dict.fromkeys("xvywu", 0.0), {"Omega": 0.8}, **given))
        few = {"control": per.ArclengthControl(max_points=1), "method": per.Collocation(ntst_max=24)}
        point = per.trace(system, "Omega", (0.8, 1.0), tol=1e-7, **few)[0]
        found = exponentials(system, point.orbit, 1e-7)
        assert (found is not None) is known
        if known:
            expected = np.linalg.eigvals(monodromy(system, point.orbit))
            assert apart(point.multipliers, expected) < max(1.5 * point.error.multiplier, 1e-9) < 3e-8


def test_steps_that_do_not_converge(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert none with too few parts, so that collocation's own multipliers count."""
    system = coupled(150.7)
    orbit = first(system).orbit
    monkeypatch.setattr(module, "MOST_PARTS", 2)
    assert exponentials(system, orbit, 1e-10) is None


def test_matrices_along_the_orbit() -> None:
    """Assert the Jacobian at Gauss points of two parts of an interval, by hand."""
    system = coupled(20.0, 0.01)
    orbit = first(system).orbit
    found = _Matrices(system, orbit).at(2, np.array([3]))
    assert found.shape == (2, 4, 4, 4)
    points = (1 + np.polynomial.legendre.leggauss(4)[0]) / 4
    tau = orbit.grid.left[3] + orbit.grid.width[3] * np.concatenate([points, 0.5 + points])
    states = orbit.state(tau)
    x, y = states[:, 0], 1e-2 * states[:, 2]
    spring = 1.5 * (x - y / 2) ** 2 / 0.8
    assert found.reshape(8, 4, 4)[:, 1, 0] == pytest.approx(-1 / 0.8 - spring, rel=1e-10)
    assert found.reshape(8, 4, 4)[:, 3, 3] == pytest.approx(np.full(8, -2 * 0.01 * 20.0 / 0.8), rel=1e-10)
