"""What every page is filled with: its own data and the library that draws, in one file."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

EXTRA = "pip install 'orbitrace[html]'"
"""What installs the library that draws."""


def write(template: str, file: Path, title: str, data: Mapping[str, Any]) -> Path:
    """Write a page: a template of this folder with a title, data and the library in it.

    Raises ValueError for a name that does not end in .html, ModuleNotFoundError without plotly.
    """
    if file.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"path is {str(file)!r}; it must be a file that ends in .html")
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    filled = {
        "TITLE": html.escape(title),
        "STYLE": _resource("style.css"),
        "DATA": text.replace("</", "<\\/"),
        "LIBRARY": _plotly(),
    }
    page = _resource(template)
    for key, value in filled.items():
        page = page.replace(f"@@{key}@@", value)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(page, "utf-8")
    return file


def _resource(name: str) -> str:
    return resources.files("periodic.results.interactive").joinpath(name).read_text("utf-8")


def _plotly() -> str:
    """Plotly's JavaScript."""
    try:
        from plotly.offline import get_plotlyjs
    except ModuleNotFoundError:
        raise ModuleNotFoundError(f"a page needs the package plotly: {EXTRA}", name="plotly") from None
    return str(get_plotlyjs())
