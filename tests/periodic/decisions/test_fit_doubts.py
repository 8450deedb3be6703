"""What a fit says of data, models and parameters that it must doubt."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.sweeps import AMPLITUDE, FREE, RESPONSE, TRUTH, swept

import periodic as per
import symbolic as sym


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


def test_a_model_that_is_wrong_is_told() -> None:
    """Assert the sentence on chi squared where nothing fits."""
    omegas, amplitudes = swept(0.0, 0)
    wrong = [a * (1.1 if k % 2 else 0.9) for k, a in enumerate(amplitudes)]
    data = per.Measured(RESPONSE, omegas[:9], {AMPLITUDE: wrong[:9]}, sigma={AMPLITUDE: 0.01})
    found = per.fit(sym.scene("duffing"), data, {"k3": (0.2, 3.0)}, start={"k3": 0.9})
    assert any(remark.startswith("chi squared is") for remark in found.remarks)
