"""What a section of a page is: what computes it, what is kept of that, and what its template is given."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from matplotlib.figure import Figure

from reports.studies.pages.engine import Engine

Tell = Callable[[str], None]
"""Told in a few words what is being worked on."""


@dataclass(frozen=True, kw_only=True)
class Kept:
    """What is kept of a section, as in its file: all that its text is made of.

    engine: what computed it, in how many seconds of processor time; None where that was not recorded.
    """

    engine: Engine | None = None
    seconds: float | None = None
    numbers: dict[str, Any]
    rows: list[dict[str, Any]]

    @classmethod
    def read(cls, text: str) -> Kept:
        """Return what a file of a section holds."""
        found = json.loads(text)
        engine = found.pop("engine", None)
        return cls(**found, engine=None if engine is None else Engine(**engine))

    def written(self) -> str:
        """Return the text of its file."""
        return json.dumps(asdict(self), indent=1, ensure_ascii=False) + "\n"

    @property
    def by(self) -> str:
        """What computed it, in a sentence."""
        if self.engine is None:
            return "By an engine that was not recorded."
        if self.seconds is None:
            return f"By the {self.engine}."
        return (
            f"By the {self.engine}, in {self.seconds:.{0 if self.seconds > 10 else 1}f} s of processor time."
        )


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a section computes.

    numbers: key numbers, in the unit that each name ends with; a test recomputes them. rows: of its tables,
    ready for JSON. figures: by name; the template shows one as ![caption](NAME.png).
    """

    numbers: Mapping[str, float]
    rows: Sequence[Mapping[str, Any]] = ()
    figures: Mapping[str, Figure] = field(default_factory=dict)

    def kept(self, engine: Engine | None = None, seconds: float | None = None) -> Kept:
        """Return what is kept of it, computed by an engine in so much processor time."""
        rows = [dict(row) for row in self.rows]
        return Kept(engine=engine, seconds=seconds, numbers=dict(self.numbers), rows=rows)


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
