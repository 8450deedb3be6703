"""What users give to functions, checked: one sentence that names the field, the value and what is allowed."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from symbolic.quoting import LONGEST_QUOTE, shortened

T = TypeVar("T")

HUGE = 10**LONGEST_QUOTE
"""Whole numbers from here on are not written out."""


def refusal(field: str, value: object, allowed: str) -> ValueError:
    """Return the error of a value that is not what is `allowed`."""
    return ValueError(f"{field} is {shown(value)}; it must be {allowed}")


def shown(value: object) -> str:
    """Return a value as a sentence shows it: on one line, texts in quotes, not too long."""
    if isinstance(value, int) and abs(value) >= HUGE:  # Python refuses to write out the largest
        return "a whole number of too many digits"
    text = " ".join((str(value) if isinstance(value, np.generic) else repr(value)).split())
    return shortened(text)


def finite(field: str, value: object) -> float:
    """Return a finite number, whatever its type. Raises ValueError."""
    number = _number(value)
    if not math.isfinite(number):
        raise refusal(field, value, "a finite number")
    return number


def positive(field: str, value: object) -> float:
    """Return a positive finite number. Raises ValueError."""
    number = _number(value)
    if not 0 < number < math.inf:
        raise refusal(field, value, "a positive number")
    return number


def whole(field: str, value: Any, least: int) -> int:
    """Return a whole number of at least `least`. Raises ValueError."""
    try:
        number = least - 1 if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = least - 1
    if number < least:
        raise refusal(field, value, f"a whole number of at least {least}")
    return number


def typed(field: str, value: object, kind: type[T], allowed: str) -> T:
    """Return a value of a certain type; `allowed` says in words what that is. Raises ValueError."""
    if not isinstance(value, kind):
        raise refusal(field, value, allowed)
    return value


def numbers(field: str, value: object, each: str) -> dict[str, float]:
    """Return finite numbers by name; a sentence calls them "`each` of name". Raises ValueError."""
    return {name: finite(f"{each} of {name}", number) for name, number in mapping(field, value).items()}


def mapping(field: str, value: object) -> Mapping[str, Any]:
    """Return a mapping. Raises ValueError."""
    if not isinstance(value, Mapping):
        raise refusal(field, value, "a mapping of names to numbers")
    return value


def sequence(field: str, value: Any) -> list[float]:
    """Return at least one finite number. Raises ValueError."""
    given = [] if isinstance(value, str | bytes | Mapping) or not np.iterable(value) else list(value)
    if not given:
        raise refusal(field, value, "a sequence of finite numbers")
    return [finite(field, number) for number in given]


def one_of(field: str, value: object, names: Sequence[str]) -> str:
    """Return a name that is among the `names`. Raises ValueError."""
    if not isinstance(value, str) or value not in names:
        raise refusal(field, value, f"one of {', '.join(names)}")
    return value


def text(field: str, value: object) -> str:
    """Return a line of text that is not empty. Raises ValueError."""
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise refusal(field, value, "one line of text that is not empty")
    return value


def line(field: str, value: object) -> str:
    """Return a line of text, perhaps an empty one, that no terminal obeys. Raises ValueError."""
    if not isinstance(value, str) or not value.isprintable():
        raise refusal(field, value, "one line of text")
    return value


def _number(value: Any) -> float:
    """The value as a float; NaN for what is no number."""
    if isinstance(value, str | bytes | bool | np.complexfloating):
        return math.nan
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan
