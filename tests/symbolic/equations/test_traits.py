"""Signs of expressions that are known by their form."""

from __future__ import annotations

from typing import Any

import casadi as ca
import pytest

from symbolic.equations.branches import Traits, _Known, jumps_with, nodes, switching

X, P, N = (ca.SX.sym(name) for name in "xpn")
GIVEN = {"x": Traits.MOVING, "p": Traits.POSITIVE | Traits.NOT_NEGATIVE, "n": Traits.NOT_NEGATIVE}


def traits(expression: ca.SX) -> Traits:
    """Those of an expression in x, which moves, p > 0 and n >= 0."""
    known = _Known(lambda symbol: GIVEN[symbol.name()], {})

    def add(node: ca.SX) -> None:
        if node.is_constant() or node.is_symbolic():
            return
        for k in range(node.n_dep()):
            add(node.dep(k))
        known.add(node)

    add(expression)
    return known.of(expression)


@pytest.mark.parametrize(
    ("expression", "positive"),
    [
        (ca.fmax(X, P), True),
        (ca.fmax(P, X), True),
        (ca.fmax(X, N), False),
        (ca.fmin(X, P), False),
        (ca.fmin(P, P + 1), True),
        (P + 2, True),
        (P - 2, False),
        (P * 3, True),
        (P * X, False),
        (P / 4, True),
        (ca.exp(X), True),
        (ca.sqrt(P), True),
        (ca.atan2(P, X), False),
        (ca.atan2(X, P), False),
        (ca.hypot(X, P), False),
        (ca.erf(P), False),
        (ca.sinh(P), False),
        (ca.fabs(X), False),
        (-P, False),
    ],
)
def test_what_is_positive_by_its_form(expression: Any, positive: bool) -> None:
    """Assert it where all arguments are, of the larger of two where one is, and of exponentials."""
    assert (Traits.POSITIVE in traits(expression)) is positive


@pytest.mark.parametrize(
    ("expression", "not_negative"),
    [
        (ca.fabs(X), True),
        (X**2, True),
        (ca.sqrt(X), True),
        (X < 1, True),
        (N * P, True),
        (N * X, False),
        (ca.fmax(X, N), True),
        (X - 1, False),
        (X**3, False),
    ],
)
def test_what_is_never_negative_by_its_form(expression: Any, not_negative: bool) -> None:
    """Assert squares, moduli, conditions, and products of such."""
    assert (Traits.NOT_NEGATIVE in traits(expression)) is not_negative


def test_what_an_expression_is_made_of() -> None:
    """Assert that what moves is handed on, and nothing else."""
    assert Traits.MOVING in traits(P + X * N) and Traits.MOVING not in traits(P + N)
    assert Traits.OTHER not in traits(P + X)


Y, V = ca.SX.sym("y"), ca.SX.sym("v")
MOVING = {"x": Traits.MOVING, "y": Traits.MOVING, "v": Traits.OTHER}


def switches(expression: ca.SX) -> list[str]:
    """The switching arguments of an expression in x and y, which move, v, a rate, p > 0 and n >= 0."""
    return [str(s) for s in switching(expression, lambda s: (GIVEN | MOVING).get(s.name(), Traits.NONE))]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (ca.fmax(X, Y), ["(x-y)"]),
        (ca.fmin(P, X), ["(x-p)"]),
        (ca.fmax(X, P), ["(x-p)"]),
        (ca.fmax(X, 0), ["x"]),
        (ca.fmax(X, 1e-300), ["x"]),
        (ca.fmax(X, 1e-100), ["(x-1e-100)"]),
        (ca.fmax(-X, 0), ["x"]),
        (ca.fmax(P, N), []),
        (ca.fmax(X, V), []),
        (ca.fmax(V, 0), []),
        (ca.fmax(ca.exp(X), 0), []),
        (ca.fabs(X), ["x"]),
        (ca.fabs(P), []),
        (ca.fabs(X * Y), ["x", "y"]),
        (ca.fabs(P * X), ["(p*x)"]),
        (ca.fabs(X * ca.exp(Y)), ["x"]),
        (ca.fabs(X / Y), ["x", "y"]),
        (ca.fabs(X**2), []),
        (ca.fabs(X * V), ["x"]),
        (ca.sign(X - 1), ["(x-1)"]),
        (ca.sign(X * Y), ["(x*y)"]),
        (X < P, ["(x-p)"]),
        (P < X, ["(x-p)"]),
        (X <= 0, ["x"]),
        (ca.fmax(ca.fabs(X), Y), ["x", "(fabs(x)-y)"]),
        (ca.sin(X) + Y, []),
    ],
)
def test_switching_arguments(expression: Any, expected: list[str]) -> None:
    """Assert what vanishes where branches meet, inner ones first; not of rates, parameters and powers."""
    assert switches(expression) == expected


@pytest.mark.parametrize(
    ("expression", "said"),
    [
        (ca.floor(X), "the equations use floor of what moves"),
        (ca.ceil(2 * X), "the equations use ceil of what moves"),
        (ca.fmod(X, 2), "the equations use fmod of what moves"),
        (ca.copysign(P, X), "the equations use copysign of what moves"),
        (X + ca.SX(float("nan")), "the equations have NaN in them"),
    ],
)
def test_jumps_that_no_switch_tells(expression: Any, said: str) -> None:
    """Assert the sentence; rounded parameters are taken."""
    assert switches(ca.fmax(X, ca.floor(P))) == ["(x-floor(p))"]
    with pytest.raises(ValueError, match=f"^{said}"):
        switches(expression)


@pytest.mark.parametrize(
    ("expression", "symbol", "expected"),
    [
        (ca.sign(X), X, True),
        (X * (Y < 1), Y, True),
        (X * (Y <= 1), X, False),
        (ca.fmax(X, Y), X, False),
        (ca.sign(X) + Y, Y, False),
    ],
)
def test_operations_that_jump(expression: Any, symbol: ca.SX, expected: bool) -> None:
    """Assert it of signs and conditions that have the symbol in them."""
    assert jumps_with(expression, symbol) is expected


def test_operations_of_a_graph() -> None:
    """Assert each once, after what it is made of, those of the first row first."""
    inner = ca.sin(X)
    found = [str(node) for node in nodes(ca.vertcat(inner + Y, ca.exp(inner), Y, ca.SX(2)))]
    assert found == ["sin(x)", "(sin(x)+y)", "exp(sin(x))"]
    assert list(nodes(ca.SX(0, 1))) == []
