"""The report's section on linear damping: its tools against exact answers, its key numbers recomputed."""

from __future__ import annotations

import cmath
import math
import re

import numpy as np
import pytest
from support.kept import kept
from support.traces import RPM

import periodic as per
from reports.studies.paper import damping
from reports.studies.paper.branches import causes
from reports.studies.paper.common.discs import OIL_A, OIL_B
from reports.studies.paper.common.scenes import PAPER_SPEED, at_paper_speed, system
from reports.studies.paper.marching.equivalent import (
    LARGE,
    ONE,
    SMALL,
    WAVINESS,
    accelerated_ratio,
    exponent,
    film_growth,
    linear_acceleration,
    orbit_at,
    orbit_ratio,
    ratio,
    stepped_ratio,
)
from reports.studies.paper.marching.rungekutta import factor
from reports.studies.paper.marching.transients import (
    PER_PERIOD,
    Record,
    beat_crests,
    crests,
    decay,
    free_decay,
    read_off,
    record,
)
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import Verdict, rows

pytestmark = pytest.mark.studies

OILS = (OIL_A, OIL_B)
STEP = 1e-4


@kept
def small_orbit(name: str, part: float) -> per.Point:
    """The orbit at 360 rev/min and a small part of the paper's waviness."""
    begin = part * WAVINESS
    return per.trace(system(name, PAPER_SPEED), "amplitude", (begin, 1.01 * begin))[0]


def vanishing_ratio(name: str, part: float) -> float:
    """The damping ratio from the multipliers of a small orbit."""
    rest = at_paper_speed(name)
    slowest = complex(small_orbit(name, part).multipliers[0])
    return ratio(exponent(slowest, 2 * math.pi / rest.omega, float(rest.damped_frequencies[0])))


@pytest.mark.parametrize("name", OILS)
def test_multipliers_tend_to_the_jacobian(name: str) -> None:
    """Assert that orbits at a thousandth of the waviness have the Jacobian's damping ratio to 1e-4."""
    linear = float(at_paper_speed(name).damping_ratios[0])
    assert vanishing_ratio(name, 1e-3) == pytest.approx(linear, rel=1e-5)


@pytest.mark.parametrize("name", OILS)
def test_damping_grows_with_the_square_of_the_waviness(name: str) -> None:
    """Assert that the orbits' excess over the Jacobian's ratio falls to a quarter for half the waviness."""
    linear = float(at_paper_speed(name).damping_ratios[0])
    excess = [vanishing_ratio(name, part) / linear - 1 for part in (0.1, 0.05)]
    assert excess[0] > 1e-4
    assert excess[0] / excess[1] == pytest.approx(4, rel=0.02)


@pytest.mark.parametrize("value", [-20 + 3500j, -0.6 + 5000j, 40 + 100j, -1 - 7000j])
def test_exponent(value: complex) -> None:
    """Assert that lambda is found again from exp(lambda T), given a frequency not half a turn away."""
    period = 2 * math.pi / 4524
    near = abs(value.imag) + 300
    found = exponent(cmath.exp(value * period), period, near)
    assert found == pytest.approx(complex(value.real, abs(value.imag)), rel=1e-12)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_runge_kutta_growth(order: int) -> None:
    """Assert that R(z) agrees with exp(z) to the order of the method."""
    z = 0.01 + 0.02j
    error = abs(complex(factor(np.array([z]), order)[0]) - cmath.exp(z))
    assert error == pytest.approx(abs(z) ** (order + 1) / math.factorial(order + 1), rel=0.02)


@pytest.mark.parametrize("name", OILS)
def test_fourth_order_steps_damp_the_linear_motion(name: str) -> None:
    """Assert the ratio of steps of 0.1 ms against steps taken with the Jacobian of the slow pair."""
    slow = complex(at_paper_speed(name).oscillating[0])
    matrix = np.array([[slow.real, -slow.imag], [slow.imag, slow.real]])
    state = np.array([1.0, 0.0])
    for _ in range(1000):
        k1 = matrix @ state
        k2 = matrix @ (state + STEP / 2 * k1)
        k3 = matrix @ (state + STEP / 2 * k2)
        k4 = matrix @ (state + STEP * k3)
        state = state + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    rate = -math.log(float(np.linalg.norm(state))) / (1000 * STEP)
    assert stepped_ratio(name, 4, STEP) == pytest.approx(rate / abs(slow), rel=1e-3)


def test_film_is_unstable_in_the_papers_step() -> None:
    """Assert that steps of 0.1 ms resolve the film's own motion for oil A and not for oil B."""
    assert film_growth(OIL_A, 4, STEP) < 1 < film_growth(OIL_B, 4, STEP)
    z = float(at_paper_speed(OIL_B).eigenvalues[-1].real) * STEP
    assert z == pytest.approx(-3.41, abs=0.01)


@pytest.mark.parametrize("weight, order", [(0.0, 1), (0.5, 2), (1.0, 1)])
def test_linear_acceleration_converges(weight: float, order: int) -> None:
    """Assert that steps of linear acceleration tend to the exact growth factors with their order."""
    exact = at_paper_speed(OIL_A).eigenvalues

    def error(step: float) -> float:
        rates = np.log(linear_acceleration(exact, step, weight)) / step
        return max(float(np.abs(rates - value).min()) for value in exact)

    assert error(2e-6) / error(1e-6) == pytest.approx(2**order, rel=0.05)


def test_crests_and_decay() -> None:
    """Assert that a damped cosine gives back its ratio, frequency and size."""
    time = np.arange(0, 0.1, 2e-5)
    zeta, omega = 0.005, 3500.0
    damped = omega * math.sqrt(1 - zeta**2)
    free = 3e-6 * np.exp(-zeta * omega * time) * np.cos(damped * time)
    found = decay(time, free, (0.0, 0.09))
    assert found.ratio == pytest.approx(zeta, rel=1e-4)
    assert found.frequency == pytest.approx(damped, rel=1e-6)
    # A crest of exp(-zeta omega t) cos lies below the envelope by zeta^2 / 2.
    assert found.size == pytest.approx(3e-6, rel=1e-3)
    at, heights = crests(time, free)
    assert np.diff(at) == pytest.approx(2 * math.pi / damped, rel=1e-4)
    assert heights[0] == pytest.approx(3e-6 * math.exp(-zeta * omega * at[0]), rel=1e-4)


def test_decay_needs_crests() -> None:
    """Assert that a window without a motion in it is refused."""
    time = np.arange(0, 0.1, 2e-5)
    with pytest.raises(ValueError, match="it must hold at least four crests and troughs"):
        decay(time, np.cos(3500 * time), (0.0, 0.002))


def test_reading_beats() -> None:
    """Assert that beats less the true steady amplitude give the ratio, and less a higher one too much."""
    time = np.arange(0, 0.2, 1e-5)
    free = 3.0 * np.exp(-0.002 * 3500 * time) * np.cos(3500 * time)
    run = Record(time=time, x=free + 2 * np.cos(4524 * time), free=free)
    at, heights = beat_crests(run)
    assert np.diff(at).mean() == pytest.approx(2 * math.pi / 1024, rel=0.02)
    assert heights.max() < 5
    # A beat's highest crest may miss its top by half a period of the motion.
    assert read_off(run, 2.0, (0.0, 0.19), 3500.0) == pytest.approx(0.002, rel=0.05)
    assert read_off(run, 2.5, (0.0, 0.19), 3500.0) > 0.0025
    assert math.isnan(read_off(run, 9.0, (0.0, 0.19), 3500.0))


@pytest.mark.parametrize("name", OILS)
def test_record_starts_as_the_paper_does(name: str) -> None:
    """Assert the start: X = a, at rest, under no net force."""
    run = record(name, ONE, 0.1)
    assert run.x[0] == pytest.approx(WAVINESS, rel=1e-12)
    # No velocity and no acceleration: x leaves as the third power of time.
    assert abs(run.x[1] - run.x[0]) < 1e-3 * WAVINESS
    step = run.time[1]
    assert step == pytest.approx(2 * math.pi / (4524 * PER_PERIOD), rel=1e-3)


@pytest.mark.parametrize("name", OILS)
def test_small_transients_have_the_linear_damping(name: str) -> None:
    """Assert that transients at a hundredth of the waviness have the Jacobian's ratio."""
    run = record(name, SMALL)
    linear = float(at_paper_speed(name).damping_ratios[0])
    assert decay(run.time, run.free, (0.0, 0.09)).ratio == pytest.approx(linear, rel=5e-4)


@pytest.mark.parametrize("name", OILS)
def test_free_decay_tends_to_the_jacobian(name: str) -> None:
    """Assert that smooth discs let go from 0.05 um decay with the Jacobian's ratio, and faster from 15 um."""
    linear = float(at_paper_speed(name).damping_ratios[0])
    assert free_decay(name, 0.05e-6)[1] == pytest.approx(linear, rel=2e-3)
    assert free_decay(name, 15e-6)[1] > 5 * linear


@pytest.mark.parametrize("name, swing, zeta", [(OIL_A, 3.865414, 0.0073237), (OIL_B, 3.955714, 0.00017947)])
def test_orbits_of_the_paper(name: str, swing: float, zeta: float) -> None:
    """Assert x p-p in um and the multipliers' ratio at the paper's point."""
    assert orbit_at(name, ONE).peak_to_peak("x") * 1e6 == pytest.approx(swing, rel=1e-6)
    assert orbit_ratio(name, ONE) == pytest.approx(zeta, rel=1e-4)
    assert orbit_ratio(name, LARGE) > 1.2 * zeta


def test_rows() -> None:
    """Assert that P10 and P11 have one measure, the Jacobian's, and say how far the others are."""
    first, second = rows("damping", numbers())
    assert (first.key, second.key) == ("P10", "P11")
    assert first.verdict == "reproduced within 4 %"
    assert second.verdict == Verdict.NOT_REPRODUCED.value
    for row, name, paper in ((first, OIL_A, causes.PAPER_A), (second, OIL_B, causes.PAPER_B)):
        found = damping.ratios(name)
        assert row.difference == pytest.approx(float(at_paper_speed(name).damping_ratios[0]) / paper - 1)
        for value in (found["orbit"], found["transient"]):
            assert f"{value:.3g} ({100 * (value / paper - 1):+.1f} %)" in row.check
    assert "(+5.5 %)" in first.check and "factor of 11" in second.check


KEY_NUMBERS = {
    "oil_a_zeta_jacobian": (0.00676333, 1e-6),
    "oil_b_zeta_jacobian": (0.000169809, 1e-5),
    "oil_a_zeta_transient": (0.007387, 1e-3),
    "oil_b_zeta_transient": (0.0001966, 2e-3),
    "oil_a_zeta_read_mean": (0.00742, 5e-3),
    "oil_a_zeta_read_highest": (0.00972, 1e-2),
    "oil_b_zeta_read_mean": (0.000335, 1e-2),
    "oil_b_zeta_read_highest": (0.00695, 2e-2),
    "oil_b_zeta_rk4": (0.000208243, 1e-4),
    "oil_b_zeta_rk3": (0.0019555, 1e-4),
    "oil_a_zeta_rk3": (0.00852995, 1e-4),
    "oil_a_zeta_transient_rk4": (0.0073895, 1e-3),
    "oil_b_zeta_transient_rk4_80us": (0.0001848, 1e-2),
    "oil_a_resonance_rpm": (281.18146, 1e-7),
    "oil_b_resonance_rpm": (282.52893, 1e-7),
    "oil_b_film_needed_um": (1.591271, 1e-5),
    "viscosity_exponent_needed": (0.245042, 1e-5),
    "beta_needed": (6.42973, 1e-5),
    "oil_b_zeta_most_from_squeeze": (0.000823217, 1e-5),
    "beta_for_both": (8.7369, 1e-4),
    "oil_b_x_needed_um": (32.43, 1e-3),
    "oil_b_zeta_unsteady_bound": (0.00077, 1e-2),
    "oil_b_zeta_axis_bound": (0.00031, 2e-2),
    "oil_b_free_left_paper_um": (0.00755, 1e-2),
}
"""Key numbers and the relative accuracy to which they are known."""


@pytest.mark.parametrize("key", KEY_NUMBERS)
def test_key_number(key: str) -> None:
    """Assert a key number of the section."""
    value, accuracy = KEY_NUMBERS[key]
    assert numbers()[key] == pytest.approx(value, rel=accuracy)


@kept
def numbers() -> dict[str, float]:
    """The key numbers, computed once."""
    return damping.key_numbers()


def test_causes_give_what_they_should() -> None:
    """Assert that the parameters found do give the paper's ratios."""
    beta = causes.beta_needed()
    assert causes.jacobian_ratio(OIL_B, {"beta": beta}) == pytest.approx(causes.PAPER_B, rel=1e-9)
    both, _ = causes.both_oils()
    assert causes.jacobian_ratio(OIL_A, both) == pytest.approx(causes.PAPER_A, rel=1e-7)
    assert causes.jacobian_ratio(OIL_B, both) == pytest.approx(causes.PAPER_B, rel=1e-7)
    most, squeeze = causes.most_from_squeeze()
    for part in (0.9, 1.1):
        assert causes.jacobian_ratio(OIL_B, {"squeeze": part * squeeze}) < most
    assert accelerated_ratio(OIL_B, STEP, 1.0) == pytest.approx(0.0020135, rel=1e-4)


def test_oil_b_fails_in_the_papers_step() -> None:
    """Assert that a run of oil B with the paper's step fails within 5 ms, and one of 0.08 ms does not."""
    assert 1 < damping.failing_step() < 50
    assert math.isfinite(damping.measured_step(OIL_B, damping.STABLE_STEP))


def test_tension_is_where_the_linear_load_reaches_zero() -> None:
    """Assert the speeds between which the linear load would be negative, oil A."""
    begin, end = (value / RPM for value in damping.tension(OIL_A))
    assert begin == pytest.approx(256.763, abs=1e-3) and end == pytest.approx(314.241, abs=1e-3)


def test_section() -> None:
    """Assert that the text has a figure for each name, and figures are drawn with labels and units."""
    told: list[str] = []
    section = damping.compute(told.append)
    text = REPORT.told("damping", section.kept())
    assert told and set(section.figures) == {f"damping-{n}" for n in ("transients", "amplitude", "response")}
    for name, figure in section.figures.items():
        assert f"](figures/{name}.png)" in text
        for axes in figure.axes:
            assert "(" in axes.get_xlabel()
            assert len(axes.lines) > 1
    assert not re.search(r"\bnan\b", text)
    assert all(math.isfinite(value) for value in section.numbers.values())
