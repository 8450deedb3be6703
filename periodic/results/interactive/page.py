"""One HTML file of a branch: point at a place on it and see that orbit in time, phase plane and spectrum."""

from __future__ import annotations

import html
import json
from importlib import resources
from pathlib import Path

from periodic.results.branch import Branch
from periodic.results.interactive.content import content

EXTRA = "pip install 'orbitrace[html]'"
"""What installs the library that draws."""


def page(
    branch: Branch, path: str | Path, *, title: str = "", units: dict[str, tuple[str, float]] | None = None
) -> Path:
    """Write a branch to one HTML file in which its orbits can be looked at.

    Pointing at the branch (or the keys left and right, or a finger) shows the orbit there: its motion over a
    period, the phase plane, the spectrum and the Floquet multipliers beside the unit circle.

    Parameters
    ----------
    branch : Branch
        The branch; one with more than 600 points is thinned out, special points kept.
    path : str or Path
        The file, which ends in .html; one that is there is replaced.
    title : str
        What stands above it.
    units : dict of str to (str, float), optional
        Units to show quantities in, by name: ``{"speed": ("rev/min", 2 * pi / 60), "x": ("µm", 1e-6)}``, each
        with its SI value.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ValueError
        For a branch without points, a name that does not end in .html, and units of what the branch has not.
    ModuleNotFoundError
        Without plotly: ``pip install 'orbitrace[html]'``.
    OSError
        Where the file cannot be written.
    """
    if not isinstance(branch, Branch):
        raise ValueError(f"branch is {branch!r}; it must be a Branch, as periodic.trace returns it")
    file = Path(path)
    if file.suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"path is {str(path)!r}; it must be a file that ends in .html")
    if not len(branch):
        raise ValueError(f"the branch has no points to show; it ended with: {branch.stop}")
    data = json.dumps(content(branch, units or {}), allow_nan=False, separators=(",", ":"))
    name = title or f"Branch over {branch.parameter}"
    filled = {
        "TITLE": html.escape(name),
        "DATA": data.replace("</", "<\\/"),
        "LIBRARY": _library(),
    }
    text = resources.files("periodic.results.interactive").joinpath("page.html").read_text("utf-8")
    for key, value in filled.items():
        text = text.replace(f"@@{key}@@", value)
    file.write_text(text, "utf-8")
    return file


def _library() -> str:
    """Plotly's JavaScript."""
    try:
        from plotly.offline import get_plotlyjs
    except ModuleNotFoundError:
        raise ModuleNotFoundError(f"a page needs the package plotly: {EXTRA}", name="plotly") from None
    return str(get_plotlyjs())
