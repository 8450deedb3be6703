"""An expression as sums of products: its graph from the leaves up, each operation once."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from symbolic.equations.branches import STANDS_FOR_ZERO, nodes
from symbolic.equations.tex.products import Product, Sum, atom, one, parenthesised, scaled, written

Leaf = Callable[[ca.SX], Sum]
"""What a symbol is written as."""

NAMED = {
    ca.OP_SIN: r"\sin", ca.OP_COS: r"\cos", ca.OP_TAN: r"\tan", ca.OP_ASIN: r"\arcsin",
    ca.OP_ACOS: r"\arccos", ca.OP_ATAN: r"\arctan", ca.OP_SINH: r"\sinh", ca.OP_COSH: r"\cosh",
    ca.OP_TANH: r"\tanh", ca.OP_LOG: r"\ln", ca.OP_FMAX: r"\max", ca.OP_FMIN: r"\min",
    ca.OP_SIGN: r"\operatorname{sgn}", ca.OP_ERF: r"\operatorname{erf}", ca.OP_ATAN2: r"\operatorname{atan2}",
    ca.OP_HYPOT: r"\operatorname{hypot}", ca.OP_LOG1P: r"\operatorname{log1p}",
    ca.OP_EXPM1: r"\operatorname{expm1}", ca.OP_ASINH: r"\operatorname{arsinh}",
    ca.OP_ACOSH: r"\operatorname{arcosh}", ca.OP_ATANH: r"\operatorname{artanh}",
}  # fmt: skip

BETWEEN = {
    ca.OP_LT: "<", ca.OP_LE: r"\le", ca.OP_EQ: "=", ca.OP_NE: r"\ne", ca.OP_AND: r"\wedge", ca.OP_OR: r"\vee",
}  # fmt: skip

OPPOSITE = {ca.OP_LT: r"\ge", ca.OP_LE: ">", ca.OP_EQ: r"\ne", ca.OP_NE: "="}
"""What a comparison that does not hold is."""

Rule = Callable[..., Sum]
"""How an operation is written: from what its arguments are."""


def _joined(a: Sum, b: Sum, power: float) -> Sum:
    return [one(a).times(one(b), power)]


def _to_power(a: Sum, b: Sum) -> Sum:
    """a^b: each factor to a whole power, otherwise all of it."""
    base, exponent = one(a), one(b)
    if exponent.powers:
        return atom(f"{{{parenthesised(base.tex)}}}^{{{written(b)}}}")
    power = exponent.number
    if power == int(power) or (base.number == 1 and len(base.powers) == 1):
        return [Product().times(base, power)]
    return [Product(1.0, {parenthesised(written(a)): power})]


RULES: dict[int, Rule] = {
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a + scaled(b, -1.0),
    ca.OP_NEG: lambda a: scaled(a, -1.0),
    ca.OP_TWICE: lambda a: scaled(a, 2.0),
    ca.OP_MUL: lambda a, b: _joined(a, b, 1.0),
    ca.OP_DIV: lambda a, b: _joined(a, b, -1.0),
    ca.OP_INV: lambda a: _joined([Product()], a, -1.0),
    ca.OP_SQ: lambda a: _joined([Product()], a, 2.0),
    ca.OP_POW: _to_power,
    ca.OP_CONSTPOW: _to_power,
    ca.OP_SQRT: lambda a: atom(rf"\sqrt{{{written(a)}}}"),
    ca.OP_EXP: lambda a: atom(f"e^{{{written(a)}}}"),
    ca.OP_FABS: lambda a: atom(rf"\left|{written(a)}\right|"),
    ca.OP_NOT: lambda a: atom(rf"\neg{parenthesised(written(a))}"),
    ca.OP_IF_ELSE_ZERO: lambda a, b: [Product(1.0, {rf"\left[{written(a)}\right]": 1.0}).times(one(b))],
}
"""Iverson's bracket [a < b] is 1 where that holds, else 0."""


def sums(expressions: ca.SX, leaf: Leaf) -> list[Sum]:
    """Return the elements of a column as sums of products.

    Parameters
    ----------
    expressions : casadi.SX
        A column.
    leaf : callable
        What a symbol is written as.

    Returns
    -------
    list of list of Product
        One sum for each.
    """
    found: dict[int, Sum] = {}

    def of(node: ca.SX) -> Sum:
        if node.is_constant():
            number = float(node)
            return [] if abs(number) < STANDS_FOR_ZERO else [Product(number)]
        return leaf(node) if node.is_symbolic() else found[node.element_hash()]

    for node in nodes(expressions):
        if node.op() == ca.OP_NOT and node.dep(0).op() in OPPOSITE:
            compared = node.dep(0)
            sides = [written(of(compared.dep(i))) for i in range(2)]
            found[node.element_hash()] = atom(f" {OPPOSITE[compared.op()]} ".join(sides))
            continue
        found[node.element_hash()] = _rule(node.op())(*(of(node.dep(i)) for i in range(node.n_dep())))
    return [of(expressions[i]) for i in range(expressions.numel())]


def _rule(operation: int) -> Rule:
    if operation in RULES:
        return RULES[operation]
    if operation in BETWEEN:
        return lambda a, b: atom(f"{written(a)} {BETWEEN[operation]} {written(b)}")
    name = NAMED.get(operation, rf"\operatorname{{op{operation}}}")
    return lambda *given: atom(name + parenthesised(r",\, ".join(map(written, given))))
