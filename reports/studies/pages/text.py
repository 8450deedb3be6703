"""Texts from Jinja2 templates in Markdown: a name that is not there is an error, never an empty place."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

FIGURES = "figures"
"""The folder of a page's figures."""


def rendered(folder: Path, template: str, values: Mapping[str, Any]) -> str:
    """Return a template of a folder, or one that all pages share, with values put in.

    Numbers are formatted as in Python: {{ x | fmt(".3f") }}. Raises jinja2.UndefinedError for a name that has
    no value.
    """
    return _with_figures(_environment(folder).get_template(template).render(values)).strip()


def filled(text: str, values: Mapping[str, Any]) -> str:
    """Return a text that is a template itself with values put in."""
    return _environment(Path(__file__).parent).from_string(text).render(values)


def holds(condition: str, values: Mapping[str, Any]) -> bool:
    """Return whether an expression of the templates' language holds for values."""
    found = _environment(Path(__file__).parent).compile_expression(condition, undefined_to_none=False)
    return bool(found(values))


class _Missing(StrictUndefined):
    """A name without a value, which cannot be formatted either."""

    def __format__(self, form: str) -> str:
        return str(self)


@cache
def _environment(folder: Path) -> Environment:
    found = Environment(
        loader=FileSystemLoader((folder, Path(__file__).parent)),
        undefined=_Missing,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.filters["fmt"] = format
    return found


def _with_figures(text: str) -> str:
    """Give figures their folder, and their captions a place under them."""

    def shown(match: re.Match[str]) -> str:
        caption = " ".join(match[1].split())
        return f"![{caption}]({FIGURES}/{match[2]}.png)\n\n*{caption}*"

    return re.sub(r"!\[([^\]]*)\]\(([\w-]+)\.png\)", shown, text)
