"""Fits to made-up measurements, whose truth is known and whose motions are integrated by SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import periodic as per
import symbolic as sym

AMPLITUDE = per.Amplitude("x")
TRUTH = {"k": 1.05, "k3": 0.9, "c": 0.12}
FREE = {"k": (0.5, 2.0), "k3": (0.2, 3.0), "c": (0.02, 0.4)}
RESPONSE = per.Response("Omega", (0.4, 2.8))


def settled(omega: float, upper: bool, force: float = 0.5) -> complex:
    """First harmonic of the oscillator of TRUTH, integrated from a large or small motion until it repeats."""
    k, k3, c = TRUTH.values()

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [y[1], force * math.cos(omega * t) - c * y[1] - k * y[0] - k3 * y[0] ** 3]

    period = 2 * math.pi / omega
    begin = [2.2, 0.0] if upper else [0.0, 0.0]
    last = solve_ivp(rate, (0, 120 * period), begin, method="DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
    t = np.linspace(0, period, 257)
    motion = solve_ivp(rate, (0, period), last, method="DOP853", rtol=1e-10, atol=1e-12, t_eval=t).y[0]
    wave = np.exp(-1j * omega * t)
    return complex(2 * np.trapezoid(motion * wave, t) / period)


def swept(noise: float, seed: int) -> tuple[list[float], list[float]]:
    """Frequencies and amplitudes of a sweep up along the upper sheet and one down along the lower."""
    rng = np.random.default_rng(seed)
    omegas = [*np.linspace(0.6, 1.8, 9), *np.linspace(2.4, 1.7, 5)]
    found = [abs(settled(w, upper=k < 9)) for k, w in enumerate(omegas)]
    return omegas, (np.array(found) * (1 + noise * rng.standard_normal(len(found)))).tolist()


def test_exact_data_give_the_truth() -> None:
    """Assert parameters to 1e-5 from motions of another integrator, on two sheets that are not told apart."""
    omegas, amplitudes = swept(0.0, 0)
    data = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes}, sigma={AMPLITUDE: 0.01})
    found = per.fit(sym.scene("duffing"), data, FREE, start={"k": 1.3, "k3": 0.6, "c": 0.2})
    assert found.ok and not found.remarks
    for name, value in TRUTH.items():
        assert found[name] == pytest.approx(value, rel=1e-7)
    assert found.match.misfit < 1e-12


def test_noise_gives_intervals_that_hold_the_truth() -> None:
    """Assert errors against those of the inverse of J' J at the truth, and both intervals about it."""
    omegas, amplitudes = swept(0.002, 3)
    sigma = (0.002 * np.array(amplitudes)).tolist()
    data = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes}, sigma={AMPLITUDE: sigma})
    found = per.fit(sym.scene("duffing"), data, FREE, start=TRUTH)
    assert found.ok
    for name, value in TRUTH.items():
        assert abs(found[name] - value) < 3.5 * found.errors[name]
    low, high = found.interval("k3")
    assert low < found["k3"] < high
    ends = found.interval("k3", profile=True)
    assert ends == pytest.approx((low, high), rel=0.02)
    assert found.freedom == len(omegas) - 3
    assert np.diag(found.correlation) == pytest.approx(1.0)
    guessed = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes})  # 1 % of the largest, to be estimated
    estimated = per.fit(sym.scene("duffing"), guessed, FREE, start=TRUTH)
    assert 0.02 < estimated.scale < 0.3
    assert estimated.errors["k3"] == pytest.approx(found.errors["k3"], rel=1.0)


def test_unstable_points_folds_and_phases() -> None:
    """Assert a fit to points of the unstable sheet, with phases, and to the places of both folds."""
    system = sym.scene("duffing")
    branch = per.trace(system, "Omega", (0.4, 2.8), values=TRUTH)
    unstable = [p for p in branch if not p.stable and not p.label][1:]
    assert len(unstable) > 3
    lag = per.PhaseLag("x")
    numbers = {f: [f(system, p.orbit) for p in unstable] for f in (AMPLITUDE, lag)}
    sigma = {AMPLITUDE: 0.01, lag: 0.02}
    points = per.Measured(RESPONSE, [p.parameter for p in unstable], numbers, sigma=sigma)
    folds = [
        per.MeasuredQuantity(RESPONSE.place("LP", which=k), p.parameter, 1e-3)
        for k, p in enumerate(branch.labelled("LP"))
    ]
    found = per.fit(system, [points, *folds], FREE, start={"k": 1.1, "k3": 0.85, "c": 0.13})
    assert found.ok
    for name, value in TRUTH.items():
        assert found[name] == pytest.approx(value, rel=1e-4)


def test_a_history_and_a_sensor_of_unknown_scale() -> None:
    """Assert a fit to a recorded motion, and one whose sensor has a gain that is fitted too."""
    system = sym.scene("duffing")
    point = per.trace(system, "Omega", (0.4, 0.9), values=TRUTH, at=0.8).labelled("UZ")[0]
    t = np.linspace(0, point.orbit.period, 200, endpoint=False)
    motion = point.orbit["x"](t)
    data = per.recorded(RESPONSE, 0.8, t, {"x": motion}, sigma=1e-3, orders=3)
    found = per.fit(system, data, FREE, start={"k": 1.1, "k3": 1.0, "c": 0.1})
    for name, value in TRUTH.items():
        assert found[name] == pytest.approx(value, rel=1e-4)
    omegas, amplitudes = swept(0.0, 0)
    wrong = [1.2 * a + 0.05 for a in amplitudes]
    sensor = per.Measured(
        RESPONSE, omegas, {AMPLITUDE: wrong}, sigma={AMPLITUDE: 0.01}, gain=True, offset=True
    )
    whole = per.fit(system, sensor, FREE, start={"k": 1.1, "k3": 1.0, "c": 0.11})
    gains = [value for name, value in whole.values.items() if name.startswith("gain")]
    offsets = [value for name, value in whole.values.items() if name.startswith("offset")]
    assert gains == [pytest.approx(1.2, rel=1e-3)] and offsets == [pytest.approx(0.05, abs=1e-3)]
    assert whole["k3"] == pytest.approx(TRUTH["k3"], rel=1e-2)


def test_what_cannot_be_told_apart_is_said() -> None:
    """Assert that masses, stiffnesses, damping and force are told to be known but for one scale."""
    omegas, amplitudes = swept(0.0, 0)
    data = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes}, sigma={AMPLITUDE: 0.01})
    free = {"k": (0.5, 2.0), "m": (0.5, 2.0), "F": (0.2, 1.0), "c": (0.02, 0.4), "k3": (0.2, 3.0)}
    found = per.fit(sym.scene("duffing"), data, free, start=TRUTH)
    (direction,) = found.untold[:1]
    assert set(direction) == set(free)
    ratios = [direction[name] / found[name] for name in free]
    assert ratios == pytest.approx([ratios[0]] * 5, rel=1e-3)
    assert "cannot be told apart" in found.table() and "nor would another amplitude or phase" in found.table()
    assert math.isinf(found.errors["k"])
    low = per.Measured(RESPONSE, omegas[:6], {AMPLITUDE: amplitudes[:6]}, sigma={AMPLITUDE: 0.05})
    found = per.fit(sym.scene("duffing"), low, FREE, start=TRUTH)
    (remark,) = [r for r in found.remarks if r.startswith("c is not determined by these data")]
    place = float(remark.rpartition("Omega = ")[2].split()[0])
    assert "would tell" in remark and place == pytest.approx(2.004, abs=0.05)  # the top of the resonance


def test_pictures_of_a_fit() -> None:
    """Assert that points, curve and residuals are drawn, and that another functional is refused."""
    omegas, amplitudes = swept(0.0, 0)
    data = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes}, sigma={AMPLITUDE: 0.01}, name="sweep")
    found = per.fit(sym.scene("duffing"), data, {"k3": (0.2, 3.0)}, start={"k3": 0.9})
    axes = found.plot()
    assert axes.get_ylabel() == "amplitude of x" and len(axes.lines) == 2
    assert axes.lines[1].get_xdata() == pytest.approx(omegas)
    assert set(found.differences) == {"sweep"} and found.differences["sweep"].shape == (14, 2)
    with pytest.raises(ValueError, match="it must be one of which points were measured"):
        found.plot(per.PhaseLag("x"))


def test_outliers_and_sheets_of_a_wrong_start() -> None:
    """Assert that a robust loss leaves an outlier aside, and says which point it is."""
    omegas, amplitudes = swept(0.0, 0)
    amplitudes[3] *= 1.5
    data = per.Measured(RESPONSE, omegas, {AMPLITUDE: amplitudes}, sigma={AMPLITUDE: 0.01})
    plain = per.fit(sym.scene("duffing"), data, FREE, start=TRUTH)
    robust = per.fit(sym.scene("duffing"), data, FREE, start=TRUTH, loss="cauchy")
    errors = [abs(f["k3"] - TRUTH["k3"]) for f in (plain, robust)]
    assert errors[1] < errors[0] / 5
    assert any("standard deviations from the model" in remark for remark in robust.remarks)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"at": [1.0, 1.1], "numbers": {AMPLITUDE: [1.0]}}, "has 1 values; it must have 2"),
        ({"at": [1.0], "numbers": {AMPLITUDE: [math.nan]}}, "has nan; all of it must be finite"),
        ({"at": [9.0], "numbers": {AMPLITUDE: [1.0]}}, "at has 9; it must lie within the response's bounds"),
        ({"at": [1.0], "numbers": {}}, "it must give numbers by functionals"),
        (
            {"at": [1.0], "numbers": {AMPLITUDE: [1.0]}, "sigma": {AMPLITUDE: 0.0}},
            "it must be a positive number",
        ),
        ({"at": [1.0], "numbers": {AMPLITUDE: [1.0]}, "sigma": 0.1}, "it must give those of all numbers"),
        ({"at": "x", "numbers": {AMPLITUDE: [1.0]}}, "at is 'x'; it must be numbers"),
        ({"at": [1.0], "numbers": {len: [1.0]}}, "which has no derivative"),
    ],
)
def test_bad_data(arguments: dict[str, object], said: str) -> None:
    """Assert one sentence for what is not allowed in data."""
    with pytest.raises(ValueError, match=said):
        per.Measured(RESPONSE, **arguments)  # type: ignore[arg-type]


def test_bad_fits() -> None:
    """Assert sentences for fewer data than parameters, other data, and parameters that there are not."""
    system = sym.scene("duffing")
    data = per.Measured(RESPONSE, [1.0], {AMPLITUDE: [1.0]}, sigma={AMPLITUDE: 0.01})
    with pytest.raises(ValueError, match="data are 1 numbers; 3 values are sought"):
        per.fit(system, data, FREE)
    with pytest.raises(ValueError, match=r"data is \[\]; it must be a list of Measured"):
        per.fit(system, [], FREE)
    with pytest.raises(ValueError, match="data has 3; it must be Measured"):
        per.fit(system, [3], FREE)  # type: ignore[list-item]
    with pytest.raises(ValueError, match="loss is 'square'; it must be one of linear"):
        per.fit(system, data, {"k": (0.5, 2.0)}, loss="square")
    with pytest.raises(ValueError, match="quantity is 3"):
        per.MeasuredQuantity(3, 1.0, 0.1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="time has 3 values; it must have more than the 11"):
        per.recorded(RESPONSE, 1.0, [0.0, 1.0, 2.0], {"x": [0.0, 0.0, 0.0]}, sigma=0.1)
    with pytest.raises(ValueError, match="at is 'a'; it must be a number"):
        per.recorded(RESPONSE, "a", [0.0], {"x": [0.0]}, sigma=0.1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="sigma is -0.1; it must be a positive number"):
        per.recorded(RESPONSE, 1.0, [0.0], {"x": [0.0]}, sigma=-0.1)


def test_a_point_on_a_wrong_sheet_is_found_out() -> None:
    """Assert that a fit that ends with a point on a wrong sheet looks for another way, and finds it."""
    from reports.studies.decide.coverage import NOISE
    from reports.studies.decide.truths import TRUTHS

    truth, rng = TRUTHS[0], np.random.default_rng(79)
    data = truth.measured(NOISE, rng)
    begin = {name: value * (1 + 0.05 * rng.standard_normal()) for name, value in truth.hidden.items()}
    found = per.fit(truth.system, data, truth.free, start=begin)
    assert found.match.misfit == pytest.approx(5.46709, rel=1e-4)
    assert found.chance > 0.5 and not found.remarks


def test_no_more_numbers_than_values() -> None:
    """Assert that nothing is claimed of a scatter of which nothing is left to estimate it from."""
    system = sym.scene("duffing")
    point = per.trace(system, "Omega", (0.4, 0.9), values={"k3": 0.9}, at=0.8).labelled("UZ")[0]
    data = per.Measured(RESPONSE, [0.8], {AMPLITUDE: [AMPLITUDE(system, point.orbit)]})
    found = per.fit(system, data, {"k3": (0.2, 3.0)}, start={"k3": 1.0})
    assert found["k3"] == pytest.approx(0.9, rel=1e-6)
    assert math.isinf(found.errors["k3"]) and found.interval("k3") == (0.2, 3.0)


@pytest.mark.parametrize("loss", ["linear", "soft_l1", "huber", "cauchy"])
def test_losses_are_those_of_scipy(loss: str) -> None:
    """Assert values and weights against the cost that SciPy minimises, and its slope."""
    from scipy.optimize import least_squares

    from periodic.decisions.fitting.fitted import LOSSES

    value, weight = LOSSES[loss]
    z = np.array([0.01, 0.5, 0.99, 1.01, 4.0, 100.0])
    costs = [least_squares(lambda x, r=r: [r + 0 * x[0]], [0.0], loss=loss, max_nfev=1).cost for r in z**0.5]
    assert value(z) / 2 == pytest.approx(costs, rel=1e-12)
    assert (value(z + 1e-6) - value(z - 1e-6)) / 2e-6 == pytest.approx(weight(z), rel=1e-5)


def test_a_model_that_is_wrong_is_told() -> None:
    """Assert the sentence on chi squared where nothing fits."""
    omegas, amplitudes = swept(0.0, 0)
    wrong = [a * (1.1 if k % 2 else 0.9) for k, a in enumerate(amplitudes)]
    data = per.Measured(RESPONSE, omegas[:9], {AMPLITUDE: wrong[:9]}, sigma={AMPLITUDE: 0.01})
    found = per.fit(sym.scene("duffing"), data, {"k3": (0.2, 3.0)}, start={"k3": 0.9})
    assert any(remark.startswith("chi squared is") for remark in found.remarks)
