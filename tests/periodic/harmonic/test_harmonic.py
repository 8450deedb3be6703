"""Harmonic balance: known answers, agreement with collocation, and what it refuses."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.flows import AUTONOMOUS, feedback, period, van_der_pol
from support.kept import kept
from support.numpy_systems import (
    AlgebraicOscillator,
    Array,
    BilinearOscillator,
    LinearOscillator,
)
from support.traces import (
    DUFFING_A,
    DUFFING_NLVIB,
    FINE,
    RPM,
    disc_system,
    duffing,
    duffing_system,
    user_points,
)

import periodic as per
import symbolic as sym
from periodic.harmonic.series import FourierOrbit, tail

HB = per.HarmonicBalance
DISC = "vitrea79-810N"


class Helmholtz(LinearOscillator):
    """r = x - x^2: its response at twice the natural frequency doubles."""

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """Return r, dr/dx, dr/dtau."""
        return x - x**2, 1 - 2 * x, np.zeros_like(x)


def loose(tolerance: float) -> per.Tolerance:
    """A tolerance that lets a few harmonics pass."""
    return per.Tolerance(orbit=tolerance)


def fourier(point: per.Point) -> FourierOrbit:
    """The orbit of a point of harmonic balance."""
    assert isinstance(point.orbit, FourierOrbit)
    return point.orbit


def folds(branch: per.Branch) -> list[float]:
    """Parameters at the folds, in order along a branch."""
    return [point.parameter for point in branch.labelled(per.Label.FOLD)]


def distance(a: Array, b: Array) -> float:
    """Largest distance of two sets of multipliers in order of size and argument."""
    return float(np.abs(np.sort_complex(a) - np.sort_complex(b)).max())


@pytest.mark.parametrize("system", [LinearOscillator(), AlgebraicOscillator()])
def test_linear_oscillator_is_exact(system: LinearOscillator) -> None:
    """Assert orbit, extremes and multipliers to rounding, with the unknown z eliminated or without any."""
    branch = per.trace(system, "Omega", (0.8, 0.9), method=HB())
    point, tau = branch[0], np.linspace(0, 7, 50)
    assert branch.stop.reason is per.Reason.BOUND
    assert point.orbit.state(tau) == pytest.approx(system.exact_state(tau), abs=1e-12)
    assert point.orbit.rate(tau)[:, 0] == pytest.approx(system.exact_state(tau)[:, 1], abs=1e-12)
    assert point.maximum["x"] == pytest.approx(np.hypot(*system.exact_state(np.zeros(1))[0]), rel=1e-12)
    assert distance(point.multipliers, system.exact_multipliers()) < 1e-12


def test_one_harmonic() -> None:
    """Assert the folds of one-term harmonic balance (NLvib), with one harmonic and no more."""
    system = duffing_system(*DUFFING_NLVIB)
    one = HB(harmonics=1, most=1)
    branch = per.trace(system, "Omega", (0.8, 1.6), method=one, tol=loose(0.1))
    assert branch.stop.reason is per.Reason.BOUND
    assert {fourier(point).harmonics for point in branch} == {1}
    assert sorted(folds(branch)) == [pytest.approx(1.115586, abs=5e-7), pytest.approx(1.267537, abs=5e-7)]
    assert {p.label for p in branch.special_points} == {per.Label.END, per.Label.FOLD}


@pytest.mark.parametrize(
    "problem, bounds, known, exactly",
    [
        (DUFFING_A, (0.3, 3.0), (2.211935317020, 1.438670145514), 1e-11),
        (DUFFING_NLVIB, (0.8, 1.6), (1.26960195555, 1.11570025177), 5e-12),
    ],
)
def test_duffing_folds(
    problem: tuple[float, float, float], bounds: tuple[float, float], known: tuple[float, ...], exactly: float
) -> None:
    """Assert the folds to the digits of the table, and that the number of harmonics rose and fell."""
    branch = per.trace(duffing_system(*problem), "Omega", bounds, method=HB(), tol=1e-7)
    assert branch.stop.reason is per.Reason.BOUND
    assert folds(branch) == pytest.approx(known, rel=exactly)
    used = [fourier(point).harmonics for point in branch]
    assert min(used) < 6 and max(used) > 8
    assert max(point.error.worst for point in branch) < 1e-7


def test_agrees_with_collocation() -> None:
    """Assert extremes and multipliers of both methods along Duffing's resonance, on every sheet."""
    values = (0.5, 1.0, 1.6, 2.0)
    harmonic = per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 3.0), at=values, method=HB(), tol=FINE)
    other = duffing(DUFFING_A, FINE, at=values)
    for value in values:
        ours, theirs = user_points(harmonic, value), user_points(other, value)
        assert len(ours) == len(theirs) == (3 if value > 1.5 else 1)
        for a, b in zip(ours, theirs, strict=True):
            assert a.maximum["x"] == pytest.approx(b.maximum["x"], rel=1e-9)
            assert distance(a.multipliers, b.multipliers) < 1e-12 * max(1.0, abs(b.multipliers[0]))
            assert a.stable == b.stable


def test_converges_exponentially() -> None:
    """Assert that the error falls by more than 20 with every odd harmonic, and that its estimate is right."""
    (exact,) = user_points(duffing(DUFFING_A, FINE, at=(0.5, 1.0, 1.6, 2.0)), 1.0)
    tau, errors = np.linspace(0, 2 * np.pi, 400), []
    for count in (3, 5, 7, 9, 11):
        method = HB(harmonics=count, most=count)
        branch = per.trace(duffing_system(*DUFFING_A), "Omega", (1.0, 1.001), method=method, tol=loose(0.1))
        error = np.abs(branch[0].orbit.state(tau) - exact.orbit.state(tau)).max() / exact.orbit.span()
        assert branch[0].error.orbit == pytest.approx(error, rel=0.15)
        off = distance(branch[0].multipliers, exact.multipliers)
        assert off < max(3 * branch[0].error.multiplier, 1e-12)
        errors.append(error)
    assert (np.array(errors[:-1]) > 20 * np.array(errors[1:])).all()
    assert errors[-1] < 3e-9


@pytest.mark.parametrize(
    "rpm, ripple", [(450.0, pytest.approx(1.615395, abs=5e-7)), (360.0, pytest.approx(3.865414, abs=5e-7))]
)
def test_disc(rpm: float, ripple: object) -> None:
    """Assert the wavy disc's ripple (um) and multiplier where contact is kept: an implicit model with z."""
    branch = per.trace(disc_system(DISC), "speed", (rpm * RPM, (rpm + 5) * RPM), method=HB())
    assert branch[0].peak_to_peak("x") * 1e6 == ripple
    other = per.trace(disc_system(DISC), "speed", (rpm * RPM, (rpm + 5) * RPM))
    assert branch[0].maximum["load"] == pytest.approx(other[0].maximum["load"], rel=1e-6)
    assert distance(branch[0].multipliers, other[0].multipliers) < 1e-9
    if rpm == 360:
        assert abs(branch[0].multipliers[0]) == pytest.approx(0.965143, abs=5e-7)


def refusal(branch: per.Branch) -> float:
    """The tail that a refusal tells, which must tell the number of harmonics and the tolerance too."""
    assert branch.stop.reason is per.Reason.INACCURATE and branch.stop.reason.numerical
    said = re.fullmatch(
        r"tolerance not reached: the spectrum's tail is (\S+) at 32 harmonics \(error estimate \S+\); "
        r"the tolerance is 1e-07",
        str(branch.stop),
    )
    assert said is not None, str(branch.stop)
    return float(said.group(1))


def test_lost_contact_is_refused() -> None:
    """Assert that the disc is refused below the loss of contact, the points before it kept."""
    branch = per.trace(disc_system(DISC), "speed", (310 * RPM, 260 * RPM), method=HB(most=32), tol=1e-7)
    assert 1e-8 < refusal(branch) < 1e-6
    assert len(branch) > 4 and 285 < branch[-1].parameter / RPM < 292
    assert branch[-1].label is per.Label.FAILED
    assert max(point.error.orbit for point in branch) < 1e-7


def test_start_without_contact_is_refused() -> None:
    """Assert that a start at 260 rev/min is refused with the tail that was measured there, or on the way."""
    branch = per.trace(disc_system(DISC), "speed", (260 * RPM, 250 * RPM), method=HB(most=32))
    assert len(branch) == 0
    assert branch.stop.reason is per.Reason.INACCURATE
    assert re.search(r"the spectrum's tail is \S+ at 32 harmonics", branch.stop.detail)


def test_kink_is_refused() -> None:
    """Assert that a spectrum that falls with a power of the harmonic alone is told."""
    branch = per.trace(BilinearOscillator(), "Omega", (0.8, 0.9), method=HB(most=32), tol=1e-7)
    assert len(branch) == 0
    assert 1e-6 < refusal(branch) < 1e-3


@kept
def van_der_pol_branch() -> per.Branch:
    """Orbits from mu = 1 on, by harmonic balance."""
    guess = van_der_pol(1.0).simulated([2.0, 0.0], 100.0, crossing=0)
    system = van_der_pol(1.0)
    return per.trace(system, "mu", (1, 2), guess=guess, determined=AUTONOMOUS, method=HB(), tol=FINE)


def test_van_der_pol() -> None:
    """Assert period, amplitude and trivial multiplier; relaxation oscillations are refused."""
    point = van_der_pol_branch()[0]
    assert period(point) == pytest.approx(6.6632868593, rel=1e-11)
    assert point.maximum["x1"] == pytest.approx(2.0086198609, rel=3e-11)
    assert point.trivial is not None and point.trivial < 1e-11
    guess = van_der_pol(5.0).simulated([2.0, 0.0], 100.0, crossing=0)
    system = van_der_pol(5.0)
    branch = per.trace(system, "mu", (5, 6), guess=guess, determined=AUTONOMOUS, method=HB(most=32), tol=1e-7)
    assert len(branch) == 0 and refusal(branch) > 1e-3


def test_doubling_of_a_flow_and_its_branch() -> None:
    """Assert a known doubling, and the next one on the doubled orbits that begin there."""
    system, guess = feedback(0.9), feedback(0.9).simulated([0.3, 0.0, 0.0], 1000.0, crossing=0)
    options = {"determined": AUTONOMOUS, "method": HB()}
    branch = per.trace(system, "alpha", (0.58, 0.9), start=0.9, guess=guess, **options)  # type: ignore[arg-type]
    (doubling,) = branch.labelled(per.Label.DOUBLING)
    assert doubling.parameter == pytest.approx(0.630302006160, rel=1e-10)
    assert period(doubling) == pytest.approx(6.364071339441, rel=1e-12)
    twice = per.doubled(system, doubling.orbit, "alpha", determined=AUTONOMOUS)
    start = float(twice.parameter[1])
    nearby = (0.575, start)
    ours = per.trace(system, "alpha", nearby, start=start, guess=twice, **options)  # type: ignore[arg-type]
    theirs = per.trace(system, "alpha", nearby, start=start, guess=twice, determined=AUTONOMOUS)
    (mine,), (other,) = (b.labelled(per.Label.DOUBLING) for b in (ours, theirs))
    assert mine.orbit.periods == 2
    assert mine.parameter == pytest.approx(other.parameter, rel=1e-10)
    assert period(mine) == pytest.approx(period(other), rel=1e-10)


class Mathieu(LinearOscillator):
    """Omega^2 x'' + (1 - 2 depth cos tau) x = 0."""

    def __init__(self, depth: float) -> None:
        super().__init__(zeta=0.0, F=0.0)
        self.depth = depth

    def restoring(self, x: Array, phase: Array) -> tuple[Array, Array, Array]:
        """Return r, dr/dx, dr/dtau."""
        stiffness = 1 - 2 * self.depth * np.cos(phase)
        return stiffness * x, stiffness, 2 * self.depth * np.sin(phase) * x


@pytest.mark.parametrize("q, a", [(1.0, 1.859108072514), (5.0, 1.858187541548)])
def test_mathieu(q: float, a: float) -> None:
    """Assert the tabulated boundary a1(q) of stability, where the multipliers meet at -1 in a double root."""
    Omega = 2 / np.sqrt(a)
    branch = per.trace(Mathieu(q / a), "Omega", (0.97 * Omega, 1.03 * Omega), method=HB(), tol=FINE)
    (doubling,) = branch.labelled(per.Label.DOUBLING)
    assert doubling.parameter == pytest.approx(Omega, rel=1e-11)


def test_subharmonics_of_a_forced_oscillator() -> None:
    """Assert that doublings and doubled orbits agree with collocation, each method on its own."""
    system, found = Helmholtz(zeta=0.05, F=0.6), []
    for method in (HB(), per.Collocation()):
        branch = per.trace(system, "Omega", (2.0, 2.6), start=2.6, method=method, tol=1e-8)
        (doubling,) = branch.labelled(per.Label.DOUBLING)
        guess = per.doubled(system, doubling.orbit, "Omega")
        other = per.trace(
            system, "Omega", (1.8, guess.parameter[0]), at=(1.9,), guess=guess, method=method, tol=1e-8
        )
        (once,) = user_points(other, 1.9)
        assert once.orbit.periods == 2
        (next_doubling,) = other.labelled(per.Label.DOUBLING)
        found.append([doubling.parameter, next_doubling.parameter, once.maximum["x"], once.minimum["x"]])
    assert found[0][:2] == pytest.approx(found[1][:2], rel=1e-11)
    assert found[0][2:] == pytest.approx(found[1][2:], rel=1e-7)


def test_branch_goes_on_with_the_other_method() -> None:
    """Assert that orbits of each method are guesses for the other."""
    system = duffing_system(*DUFFING_A)
    harmonic = per.trace(system, "Omega", (1.0, 1.2), method=HB())
    onward = per.trace(system, "Omega", (1.2, 1.4), guess=harmonic[-1].orbit)
    again = per.trace(system, "Omega", (1.3, 1.4), start=1.4, guess=onward[-1].orbit, method=HB())
    assert not isinstance(onward[0].orbit, FourierOrbit) and isinstance(again[0].orbit, FourierOrbit)
    assert onward[0].maximum["x"] == pytest.approx(harmonic[-1].maximum["x"], rel=1e-7)
    assert again[0].maximum["x"] == pytest.approx(onward[-1].maximum["x"], rel=1e-7)


def test_kept_on_disk(tmp_path: object) -> None:
    """Assert that a loaded branch has the same Fourier series, unknowns and labels."""
    branch = per.trace(AlgebraicOscillator(), "Omega", (0.8, 0.9), method=HB())
    path = f"{tmp_path}/branch.nc"
    branch.save(path)
    again = per.Branch.load(path)
    assert [p.label for p in again] == [p.label for p in branch]
    tau = np.linspace(0, 7, 20)
    for a, b in zip(again, branch, strict=True):
        assert fourier(a).harmonics == fourier(b).harmonics
        assert (a.orbit.state(tau) == b.orbit.state(tau)).all()
        assert (a.orbit.algebraic == b.orbit.algebraic).all()


@pytest.mark.parametrize("functional", [per.Amplitude("load"), per.Maximum("load"), per.PeakToPeak("film")])
def test_levels_of_unknowns_and_rates(functional: per.Amplitude) -> None:
    """Assert that orbits of constant load or film over speed and preload agree with collocation's."""
    system = disc_system("vitrea79-810N")
    start = per.trace(
        system, "speed", (420 * RPM, 440 * RPM), start=430 * RPM, watch=per.Watch(stop={"EP": 1})
    )
    guess = next(p for p in start if p.parameter == 430 * RPM).orbit
    level = per.Level(functional, functional(system, guess))
    found = [
        per.trace(
            system,
            "preload",
            (800.0, 900.0),
            guess=guess,
            determined={"speed": level},
            method=method,
            at=[850.0],
            tol=1e-8,
        )
        for method in (HB(), per.Collocation())
    ]
    ends = [[p.orbit.parameter for p in branch.labelled(per.Label.USER)] for branch in found]
    assert len(ends[0]) == 1
    assert ends[0][0] == pytest.approx(ends[1][0], rel=1e-8)
    assert np.median([p.iterations for p in found[0]]) <= 4


def test_curves_need_piecewise_polynomials() -> None:
    """Assert that derivatives of multipliers are refused for Fourier series, in one sentence."""
    system = duffing_system(*DUFFING_A)
    fold = duffing().labelled(per.Label.FOLD)[0].orbit
    with pytest.raises(ValueError, match="FourierOrbit.*need one found by Collocation or Shooting"):
        per.trace(system, "Omega", (2, 3), guess=fold, determined={"F": per.FoldCondition()}, method=HB())


@pytest.mark.parametrize(
    "settings, sentence",
    [
        ({"harmonics": 0}, "harmonics is 0; it must be a whole number of at least 1"),
        ({"most": 2.5}, "most is 2.5; it must be a whole number of at least 1"),
        ({"harmonics": 9, "most": 8}, "harmonics is 9; it must be at most most = 8"),
    ],
)
def test_refused_settings(settings: dict[str, float], sentence: str) -> None:
    """Assert that settings that make no sense are refused in one sentence."""
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        HB(**settings)  # type: ignore[arg-type]


def test_tail_of_a_spectrum() -> None:
    """Assert the peak to peak of the last quarter of the harmonics over that of the orbit, to rounding."""
    x = sym.coordinate("x")
    spring = sym.Mass(x, 1.0) + sym.Damper(x, 0.1) + sym.Spring(x, 1.0) + sym.CubicSpring(x, 1.0)
    system = sym.compile(spring + sym.HarmonicForce(x, 1.0))
    orbit = per.trace(system, "Omega", (0.3, 0.32), method=HB(harmonics=8), tol=1e-3)[0].orbit
    assert isinstance(orbit, FourierOrbit)
    last = np.arange(orbit.harmonics - orbit.harmonics // 4, orbit.harmonics) + 1
    sampled = np.fft.rfft(orbit.state(2 * np.pi * np.arange(256) / 256), axis=0) / 128
    wanted = 2 * np.abs(sampled[last]).max() / float(orbit.span())
    assert tail(orbit, 0.0) == pytest.approx(wanted, rel=1e-9)
