"""Generated NumPy kernels against CasADi's own evaluation of the same expressions."""

import ctypes
import math
from pathlib import Path
from types import SimpleNamespace

import casadi as ca
import numpy as np
import pytest
from support.kernels import COMBINED, OPERATIONS, PLANE, X, Y, arguments
from support.models import PARTS, REGIMES, Array, draw, scene

from symbolic.kernels import built, choice, kernel
from symbolic.kernels.choice import ChosenKernel

LOGICAL = {"LT", "LE", "EQ", "NE", "AND", "OR", "NOT", "IF_ELSE_ZERO"}
"""Operations in which NaN is compared: they answer yes or no."""


def by_kernel(expression: ca.SX, x: Array, y: Array) -> Array:
    """The expression at points (N,), by the generated kernel."""
    run = kernel.build([kernel.points(X, "x"), kernel.batch(Y, "y")], [expression])
    out = np.zeros((len(x), expression.shape[0]))
    with np.errstate(all="ignore"):
        run(x, y[:, None], out)
    return out[:, 0]


def by_casadi(expression: ca.SX, x: Array, y: Array) -> Array:
    """The expression at points (N,), by CasADi's virtual machine."""
    function = ca.Function("reference", [X, Y], [expression])
    return np.array([float(function(a, b)) for a, b in zip(x, y, strict=True)])


def operations(expression: ca.SX) -> set[int]:
    """CasADi's codes of the operations in an expression."""
    function = ca.Function("listed", [X, Y], [expression])
    codes = {function.instruction_id(k) for k in range(function.n_instructions())}
    return codes - {ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_CONST}


@pytest.mark.parametrize("count", [1, 200])
@pytest.mark.parametrize("name", OPERATIONS)
def test_operation_agrees_with_casadi(name: str, count: int) -> None:
    """Assert that an operation on one point or on many gives CasADi's value to 1e-15."""
    expression, (low, high) = OPERATIONS[name]
    assert operations(expression) == {getattr(ca, f"OP_{name}")}
    x, y = arguments(low, high, count)
    found, expected = by_kernel(expression, x, y), by_casadi(expression, x, y)
    np.testing.assert_allclose(found, expected, rtol=1e-15, atol=0)


def test_every_operation_of_the_tables_is_tested() -> None:
    """Assert that the table above leaves out none of the kernel's, but for CasADi's plain assignment."""
    tested = {getattr(ca, f"OP_{name}") for name in OPERATIONS}
    assert tested == set(kernel._OPERATIONS) - {ca.OP_ASSIGN}


@pytest.mark.parametrize("special", [0.0, -0.0, np.inf, -np.inf, 1e308, 5e-324])
@pytest.mark.parametrize("name", OPERATIONS)
def test_operation_agrees_with_casadi_at_the_ends_of_its_range(name: str, special: float) -> None:
    """Assert that zeros, infinities and overflow give what CasADi gives, NaN for NaN."""
    others = np.array([-2.5, -1.0, 0.0, 1.0, 2.5, np.inf, special])
    expression = OPERATIONS[name][0]
    for x, y in ((np.full(7, special), others), (others, np.full(7, special))):
        np.testing.assert_allclose(
            by_kernel(expression, x, y), by_casadi(expression, x, y), rtol=1e-15, atol=0
        )


@pytest.mark.parametrize("name", sorted(set(OPERATIONS) - LOGICAL))
def test_operation_on_nan_is_nan(name: str) -> None:
    """Assert that NaN comes out of every operation that is not a question, whichever argument it is in."""
    expression = OPERATIONS[name][0]
    nan, one = np.full(2, np.nan), np.full(2, 0.5)
    assert np.isnan(by_kernel(expression, nan, one)).all()
    if ca.which_depends(expression, Y, 1)[0] and name != "COPYSIGN":
        assert np.isnan(by_kernel(expression, one, nan)).all()


@pytest.mark.parametrize("count", [1, 200])
@pytest.mark.parametrize("name", COMBINED)
def test_combined_expression_agrees_with_casadi(name: str, count: int) -> None:
    """Assert that several operations together give CasADi's value."""
    x, y = arguments(*PLANE, count)
    x[x == 0] = 0.5
    found, expected = by_kernel(COMBINED[name], x, y), by_casadi(COMBINED[name], x, y)
    np.testing.assert_allclose(found, expected, rtol=2e-15, atol=1e-15)


@pytest.mark.parametrize("value", [0.0, -0.0, 3.5, 1e-300, -1 / 3, np.inf, -np.inf, np.nan])
def test_constant_is_kept_exactly(value: float) -> None:
    """Assert that a constant reaches every point bit by bit, on its own and in an operation."""
    for expression in (ca.SX(value), ca.copysign(ca.SX(value), X) + 0 * Y, ca.if_else(X > Y, value, Y)):
        x, y = np.array([2.0, -2.0]), np.array([1.0, -3.0])
        np.testing.assert_array_equal(by_kernel(expression, x, y), by_casadi(expression, x, y))


@pytest.mark.parametrize("expression", [ca.erfinv(X), ca.remainder(X, Y)], ids=["unary", "binary"])
def test_unknown_operation_is_refused(expression: ca.SX) -> None:
    """Assert that an operation without a counterpart is named when the kernel is made, not when it runs."""
    (code,) = operations(expression)
    with pytest.raises(NotImplementedError, match=rf"^CasADi operation {code} has no counterpart"):
        kernel.build([kernel.points(X, "x"), kernel.points(Y, "y")], [expression])


def test_only_structural_nonzeros_are_written() -> None:
    """Assert that a matrix result fills (points, rows, columns) and leaves its structural zeros alone."""
    matrix = ca.jacobian(ca.vertcat(X**2, X * Y, Y), ca.vertcat(X, Y))
    run = kernel.build([kernel.points(X, "x"), kernel.vector(Y, "y")], [matrix])
    out = np.full((4, 3, 2), 7.0)
    x, y = np.arange(1.0, 5.0), np.array([0.5])
    run(x, y, out)
    expected = np.array([[[2 * a, 7.0], [0.5, a], [7.0, 1.0]] for a in x])
    np.testing.assert_array_equal(out, expected)


def test_empty_batch_is_empty() -> None:
    """Assert that no points give no values."""
    assert by_kernel(X * Y, np.zeros(0), np.zeros(0)).shape == (0,)


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("name", PARTS)
def test_residual_of_a_scene_agrees_with_casadi(name: str, regime: str) -> None:
    """Assert that a compiled residual is CasADi's, row by row, in and out of contact."""
    system = scene(name)
    points = draw(system, regime)
    e = system.expressions
    function = ca.Function("reference", [e.rate, e.state, e.algebraic, e.phase, e.parameter], [e.residual])
    found = system.residual(*points.arguments)
    *each, p = points.arguments
    expected = np.array(
        [np.array(function(*(a[i] for a in each), p)).ravel() for i in range(len(points.phase))]
    )
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-15 * np.abs(expected).max())


def test_arrays_that_c_takes() -> None:
    """Assert that arguments of another kind or order are copied, and results and other shapes are refused.

    Layouts: (points, 2), one of (3,) for all points, and the result (points, 2).
    """
    layouts = [choice.Layout((2,)), choice.Layout((3,), shared=True), choice.Layout((2,))]
    given = SimpleNamespace(layouts=layouts, results=1)

    def taken(*arrays: Array) -> bool:
        return ChosenKernel._addresses(given, arrays) is not None  # type: ignore[arg-type]

    x, shared, out = np.ones((4, 2)), np.ones(3), np.zeros((4, 2))
    assert taken(x, shared, out)
    assert taken(x.astype(int), shared, out) and taken(np.asfortranarray(x), shared, out)
    assert taken(x, np.ones(6)[::2], out)
    assert not taken(x[:3], shared, out) and not taken(np.ones((4, 3)), shared, out)
    assert not taken(x, np.ones((4, 3)), out) and not taken(x, np.ones(2), out)
    assert not taken(x, shared, out.astype(np.float32)) and not taken(x, shared, np.asfortranarray(out))
    found = ChosenKernel._addresses(given, (x, shared, out))  # type: ignore[arg-type]
    assert found is not None and ctypes.addressof(found[2]) == out.ctypes.data
    assert ctypes.addressof(found[0]) == x.ctypes.data


def test_calls_after_which_compiling_has_paid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that a kernel is compiled at that call, and once where there is no compiler."""
    asked: list[str] = []
    monkeypatch.setattr(choice.native, "kept", lambda source: None)
    monkeypatch.setattr(choice.native, "attempted", asked.append)
    done: list[int] = []
    run = ChosenKernel("source", 1000, [], 0, choice.Kernels.AUTO, lambda: lambda *arrays: done.append(1))
    saved, cost = choice.SAVED * 1000, choice.COMPILER + choice.STATEMENT * 1000
    assert run.pays == math.ceil(cost / saved) > 1
    whole = ChosenKernel("source", 1000, [], 0, choice.Kernels.AUTO, lambda: done.append, iterated=True)
    assert whole.pays == math.ceil(cost / (saved + choice.ITERATION))
    for _ in range(run.pays - 1):
        run(np.zeros(1))
    assert asked == [] and not run.compiled
    for _ in range(5):
        run(np.zeros(1))
    assert asked == ["source"] and len(done) == run.pays + 4 and run.address() is None


def test_library_that_does_not_load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that one of another machine, or none, is as if there were none."""
    monkeypatch.setattr(built, "FOLDER", tmp_path)
    assert built.built("int x;") is None
    (tmp_path / built.file_name("int x;")).write_bytes(b"no library")
    assert built.built("int x;") is None
    assert built.file_name("int x;") != built.file_name("int y;")
    assert len(built.file_name("").partition(".")[0]) == 32
