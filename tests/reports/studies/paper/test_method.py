"""The paper's own method: the Runge-Kutta steps, the start, and where and why it breaks down."""

import math
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.kept import kept
from support.traces import RPM

import periodic as per
from reports.studies.paper import method
from reports.studies.paper.common.tracing import branch
from reports.studies.paper.marching.beginnings import Beginning, beginnings, loss, unstable_first
from reports.studies.paper.marching.breakdown import (
    Band,
    Outcome,
    bands,
    fastest,
    film_rate,
    on_orbits,
    real_limit,
    rest_growth,
    step_limit,
    swing,
)
from reports.studies.paper.marching.histories import ripple, stepped, trusted
from reports.studies.paper.marching.rungekutta import growth, march
from reports.studies.paper.marching.started import Form, ramped, runs
from reports.studies.paper.page import REPORT
from reports.studies.paper.rows import rows
from symbolic.motion.linear import modes
from symbolic.scenes.building import build
from symbolic.scenes.reading import load

pytestmark = pytest.mark.studies

OIL_A, OIL_B = "vitrea79-810N", "turbo33-810N"
AT = (240.0, 245.0, 270.0, 290.0, 315.0, 320.0, 360.0)


@kept
def known() -> per.Branch:
    """Return the branch of oil A at 810 N with points at the speeds of this module."""
    return branch(OIL_A, 500.0, 230.0, at=AT)


@cache
def stepped_at(form: Form, step: float) -> Band:
    """Return what becomes of oil A at 810 N with one step."""
    (band,) = bands(form, [OIL_A], AT, step, [known()])
    return band


def oscillator(state: np.ndarray, phase: np.ndarray, parameter: np.ndarray) -> np.ndarray:
    """x'' = -x + p cos(2 tau)."""
    return np.stack([state[:, 1], -state[:, 0] + parameter[0] * np.cos(2 * phase)], axis=1)


def exact(tau: float, force: float) -> float:
    """x of the oscillator from x = 1, x' = 0."""
    return (1 + force / 3) * math.cos(tau) - force / 3 * math.cos(2 * tau)


def test_order_of_the_steps() -> None:
    """Assert that the method is of fourth order, for runs with parameters of their own."""
    force, errors = np.array([[0.5, 2.0]]), []
    start = np.array([[1.0, 0.0], [1.0, 0.0]])
    for steps in (50, 100, 200):
        size = np.full(2, 2.0 / steps)
        done = march(oscillator, start, np.zeros(2), force, size, np.array([0, steps]))
        np.testing.assert_array_equal(done.state[0], start)
        errors.append(np.abs(done.state[-1, :, 0] - [exact(2.0, f) for f in force[0]]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 4, atol=0.15)


def test_a_failed_run_leaves_the_others_alone() -> None:
    """Assert that of two runs one may blow up, is marked where it does, and the other goes on."""

    def rates(state: np.ndarray, phase: np.ndarray, parameter: np.ndarray) -> np.ndarray:
        return parameter[0][:, None] * state**2

    start, power = np.ones((2, 1)), np.array([[1.0, -1.0]])
    done = march(rates, start, np.zeros(2), power, np.full(2, 0.1), np.array([40]))
    assert done.failed[1] == -1 and 10 < done.failed[0] < 40
    assert done.state[-1, 1, 0] == pytest.approx(1 / 5, rel=1e-6) and math.isnan(done.state[-1, 0, 0])


def test_growth_of_a_mode() -> None:
    """Assert that R(z) is exp(z) to fifth order, and where its real interval of stability ends."""
    z = np.array([0.1j, -0.1 + 0.05j])
    np.testing.assert_allclose(growth(z), np.abs(np.exp(z)), rtol=2e-7)
    assert real_limit() == pytest.approx(2.785293563405)


def test_swing_of_few_samples() -> None:
    """Assert that 14 samples a period give the swing of a sine to 0.1 %."""
    samples = np.sin(2 * np.pi / 14 * np.arange(100) + 0.2)[:, None]
    assert swing(samples)[0] == pytest.approx(2, rel=1e-3)


def test_ramp_ends_at_rest_on_the_crest() -> None:
    """Assert that 20 s of the paper's ramp lead to where the runs start from, but for 1e-4."""
    case = runs(Form.UNKNOWN, [(OIL_A, 360.0)])
    _, _, path = ramped(OIL_A, 360.0)
    np.testing.assert_allclose(path.state[-1], case.state[0], atol=1e-4)
    assert case.state[0, 0] * case.system.states[0].scale == pytest.approx(1.27e-6, rel=1e-6)
    assert math.tan(case.phase[0]) == pytest.approx(4 * math.pi * 360)


def test_forms_agree_from_the_start() -> None:
    """Assert that the stepped third-order form follows CVODES on the three states for 20 ms."""
    ours = trusted(OIL_A, 0.02)
    paper = stepped(OIL_A, 0.02, step=1e-5)
    common = np.interp(paper.time, ours.time, ours.x)
    assert np.abs(common - paper.x).max() < 0.01 * ripple(ours.x)
    assert ripple(paper.x) == pytest.approx(ripple(ours.x), rel=1e-3)


def test_band_of_the_paper_step() -> None:
    """Assert where oil A at 810 N breaks down with 0.1 ms, why and how soon; beside it the branch is met."""
    band = stepped_at(Form.THIRD_ORDER, 1e-4)
    assert [o is Outcome.UNLOADED for o in band.outcome] == [rpm in AT[1:5] for rpm in AT]
    assert {band.outcome[0], band.outcome[5], band.outcome[6]} == {Outcome.SETTLED}
    assert np.nanmax(band.time) < 0.011
    assert band.swing[6] * 1e6 == pytest.approx(3.865414, rel=3e-3)


@pytest.mark.long
def test_band_does_not_close_with_the_step() -> None:
    """Assert that a fifth of the step fails at the same speeds but the lowest."""
    band = stepped_at(Form.THIRD_ORDER, 2e-5)
    assert band.failed.tolist() == [270.0, 290.0, 315.0]
    assert band.swing[6] * 1e6 == pytest.approx(3.865414, rel=1e-5)


@pytest.mark.long
def test_failures_begin_with_loss_of_contact() -> None:
    """Assert that with 0.02 ms all failures follow the exact motion's loss of contact, the steps stable."""
    band = stepped_at(Form.THIRD_ORDER, 2e-5)
    assert beginnings(band) == [Beginning.CONTACT] * 3
    for rpm, time in zip(band.speeds[2:5], band.time[2:5], strict=True):
        assert 3e-3 < loss(OIL_A, rpm, time) < time + band.step


@pytest.mark.long
def test_failures_of_another_kind() -> None:
    """Assert that unstable steps, and failures before the contact is lost, are told from loss of contact."""
    band = stepped_at(Form.THIRD_ORDER, 1e-4)
    stable = replace(band, time=np.where(np.isfinite(band.time), 1e-3, np.nan))
    assert set(beginnings(stable)) == {Beginning.EARLY}
    (thin,) = bands(Form.THREE_STATE, [OIL_B], [360.0], 1e-4, [branch(OIL_B, at=(360.0,))])
    number = np.rint(thin.time / thin.step).astype(int)
    assert thin.outcome == (Outcome.UNSTABLE,) and unstable_first(thin, thin.speeds, number) == [True]
    assert unstable_first(band, band.speeds[1:5], np.rint(band.time[1:5] / 1e-4).astype(int)) == [False] * 4


def test_three_states_fail_alike() -> None:
    """Assert that the three-state form fails at the same speeds, by a deflection below zero."""
    band = stepped_at(Form.THREE_STATE, 1e-4)
    assert band.failed.tolist() == list(AT[1:5])
    assert {o for o in band.outcome if o.failure} == {Outcome.DEFLECTION}


def test_method_leaves_orbits_that_lose_contact() -> None:
    """Assert that, started on the orbits, it stays on those with contact and leaves those without."""
    points = [p for p in known().labelled(per.Label.USER) if p.stable and p.parameter / RPM > 260]
    found = {round(p.parameter / RPM): o for p, o in zip(points, on_orbits(OIL_A, points, 1e-4), strict=True)}
    assert found.pop(270) is Outcome.DEFLECTION
    assert found == dict.fromkeys((290, 315, 320, 360), Outcome.SETTLED)


@pytest.mark.parametrize("rpm", [270.0, pytest.param(290.0, marks=pytest.mark.long)])
def test_error_control_goes_through(rpm: float) -> None:
    """Assert that CVODES settles to the branch from the same start, inside the band."""
    (point,) = [p for p in known().labelled(per.Label.USER) if abs(p.parameter / RPM - rpm) < 1e-6]
    assert method.settles(OIL_A, rpm) == pytest.approx(point.peak_to_peak("x"), rel=1e-4)


def test_thin_oil_is_unstable_from_the_start() -> None:
    """Assert that 0.1 ms is too long for oil B at 360 rev/min: lambda dt, growth, limit and the end."""
    assert fastest(OIL_B, 360.0) * 1e-4 == pytest.approx(3.407, abs=5e-3)
    assert rest_growth(OIL_B, 360.0, 1e-4) == pytest.approx(2.42, abs=0.01)
    assert step_limit(OIL_B, 360.0) == pytest.approx(8.174e-5, rel=1e-3)
    assert rest_growth(OIL_B, 210.0, 1e-4) < 1 < rest_growth(OIL_B, 215.0, 1e-4)
    assert stepped(OIL_B, 0.01).time[-1] < 2e-3
    assert stepped(OIL_B, 0.01, step=5e-5).time[-1] == pytest.approx(0.01)


def test_film_that_would_be_stable() -> None:
    """Assert that an oil whose film has the thickness named would have been at the limit of 0.1 ms."""
    film, wanted = method.rest_film(OIL_B), method.stable_film(OIL_B)
    assert (film, wanted) == (pytest.approx(0.46025e-6, rel=1e-4), pytest.approx(0.5635e-6, rel=1e-3))
    viscosity = 0.034 * (wanted / film) ** (1 / 0.625)
    thicker = build(load(OIL_B, [("viscosity", str(viscosity))]))
    rate = np.abs(modes(thicker, {"speed": 360 * RPM}).eigenvalues).max()
    assert rate * 1e-4 == pytest.approx(real_limit(), rel=0.01)


def test_film_rate_is_the_fast_eigenvalue() -> None:
    """Assert that the film's rate at fixed x is the fast eigenvalue at rest of the thin oil."""
    deflection = (810 / 28e9) ** (2 / 3)
    rate = film_rate(OIL_B, method.rest_film(OIL_B), deflection, 360.0)
    assert float(rate) == pytest.approx(fastest(OIL_B, 360.0), rel=1e-2)


@pytest.mark.long
def test_section() -> None:
    """Assert the key numbers of the whole section, and that its text names each of its figures once."""
    found = method.compute(lambda what: None)
    n = found.numbers
    assert (n["oil_a_low_rpm"], n["oil_a_high_rpm"]) == (245, 315)
    assert (n["heavy_low_rpm"], n["heavy_high_rpm"]) == (305, 345)
    assert (n["oil_a_fine_low_rpm"], n["oil_a_fine_high_rpm"]) == (250, 315)
    assert (n["oil_b_unstable_rpm"], n["oil_b_heavy_unstable_rpm"]) == (215, 190)
    assert n["survivors_off_percent"] < 0.5 and n["trusted_off"] < 1e-4
    others = n["failures_step_unstable"] + n["failures_early"]
    assert n["failures"] == n["failures_contact_lost"] + others and others < 0.1 * n["failures"]
    text = REPORT.told("method", found.kept())
    assert sorted(re.findall(r"\]\(figures/([\w-]+)\.png\)", text)) == sorted(found.figures)
    assert [row.key for row in rows("method", n)] == ["P13"]
