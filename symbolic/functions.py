"""The elementary functions that equations may use, of expressions and numbers alike."""

from __future__ import annotations

from casadi import (
    atan,
    atan2,
    cos,
    cosh,
    exp,
    fabs,
    fmax,
    fmin,
    if_else,
    log,
    sign,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
)

__all__ = [
    "atan",
    "atan2",
    "cos",
    "cosh",
    "exp",
    "fabs",
    "fmax",
    "fmin",
    "if_else",
    "log",
    "sign",
    "sin",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
]
