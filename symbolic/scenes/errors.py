"""The one exception for bad input: a sentence that names the field, its value and what is allowed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from symbolic.quoting import LONGEST_QUOTE, shortened

HUGE = 10**LONGEST_QUOTE
"""Whole numbers from here on are not written out: Python refuses to convert the largest to text."""


class InputError(Exception):
    """Bad input: `field` and `what` was found there ("is -3"); `allowed` says what it must be."""

    def __init__(self, field: str, what: str, allowed: str) -> None:
        super().__init__(plain(f"{field} {what}; {allowed}"))
        self.field, self.what, self.allowed = field, what, allowed

    @classmethod
    def said(cls, sentence: str) -> InputError:
        """Return an error with a sentence that is complete already, as that of a ValueError.

        Parameters
        ----------
        sentence : str
            "what it is; what is allowed".

        Returns
        -------
        InputError
            With that sentence.
        """
        return ToldError(sentence)

    def renamed(self, names: Mapping[str, str]) -> InputError:
        """Return the error with fields under the names by which the user gave them.

        Parameters
        ----------
        names : mapping of str to str
            The user's names by field.

        Returns
        -------
        InputError
            The same error in the user's words.
        """
        field, allowed = self.field, self.allowed
        for old, new in names.items():
            field, allowed = new if field == old else field, allowed.replace(old, new)
        return InputError(field, self.what, allowed)


class ToldError(InputError):
    """Bad input whose whole message is a sentence given by the caller."""

    def __init__(self, sentence: str) -> None:
        Exception.__init__(self, plain(" ".join(sentence.split())))
        self.field, self.what, self.allowed = sentence, "", ""

    def renamed(self, names: Mapping[str, str]) -> InputError:
        """Return the error itself."""
        return self


def refused(field: str, value: Any, allowed: str) -> InputError:
    """Return the error of a value that is not among the `allowed`."""
    return InputError(field, f"is {shown(value)}", f"it must be {allowed}")


def shown(value: Any) -> str:
    """Return a value as a sentence shows it: on one line, texts in quotes, not too long."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, int) and abs(value) >= HUGE:
        return "a number of too many digits"
    text = cut(str(value).lower() if isinstance(value, bool) else " ".join(str(value).split()))
    return f'"{text}"' if isinstance(value, str) else text


def plain(text: str) -> str:
    """Return a text with control characters escaped, which a terminal would obey and not show."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def cut(text: str, longest: int = LONGEST_QUOTE) -> str:
    """Return the plain text, or as much of its beginning as is not too long."""
    return shortened(plain(text), longest)


def listed(names: Sequence[str], last: str = "or") -> str:
    """Return "a, b or c"."""
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
