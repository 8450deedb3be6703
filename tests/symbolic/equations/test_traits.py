"""Signs of expressions that are known by their form."""

from __future__ import annotations

from typing import Any

import casadi as ca
import pytest

from symbolic.equations.branches import Traits, _Known

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
