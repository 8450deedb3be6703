"""What a section of a page is: what computes it, what is kept of that, and what its template is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from matplotlib.figure import Figure

Tell = Callable[[str], None]
"""Told in a few words what is being worked on."""


@dataclass(frozen=True, kw_only=True)
class Kept:
    """What is kept of a section, as in its file: all that its text is made of."""

    numbers: dict[str, Any]
    rows: list[dict[str, Any]]


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a section computes.

    numbers: key numbers, in the unit that each name ends with; a test recomputes them. rows: of its tables,
    ready for JSON. figures: by name; the template shows one as ![caption](NAME.png).
    """

    numbers: Mapping[str, float]
    rows: Sequence[Mapping[str, Any]] = ()
    figures: Mapping[str, Figure] = field(default_factory=dict)

    def kept(self) -> Kept:
        """Return what is kept of it."""
        return Kept(numbers=dict(self.numbers), rows=[dict(row) for row in self.rows])


def nothing(_: Kept) -> Mapping[str, Any]:
    """Return no further values."""
    return {}


@dataclass(frozen=True, kw_only=True)
class Section:
    """A section of a page.

    Its template is given `n`, the kept numbers, `rows`, the kept rows, and what `context` returns: constants
    of the section and what follows from the kept data. `template` is by default the section's own,
    NAME.md.j2.
    """

    title: str
    compute: Callable[[Tell], Found]
    context: Callable[[Kept], Mapping[str, Any]] = nothing
    template: str = ""
