"""Functions of the film: deflection from xi, the way of Newton's increments, and the steady thickness."""

import math
from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest
from support.models import RPM, Array, Disc, scene

from symbolic.kernels import kernel
from symbolic.parts.films import softplus as film

XI, STEP = ca.SX.sym("xi"), ca.SX.sym("step")
GRID = np.unique(
    np.concatenate([-np.logspace(-3, 4, 200), [0.0, -30.0, 40.0, -27.0], np.logspace(-3, 4, 200)])
)
"""xi from -1e4 to 1e4, the places where the functions are put together among them."""

RISES = np.logspace(-6, 4, 41)
"""Increments of xi."""


def softplus(xi: float) -> float:
    """ln(1 + e^xi) in the form that is accurate on each side."""
    return math.log1p(math.exp(xi)) if xi < 0 else xi + math.log1p(math.exp(-xi))


def log_softplus(xi: float) -> float:
    """ln ln(1 + e^xi); with u = e^xi small, ln ln(1 + u) = ln u + ln(1 - u/2 + u^2/3 - ...)."""
    if xi > -20:
        return math.log(softplus(xi))
    u = math.exp(xi)
    return xi + math.log1p(-u / 2 + u * u / 3)


def expit(xi: float) -> float:
    """ds/dxi = 1/(1 + e^-xi)."""
    return 1 / (1 + math.exp(-xi)) if xi > 0 else math.exp(xi) / (1 + math.exp(xi))


def evaluate(expression: ca.SX, xi: Array, step: Array | float = 0.0) -> Array:
    """The expression at points, by the kernel that solves use."""
    run = kernel.build([kernel.points(XI, "xi"), kernel.points(STEP, "step")], [expression])
    out = np.zeros((len(xi), 1))
    with np.errstate(all="ignore"):
        run(xi, np.broadcast_to(step, xi.shape), out)
    return out[:, 0]


def moved(xi: Array, step: Array | float) -> Array:
    """Where increments take xi."""
    return evaluate(film.move_xi(XI, STEP), xi, step)


def each(function: Callable[[float], float], xi: Array) -> Array:
    """A scalar function at points."""
    return np.array([function(float(v)) for v in xi])


def pairs(xi: Array, steps: Array) -> tuple[Array, Array]:
    """All pairs of a place and an increment."""
    a, b = np.meshgrid(xi, steps)
    return a.ravel(), b.ravel()


def test_softplus_is_accurate_everywhere() -> None:
    """Assert that s(xi) = ln(1 + e^xi) to 1e-15 relative, from complete loss to deep contact."""
    np.testing.assert_allclose(evaluate(film.softplus(XI), GRID), each(softplus, GRID), rtol=1e-15)


def test_log_softplus_is_accurate_everywhere() -> None:
    """Assert that ln s(xi) is right to 5e-14, also where s itself underflows."""
    found = evaluate(film.log_softplus(XI), GRID)
    np.testing.assert_allclose(found, each(log_softplus, GRID), rtol=1e-15, atol=5e-14)


def test_derivative_of_softplus() -> None:
    """Assert that ds/dxi = 1/(1 + e^-xi) to 1e-14 relative, at the joints too."""
    found = evaluate(ca.jacobian(film.softplus(XI), XI), GRID)
    np.testing.assert_allclose(found, each(expit, GRID), rtol=1e-14, atol=1e-300)


def test_derivative_of_log_softplus() -> None:
    """Assert that d ln s/dxi = (ds/dxi)/s, which tends to 1 out of contact, at the joints too."""
    expected = [1.0 if xi < -40 else expit(xi) / softplus(xi) for xi in GRID]
    found = evaluate(ca.jacobian(film.log_softplus(XI), XI), GRID)
    np.testing.assert_allclose(found, expected, rtol=1e-13)


@pytest.mark.parametrize("function", [film.softplus, film.log_softplus], ids=["softplus", "log_softplus"])
def test_second_derivatives_are_finite(function: Callable[[ca.SX], ca.SX]) -> None:
    """Assert that the curvature is finite wherever xi is."""
    assert np.isfinite(evaluate(ca.hessian(function(XI), XI)[0], GRID)).all()


def test_functions_increase() -> None:
    """Assert that both functions of xi increase across their joints."""
    near = np.concatenate([c + np.linspace(-1e-6, 1e-6, 21) for c in (-30.0, 40.0)])
    fine = np.unique(np.concatenate([near, np.linspace(-60, 60, 241)]))
    for function in (film.softplus, film.log_softplus):
        assert (np.diff(evaluate(function(XI), fine)) > 0).all()


def test_rest_is_the_steady_deflection() -> None:
    """Assert that s = 1 and ln s = 0 at REST_XI."""
    rest = np.array([film.REST_XI])
    assert evaluate(film.softplus(XI), rest)[0] == pytest.approx(1, abs=1e-15)
    assert evaluate(film.log_softplus(XI), rest)[0] == pytest.approx(0, abs=1e-15)


def test_no_increment_leaves_xi() -> None:
    """Assert that an increment of zero moves nothing, to the accuracy of xi."""
    np.testing.assert_allclose(moved(GRID, 0.0), GRID, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("ratio", [0.11, 0.5, 0.999, 1.001, 2.0, 30.0, 1e6])
def test_move_inverts_moves_that_are_linear_in_the_deflection(ratio: float) -> None:
    """Assert that the tangent's increment towards s1 = ratio * s arrives at s1 exactly."""
    xi = GRID[(GRID > film.EMPTY) & (GRID < 1e3)]
    s = each(softplus, xi)
    arrived = moved(xi, (ratio - 1) * s / each(expit, xi))
    np.testing.assert_allclose(each(log_softplus, arrived), np.log(ratio * s), rtol=1e-13, atol=1e-13)


def test_rise_never_overshoots_newtons_increment() -> None:
    """Assert that a positive increment takes xi up, and by no more than itself."""
    xi, step = pairs(GRID, RISES)
    new = moved(xi, step)
    room = 1e-12 * (1 + np.abs(xi))
    assert (new >= xi - room).all()
    assert (new <= xi + step + room).all()


def test_fall_keeps_a_tenth_of_the_deflection_or_stops_after_ten() -> None:
    """Assert that a fall in contact goes to s/10 at most, or by 10 in xi at most: its documented limits."""
    xi, step = pairs(GRID[film.EMPTY < GRID], -RISES)
    new = moved(xi, step)
    kept = each(log_softplus, new) - each(log_softplus, xi) >= math.log(film.LEAST_LEFT) - 1e-12
    assert (kept | (new >= xi - 10 - 1e-12 * np.abs(xi))).all()
    assert (new <= xi + 1e-12 * (1 + np.abs(xi))).all()


def test_fall_that_would_empty_the_contact_is_taken_in_xi() -> None:
    """Assert that where the tangent leaves less than a tenth xi falls as told, within ln 10 and 10."""
    xi, step = pairs(GRID[film.EMPTY < GRID], -RISES)
    empties = step * each(expit, xi) / each(softplus, xi) < (film.LEAST_LEFT - 1) * (1 + 1e-9)
    assert empties.any() and (~empties).any()
    expected = xi - np.clip(-step, -math.log(film.LEAST_LEFT), 10)
    np.testing.assert_allclose(moved(xi, step)[empties], expected[empties], rtol=1e-14, atol=1e-14)


def test_empty_contact_moves_freely() -> None:
    """Assert that below EMPTY a fall is taken as it is, and a rise as far as EMPTY or the tangent in s."""
    xi, step = pairs(GRID[film.EMPTY > GRID], np.concatenate([-RISES, RISES]))
    new, wanted = moved(xi, step), xi + step
    down = step < 0
    np.testing.assert_allclose(new[down], wanted[down], rtol=1e-14)
    tangent = xi[~down] + np.log1p(step[~down])  # s and ds/dxi are both e^xi there
    expected = np.maximum(np.minimum(wanted[~down], film.EMPTY), tangent)
    assert (tangent > film.EMPTY).any()
    np.testing.assert_allclose(new[~down], expected, rtol=1e-9)


@pytest.mark.parametrize("step", [1e300, -1e300, 1e-300, -1e-300])
def test_absurd_increment_gives_a_number(step: float) -> None:
    """Assert that no finite xi is moved to NaN, nor downwards to infinity out of contact."""
    inside = moved(GRID[film.EMPTY < GRID], step)
    assert np.isfinite(inside).all()
    assert not np.isnan(moved(GRID, step)).any()


def test_system_moves_its_unknown_as_move_xi() -> None:
    """Assert that a lubricated scene takes Newton's increments along move_xi, an array of any length."""
    xi, step = pairs(np.array([-60.0, -20.0, 0.5, 20.0]), np.array([-30.0, -1.0, 0.0, 1.0, 30.0]))
    for name in ("squeeze", "quasistatic"):
        np.testing.assert_array_equal(scene(name).move(xi[:, None], step[:, None])[:, 0], moved(xi, step))


def thickness(**values: float) -> float:
    """h0 of the squeeze film at 360 rev/min, 810 N, Vitrea 79, with some parameters changed."""
    system = scene("squeeze")
    names = [v.name for v in system.parameters]
    parameter = system.nominal
    for name, value in values.items():
        parameter[names.index(name)] = value
    return float(system.rest(parameter)[0][2] * system.states[2].scale)


def test_thickness_at_the_papers_point() -> None:
    """Assert that h0 is 3.85 um at 360 rev/min, 810 N and Vitrea 79 (u = 1.92265 m/s)."""
    assert thickness() == pytest.approx(3.85e-6, rel=1e-5)


@pytest.mark.parametrize(
    ("name", "nominal", "exponent"),
    [
        ("speed", 360 * RPM, 0.625),
        ("radius", 0.051, 0.625),
        ("viscosity", 0.890, 0.625),
        ("piezoviscosity", 25.9e-9, 0.46),
        ("preload", 810.0, -1 / 22.23),
    ],
)
def test_thickness_scales_with_a_power(name: str, nominal: float, exponent: float) -> None:
    """Assert that h0 goes with the printed power of each quantity."""
    for factor in (0.1, 2.0):
        assert thickness(**{name: factor * nominal}) / thickness() == pytest.approx(
            factor**exponent, rel=1e-12
        )


@pytest.mark.parametrize("beta", [10.0, 22.23, 100.0])
def test_thickness_exponent_of_the_load_is_that_of_the_film_law(beta: float) -> None:
    """Assert that h0 goes with Q^(-1/beta) for the beta of the film, whatever it is."""
    ratio = thickness(beta=beta, preload=2100.0) / thickness(beta=beta)
    assert ratio == pytest.approx((2100 / 810) ** (-1 / beta), rel=1e-12)


def test_both_films_share_the_steady_thickness() -> None:
    """Assert that the quasi-static film at rest is as thick as the squeeze film at rest."""
    system = Disc(film="quasistatic").compile()
    state, xi = system.rest(system.nominal)
    out = system.output(np.zeros((1, 2)), state[None], xi[None], np.zeros(1), system.nominal)
    film_out = out[0, [v.name for v in system.outputs].index("film")]
    assert film_out == pytest.approx(thickness(), rel=1e-14)
