"""A report: sections computed one by one and kept, put together on one page with a summary in front."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from reports.errors import InputError
from reports.files import writable, write
from reports.pages.section import Section, Tell

PAGE, FIGURES, KEPT = "README.md", "figures", "sections"
"""The page, and the folders of its figures and of what each section said."""

DPI = 150

Said = dict[str, dict[str, Any]]
"""What the sections said, by name: title, numbers, rows, text."""


@dataclass(frozen=True, kw_only=True)
class Report:
    """The report of a name: a package of that name with `introduction.md` and a module for each section.

    sections: the modules, each with a function `section`, in the order of the page. `summary` makes what
    follows the introduction out of what the sections said.
    """

    name: str
    sections: tuple[str, ...]
    summary: Callable[[Said], str]

    def ready(self, folder: Path) -> Path:
        """Make the folders of a page and return the first. Raises InputError where a page cannot go there."""
        for place in (folder, folder / FIGURES, folder / KEPT):
            writable(place)
        allowed = "it must be a directory for this report alone"
        page, begin = folder / PAGE, self.introduction()[:40]
        if page.exists() and not (page.is_file() and page.read_bytes().startswith(begin.encode())):
            raise InputError("--out", f'is "{folder}", whose {PAGE} is not a page of this report', allowed)
        try:
            self.assembled(folder)
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            raise InputError("--out", f'is "{folder}", whose {KEPT} are damaged', allowed) from error
        return folder

    def make(self, folder: Path, names: Sequence[str], tell: Tell) -> Path:
        """Compute some sections into a folder, each kept as soon as it is done, and write the page."""
        for name in names:

            def told(what: str, name: str = name) -> None:
                tell(f"{name}: {what}")

            keep(folder, name, computed(self.name, name, told))
            self.assemble(folder)
        return folder / PAGE

    def kept(self, folder: Path) -> Said:
        """Return what the sections in a folder said, in the order of the page."""
        files = {name: folder / KEPT / f"{name}.json" for name in self.sections}
        return {name: json.loads(file.read_text("utf-8")) for name, file in files.items() if file.exists()}

    def assemble(self, folder: Path) -> None:
        """Write the page from what its sections said."""
        text = self.assembled(folder)
        write(folder, {PAGE: lambda part: part.write_text(text, "utf-8")})

    def assembled(self, folder: Path) -> str:
        """Return the page from what its sections said."""
        said = self.kept(folder)
        parts = [self.introduction(), self.summary(said), self._contents(said)]
        parts += [
            f"## {self._number(name)}. {s['title']}\n\n{_with_figures(s['text'])}" for name, s in said.items()
        ]
        if missing := [name for name in self.sections if name not in said]:
            parts.append(f"Sections not computed yet: {', '.join(missing)}.")
        parts.append(
            f"*`orbitrace report {self.name}` computes this page, `--only SECTION` one section of it.*"
        )
        return "\n\n".join(part.strip() for part in parts if part) + "\n"

    def introduction(self) -> str:
        """Return what the page begins with."""
        return resources.files(f"reports.{self.name}").joinpath("introduction.md").read_text("utf-8")

    def _contents(self, said: Said) -> str:
        return "\n".join(f"{self._number(name)}. {section['title']}" for name, section in said.items())

    def _number(self, name: str) -> int:
        """The number of a section on the whole page, whichever others are there."""
        return self.sections.index(name) + 1


def computed(report: str, name: str, tell: Tell) -> Section:
    """Compute one section of a report by its module."""
    section = importlib.import_module(f"reports.{report}.{name}").section(tell)
    assert isinstance(section, Section)
    return section


def keep(folder: Path, name: str, section: Section) -> None:
    """Write the figures of a section and what it says."""
    rows = [row.kept() for row in section.rows]
    said = {"title": section.title, "numbers": dict(section.numbers), "rows": rows, "text": section.text}
    text = json.dumps(said, indent=1, ensure_ascii=False) + "\n"
    for place in (FIGURES, KEPT):
        writable(folder / place)
    drawings = {f"{title}.png": partial(_draw, figure) for title, figure in section.figures.items()}
    write(folder / FIGURES, drawings)
    write(folder / KEPT, {f"{name}.json": lambda part: part.write_text(text, "utf-8")})


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])


def _draw(figure: Figure, path: Path) -> None:
    FigureCanvasAgg(figure)
    # No version or date: the same figure is the same file.
    figure.savefig(path, format="png", dpi=DPI, metadata={"Software": None})


def _with_figures(text: str) -> str:
    """Give figures their folder, and their captions a place under them."""

    def shown(match: re.Match[str]) -> str:
        caption = " ".join(match[1].split())
        return f"![{caption}]({FIGURES}/{match[2]}.png)\n\n*{caption}*"

    return re.sub(r"!\[([^\]]*)\]\(([\w-]+)\.png\)", shown, text)
