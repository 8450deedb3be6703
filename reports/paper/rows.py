"""The rows of the first table: what the paper says beside ours, and the verdict."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from enum import Enum
from typing import Any

CLOSE, NEAR = 0.01, 0.05
"""Differences up to which a number counts as reproduced, and as reproduced within so many per cent."""


class Verdict(Enum):
    """What the comparison with the paper says."""

    REPRODUCED = "reproduced"
    WITHIN = "reproduced within"
    NOT_REPRODUCED = "not reproduced"
    NOT_COMPARABLE = "cannot be compared"


@dataclass(frozen=True, kw_only=True)
class Row:
    """One line of the first table: what the paper says, what we find, the verdict, how ours was checked.

    `difference` is relative, None where there is no number to compare; the verdict on a number follows
    from it unless one is given.
    """

    key: str
    what: str
    paper: str
    ours: str
    check: str
    difference: float | None = None
    given: Verdict | None = None

    @property
    def verdict(self) -> str:
        """The verdict in words."""
        if self.given is not None:
            return self.given.value
        if self.difference is None:
            return Verdict.NOT_COMPARABLE.value
        size = abs(self.difference)
        if size <= CLOSE:
            return Verdict.REPRODUCED.value
        if size <= NEAR:
            return f"{Verdict.WITHIN.value} {math.ceil(100 * size)} %"
        return Verdict.NOT_REPRODUCED.value

    def kept(self) -> dict[str, Any]:
        """Return what is kept of the row."""
        return asdict(replace(self, given=None)) | {"verdict": self.verdict}


def compared(
    key: str, what: str, paper: float, ours: float, unit: str, check: str, *, form: str = ".4g"
) -> Row:
    """Return the row of a number that the paper gives; values in the unit shown."""
    space = f" {unit}" if unit else ""
    return Row(
        key=key,
        what=what,
        paper=f"{paper:g}{space}",
        ours=f"{ours:{form}}{space}",
        check=check,
        difference=ours / paper - 1,
    )
