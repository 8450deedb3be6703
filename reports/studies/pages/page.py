"""A page: sections computed one by one and kept, told by their templates, with an introduction in front."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from jinja2 import UndefinedError
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from reports.app.files import writable, write
from reports.studies.pages.content import Kept, Section, Tell
from reports.studies.pages.engine import current, sources
from reports.studies.pages.text import FIGURES, rendered
from symbolic.scenes.errors import InputError

PAGE, KEPT = "README.md", "sections"
"""The page, and the folder of what is kept of each section."""

INTRODUCTION, WHOLE = "introduction.md.j2", "page.md.j2"
"""The template of what a page begins with, its own, and that of the whole page, shared."""

DPI = 150

UNFIT = (OSError, ValueError, KeyError, TypeError, AttributeError, UndefinedError)
"""What the text of a page raises where kept data are not those of its templates."""

Sections = Mapping[str, Kept]
"""What is kept of sections, by name, in the order of the page."""


def nothing(_: Sections) -> Mapping[str, Any]:
    """Return no further values."""
    return {}


@dataclass(frozen=True, kw_only=True)
class Page:
    """The page of a study.

    folder: that of the study's templates and, unless another is asked for, of the page. sections: by name,
    in the order of the page. The introduction's template is given `kept`, what is kept of the sections, and
    what `context` makes of that.
    """

    name: str
    folder: Path
    sections: Mapping[str, Section]
    context: Callable[[Sections], Mapping[str, Any]] = nothing

    def ready(self, folder: Path, names: Collection[str] = ()) -> Path:
        """Make the folders of a page of which some sections are to be computed, and return the first.

        Raises InputError where a page cannot go there or another section's kept data are not those of its
        template.
        """
        for place in (folder, folder / FIGURES, folder / KEPT):
            writable(place)
        page, begin = folder / PAGE, (self.folder / INTRODUCTION).read_bytes()[:40]
        if page.exists() and not (page.is_file() and page.read_bytes().startswith(begin)):
            allowed = "it must be a directory for this report alone"
            raise InputError("--out", f'is "{folder}", whose {PAGE} is not a page of this report', allowed)
        try:
            self.text(folder, names)
        except UNFIT as error:
            what = f'is "{folder}", whose {KEPT} are damaged ({error})'
            raise InputError("--out", what, "they must be those of this report, or be removed") from error
        return folder

    def make(self, folder: Path, names: Iterable[str], tell: Tell) -> Path:
        """Compute some sections into a folder, each kept as soon as it is done, and write the page.

        What was kept of the others before stays on the page, if its template can still tell it. Raises
        InputError if the engine's sources change while a section is computed; that one is not kept.
        """
        names = tuple(names)
        for done, name in enumerate(names, 1):

            def told(what: str, name: str = name) -> None:
                tell(f"{name}: {what}")

            engine, begun = current(), spent()
            found = self.sections[name].compute(told)
            if sources() != engine.sources:
                what = f"changed while section {name} was computed, which is not kept"
                raise InputError(
                    "periodic/ or symbolic/", what, "they must stay as they are until it is done"
                )
            keep(folder, name, found.kept(engine, round(spent() - begun, 1)), found.figures)
            self.write(folder, self.unfit(folder, names[done:]))
        if not names:
            self.write(folder)
        return folder / PAGE

    def unfit(self, folder: Path, names: Collection[str]) -> Collection[str]:
        """Return those of some sections without which alone the page can be told: none or all."""
        try:
            self.text(folder)
        except UNFIT:
            return names
        return ()

    def stale(self, folder: Path, now: str = "") -> list[str]:
        """Return the sections that no engine with these sources, by default those here, has computed.

        Quickest first, as far as it is known what they take.
        """
        kept, now = self.kept(folder), now or sources()

        def cost(name: str) -> float:
            seconds = kept[name].seconds if name in kept else None
            return float("inf") if seconds is None else seconds

        return sorted((name for name in self.sections if not made_by(kept.get(name), now)), key=cost)

    def kept(self, folder: Path) -> dict[str, Kept]:
        """Return what is kept of the sections in a folder, in the order of the page."""
        files = {name: folder / KEPT / f"{name}.json" for name in self.sections}
        return {name: Kept.read(file.read_text("utf-8")) for name, file in files.items() if file.exists()}

    def write(self, folder: Path, without: Collection[str] = ()) -> None:
        """Write the page from what is kept of its sections, without some."""
        text = self.text(folder, without)
        write(folder, {PAGE: lambda part: part.write_text(text, "utf-8")})

    def text(self, folder: Path, without: Collection[str] = ()) -> str:
        """Return the page from what is kept of its sections, without some."""
        kept = {name: found for name, found in self.kept(folder).items() if name not in without}
        numbered = {name: number for number, name in enumerate(self.sections, 1)}
        sections = [
            {
                "number": numbered[name],
                "title": self.sections[name].title,
                "text": self.told(name, found),
                "by": found.by,
            }
            for name, found in kept.items()
        ]
        values = {
            "name": self.name,
            "names": list(self.sections),
            "introduction": rendered(self.folder, INTRODUCTION, {"kept": kept, **self.context(kept)}),
            "sections": sections,
            "missing": [name for name in self.sections if name not in kept],
        }
        return rendered(self.folder, WHOLE, values) + "\n"

    def told(self, name: str, kept: Kept) -> str:
        """Return the text of a section."""
        section = self.sections[name]
        values = {"n": kept.numbers, "rows": kept.rows, **section.context(kept)}
        return rendered(self.folder, section.template or f"{name}.md.j2", values)


def made_by(kept: Kept | None, now: str) -> bool:
    """Return whether a section is there and of an engine with these sources."""
    return kept is not None and kept.engine is not None and kept.engine.sources == now


def keep(folder: Path, name: str, kept: Kept, figures: Mapping[str, Figure]) -> None:
    """Write the figures of a section, and its numbers and rows."""
    text = kept.written()
    for place in (FIGURES, KEPT):
        writable(folder / place)
    drawings = {f"{title}.png": partial(_draw, figure) for title, figure in figures.items()}
    write(folder / FIGURES, drawings)
    write(folder / KEPT, {f"{name}.json": lambda part: part.write_text(text, "utf-8")})


def spent() -> float:
    """Return the processor time (s) that this process and those it has waited for have taken."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _draw(figure: Figure, path: Path) -> None:
    FigureCanvasAgg(figure)
    # No version or date: the same figure is the same file.
    figure.savefig(path, format="png", dpi=DPI, metadata={"Software": None})
