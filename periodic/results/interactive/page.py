"""One HTML file of a branch: point at a place on it and see that orbit in time, phase plane and spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from periodic.orbit.layout import layout_of
from periodic.results.branch import Branch
from periodic.results.interactive.content import content
from periodic.results.interactive.library import write
from periodic.results.interactive.mapped import map_content
from periodic.results.interactive.pictures import Showable, pictured
from periodic.results.plots.units import Units
from periodic.results.point import Point
from periodic.system import System, check_system

if TYPE_CHECKING:
    import xarray as xr


def page(
    branch: Branch | xr.Dataset | Showable,
    path: str | Path,
    *,
    system: System | None = None,
    title: str = "",
    units: Units | None = None,
    notes: Mapping[Point, str] | None = None,
) -> Path:
    """Write a branch, a map, an atlas or a torus to one HTML file in which it can be looked at.

    Pointing at the branch (or the keys left and right, or a finger) shows the orbit there: its motion over a
    period, the phase plane, the spectrum and the Floquet multipliers beside the unit circle; with its system
    also loads and other outputs, and a drawing of the parts that moves.

    Titles, names, units and labels are shown as they are, whatever is in them. The file runs its own two
    scripts and no other, and fetches nothing: its content security policy says so.

    Parameters
    ----------
    branch : Branch, xarray.Dataset, Atlas, Torus or TorusBranch
        The branch, or a curve in two parameters; one with more than 600 points is thinned out, special points
        kept. Or a map over one or two parameters, as `design_map` returns it, whose cells can be pointed at;
        an atlas, whose values can; tori, of which with their system also motion and spectrum are shown.
    path : str or Path
        The file, which ends in .html; one that is there is replaced.
    system : System, optional
        The system that was traced: it has the outputs that are no states, and the drawing.
    title : str
        What stands above it.
    units : dict, optional
        Units by names, as for `plot`: ``{"speed": "rev/min", "x": "um"}``.
    notes : dict of Point to str, optional
        What else is said of points of the branch, as "proven, stable" of what `proved` has proven: these are
        marked with a tick and what is said stands beside their numbers.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ValueError
        For a branch without points or of another system, a map of more parameters, a name that does not end
        in .html, a title that is no text, units and notes of what the branch has not.
    ModuleNotFoundError
        Without plotly or jinja2: ``pip install 'orbitrace[html]'``.
    OSError
        Where the file cannot be written.
    """
    file = Path(path)
    if system is not None:
        check_system(system)
    if not isinstance(branch, Branch):
        return _of_another(branch, file, title, system)
    if not len(branch):
        raise ValueError(f"the branch has no points to show; it ended with: {branch.stop}")
    if system is not None:
        branch[0].orbit.expressed_in(layout_of(system), "branch")
    _check_notes(branch, notes or {})
    shown = content(branch, units or {}, system, notes)
    return write("page", file, title or f"Branch over {branch.parameter}", shown)


def _of_another(shown: Any, file: Path, title: str, system: System | None) -> Path:
    """Write the page of what is no branch."""
    if isinstance(shown, Showable):
        return write("pictures", file, title or type(shown).__name__, pictured(shown.shown(system)))
    if not hasattr(shown, "data_vars"):
        raise ValueError(f"branch is {shown!r}; it must be a Branch, as periodic.trace returns it")
    return write("map", file, title or "Map", map_content(shown))


def _check_notes(branch: Branch, notes: Mapping[Point, str]) -> None:
    for point, said in notes.items():
        if point not in branch.points:
            raise ValueError(f"notes has {point!r}; it must be a point of the branch")
        if not isinstance(said, str):
            raise ValueError(f"the note of {point!r} is {said!r}; it must be a text")
