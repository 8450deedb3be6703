"""Functionals of orbits, their sensitivities, and orbits picked by them, where the answers are known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.numpy_systems import LinearOscillator
from support.traces import DUFFING_A, FINE, RPM, disc_system, duffing, duffing_system, user_points

import periodic as per
import symbolic as sym

DAMPING, FORCE, OMEGA = 0.2, 0.7, 0.8
TOLERANCE = 1e-9


def linear_system() -> sym.CompiledSystem:
    """m x'' + c x' + k x = F cos(Omega t)."""
    x = sym.coordinate("x")
    parts = sym.Mass(x, 1.0) + sym.Damper(x, DAMPING) + sym.Spring(x, 1.0)
    return sym.compile(parts + sym.HarmonicForce(x, FORCE))


def gain(Omega: float, c: float = DAMPING, k: float = 1.0, m: float = 1.0) -> complex:
    """Complex amplitude of x over that of the force."""
    return 1 / (k - m * Omega**2 + 1j * c * Omega)


def linear_orbit() -> tuple[sym.CompiledSystem, per.Orbit]:
    """The orbit at OMEGA."""
    system = linear_system()
    branch = per.trace(system, "Omega", (0.5, OMEGA), start=OMEGA, tol=FINE)
    return system, branch[0].orbit


def test_harmonics_of_a_linear_oscillator() -> None:
    """Assert amplitude, phase lag, components and mean against the exact response."""
    system, orbit = linear_orbit()
    expected = FORCE * gain(OMEGA)
    assert per.Amplitude("x")(system, orbit) == pytest.approx(abs(expected), rel=TOLERANCE)
    assert per.PhaseLag("x")(system, orbit) == pytest.approx(-np.angle(expected), rel=TOLERANCE)
    assert per.Component("x")(system, orbit) == pytest.approx(expected.real, rel=TOLERANCE)
    assert per.Component("x", 1, math.pi / 2)(system, orbit) == pytest.approx(-expected.imag, rel=TOLERANCE)
    assert per.mean("x")(system, orbit) == pytest.approx(0, abs=TOLERANCE)
    assert per.Amplitude("x", 3)(system, orbit) == pytest.approx(0, abs=TOLERANCE)
    assert per.PeakToPeak("x")(system, orbit) == pytest.approx(2 * abs(expected), rel=TOLERANCE)
    assert per.Maximum("x")(system, orbit) == pytest.approx(-per.Minimum("x")(system, orbit), rel=TOLERANCE)


def test_sensitivities_of_a_linear_oscillator() -> None:
    """Assert derivatives of extremes, harmonics and multipliers in every parameter against exact ones."""
    system, orbit = linear_orbit()
    found = per.sensitivities(
        system,
        orbit,
        {
            "p-p": per.PeakToPeak("x"),
            "amplitude": per.Amplitude("x"),
            "lag": per.PhaseLag("x"),
            "modulus": per.Multiplier(),
            "real": per.Multiplier(0, "real"),
            "imaginary": per.Multiplier(0, "imaginary"),
            "angle": per.Multiplier(0, "angle"),
        },
    )

    def exact(m: float, c: float, k: float, F: float, Omega: float) -> dict[str, float]:
        response = F * gain(Omega, c, k, m)
        root = -c / (2 * m) + 1j * math.sqrt(k / m - (c / (2 * m)) ** 2)
        multiplier = np.exp(root * 2 * math.pi / Omega)
        return {
            "p-p": 2 * abs(response),
            "amplitude": abs(response),
            "lag": -float(np.angle(response)),
            "modulus": abs(multiplier),
            "real": multiplier.real,
            "imaginary": multiplier.imag * math.copysign(1, multiplier.imag),
            "angle": abs(float(np.angle(multiplier))),
        }

    values = {p.name: float(v) for p, v in zip(system.parameters, orbit.parameter, strict=True)}
    for name in values:
        h = 1e-3

        def at(step: float, name: str = name) -> dict[str, float]:
            return exact(**{**values, name: values[name] + step})

        for label in found:
            near, far = at(h)[label] - at(-h)[label], at(2 * h)[label] - at(-2 * h)[label]
            assert found[label][name] == pytest.approx((8 * near - far) / (12 * h), rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("rpm", [450.0, 360.0, 260.0])
def test_sensitivities_of_the_disc(rpm: float) -> None:
    """Assert derivatives of ripple, least film and largest multiplier against orbits at other preloads."""
    system = disc_system("vitrea79-810N")
    functionals = {"x": per.PeakToPeak("x"), "film": per.Minimum("film"), "mu": per.Multiplier(0, "real")}
    names = [p.name for p in system.parameters]
    (point, *_) = user_points(
        per.trace(
            system,
            "speed",
            (240 * RPM, 460 * RPM),
            start=460 * RPM,
            at=[rpm * RPM],
            tol=FINE,
            watch=per.Watch(stop={"UZ": 1}),
        ),
        rpm * RPM,
    )
    found = per.sensitivities(system, point.orbit, functionals)
    step = 0.5

    def at(preload: float) -> per.Orbit:
        branch = per.trace(
            system,
            "preload",
            (700.0, 900.0),
            guess=point.orbit,
            at=[preload],
            tol=FINE,
        )
        return min(user_points(branch, preload), key=lambda p: abs(p.maximum["x"] - point.maximum["x"])).orbit

    orbits = [at(810 + k * step) for k in (1, -1, 2, -2)]
    for label, functional in functionals.items():
        values = [functional(system, orbit) for orbit in orbits]
        expected = (8 * (values[0] - values[1]) - (values[2] - values[3])) / (12 * step)
        assert found[label]["preload"] == pytest.approx(expected, rel=1e-6)
    assert set(found["x"]) == set(names)


def test_fold_moves_as_its_sensitivity_says() -> None:
    """Assert that d Omega/dF of a fold agrees with folds at neighbouring forces."""
    system, (fold, _) = duffing_system(*DUFFING_A), duffing(accuracy=FINE).labelled(per.Label.FOLD)
    determined = {"Omega": per.FoldCondition()}
    found = per.sensitivities(
        system, fold.orbit, {"fold": per.Value("Omega"), "x": per.Maximum("x")}, determined=determined
    )
    h = 1e-3
    folds = [duffing((0.1, 1.0, 0.5 + k * h), FINE).labelled(per.Label.FOLD)[0] for k in (1, -1, 2, -2)]
    for label, values in (
        ("fold", [p.parameter for p in folds]),
        ("x", [p.maximum["x"] for p in folds]),
    ):
        expected = (8 * (values[0] - values[1]) - (values[2] - values[3])) / (12 * h)
        # a fold's orbit is known to the root of the precision of its place
        assert found[label]["F"] == pytest.approx(expected, rel=1e-8 if label == "fold" else 1e-4)
    assert "Omega" not in found["fold"]


def test_derivatives_at_a_fold_are_without_bound() -> None:
    """Assert that they are huge at a fold whose place is not determined."""
    (fold, _) = duffing(accuracy=FINE).labelled(per.Label.FOLD)
    found = per.sensitivities(duffing_system(*DUFFING_A), fold.orbit, {"x": per.Maximum("x")})
    assert abs(found["x"]["Omega"]) > 1e3


def test_fourier_series_have_no_exact_derivatives() -> None:
    """Assert that sensitivities of an orbit of harmonic balance are refused in one sentence."""
    system = duffing_system(*DUFFING_A)
    orbit = per.trace(system, "Omega", (0.8, 1.0), start=0.8, method=per.HarmonicBalance())[0].orbit
    with pytest.raises(ValueError, match="exact derivatives need one found by Collocation or Shooting"):
        per.sensitivities(system, orbit, {"x": per.PeakToPeak("x")})


def test_level_must_be_a_number() -> None:
    """Assert the sentence about a level that is none."""
    with pytest.raises(
        ValueError, match="value of a Level is nan; it must be a finite number, or a parameter's name"
    ):
        per.Level(per.Maximum("x"), math.nan)


def test_peak_of_a_linear_oscillator() -> None:
    """Assert Omega^2 = 1 - c^2/2 along the curve of amplitude peaks over the damping."""
    system, dampings = linear_system(), (0.05, 0.2, 0.5)
    begin = math.sqrt(1 - DAMPING**2 / 2)
    guess = per.trace(system, "Omega", (0.5, begin), start=begin, tol=FINE)[0].orbit
    determined = {"Omega": per.Peak(per.PeakToPeak("x"))}
    curve = per.trace(system, "c", (0.04, 0.6), guess=guess, at=dampings, determined=determined, tol=FINE)
    assert curve.stop.reason is per.Reason.BOUND
    at = [p.name for p in system.parameters].index("Omega")
    for c in dampings:
        point, Omega = user_points(curve, c)[0], math.sqrt(1 - c**2 / 2)
        assert point.orbit.parameter[at] == pytest.approx(Omega, rel=1e-8)
        assert point.peak_to_peak("x") == pytest.approx(2 * FORCE * abs(gain(Omega, c)), rel=1e-9)


def test_phase_resonance_of_a_linear_oscillator() -> None:
    """Assert Omega = 1 along the curve where x lags a quarter period behind, whatever the damping."""
    system = linear_system()
    guess = per.trace(system, "Omega", (0.5, 1.0), start=1.0, tol=FINE)[0].orbit
    lag = per.Level(per.Component("x"), 0.0)
    curve = per.trace(system, "c", (0.04, 0.6), guess=guess, determined={"Omega": lag}, tol=FINE)
    assert curve.column("Omega") == pytest.approx(np.ones(len(curve)), abs=1e-11)
    assert curve.column("c")[[0, -1]] == pytest.approx([0.04, 0.6])


def test_constant_ripple_of_duffing() -> None:
    """Assert that the curve of ripple 3 passes through the events of a branch, and through folds."""
    system, level = duffing_system(*DUFFING_A), per.Level(per.PeakToPeak("x"), 3.0)
    branch = per.trace(system, "Omega", (0.3, 3.0), watch=per.Watch(events={"three": level}), tol=FINE)
    first, second = branch.labelled(per.Label.USER)
    assert {p.event for p in (first, second)} == {"three"}
    curve = per.trace(
        system,
        "Omega",
        (1.0, 2.5),
        guess=first.orbit,
        at=[second.parameter],
        determined={"F": level},
        watch=per.Watch(limits={"F": (0.05, 2.0)}),
        tol=FINE,
    )
    (again,) = user_points(curve, second.parameter)
    force = [p.name for p in system.parameters].index("F")
    assert again.orbit.parameter[force] == pytest.approx(0.5, rel=1e-9)
    assert np.abs(curve.peak_to_peak("x") - 3.0).max() < 1e-11
    assert curve.stop == per.Stop(per.Reason.BOUND, "upper limit of F")
    assert curve[-1].orbit.parameter[force] == pytest.approx(2.0, rel=1e-9)
    (fold,) = curve.labelled(per.Label.FOLD)
    at_fold = duffing((0.1, 1.0, float(fold.orbit.parameter[force])), FINE).labelled(per.Label.FOLD)
    assert min(abs(p.parameter - fold.parameter) for p in at_fold) < 1e-11


def test_disc_at_ten_micrometres() -> None:
    """Assert that x p-p is 10 um along a curve over speed and preload that meets a plain branch."""
    system, level = disc_system("vitrea79-810N"), per.Level(per.PeakToPeak("x"), 10e-6)
    branch = per.trace(
        system,
        "speed",
        (260 * RPM, 460 * RPM),
        start=460 * RPM,
        watch=per.Watch(events={"ten": level}, stop={"ten": 1}),
    )
    assert branch.stop.reason is per.Reason.ASKED
    begin = branch[-1]
    assert begin.peak_to_peak("x") == pytest.approx(10e-6, rel=1e-10)
    curve = per.trace(
        system, "preload", (400.0, 1600.0), guess=begin.orbit, determined={"speed": level}, at=[1200.0]
    )
    assert np.abs(curve.peak_to_peak("x") / 10e-6 - 1).max() < 1e-10
    (point,) = user_points(curve, 1200.0)
    other = per.trace(
        system,
        "speed",
        (260 * RPM, 560 * RPM),
        start=560 * RPM,
        values={"preload": 1200.0},
        watch=per.Watch(events={"ten": level}, stop={"ten": 1}),
    )
    at = [p.name for p in system.parameters].index("speed")
    assert other[-1].parameter == pytest.approx(point.orbit.parameter[at], rel=1e-7)


def test_columns_and_counts() -> None:
    """Assert that functionals become columns, and that a branch ends at the n-th point of a kind."""
    system = duffing_system(*DUFFING_A)
    branch = per.trace(
        system,
        "Omega",
        (0.3, 3.0),
        watch=per.Watch(
            columns={"amplitude": per.Amplitude("x"), "intervals": lambda _, orbit: orbit.mesh.ntst},
            stop={"LP": 2},
        ),
    )
    assert [p.label for p in branch.special_points[-2:]] == [per.Label.FOLD] * 2
    assert str(branch.stop) == "stopped as asked: LP met 2 times"
    assert branch.column("intervals") == pytest.approx([p.orbit.mesh.ntst for p in branch])
    assert branch.column("amplitude")[-1] == pytest.approx(branch[-1].maximum["x"], rel=1e-2)
    with pytest.raises(ValueError, match="column is 'amp'; it must be one of .*amplitude, intervals"):
        branch.column("amp")


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"watch": {"stop": {"LQ": 1}}}, "stop has 'LQ'; it must name a label or an event: EP, LP"),
        ({"watch": {"stop": {"LP": 0}}}, "stop of LP is 0; it must be a whole number of at least 1"),
        ({"watch": {"events": {"x": 3.0}}}, r"event x is 3.0; it must be a Level\(functional, value\)"),
        (
            {"watch": {"limits": {"F": (2.0, 1.0)}}},
            r"limits of F are \(2.0, 1.0\); they must be two rising finite",
        ),
        ({"watch": {"limits": {"F": (2.0, 3.0)}}}, "F is 0.5 at the start; its limits are 2.0 to 3.0"),
        ({"watch": {"limits": {"G": (2.0, 3.0)}}}, "parameter is 'G'; it must be one of"),
        ({"watch": {"columns": {"y": per.Maximum("y")}}}, "output is 'y'; it must be one of x"),
        ({"determined": {"F": per.Level(len, 1.0)}}, "which has no derivative"),
        (
            {"determined": {"Omega": per.FoldCondition()}},
            "determined has 'Omega', which is also the parameter",
        ),
        ({"determined": {"F": per.FoldCondition}}, "for F; it must be a condition, as FoldCondition.. is"),
        ({"method": "shooting"}, "method is 'shooting'; it must be Collocation"),
        ({"guess": 3.0}, "guess is a float; it must be an Orbit, as point.orbit is"),
    ],
)
def test_what_is_refused(options: dict[str, object], sentence: str) -> None:
    """Assert the sentences about wrong columns, events, limits and counts."""
    with pytest.raises(ValueError, match=sentence):
        if "watch" in options:
            options = {"watch": per.Watch(**options["watch"])}  # type: ignore[arg-type]
        per.trace(duffing_system(*DUFFING_A), "Omega", (0.3, 3.0), **options)  # type: ignore[arg-type]


def test_derivatives_need_a_differentiable_system() -> None:
    """Assert that a hand-written system without second derivatives is told what it lacks."""
    system = LinearOscillator()
    orbit = per.trace(system, "Omega", (0.5, 0.8))[0].orbit
    with pytest.raises(ValueError, match="LinearOscillator without output_gradient, curvature"):
        per.sensitivities(system, orbit, {"x": per.Maximum("x")})


def test_part_of_a_multiplier_is_checked() -> None:
    """Assert the sentences about a multiplier that there is not."""
    with pytest.raises(ValueError, match="part is 'size'; it must be one of modulus, angle, real, imaginary"):
        per.Multiplier(0, "size")
    system, orbit = linear_orbit()
    with pytest.raises(ValueError, match="which is 2; the orbit has the multipliers 0 to 1"):
        per.Multiplier(2)(system, orbit)


def test_gradient_of_every_functional_in_the_orbit() -> None:
    """Assert rows of functionals on a mesh tied to a kink against differences in all its numbers."""
    system = disc_system("vitrea79-810N")
    branch = per.trace(system, "speed", (255 * RPM, 300 * RPM), start=300 * RPM, tol=FINE)
    orbit, free = branch[-1].orbit, (1, 6)
    assert orbit.mesh.events
    rng = np.random.default_rng(4)
    nodes, stages = (1e-3 * rng.normal(size=a.shape) for a in (orbit.nodes, orbit.stages))
    phases, parts = 1e-4 * rng.normal(size=len(orbit.phases)), 1e-3 * rng.normal(size=2)

    def moved(h: float) -> per.Orbit:
        parameter = orbit.parameter.copy()
        parameter[list(free)] *= 1 + h * parts
        return replace(
            orbit,
            nodes=orbit.nodes + h * nodes,
            stages=orbit.stages + h * stages,
            phases=orbit.phases + h * phases,
            parameter=parameter,
        )

    for functional in (per.Amplitude("x"), per.Component("x", 2, 0.3), per.PhaseLag("x")):
        row = functional.linearise(system, orbit, free)
        change = np.einsum("jn,jn->", row.nodes, nodes) + np.einsum("jln,jln->", row.stages, stages)
        change += row.outer @ np.concatenate([phases, parts * orbit.parameter[list(free)]])
        h = 1e-2
        near = functional(system, moved(h)) - functional(system, moved(-h))
        far = functional(system, moved(2 * h)) - functional(system, moved(-2 * h))
        assert change == pytest.approx((8 * near - far) / (12 * h), rel=1e-7)


def test_sensitivities_ask_for_an_orbit_that_meets_its_conditions() -> None:
    """Assert that an orbit of other parameters, and one that is no fold, are refused; a fold is not."""
    system, wanted = sym.scene("duffing"), {"place": per.Value("Omega")}
    branch = per.trace(system, "Omega", (0.3, 3.0), tol=per.Accuracy.DRAFT)
    fold = branch.labelled("LP")[0]
    determined = {"Omega": per.FoldCondition()}
    assert per.sensitivities(system, fold.orbit, wanted, determined=determined)["place"]["F"] > 0
    with pytest.raises(ValueError, match="^Omega of the orbit is 0.3, where its condition is not met; "):
        per.sensitivities(system, branch[0].orbit, wanted, determined=determined)
    elsewhere = replace(branch[0].orbit, parameter=1.1 * branch[0].orbit.parameter)
    with pytest.raises(ValueError, match="peaks to peak from the one at its parameters"):
        per.sensitivities(system, elsewhere, wanted)
    with pytest.raises(ValueError, match="^functionals is Value"):
        per.sensitivities(system, fold.orbit, per.Value("Omega"))  # type: ignore[arg-type]


@pytest.mark.parametrize("condition", [per.TorusCondition(), per.DoublingCondition(), per.PhaseCondition()])
def test_conditions_of_orbits_are_refused_for_equilibria(condition: per.extend.Condition) -> None:
    """Assert that what holds a periodic orbit holds no equilibrium."""
    system = sym.compile(
        sym.Equations(lambda x, p: {"x": x.v, "v": p.mu * x.v - x.x}, {"x": 0.0, "v": 0.0}, {"mu": -0.1})
    )
    with pytest.raises(ValueError, match="which holds orbits; it must be left out of equilibria"):
        per.trace(system, "mu", (-0.2, -0.1), determined={"omega": condition}, method=per.Equilibrium())


def test_one_state_does_not_double() -> None:
    """Assert that a doubling of a single state, whose multiplier is positive, is refused."""
    values = {"a": 1.0, "w": 1.0}
    system = sym.compile(
        sym.Equations(lambda x, p, w: {"x": w.cos - p.a * x.x}, {"x": 0.0}, values, frequency="w")
    )
    with pytest.raises(ValueError, match="DoublingCondition.., which needs two states"):
        per.trace(system, "w", (0.9, 1.1), determined={"a": per.DoublingCondition()})


def test_special_points_by_no_number_are_refused() -> None:
    """Assert that a test function that gives no finite number is named, with the place."""
    nothing = per.extend.TestFunction(label=per.Label.USER, value=lambda solution: float("nan"))
    with pytest.raises(ValueError, match="^special point UZ gave nan at Omega = "):
        per.trace(sym.scene("duffing"), "Omega", (0.9, 1.0), watch=per.Watch(special=(nothing,)))
