"""Everything over a parameter: branches joined, shares of basins, what is seen from many starts beneath."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from periodic.checks import one_of, two, whole
from periodic.correction.tolerance import Accuracy
from periodic.display.htmltables import with_unit
from periodic.display.meter import meter
from periodic.orbit.layout import layout_of
from periodic.phasespace.atlases.chart import Chart
from periodic.phasespace.atlases.charted import Atlas
from periodic.phasespace.search.search import search_of
from periodic.phasespace.search.stages import SearchInterrupted
from periodic.system import System, index_of

SETTLE = 1000
"""Most periods that a motion is followed."""


def atlas(
    system: System,
    parameter: str,
    bounds: tuple[float, float],
    values: Mapping[str, float] | None = None,
    *,
    box: Mapping[str, tuple[float, float]] | None = None,
    state: str | None = None,
    count: int = 21,
    diagram: int = 200,
    periods: int = 4,
    starts: int = 64,
    places: int = 16,
    tol: float = Accuracy.STANDARD,
) -> Atlas:
    """Return what an excited system can do over a parameter.

    At `count` values all motions are looked for as `motions` does. The branch of each orbit that is on no
    known one is traced through the whole range, those of stable orbits first; of unstable ones only a few.
    Shares of the box are those of the starts at each value.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    parameter : str
        The parameter.
    bounds : tuple of float
        Its range (SI).
    values : mapping of str to float, optional
        Other parameters (SI) that differ from their nominal values.
    box : mapping of str to (float, float), optional
        Ranges of states (SI) in which motions start, as in `motions`; by default that of the lower end.
    state : str, optional
        The state that the picture shows at tau = 0; by default the first.
    count : int
        Values at which motions are looked for.
    diagram : int
        Values of the diagram beneath, of motions from a few starts each.
    periods, starts, places, tol
        As in `motions`.

    Returns
    -------
    Atlas
        Branches, shares, diagram.

    Raises
    ------
    ValueError
        For what is not allowed.
    SearchInterrupted
        For Ctrl-C: its `found` is the atlas of the values that were done.
    """
    index_of(system, parameter)
    low, high = two("bounds", bounds)
    if parameter in (values or {}):
        raise ValueError(f"values has {parameter!r}, over which the atlas is; it must be left out")
    whole("diagram", diagram, 2)
    names = [each.name for each in system.states]
    column = names.index(names[0] if state is None else one_of("state", state, names))
    at = np.linspace(low, high, whole("count", count, 2))
    first = search_of(
        system, {**(values or {}), parameter: low}, box, periods, starts, SETTLE, places, 0, tol
    )
    if first.frequency:
        raise ValueError("the system is not excited: its equations do not depend on the phase; they must")
    chart = Chart(first, parameter, at)
    try:
        with meter(f"atlas over {parameter}", "values", 2 * len(at) + diagram) as show:
            chart.run(np.linspace(low, high, diagram), column, show)
    except KeyboardInterrupt:
        if not chart.motions:
            raise
        found = _drawn(chart, column)
        raise SearchInterrupted(found, f"the atlas of {len(found.values)} values so far is") from None
    return _drawn(chart, column)


def _drawn(chart: Chart, column: int) -> Atlas:
    """What a chart has so far."""
    system, done = chart.first.crowd.system, len(chart.motions)
    place, name = index_of(system, chart.parameter), system.states[column].name
    sheets = [replace(s, sections=s.sections[:done], shares=s.shares[:, :done]) for s in chart.sheets]
    return Atlas(
        chart.parameter,
        name,
        with_unit(chart.parameter, system.parameters[place].unit),
        with_unit(f"{name} at tau = 0", layout_of(system).column(name).unit),
        chart.at[:done],
        tuple(chart.motions),
        tuple(sheets),
        np.concatenate([np.zeros((0, 2)), *chart.dots]),
        chart.remarks,
    )
