"""Kernels in C against the same in NumPy, operation by operation and scene by scene."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import casadi as ca
import numpy as np
import pytest
from support.kernels import COMBINED, LARGE, OPERATIONS, POSITIVE, UNIT, X, Y, arguments, forms
from support.models import PARTS, REGIMES, Array, draw

import symbolic as sym
from symbolic.kernels import csource, kernel, native
from symbolic.kernels.choice import ChosenKernel, Kernels
from symbolic.scenes.building import build as build_scene
from symbolic.scenes.names import scene_names
from symbolic.scenes.reading import load

if native.compiler() is None:
    pytest.skip("there is no C compiler", allow_module_level=True)

EXPRESSIONS = {**{name: expression for name, (expression, _) in OPERATIONS.items()}, **COMBINED}
SPECIAL = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 1e308, -1e308, 5e-324, 1.0, -1.0, 2.5, -2.5])


@pytest.fixture(scope="module", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory):  # noqa: ANN202
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


@cache
def both() -> tuple[Callable[..., None], Callable[..., None]]:
    """One kernel of all expressions, in NumPy and in C."""
    given = [kernel.points(X, "x"), kernel.points(Y, "y")]
    rows = [ca.vertcat(*EXPRESSIONS.values())]
    return kernel.build(given, rows, Kernels.NUMPY), kernel.build(given, rows, Kernels.C)


def values(x: Array, y: Array) -> tuple[dict[str, Array], dict[str, Array]]:
    """All expressions at the points, by name, from NumPy and from C."""
    found = []
    for run in both():
        out = np.zeros((len(x), len(EXPRESSIONS)))
        with np.errstate(all="ignore"):
            run(x, y, out)
        found.append(dict(zip(EXPRESSIONS, out.T, strict=True)))
    return found[0], found[1]


def test_tables_hold_the_same_operations() -> None:
    """Assert that what NumPy evaluates, C evaluates."""
    assert set(csource.OPERATIONS) == set(kernel._OPERATIONS)


@pytest.mark.parametrize("limits", [(-3.0, 3.0), POSITIVE, UNIT, LARGE])
def test_operations_agree(limits: tuple[float, float]) -> None:
    """Assert every expression's value to 1e-14, relative, NaN for NaN."""
    by_numpy, by_c = values(*arguments(*limits, 500))
    for name in EXPRESSIONS:
        scale = np.finfo(float).eps if name in COMBINED else 0
        np.testing.assert_allclose(by_c[name], by_numpy[name], rtol=1e-14, atol=scale, err_msg=name)


def test_operations_agree_at_the_ends_of_their_range() -> None:
    """Assert zeros, infinities, overflow and NaN in either argument, all pairs of them."""
    x, y = (a.ravel() for a in np.meshgrid(SPECIAL, SPECIAL))
    by_numpy, by_c = values(x, y)
    for name in OPERATIONS:
        np.testing.assert_allclose(by_c[name], by_numpy[name], rtol=1e-14, atol=0, err_msg=name)


@pytest.mark.parametrize("value", [0.0, -0.0, 3.5, 1e-300, -1 / 3, np.inf, -np.inf, np.nan])
def test_constant_is_kept_exactly(value: float) -> None:
    """Assert that C holds a constant as NumPy does, its sign too."""
    rows = [ca.vertcat(value, ca.copysign(value, X), ca.if_else(X > 0, value, X))]
    found = []
    for choice in (Kernels.NUMPY, Kernels.C):
        found.append(np.zeros((2, 3)))
        kernel.build([kernel.points(X, "x")], rows, choice)(np.array([2.0, -2.0]), found[-1])
    np.testing.assert_array_equal(*found)
    np.testing.assert_array_equal(*np.signbit(found))
    np.testing.assert_array_equal(found[1][:, 0], value)


def test_only_structural_nonzeros_are_written() -> None:
    """Assert where a matrix result goes, and that its structural zeros are left alone."""
    matrix = ca.jacobian(ca.vertcat(X**2, X * Y, Y), ca.vertcat(X, Y))
    run = kernel.build([kernel.points(X, "x"), kernel.vector(Y, "y")], [matrix, X * Y], Kernels.C)
    out, product = np.full((4, 3, 2), 7.0), np.zeros((4, 1))
    x, y = np.arange(1.0, 5.0), np.array([0.5])
    run(x, y, out, product)
    np.testing.assert_array_equal(out, [[[2 * a, 7.0], [0.5, a], [7.0, 1.0]] for a in x])
    np.testing.assert_array_equal(product[:, 0], 0.5 * x)


def test_arrays_of_any_kind_are_read_and_filled() -> None:
    """Assert strided, broadcast, read-only, integer and single-precision arrays, and parameters per point."""
    given = [kernel.batch(ca.vertcat(X, Y), "xy"), kernel.vector(ca.SX.sym("p", 2), "p")]
    rows = [X * given[1].symbol[0] - Y / given[1].symbol[1]]
    slow, fast = (kernel.build(given, rows, choice) for choice in (Kernels.NUMPY, Kernels.C))
    xy, p = np.random.default_rng(1).uniform(1, 2, (6, 2)), np.array([2.0, 3.0])
    fixed = xy.copy()
    fixed.flags.writeable = False
    broadcast = np.broadcast_to(xy[:1], (6, 2))
    integer = np.arange(1, 13).reshape(6, 2)
    for a in (xy, xy[::2], xy[::-1], np.asfortranarray(xy), fixed, broadcast, integer, xy.astype("f4")):
        for q in (p, p[::-1], np.stack([np.full(len(a), 2.0), np.linspace(1, 2, len(a))])):
            for spaced in (1, 3):
                expected, found = np.zeros((len(a), 1)), np.zeros((len(a), spaced))[:, :1]
                slow(a, q, expected)
                fast(a, q, found)
                np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_arrays_that_do_not_fit_are_refused() -> None:
    """Assert that C never reads past an array: what does not fit goes to NumPy, which says so."""
    run = kernel.build([kernel.batch(ca.vertcat(X, Y), "xy")], [X + Y], Kernels.C)
    for shape in ((5, 1), (4, 2), (2,)):
        with pytest.raises((ValueError, IndexError)):
            run(np.zeros(shape), np.zeros((5, 1)))


def test_empty_batch_is_empty() -> None:
    """Assert that no points give no values."""
    by_numpy, by_c = values(np.zeros(0), np.zeros(0))
    assert all(len(by_c[name]) == len(by_numpy[name]) == 0 for name in EXPRESSIONS)


def test_unknown_operation_is_refused() -> None:
    """Assert that an operation without a counterpart is named when the kernel is made."""
    with pytest.raises(NotImplementedError, match="^CasADi operation .* has no counterpart"):
        kernel.build([kernel.points(X, "x")], [ca.erfinv(X)], Kernels.C)


SCENES = ("two discs, squeeze", "relaxation")
"""Scenes of the tests unlike any of the package's."""


def pair(name: str) -> tuple[sym.CompiledSystem, sym.CompiledSystem]:
    """A scene of the tests or of the package, in NumPy and in C."""
    if name in PARTS:
        model = sym.combine(PARTS[name]())
        return sym.compile(model, kernels="numpy"), sym.compile(model, kernels="c")
    with pytest.MonkeyPatch.context() as patch:
        made = []
        for choice in ("numpy", "c"):
            patch.setenv("ORBITRACE_KERNELS", choice)
            made.append(build_scene(load(name, [])))
    return made[0], made[1]


def agree(found: object, expected: object) -> None:
    """Assert all arrays of a result to 1e-14 relative to the largest entry of each."""
    if not isinstance(expected, np.ndarray):
        parts = expected if isinstance(expected, tuple) else tuple(vars(expected).values())
        others = found if isinstance(found, tuple) else tuple(vars(found).values())
        for a, b in zip(others, parts, strict=True):
            agree(a, b)
        return
    np.testing.assert_array_equal(np.isfinite(found), np.isfinite(expected))
    size = np.abs(expected[np.isfinite(expected)]).max(initial=0.0)
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-14 * size)


@pytest.mark.backends
@pytest.mark.parametrize("name", [*SCENES, *scene_names()])
def test_kernels_of_a_scene_agree(name: str) -> None:
    """Assert residual, derivatives, outputs, switches and second derivatives, in and out of contact."""
    by_numpy, by_c = pair(name)
    free = tuple({0, len(by_numpy.parameters) - 1})
    weights = forms(by_numpy)
    for regime in REGIMES if name in PARTS else ("touching",):
        at = draw(by_numpy, regime)
        for call in (
            lambda s, at=at: s.residual(*at.arguments),
            lambda s, at=at: s.linearise(*at.arguments, free),
            lambda s, at=at: s.output(*at.arguments),
            lambda s, at=at: s.output_gradient(*at.arguments, free),
            lambda s, at=at: s.switch(at.state, at.phase, at.parameter),
            lambda s, at=at: s.switch_gradient(at.state, at.phase, at.parameter),
            lambda s, at=at: s.move(at.algebraic, 0.1 * at.algebraic),
            lambda s, at=at: s.curvature(*at.arguments, *weights),
        ):
            agree(call(by_c), call(by_numpy))
    made = by_c._generated._derivatives.values()
    assert all(isinstance(run, ChosenKernel) and run.compiled for run in made)
