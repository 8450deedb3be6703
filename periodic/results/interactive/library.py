"""What every page is filled with: its own data and the library that draws, in one file.

The templates of this folder are filled in by Jinja2 in one pass: what is put in is not looked at again, texts
are escaped, and data are JSON in which no tag can begin. The page's content security policy lets its own two
scripts run, by their hashes, and nothing else.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jinja2 import Environment

EXTRA = "pip install 'orbitrace[html]'"
"""What installs the packages that make pages."""

NEEDED = ("jinja2", "plotly")
"""These packages: one fills pages in, the other draws in them."""


def missing() -> list[str]:
    """Return which packages that make pages are not installed."""
    return [name for name in NEEDED if find_spec(name) is None]


def write(template: str, file: Path, title: str, data: Mapping[str, Any]) -> Path:
    """Write a page: a template of this folder with a title, data and the library in it.

    Parameters
    ----------
    template : str
        "page", "map" or "pictures": the stem of a template and of its script.
    file : Path
        The file.
    title : str
        What stands above it.
    data : dict
        What the script is given, as JSON.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ValueError
        For a name that does not end in .html, and a title that is no text.
    ModuleNotFoundError
        Without jinja2 or plotly.
    """
    if file.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"path is {str(file)!r}; it must be a file that ends in .html")
    check_title(title)
    if lacking := missing():
        raise ModuleNotFoundError(f"a page needs the package {lacking[0]}: {EXTRA}", name=lacking[0])
    page = _filled(f"{template}.html", f"{template}.js", title, data)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(page, "utf-8")
    return file


def check_title(title: object) -> None:
    """Raise ValueError for a title that cannot be written as UTF-8."""
    if not isinstance(title, str) or any("\ud800" <= letter <= "\udfff" for letter in title):
        raise ValueError(f"title is {title!r}; it must be a text of Unicode characters")


def _filled(template: str, script: str, title: str, data: Mapping[str, Any]) -> str:
    """Return the text of a page."""
    from markupsafe import Markup

    style, library = _resource("style.css"), _plotly()
    own = _resource("common.js") + _resource(script)
    return (
        _environment()
        .get_template(template)
        .render(
            title=title,
            data=data,
            policy=policy([library, own]),
            style=Markup(style),
            library=Markup(library),
            script=Markup(own),
        )
    )


def policy(scripts: list[str]) -> str:
    """Return the content security policy of a page with these scripts.

    They alone run, and cannot write markup; nothing is fetched. Plotly sets rules and attributes of style and
    draws heat maps as images in their own address: that it may.
    """
    allowed = {
        "default-src": "'none'",
        "script-src": " ".join(map(_hashed, scripts)),
        "style-src": "'unsafe-inline'",
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
        "require-trusted-types-for": "'script'",
    }
    return "; ".join(f"{what} {sources}" for what, sources in allowed.items())


def _hashed(text: str) -> str:
    """A text's hash, as a policy gives it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _environment() -> Environment:
    """The templates: everything is escaped that is not marked, a name without a value is an error."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    found = Environment(
        loader=FunctionLoader(_resource), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    found.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    return found


def _resource(name: str) -> str:
    return resources.files("periodic.results.interactive").joinpath(name).read_text("utf-8")


def _plotly() -> str:
    """Plotly's JavaScript, its line ends those of the text that a browser takes the hash of."""
    from plotly.offline import get_plotlyjs

    return str(get_plotlyjs()).replace("\r\n", "\n").replace("\r", "\n")
