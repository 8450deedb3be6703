"""The one exception for bad input: a sentence that names the field, its value and what is allowed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

LONGEST = 60
"""Values longer than this are cut in a sentence."""


class InputError(Exception):
    """Bad input: `field` and `what` was found there ("is -3"); `allowed` says what it must be."""

    def __init__(self, field: str, what: str, allowed: str) -> None:
        super().__init__(f"{field} {what}; {allowed}")
        self.field, self.what, self.allowed = field, what, allowed

    def renamed(self, names: Mapping[str, str]) -> InputError:
        """Return the error with fields under the names by which the user gave them."""
        field, allowed = self.field, self.allowed
        for old, new in names.items():
            field, allowed = new if field == old else field, allowed.replace(old, new)
        return InputError(field, self.what, allowed)


def refused(field: str, value: Any, allowed: str) -> InputError:
    """Return the error of a value that is not among the `allowed`."""
    return InputError(field, f"is {shown(value)}", f"it must be {allowed}")


def shown(value: Any) -> str:
    """Return a value as a sentence shows it: on one line, texts in quotes, not too long."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, list):
        return "a list"
    text = str(value).lower() if isinstance(value, bool) else " ".join(str(value).split())
    text = text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."
    return f'"{text}"' if isinstance(value, str) else text


def listed(names: Sequence[str], last: str = "or") -> str:
    """Return "a, b or c"."""
    return f" {last} ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
