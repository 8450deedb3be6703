"""The page of a branch: one HTML file that shows the orbit pointed at, in the units of its scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from symbolic.scenes.errors import InputError
from symbolic.scenes.schema import Scene

if TYPE_CHECKING:
    from periodic import Branch, Point


def check_html() -> None:
    """Raise InputError where a package is missing that makes the page."""
    from periodic.results.interactive.library import EXTRA, missing

    if lacking := missing():
        raise InputError("--html", f"needs the package {lacking[0]}", f"{EXTRA} installs it")


def write_page(path: Path, scene: Scene, branch: Branch, notes: Mapping[Point, str] | None = None) -> None:
    """Write the page of a branch, with notes beside points of it."""
    import periodic as per
    from symbolic.scenes.building import build

    from ..view import MICRO, view_of

    view = view_of(scene)
    known = {quantity.name for quantity in branch.layout.outputs}
    units = {name: ("µm", MICRO) for name in view.micro if name in known}
    if view.unit_name:
        units[view.parameter] = (view.unit_name, view.unit)
    # A page is written under a name that ends in .html.
    place = path.with_suffix(".html")
    page = per.page(branch, place, system=build(scene), title=scene.title, units=units, notes=notes)
    page.replace(path)
