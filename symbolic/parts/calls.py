"""The functions that users write of equations: called with symbols, and what they return as expressions."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from symbolic.checks import shown
from symbolic.mistakes import explained

Function = Callable[..., Mapping[str, Any]]
"""(x, p), or (x, p, wave) of a forced system, to expressions by name."""


ARGUMENTS = ("x", "p", "wave")


def called(name: str, function: Function, arguments: Sequence[object]) -> dict[str, ca.SX]:
    """Return what a user's function returns for symbols. Raises ValueError for other than expressions."""
    check_taken(name, function, len(arguments))
    with explained(name):
        found: object = function(*arguments)
    if not isinstance(found, Mapping):
        raise ValueError(
            f"{name} returned a {type(found).__name__}; it must return a mapping of names to expressions"
        )
    return {str(key): _expression(name, key, value) for key, value in found.items()}


def check_taken(name: str, function: Callable[..., Any] | None, count: int) -> None:
    """Refuse a function that cannot be called with so many arguments."""
    if function is None:
        return
    try:
        taken = inspect.signature(function)
    except ValueError:  # of some functions that are not written in Python
        return
    try:
        taken.bind(*range(count))
    except TypeError:
        raise ValueError(
            f"{name} takes {taken}; it must take ({', '.join(ARGUMENTS[:count])})"
            f"{', as the system is forced' if count == len(ARGUMENTS) else ''}"
        ) from None


def _expression(name: str, key: object, value: object) -> ca.SX:
    """One value that a function returned. Raises ValueError for anything else than a number or expression."""
    if isinstance(value, np.ndarray) and value.shape == ():
        value = value.item()
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
