"""The functions of expressions and numbers: values, help, and what they refuse."""

from __future__ import annotations

import pydoc

import casadi as ca
import numpy as np
import pytest
import scipy.special

import symbolic as sym

F = sym.functions
NUMERIC = {
    "acos": np.arccos, "asin": np.arcsin, "atan": np.arctan, "cos": np.cos, "cosh": np.cosh,
    "erf": scipy.special.erf, "exp": np.exp, "fabs": np.abs, "log": np.log, "sign": np.sign, "sin": np.sin,
    "sinh": np.sinh, "sqrt": np.sqrt, "tan": np.tan, "tanh": np.tanh, "atan2": np.arctan2, "fmax": np.maximum,
    "fmin": np.minimum, "hypot": np.hypot, "clip": np.clip, "if_else": np.where,
}  # fmt: skip
TWO, THREE = ("atan2", "fmax", "fmin", "hypot"), ("clip", "if_else")


@pytest.mark.parametrize("name", [name for name in F.__all__ if name not in ("interp", "relay")])
def test_values(name: str) -> None:
    """Assert the values of an expression, of a number and of an array, against NumPy's and SciPy's."""
    count = 2 if name in TWO else 3 if name in THREE else 1
    given = (0.7, 0.2, 0.4)[:count]
    symbols = [ca.SX.sym(f"x{k}") for k in range(count)]
    function, expected = getattr(F, name), float(NUMERIC[name](*given))
    expression = ca.Function("f", symbols, [function(*symbols)])
    assert float(expression(*given)) == pytest.approx(expected, rel=1e-15)
    assert function(*given) == pytest.approx(expected, rel=1e-15)
    several = function(*([value, value] for value in given))
    assert several == pytest.approx([expected] * 2, rel=1e-15)


@pytest.mark.parametrize("name", F.__all__)
def test_help_is_ours(name: str) -> None:
    """Assert that help tells what a function returns, its arguments and nothing of CasADi's."""
    text = pydoc.plain(pydoc.render_doc(getattr(F, name)))
    assert f"{name}(" in text and "symbolic.functions" in text and "Parameters" in text
    assert "casadi" not in text.lower() and "SX" not in text


def test_arrays_of_expressions() -> None:
    """Assert that a list of symbols and numbers gives one value each."""
    x = ca.SX.sym("x")
    found = F.sin([x, 1.0])
    assert found.shape == (2,) and ca.is_equal(found[0], ca.sin(x), 1)
    assert float(found[1]) == pytest.approx(np.sin(1), rel=1e-15)


def test_broken_line() -> None:
    """Assert that interp is NumPy's, of symbols too, and has one kink a bend."""
    places, values, x = [-1.0, 0.0, 0.5, 2.0], [3.0, 1.0, 1.0, -2.0], ca.SX.sym("x")
    at = np.linspace(-2, 3, 41)
    expression = ca.Function("f", [x], [F.interp(x, places, values)]).map(len(at))
    assert expression(at).full().ravel() == pytest.approx(np.interp(at, places, values), abs=1e-14)
    assert F.interp(at, places, values) == pytest.approx(np.interp(at, places, values), abs=1e-14)
    spring = sym.compile(
        sym.Equations(lambda x, p: {"x": x.v, "v": -F.interp(x.x, places, values)}, {"x": 0.0, "v": 0.0})
    )
    assert len(spring.switches) == len(places)


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("sin", ("a",), "sin is of 'a'; it must be of expressions or numbers"),
        ("sin", (None,), "sin is of None; it must be of expressions or numbers"),
        ("fmax", (1.0, [None]), r"fmax is of 1.0, \[None\]; it must be of expressions or numbers"),
        ("interp", (1.0, [1, 0], [1, 2]), "places and values of interp are"),
        ("interp", (1.0, [1, 2], [1]), "places and values of interp are"),
    ],
)
def test_refused(name: str, given: tuple[object, ...], said: str) -> None:
    """Assert one sentence for what is neither expression nor number."""
    with pytest.raises(ValueError, match=said):
        getattr(F, name)(*given)


def test_argument_that_is_missing() -> None:
    """Assert that the function is named whose argument is missing."""
    with pytest.raises(TypeError, match=r"^fmax\(\): missing a required argument: 'y'$"):
        F.fmax(1.0)
