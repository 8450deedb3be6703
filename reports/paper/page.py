"""The page: sections computed one by one and kept, put together with the table of all rows in front."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from reports.errors import InputError
from reports.files import writable, write
from reports.paper.section import Section, Tell

SECTIONS = ("method", "timedomain", "damping", "frequency", "supports", "filmlaws", "unseen", "regions")
"""Modules with a function `section`, in the order of the page."""

PAGE, FIGURES, KEPT = "README.md", "figures", "sections"
"""The page, and the folders of its figures and of what each section said."""

DPI = 150

COLUMNS = ("", "quantity", "paper", "ours", "difference", "verdict", "how ours was checked")


def ready(folder: Path) -> Path:
    """Make the folders of a page and return the first. Raises InputError where a page cannot go there."""
    for place in (folder, folder / FIGURES, folder / KEPT):
        writable(place)
    allowed = "it must be a directory for this report alone"
    page = folder / PAGE
    if page.exists() and not (page.is_file() and page.read_text("utf-8").startswith(_introduction()[:40])):
        raise InputError("--out", f'is "{folder}", whose {PAGE} is not a page of this report', allowed)
    try:
        assemble_text(folder)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError("--out", f'is "{folder}", whose {KEPT} are damaged', allowed) from error
    return folder


def make(folder: Path, names: Sequence[str], tell: Tell) -> Path:
    """Compute some sections into a folder, each kept as soon as it is done, and write the page."""
    for name in names:

        def told(what: str, name: str = name) -> None:
            tell(f"{name}: {what}")

        keep(folder, name, computed(name, told))
        assemble(folder)
    return folder / PAGE


def computed(name: str, tell: Tell) -> Section:
    """Compute one section by its module."""
    section = importlib.import_module(f"reports.paper.{name}").section(tell)
    assert isinstance(section, Section)
    return section


def keep(folder: Path, name: str, section: Section) -> None:
    """Write the figures of a section and what it says."""
    rows = [asdict(replace(row, given=None)) | {"verdict": row.verdict} for row in section.rows]
    said = {"title": section.title, "numbers": dict(section.numbers), "rows": rows, "text": section.text}
    text = json.dumps(said, indent=1, ensure_ascii=False) + "\n"
    for place in (FIGURES, KEPT):
        writable(folder / place)
    drawings = {f"{title}.png": partial(_draw, figure) for title, figure in section.figures.items()}
    write(folder / FIGURES, drawings)
    write(folder / KEPT, {f"{name}.json": lambda part: part.write_text(text, "utf-8")})


def _draw(figure: Figure, path: Path) -> None:
    FigureCanvasAgg(figure)
    # No version or date: the same figure is the same file.
    figure.savefig(path, format="png", dpi=DPI, metadata={"Software": None})


def kept(folder: Path) -> dict[str, dict[str, Any]]:
    """Return what the sections in a folder said, in the order of the page."""
    files = {name: folder / KEPT / f"{name}.json" for name in SECTIONS}
    return {name: json.loads(file.read_text("utf-8")) for name, file in files.items() if file.exists()}


def assemble(folder: Path) -> None:
    """Write the page from what its sections said."""
    text = assemble_text(folder)
    write(folder, {PAGE: lambda part: part.write_text(text, "utf-8")})


def assemble_text(folder: Path) -> str:
    """Return the page from what its sections said."""
    said = kept(folder)
    rows = [row for section in said.values() for row in section["rows"]]
    parts = [_introduction(), _table(rows), _contents(said)]
    parts += [f"## {_number(name)}. {s['title']}\n\n{_with_figures(s['text'])}" for name, s in said.items()]
    if missing := [name for name in SECTIONS if name not in said]:
        parts.append(f"Sections not computed yet: {', '.join(missing)}.")
    parts.append("*`orbitrace report paper` computes this page, `--only SECTION` one section of it.*")
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _introduction() -> str:
    return resources.files("reports.paper").joinpath("introduction.md").read_text("utf-8")


def _table(rows: list[dict[str, Any]]) -> str:
    rows = sorted(
        rows, key=lambda row: [int(t) if t.isdigit() else t for t in re.split(r"(\d+)", row["key"])]
    )
    lines = [f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        difference = "" if row["difference"] is None else f"{100 * row['difference']:+.1f} %"
        cells = (row["key"], row["what"], row["paper"], row["ours"], difference, row["verdict"], row["check"])
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _contents(said: dict[str, dict[str, Any]]) -> str:
    return "\n".join(f"{_number(name)}. {section['title']}" for name, section in said.items())


def _number(name: str) -> int:
    """The number of a section on the whole page, whichever others are there."""
    return SECTIONS.index(name) + 1


def _with_figures(text: str) -> str:
    """Give figures their folder, and their captions a place under them."""

    def shown(match: re.Match[str]) -> str:
        caption = " ".join(match[1].split())
        return f"![{caption}]({FIGURES}/{match[2]}.png)\n\n*{caption}*"

    return re.sub(r"!\[([^\]]*)\]\(([\w-]+)\.png\)", shown, text)
