"""Operations and arguments that all kernels are tried with."""

from __future__ import annotations

import casadi as ca
import numpy as np

import symbolic as sym
from support.models import Array


def forms(system: sym.CompiledSystem, seed: int = 3) -> tuple[Array, Array, Array, Array, Array]:
    """Random weights and a random direction (v_x', v_x, v_z, v_p) for the points of `draw`."""
    rng = np.random.default_rng(seed)
    n, m, count = len(system.states), len(system.algebraics), 7
    sizes = (n + m, n, n, m)
    weights, *directions = (rng.uniform(-1, 1, (count, size)) for size in sizes)
    along = rng.uniform(-1, 1, len(system.parameters)) * np.abs(system.nominal)
    return weights, directions[0], directions[1], directions[2], along


X, Y = ca.SX.sym("x"), ca.SX.sym("y")


PLANE, POSITIVE, UNIT, LARGE = (-3.0, 3.0), (0.01, 30.0), (-0.99, 0.99), (1.01, 30.0)


OPERATIONS = {
    "ADD": (X + Y, PLANE),
    "SUB": (X - Y, PLANE),
    "MUL": (X * Y, PLANE),
    "DIV": (X / Y, PLANE),
    "POW": (X**Y, POSITIVE),
    "CONSTPOW": (X**2.5, POSITIVE),
    "LT": (Y > X, PLANE),
    "LE": (Y >= X, PLANE),
    "EQ": (X == Y, PLANE),
    "NE": (X != Y, PLANE),
    "AND": (ca.logic_and(X, Y), PLANE),
    "OR": (ca.logic_or(X, Y), PLANE),
    "NOT": (ca.logic_not(X), PLANE),
    "FMOD": (ca.fmod(X, Y), PLANE),
    "COPYSIGN": (ca.copysign(X, Y), PLANE),
    "FMIN": (ca.fmin(X, Y), PLANE),
    "FMAX": (ca.fmax(X, Y), PLANE),
    "ATAN2": (ca.atan2(X, Y), PLANE),
    "HYPOT": (ca.hypot(X, Y), PLANE),
    "IF_ELSE_ZERO": (ca.if_else(X, Y, 0), PLANE),
    "NEG": (-X, PLANE),
    "SQ": (X**2, PLANE),
    "TWICE": (2 * X, PLANE),
    "INV": (1 / X, PLANE),
    "EXP": (ca.exp(X), PLANE),
    "EXPM1": (ca.expm1(X), PLANE),
    "LOG": (ca.log(X), POSITIVE),
    "LOG1P": (ca.log1p(X), UNIT),
    "SQRT": (ca.sqrt(X), POSITIVE),
    "SIN": (ca.sin(X), PLANE),
    "COS": (ca.cos(X), PLANE),
    "TAN": (ca.tan(X), PLANE),
    "ASIN": (ca.asin(X), UNIT),
    "ACOS": (ca.acos(X), UNIT),
    "ATAN": (ca.atan(X), PLANE),
    "SINH": (ca.sinh(X), PLANE),
    "COSH": (ca.cosh(X), PLANE),
    "TANH": (ca.tanh(X), PLANE),
    "ASINH": (ca.asinh(X), PLANE),
    "ACOSH": (ca.acosh(X), LARGE),
    "ATANH": (ca.atanh(X), UNIT),
    "FLOOR": (ca.floor(X), PLANE),
    "CEIL": (ca.ceil(X), PLANE),
    "FABS": (ca.fabs(X), PLANE),
    "SIGN": (ca.sign(X), PLANE),
    "ERF": (ca.erf(X), PLANE),
}
"""An expression for every operation of the kernel's tables, and the range of its arguments."""


COMBINED = {
    "if_else": ca.if_else(X > Y, X * Y, ca.sin(X) - Y),
    "nested if_else": ca.if_else(X > 0, ca.if_else(Y > 0, X, -Y), ca.if_else(X + Y > 0, 2.5, X)),
    "clipped": ca.fmax(ca.fmin(X, 1.25), -Y),
    "integer powers": X**3 + Y**7 - X**-2,
    "repeated": ca.exp(X * Y) + ca.log1p(ca.exp(X * Y)) * ca.exp(X * Y),
    "derivative of fmax": ca.jacobian(ca.fmax(X, Y) ** 2, X),
    "derivative of if_else": ca.jacobian(ca.if_else(X > Y, X**3, Y * X), X),
}
"""Expressions of several operations."""


def arguments(low: float, high: float, count: int) -> tuple[Array, Array]:
    """Random arguments, some of them equal and, where the range allows, zero."""
    x, y = np.random.default_rng(3).uniform(low, high, (2, count))
    x[::7] = y[::7]
    if low < 0 and count > 1:
        x[::5] = 0.0
    return x, y
