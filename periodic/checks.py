"""Checks of what users give: one sentence names the field, the value and what is allowed."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

LONGEST = 200
"""Characters of the longest value that a sentence quotes."""


class UnknownNameError(KeyError):
    """A name that does not exist; the sentence lists those that do."""

    def __str__(self) -> str:
        return str(self.args[0])


class ByName(dict[str, float]):
    """Numbers by name; for another name the error lists the names.

    Parameters
    ----------
    what : str
        What the error message calls the names, such as "parameter".
    numbers : mapping of str to float
        The numbers.
    """

    def __init__(self, what: str, numbers: Mapping[str, float]) -> None:
        super().__init__(numbers)
        self._what = what

    def __missing__(self, name: str) -> float:
        raise UnknownNameError(f"{self._what} is {name!r}; it must be one of {', '.join(self) or 'none'}")

    def __reduce__(self) -> tuple[type[ByName], tuple[str, dict[str, float]]]:
        return ByName, (self._what, dict(self))


def shown(value: Any) -> str:
    """Return a value as a sentence shows it, not too long; Python does not write out the longest numbers."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:
        return "a number of too many digits"
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def plain(text: str) -> str:
    """Return a text on one line, with line ends, escapes and all else that a terminal obeys written out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def printable(text: str) -> str:
    """Return a text of a file as a terminal may show it: plain, and not too long."""
    shown = plain(text)
    return shown if len(shown) <= 2 * LONGEST else shown[: 2 * LONGEST - 3] + "..."


def line(name: str, value: Any) -> str:
    """Return a line of text, perhaps an empty one, that is plain. Raises ValueError for anything else."""
    if not isinstance(value, str) or not value.isprintable():
        raise ValueError(f"{name} is {shown(value)}; it must be one line of text")
    return value


def number(name: str, value: Any) -> float:
    """Return a real number, infinities and NaN included. Raises ValueError for anything else."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.integer | np.floating):
        raise ValueError(f"{name} is {value!r}; it must be a number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} is a whole number of too many digits; it must be below 1e308") from None


def positive(name: str, value: Any) -> float:
    """Return a positive finite number. Raises ValueError for any other."""
    if not 0 < number(name, value) < np.inf:
        raise ValueError(f"{name} is {value!r}; it must be a positive number")
    return float(value)


def at_least_0(name: str, value: Any) -> float:
    """Return a finite number that is not negative. Raises ValueError for any other."""
    if not 0 <= number(name, value) < np.inf:
        raise ValueError(f"{name} is {value!r}; it must be a number of at least 0")
    return float(value)


def between(name: str, value: Any, low: float, high: float) -> float:
    """Return a number between two others. Raises ValueError for any other."""
    if not low < number(name, value) < high:
        raise ValueError(f"{name} is {value!r}; it must lie between {low:g} and {high:g}")
    return float(value)


def two(name: str, value: Any) -> tuple[float, float]:
    """Return two finite numbers, the first the smaller. Raises ValueError for anything else."""
    try:
        low, high = (number(name, each) for each in value)
    except (TypeError, ValueError):
        low, high = np.inf, -np.inf
    if not -np.inf < low < high < np.inf:
        raise ValueError(f"{name} is {shown(value)}; it must be two finite numbers, the first the smaller")
    return low, high


def whole(name: str, value: Any, least: int = 1) -> int:
    """Return a whole number that is large enough. Raises ValueError for any other."""
    counts = isinstance(value, int | np.integer) and not isinstance(value, bool | np.bool_)
    if not (counts and value >= least):
        raise ValueError(f"{name} is {value!r}; it must be a whole number of at least {least}")
    return int(value)


def one_of(name: str, value: Any, known: Collection[str]) -> str:
    """Return a text that is among the known ones. Raises ValueError for any other."""
    if value not in known:
        raise ValueError(f"{name} is {value!r}; it must be one of {', '.join(known)}")
    return str(value)


def named(name: str, value: Any, what: str) -> Mapping[str, Any]:
    """Return a mapping whose keys are lines of text, none of them empty. Raises ValueError for any other."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) and key for key in value):
        raise ValueError(f"{name} is {value!r}; it must give {what} by their names")
    for key in value:
        line(f"a name in {name}", key)
    return value
