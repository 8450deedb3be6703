"""The functions that users write of equations: called with symbols, and what they return as expressions."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from symbolic.checks import shown

UNDECIDED = "Cannot compute the truth value"
NUMPY = r"\s*casadi: a numpy function was called"
"""How CasADi begins what it says of a comparison in Python, and of a function of NumPy's."""

Function = Callable[..., Mapping[str, Any]]
"""(x, p), or (x, p, wave) of a forced system, to expressions by name."""


def called(name: str, function: Function, arguments: Sequence[object]) -> dict[str, ca.SX]:
    """Return what a function called `name` makes of symbols. Raises ValueError for no expressions."""
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("error", NUMPY, FutureWarning)
            found: object = function(*arguments)
    except RuntimeError as error:
        if UNDECIDED not in str(error):
            raise
        raise ValueError(
            f"{name} decides by a symbol, as if, and, or, max and min do; "
            f"it must use if_else, fmax or fmin of symbolic.functions"
        ) from None
    except FutureWarning as warning:
        if "casadi" not in str(warning):
            raise
        raise ValueError(
            f"{name} takes a function of NumPy's of a symbol; "
            f"it must use that of symbolic.functions, as symbolic.functions.sin"
        ) from None
    if not isinstance(found, Mapping):
        raise ValueError(
            f"{name} returned a {type(found).__name__}; it must return a mapping of names to expressions"
        )
    return {str(key): _expression(name, key, value) for key, value in found.items()}


def _expression(name: str, key: object, value: object) -> ca.SX:
    """One value that a function returned. Raises ValueError for anything else than a number or expression."""
    if isinstance(value, int | float | np.integer | np.floating):
        value = ca.SX(float(value))
    if not (isinstance(value, ca.SX) and value.is_scalar()):
        raise ValueError(
            f"{name} returned {shown(value)} for {key!r}; it must be one number or one expression"
        )
    if _has_nan(value):
        raise ValueError(
            f"{name} returned an expression with NaN in it for {key!r}; "
            f"it must use the functions of symbolic.functions, not those of math"
        )
    return value


def _has_nan(expression: ca.SX) -> bool:
    function = ca.Function("returned", ca.symvar(expression), [expression])
    constants = [k for k in range(function.n_instructions()) if function.instruction_id(k) == ca.OP_CONST]
    return any(math.isnan(function.instruction_constant(k)) for k in constants)
