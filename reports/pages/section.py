"""What a section of a report is: Markdown, figures, key numbers, and the rows of its tables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from matplotlib.figure import Figure

Tell = Callable[[str], None]
"""Told in a few words what is being worked on."""


class Line(Protocol):
    """A row of a table."""

    def kept(self) -> dict[str, Any]:
        """Return what is kept of it, ready for JSON."""


@dataclass(frozen=True, kw_only=True)
class Section:
    """A section of the page. `text` refers to a figure of the name NAME as ![caption](NAME.png).

    `numbers` are the key numbers, in the unit that each name ends with; a test recomputes them.
    """

    title: str
    text: str
    numbers: Mapping[str, float]
    rows: Sequence[Line] = ()
    figures: Mapping[str, Figure] = field(default_factory=dict)
