"""The elementary functions that equations may use, of expressions and numbers alike.

NumPy's take expressions too; Python's own `max`, `min`, `if`, `and`, `or` and those of `math` do not.
"""

from __future__ import annotations

import functools
import inspect
import reprlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import casadi as ca
import numpy as np

from symbolic import relays

__all__ = [
    "acos",
    "asin",
    "atan",
    "atan2",
    "clip",
    "cos",
    "cosh",
    "erf",
    "exp",
    "fabs",
    "fmax",
    "fmin",
    "hypot",
    "if_else",
    "interp",
    "log",
    "relay",
    "sign",
    "sin",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
]

F = TypeVar("F", bound=Callable[..., Any])

SYMBOLIC = (ca.SX, ca.MX, ca.DM)

SECTIONS = """

    Parameters
    ----------
    {names} : expression, float or array
        Symbols, numbers or arrays of them.

    Returns
    -------
    expression, float or array
        An expression of symbols, a number of numbers, an array of arrays.
    """


def elementary(symbolic: Callable[..., Any], numeric: Callable[..., Any]) -> Callable[[F], F]:
    """Return the decorator of a function that is CasADi's of symbols and NumPy's of numbers.

    Parameters
    ----------
    symbolic, numeric : callable
        Both functions.

    Returns
    -------
    callable
        The decorator; what it is laid on gives name, arguments and docstring.
    """

    def decorate(named: F) -> F:
        signature = inspect.signature(named)

        @functools.wraps(named)
        def function(*args: Any, **kwargs: Any) -> Any:
            try:
                values = signature.bind(*args, **kwargs).args
            except TypeError as error:
                raise TypeError(f"{named.__name__}(): {error}") from None
            return _applied(named.__name__, symbolic, numeric, values)

        function.__doc__ = f"{inspect.getdoc(named)}{SECTIONS.format(names=', '.join(signature.parameters))}"
        return function  # type: ignore[return-value]

    return decorate


def _applied(
    name: str, symbolic: Callable[..., Any], numeric: Callable[..., Any], values: tuple[Any, ...]
) -> Any:
    if any(isinstance(value, SYMBOLIC) for value in values) and all(map(_fit, values)):
        return symbolic(*values)
    arrays = [np.asarray(value) for value in values]
    kinds = {array.dtype.kind for array in arrays}
    if kinds <= set("biuf"):
        with np.errstate(all="ignore"):
            found = numeric(*arrays)
        return found if np.ndim(found) else float(found)
    if kinds <= set("biufO") and all(_fit(item) for array in arrays for item in array.ravel()):
        return np.vectorize(symbolic, otypes=[object])(*arrays)
    raise ValueError(f"{name} is of {_said(values)}; it must be of expressions or numbers")


def _fit(item: Any) -> bool:
    return isinstance(item, (*SYMBOLIC, int, float, np.number, np.bool_))


def _said(values: tuple[Any, ...]) -> str:
    return ", ".join(reprlib.repr(value) for value in values)


def _hypot(x: Any, y: Any) -> Any:
    return ca.sqrt(x**2 + y**2)


def _clip(x: Any, low: Any, high: Any) -> Any:
    return ca.fmin(ca.fmax(x, low), high)


def _erf(x: Any) -> Any:
    from scipy.special import erf

    return erf(x)


@elementary(ca.acos, np.arccos)
def acos(x: Any) -> Any:
    """Return the arc cosine of x, in rad."""


@elementary(ca.asin, np.arcsin)
def asin(x: Any) -> Any:
    """Return the arc sine of x, in rad."""


@elementary(ca.atan, np.arctan)
def atan(x: Any) -> Any:
    """Return the arc tangent of x, in rad."""


@elementary(ca.atan2, np.arctan2)
def atan2(y: Any, x: Any) -> Any:
    """Return the angle of the point (x, y), in rad from -pi to pi."""


@elementary(_clip, np.clip)
def clip(x: Any, low: Any, high: Any) -> Any:
    """Return x, or the limit that it is beyond; both kinks become switches."""


@elementary(ca.cos, np.cos)
def cos(x: Any) -> Any:
    """Return the cosine of x (rad)."""


@elementary(ca.cosh, np.cosh)
def cosh(x: Any) -> Any:
    """Return the hyperbolic cosine of x."""


@elementary(ca.erf, _erf)
def erf(x: Any) -> Any:
    """Return the error function of x, 2/sqrt(pi) times the integral of exp(-t^2) from 0 to x."""


@elementary(ca.exp, np.exp)
def exp(x: Any) -> Any:
    """Return e to the power x."""


@elementary(ca.fabs, np.fabs)
def fabs(x: Any) -> Any:
    """Return the absolute value of x; its kink at x = 0 becomes a switch."""


@elementary(ca.fmax, np.fmax)
def fmax(x: Any, y: Any) -> Any:
    """Return the larger of x and y; the kink at x = y becomes a switch."""


@elementary(ca.fmin, np.fmin)
def fmin(x: Any, y: Any) -> Any:
    """Return the smaller of x and y; the kink at x = y becomes a switch."""


@elementary(_hypot, np.hypot)
def hypot(x: Any, y: Any) -> Any:
    """Return sqrt(x^2 + y^2), which has no derivative at (0, 0)."""


@elementary(ca.if_else, np.where)
def if_else(condition: Any, yes: Any, no: Any) -> Any:
    """Return `yes` where the condition holds, else `no`; where it changes becomes a switch."""


@elementary(ca.log, np.log)
def log(x: Any) -> Any:
    """Return the natural logarithm of x."""


@elementary(ca.sign, np.sign)
def sign(x: Any) -> Any:
    """Return -1, 0 or 1 as x is negative, 0 or positive; its jump becomes a switch."""


@elementary(ca.sin, np.sin)
def sin(x: Any) -> Any:
    """Return the sine of x (rad)."""


@elementary(ca.sinh, np.sinh)
def sinh(x: Any) -> Any:
    """Return the hyperbolic sine of x."""


@elementary(ca.sqrt, np.sqrt)
def sqrt(x: Any) -> Any:
    """Return the square root of x, which has no derivative at 0."""


@elementary(ca.tan, np.tan)
def tan(x: Any) -> Any:
    """Return the tangent of x (rad)."""


@elementary(ca.tanh, np.tanh)
def tanh(x: Any) -> Any:
    """Return the hyperbolic tangent of x, a smooth sign."""


def relay(u: Any, on: Any, off: Any, low: Any = 0.0, high: Any = 1.0) -> Any:
    """Return `high` from where u has risen through `on`, and `low` from where it has fallen through `off`.

    Between the thresholds a relay keeps what it is; a motion that begins there begins with `low`. Where it
    switches is an event of the motion. A thermostat heats what has become colder than `off` until it is
    warmer than `on`: low=1, high=0.

    Parameters
    ----------
    u : expression
        What is compared, a function of states, phase and parameters.
    on, off : expression or float
        The upper and the lower threshold, off < on.
    low, high : expression or float
        The values below and above.

    Returns
    -------
    expression
        Its value. It is one of a model at work: a relay is called in equations, not of numbers.

    Raises
    ------
    ValueError
        Outside of a model's equations, and for what is no expression or number.
    """
    symbol = relays.symbol_of(u, on, off)
    below, above = relays.expression("low", low), relays.expression("high", high)
    return below + (above - below) * (1 + symbol) / 2


def interp(x: Any, places: Sequence[float], values: Sequence[float]) -> Any:
    """Return the broken line through given points at x, constant beyond the first and the last.

    Its kinks become switches.

    Parameters
    ----------
    x : expression, float or array
        Where.
    places : sequence of float
        Abscissas of the points, rising.
    values : sequence of float
        Their ordinates.

    Returns
    -------
    expression, float or array
        values[k] at x = places[k], linear in between.

    Raises
    ------
    ValueError
        For places that do not rise, and another number of values.
    """
    at, height = np.asarray(places, dtype=float), np.asarray(values, dtype=float)
    if at.ndim != 1 or at.shape != height.shape or len(at) < 2 or not (np.diff(at) > 0).all():
        raise ValueError(
            f"places and values of interp are {_said((places, values))}; "
            f"they must be equally many numbers, at least 2, and places must rise"
        )
    slopes = np.diff(height) / np.diff(at)
    bends = np.diff([0.0, *slopes, 0.0])
    return height[0] + sum(bend * fmax(x - place, 0.0) for bend, place in zip(bends, at, strict=True) if bend)
