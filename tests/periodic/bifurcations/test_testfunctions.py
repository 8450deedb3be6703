"""Test functions of special points, of multipliers and slopes that are given: values computed by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from periodic.bifurcations import branchpoint, doubling, fold, stationary, testfunction, torus
from periodic.bifurcations.codimension2 import codim2
from periodic.bifurcations.label import Label
from periodic.correction.error import ErrorEstimate
from periodic.stability.multipliers import ERRORS_FROM_ONE, ROUNDED_ONE

SQUARE = 0.6 + 0.8j
"""On the unit circle."""


def having(*multipliers: complex, error: float = 0.0, trivial: int = 0, known: bool = True) -> Any:
    """A solution with these multipliers."""
    found = np.array(multipliers, dtype=complex)
    spectrum = SimpleNamespace(nontrivial=found, multipliers=found, known=known)
    return SimpleNamespace(
        spectrum=spectrum,
        error=SimpleNamespace(multiplier=error),
        problem=SimpleNamespace(trivial=trivial, scale=1.0),
        tangent=SimpleNamespace(parameter=1.0),
    )


def going(slope: float, value: float = 0.0, scale: float = 2.0, error: float = 0.0) -> Any:
    """A solution with a slope of the parameter in a range of that length, and its parameter's error."""
    return SimpleNamespace(
        tangent=SimpleNamespace(parameter=slope),
        problem=SimpleNamespace(scale=scale),
        value=value,
        error=ErrorEstimate(0.0, 0.0, error),
    )


@pytest.mark.parametrize(
    ("at", "multipliers", "value"),
    [
        (-1, (0.5,), 1.0),  # (1 + 0.5) / 1.5
        (-1, (-0.5,), 1 / 3),
        (-1, (-3.0,), -0.5),
        (-1, (-3.0, -0.5), -1 / 6),
        (-1, (SQUARE, SQUARE.conjugate()), 0.8),  # |1.6 + 0.8i|^2 / 4
        (1, (0.5,), 1 / 3),
        (1, (3.0, 3.0), 0.25),
        (1, (), 1.0),
    ],
)
def test_product_of_distances(at: int, multipliers: tuple[complex, ...], value: float) -> None:
    """Assert prod (1 - at mu) / (1 + |mu|)."""
    assert doubling.product_test(np.array(multipliers, dtype=complex), at) == pytest.approx(value, rel=1e-14)


def test_nearest_is_the_product_of_the_two_smallest_factors_with_the_sign_of_all() -> None:
    """Assert it for the factors 1/3, 1/9 and -1/2 at 1, whose smallest are the first two."""
    assert doubling.nearest(np.array([0.5, 0.8, 3.0], dtype=complex), 1) == pytest.approx(-1 / 27, rel=1e-14)


@pytest.mark.parametrize(("test", "value"), [(doubling.doubling, 1.5 / 1.5), (branchpoint.branching, 1 / 3)])
def test_tests_of_multipliers_that_are_lost_are_0(test: Any, value: float) -> None:
    """Assert the value for mu = 0.5, and 0 where rounding has eaten it."""
    assert test(having(0.5)) == pytest.approx(value, rel=1e-14)
    assert test(having(0.5, known=False)) == 0.0


@pytest.mark.parametrize(
    ("base", "new", "twice"),
    [
        ((-0.5, -0.2), (0.5, 0.3), True),
        ((0.5, 0.3), (-0.5, -0.2), True),
        ((-0.5, 0.2), (-0.5, 0.2), False),
        ((-0.5, -5e-4), (-0.5, 0.2), False),  # too near 0 to reach -1
        ((-0.5, -2e-3), (-0.5, 0.2), True),
    ],
)
def test_two_negative_multipliers_may_pass(
    base: tuple[float, ...], new: tuple[float, ...], twice: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that two doublings are expected of two negative multipliers at one end, if no pair turns."""
    monkeypatch.setattr(doubling, "pair_crossings", lambda *_: [])
    assert doubling.doubles_twice(having(*base), having(*new)) is twice


@pytest.mark.parametrize("confined", [True, False])
def test_doublings_are_looked_for_of_real_multipliers_whatever_pairs_do(
    confined: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a step is without doublings where pairs are confined and no two are real and negative."""
    monkeypatch.setattr(doubling, "confined", lambda *_: confined)
    assert doubling.kept_from_doubling(having(0.5, -0.3), having(0.5, 0.3)) is confined
    assert not doubling.kept_from_doubling(having(-0.5, -0.3), having(0.5, 0.3))
    assert not doubling.kept_from_doubling(having(0.5, 0.3), having(-0.5, -0.3))


def test_value_at_the_dip_of_a_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert ((1 - r) / (1 + r))^2 for a pair of modulus r = 0.6 that turns past: (0.4 / 1.6)^2."""
    monkeypatch.setattr(doubling, "pair_crossings", lambda *_: [(0.25, 0.6)])
    assert doubling.dips(having(), having(), 1) == [(0.25, pytest.approx(0.0625, rel=1e-14))]


@pytest.mark.parametrize(
    ("limit", "error", "trusted"), [(np.inf, np.inf, True), (1e-3, 9e-4, True), (1e-3, 1e-3, False)]
)
def test_multipliers_are_trusted_below_the_methods_limit(limit: float, error: float, trusted: bool) -> None:
    """Assert that the error lies below the limit, where there is one."""
    solution = having(0.5, error=error)
    solution.discretisation = SimpleNamespace(trusted=limit)
    assert doubling.trusted(solution) is trusted
    assert doubling.known(solution) is trusted
    solution.spectrum.known = False
    assert doubling.known(solution) is False


@pytest.mark.parametrize(
    ("multipliers", "value"),
    [
        ((2.0, 3.0), -5 / 7),
        ((0.5, 0.5), 0.75 / 1.25),
        ((0.5, 0.5, 4.0), (0.75 / 1.25) * (-1 / 3) ** 2),
        ((2 * SQUARE, 2 * SQUARE.conjugate()), -3 / 5),
    ],
)
def test_torus_test(multipliers: tuple[complex, ...], value: float) -> None:
    """Assert prod over pairs of (1 - mu_i mu_j) / (1 + |mu_i mu_j|)."""
    assert torus.torus_of(np.array(multipliers, dtype=complex), 0.0) == pytest.approx(value, rel=1e-13)


def test_torus_test_is_0_within_the_noise_of_a_product() -> None:
    """Assert that a product 1.01 is told from 1 with a noise of 0.009, not with one of 0.011."""
    found = np.array([1.01, 1.0], dtype=complex)
    assert torus.torus_of(found, 0.011) == 0.0
    assert torus.torus_of(found, 0.009) == pytest.approx(-0.01 / 2.01, rel=1e-12)


def test_noise_of_multipliers() -> None:
    """Assert the multipliers' error by its factor, and the rounding of 1."""
    assert torus.noise(having(error=2e-5)) == pytest.approx(ERRORS_FROM_ONE * 2e-5 + ROUNDED_ONE, rel=1e-14)


def test_products_of_huge_multipliers_are_bounded() -> None:
    """Assert that 1e200 * 1e200 does not overflow, and that the phase of the product stays."""
    (found,) = torus._products(np.array([1e200j, 1e200j]))
    assert np.isfinite(abs(found)) and abs(found) > 1e100
    assert found / abs(found) == pytest.approx(-1.0, abs=1e-12)
    (small,) = torus._products(np.array([1e200, 1e-150 + 0j]))
    assert small == pytest.approx(1e50, rel=1e-9)


def test_pair_whose_product_is_nearest_1() -> None:
    """Assert the indices of 4 and 0.26, a neutral saddle, and of a complex pair."""
    assert torus.nearest_pair(np.array([0.5, 4.0, 0.26], dtype=complex)) == [1, 2]
    assert not torus.complex_pair(np.array([0.5, 4.0, 0.26], dtype=complex))
    assert torus.complex_pair(np.array([0.5, SQUARE, SQUARE.conjugate()]))


def test_growth_of_the_pair_nearest_the_circle() -> None:
    """Assert log 1.25 of moduli 1.25 and 0.5, with the sign of the test; the test without a complex pair."""
    pairs = [mu for size in (1.25, 0.5) for mu in (size * SQUARE, size * SQUARE.conjugate())]
    solution = having(*pairs)
    sign = np.sign(torus.torus(solution))
    assert torus._pair_nearest_the_circle(solution) == pytest.approx(sign * np.log(1.25), rel=1e-13)
    assert torus._pair_nearest_the_circle(having(2.0, 3.0)) == pytest.approx(-5 / 7, rel=1e-13)


@pytest.mark.parametrize(
    ("eigenvalues", "value"),
    [
        ((-1.0, -3.0), -1.0),
        ((-1.0, 3.0), 0.5),
        ((1 + 2j, 1 - 2j), 1 / np.sqrt(5)),
        ((-1 + 2j, -1 - 2j, -1.0), -(1 / np.sqrt(5)) * (4 + 4) / (1 + np.sqrt(5)) ** 2),
        ((2j, -2j), 0.0),
    ],
)
def test_balance_of_eigenvalues(eigenvalues: tuple[complex, ...], value: float) -> None:
    """Assert prod over pairs of (lambda_i + lambda_j) / (|lambda_i| + |lambda_j|)."""
    assert stationary.balance(np.array(eigenvalues, dtype=complex)) == pytest.approx(value, rel=1e-13)


def test_product_of_eigenvalues_over_the_largest() -> None:
    """Assert (-1/4)(2/4)(-4/4)."""
    assert stationary.product(having(-1.0, 2.0, -4.0)) == pytest.approx(0.125, rel=1e-14)


def test_hopf_is_genuine_where_the_pair_nearest_the_axis_is_complex() -> None:
    """Assert it of 0.01 +- i beside real ones, and not where real ones have the smaller sum."""
    assert stationary._complex(having(0.01 + 1j, 0.01 - 1j, -3.0, 2.0))
    assert not stationary._complex(having(0.5 + 1j, 0.5 - 1j, -3.0, 2.99))


@pytest.mark.parametrize(
    ("before", "after", "twice"),
    [
        (-0.05 + 1j, -0.05 + 1j, True),  # damping ratio 0.05
        (-0.2 + 1j, -0.2 + 1j, False),
        (-0.2 + 1j, -0.2 + 1.3j, True),  # moved by more than its distance
        (-0.2 + 1j, -0.2 + 1.15j, False),
    ],
)
def test_pairs_that_may_cross_the_axis_and_come_back(before: complex, after: complex, twice: bool) -> None:
    """Assert it of lightly damped ones, and of those that move by more than their distance from the axis."""
    ends = [having(found, np.conj(found)) for found in (before, after)]
    assert stationary._crosses_twice(ends[0], ends[1]) is twice
    assert stationary._crosses_twice(ends[0], having(-1.0)) is False


@pytest.mark.parametrize(
    ("after", "twice"), [(-0.79, False), (-0.7, False), (-0.6, True), (-1.4, False), (-1.6, True)]
)
def test_real_eigenvalue_that_may_touch_0(after: float, twice: bool) -> None:
    """Assert it of one at -1 that moves by more than half the smaller distance from 0."""
    assert stationary._touches_twice(having(-1.0), having(after)) is twice


def test_slope_of_rounding_is_0() -> None:
    """Assert that a slope below 1e-10 of the range is none."""
    assert fold.slope(going(1.9e-10)) == 0.0
    assert fold.slope(going(-2.1e-10)) == -2.1e-10


def test_change_of_the_parameter_less_its_error() -> None:
    """Assert it on a steep branch, less rounding, and on a vertical one, less three times the error."""
    assert fold.moves(going(1.0, 1.0), going(1.0, 1.5)) == pytest.approx(0.5, rel=1e-9)
    assert fold.moves(going(1.0, 1.0), going(1.0, 1.0)) == 0.0
    vertical = going(1e-6, 1.0, error=0.01), going(1e-6, 1.5, error=0.02)
    assert fold.moves(*vertical) == pytest.approx(0.5 - 3 * 0.02 * 1.5, rel=1e-12)


@pytest.mark.parametrize(
    ("slopes", "ds", "error", "found"),
    [
        ((1e-5, -1e-5), 0.1, 1e-8, True),  # rises by (2e-5 / 0.1) 0.1^2 / 8 = 2.5e-7 > 6e-8
        ((1e-5, -1e-5), 0.1, 1e-7, False),
        ((1e-5, -1e-5), 0.001, 1e-9, True),  # over 0.005: 6.25e-8 > 6e-9
        ((1e-5, -1e-5), 0.001, 2e-8, False),
        ((1e-5, 0.9e-5), 0.1, 1e-8, False),  # 1.25e-8
    ],
)
def test_fold_rises_above_the_error(
    slopes: tuple[float, float], ds: float, error: float, found: bool
) -> None:
    """Assert that a change of sign of the slope is a fold where the arc rises by more than the error."""
    base, new = (going(slope, 2.0, error=error) for slope in slopes)
    assert fold.has_fold(base, new, ds) is found


def test_two_folds_by_the_mean_slope(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert them where the parabola with slopes 1 at the ends and a mean slope m is below 1/2 in the middle.

    It is 1.5 m - 0.5 there: 0.5 for m = 2/3.
    """
    for mean, twice in ((0.6, True), (0.7, False), (1.0, False)):
        way = SimpleNamespace(parameter=mean * 0.1)
        monkeypatch.setattr(fold, "difference", lambda *_, way=way: way)
        monkeypatch.setattr(fold, "size_of", lambda _: 1.0)
        for sign in (1, -1):
            way.parameter = sign * mean * 0.1
            tangent = SimpleNamespace(parameter=sign * 1.0, dot=lambda *_: 0.1)
            problem = SimpleNamespace(units=lambda _: 1.0)
            end: Any = SimpleNamespace(problem=problem, orbit=None, tangent=tangent)
            assert fold.has_two_folds(end, end) is twice


@pytest.mark.parametrize(("fold_at", "touches"), [(0.999, True), (0.98, False)])
def test_conservative_fold_is_touched(fold_at: float, touches: bool) -> None:
    """Assert that prod (1 - mu) falls to a hundredth where a multiplier comes to 1 among conservative ones.

    It is 1/3 at the ends, 5.0e-4 and 1.0e-2 at the fold, the bound being 3.3e-3.
    """
    ends = having(0.5, trivial=2), having(0.5, trivial=2)
    assert branchpoint.touches(having(fold_at, trivial=2), *ends) is touches


@pytest.mark.parametrize(
    ("base", "new", "touches"),
    [
        ((0.5,), (0.6,), True),
        ((0.5,), (1.5,), False),
        ((0.5, 1 + 1e-4), (0.6, 1.1), False),
        ((1.5,), (1.6,), True),
    ],
)
def test_fold_is_touched(base: tuple[float, ...], new: tuple[float, ...], touches: bool) -> None:
    """Assert that nothing passes 1, and that no multiplier is within its error of 1 at an end."""
    assert branchpoint.touches(having(1.0), having(*base, error=1e-3), having(*new, error=1e-3)) is touches


def test_sums_of_products_but_one() -> None:
    """Assert d_1 d_2 + d_1 d_3 + d_2 d_3 with d = (mu - 1) / (1 + |mu|) for mu = 0.5, 3 and -1."""
    d = (-1 / 3, 0.5, -1.0)
    value = d[0] * d[1] + d[0] * d[2] + d[1] * d[2]
    assert codim2.second_at(having(0.5, 3.0, -1.0), 1.0) == pytest.approx(value, rel=1e-13)
    factors, raw = codim2._second(having(0.5, 3.0, -1.0), 1.0)
    assert factors == pytest.approx(d, rel=1e-14) and raw == pytest.approx(value, rel=1e-13)


def test_sum_of_products_within_its_error_is_0() -> None:
    """Assert it for d = 0 and d = -1/199 beside -1/3: the products of all but two are 1/3, 0 and 1/199."""
    solution = having(1.0, 0.99, 0.5)
    value = -1 / 199 * -1 / 3
    bound = value / (1 / 3 + 1 / 199)
    solution.error.multiplier = 0.9 * bound / ERRORS_FROM_ONE
    assert codim2.second_at(solution, 1.0) == pytest.approx(value, rel=1e-12)
    solution.error.multiplier = 1.1 * bound / ERRORS_FROM_ONE
    assert codim2.second_at(solution, 1.0) == 0.0


def test_tests_on_curves_leave_out_what_is_held() -> None:
    """Assert the cosine of a pair on the circle, and the tests of the multipliers beside those held."""
    pair = having(SQUARE, SQUARE.conjugate(), 0.5)
    assert codim2._cosine(pair) == pytest.approx(0.6, rel=1e-14)
    assert codim2._product_beside(pair, 1) == pytest.approx(1 / 3, rel=1e-13)
    assert codim2._product_beside(pair, -1) == pytest.approx(1.0, rel=1e-13)
    held = having(-1.0, 0.5, 4.0)
    assert sorted(codim2._beside(held).real) == [0.5, 4.0]
    assert codim2._torus_beside(held) == pytest.approx(-1 / 3, rel=1e-13)
    assert codim2._sharp_beside(held) == pytest.approx(-1 / 3, rel=1e-13)
    assert not codim2._complex_beside(held)
    assert {test.label: test.value(pair) for test in codim2.TORI} == pytest.approx(
        {"R1": -0.4, "R2": 1.6, "R3": 1.1, "R4": 0.6, "LPNS": 1 / 3, "PDNS": 1.0}, rel=1e-13
    )


def test_margins_by_kind_and_name() -> None:
    """Assert that a margin is the local function's where there is one, by label and user's name."""
    solution: Any = SimpleNamespace(once=lambda function: function(None))
    tests = [
        testfunction.TestFunction(label=Label.TORUS, value=lambda _: 1.0, local=lambda _: 2.0),
        testfunction.TestFunction(
            label=Label.USER, value=lambda _: 3.0, sharp=lambda _: 4.0, name="lift-off"
        ),
    ]
    assert testfunction.margins(solution, tests) == {"NS ": 2.0, "UZ lift-off": 3.0}
    assert tests[0].placed(solution) == 1.0 and tests[1].placed(solution) == 4.0


@pytest.mark.parametrize(
    ("before", "begin", "end", "returns"),
    [
        (5.2, 1.0, 1.0, True),
        (4.8, 1.0, 1.0, False),
        (-5.2, -1.0, -1.0, True),
        (0.0, 1.0, 1.0, False),
        (1.0, 1.0, 1.0, False),
        (5.2, 1.0, -1.0, False),
        (3.1, 1.0, 0.5, False),
        (np.nan, 1.0, 1.0, False),
    ],
)
def test_parabola_that_comes_near_0(before: float, begin: float, end: float, returns: bool) -> None:
    """Assert it of the parabola through b at -1 and 1 at 0 and 1: it falls to 1 - (b - 1) / 8.

    That is half the end values for b = 5. The sign of the values does not matter where they have one.
    """
    ends: list[Any] = [SimpleNamespace(once=lambda _, value=value: value) for value in (begin, end)]
    test = testfunction.TestFunction(label=Label.TORUS, value=lambda _: 0.0)
    course = testfunction.Course(1.0, {"NS ": before})
    assert course.returns(test, ends[0], ends[1], 1.0) is returns
    assert not testfunction.Course().returns(test, ends[0], ends[1], 1.0)


def test_parabola_over_steps_of_two_lengths() -> None:
    """Assert the same parabola, 2 (t - 0.5)^2 + c, by its values at -2, 0 and 1: it falls to c."""
    test = testfunction.TestFunction(label=Label.TORUS, value=lambda _: 0.0)
    for c, returns in ((0.45, True), (0.55, False)):
        ends: list[Any] = [SimpleNamespace(once=lambda _, c=c: 0.5 + c)] * 2
        course = testfunction.Course(2.0, {"NS ": 12.5 + c})
        assert course.returns(test, ends[0], ends[1], 1.0) is returns


@pytest.mark.parametrize(
    ("signs", "crossed", "found"),
    [
        ((1.0, -1.0), True, True),
        ((1.0, -1.0), False, False),
        ((0.5, 0.5), True, False),
        ((-0.5, 0.0), True, False),
    ],
)
def test_crossing_of_branches_at_a_fold(
    signs: tuple[float, float], crossed: bool, found: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that the determinant changes its sign, and that derivatives have a kernel of two dimensions."""
    monkeypatch.setattr(stationary, "branching", lambda solution: solution)
    monkeypatch.setattr(stationary, "is_crossed", lambda solution: crossed)
    assert stationary.crosses(0.0, *signs) is found  # type: ignore[arg-type]


@pytest.mark.parametrize("size", [1e-3, 1.0, 5.0])
def test_matrix_of_equilibria_and_their_conditions(size: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert R_u above a condition's gradient of length 1, whatever its size, and the tangent in ranges."""
    own = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    monkeypatch.setattr(stationary, "rows_at", lambda *_: SimpleNamespace(balanced=lambda scale: own / scale))
    monkeypatch.setattr(stationary, "flat", lambda orbit, row: size * np.array([3.0, 0.0, 2.0]))
    condition = SimpleNamespace(linearise=lambda system, orbit, free: None)
    problem = SimpleNamespace(system=None, free=(0,), scale=2.0, side_conditions=lambda orbit: [condition])
    tangent = SimpleNamespace(
        nodes=np.array([[3.0, 0.0]]), algebraic=np.zeros((1, 1, 0)), parameters=np.array([8.0])
    )
    solution: Any = SimpleNamespace(problem=problem, orbit=None, tangent=tangent)
    matrix, along = stationary._matrix(solution)
    assert matrix == pytest.approx(np.array([[0.5, 1.0, 1.5], [2.0, 2.5, 3.0], [0.6, 0.0, 0.8]]))
    assert along == pytest.approx([0.6, 0.0, 0.8])
