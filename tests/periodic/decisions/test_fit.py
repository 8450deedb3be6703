"""Fits to made-up measurements, whose truth is known and whose motions are integrated by SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.sweeps import AMPLITUDE, FREE, RESPONSE, TRUTH, swept

import periodic as per
import symbolic as sym


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
