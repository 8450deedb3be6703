"""The first match of a model with what was measured: branches traced, each point on its nearest sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from periodic.decisions.fitting.match import Foot, Match, Single, Spot
from periodic.decisions.fitting.measured import Measured, MeasuredQuantity
from periodic.decisions.responses.feature import Count, LostError, Way
from periodic.decisions.responses.quantity import AbsentError
from periodic.decisions.responses.readquantities import traced
from periodic.decisions.responses.words import called
from periodic.results.branch import Branch
from periodic.system import System

TRIES = 4
"""Of how many motions, the nearest first, Newton's method may start towards a measured point."""

Sensors = tuple[tuple[str, str], ...]
"""Names of gain and offset of each functional of a set of points, empty where they are known."""


def sensors_of(data: Sequence[Measured | MeasuredQuantity]) -> list[Sensors]:
    """Return the names of the sensors' unknown gains and offsets, for each of the data."""
    found: list[Sensors] = []
    for k, each in enumerate(data):
        if isinstance(each, MeasuredQuantity):
            found.append(())
            continue
        tests = [other for other in data if isinstance(other, Measured) and other.name == each.name]
        name = each.name if len(tests) == 1 else f"{each.name} {k}"
        found.append(
            tuple(
                (
                    f"gain of {called(f)}, {name}" if each.gain else "",
                    f"offset of {called(f)}, {name}" if each.offset else "",
                )
                for f in each.values
            )
        )
    return found


def matched(
    system: System,
    data: Sequence[Measured | MeasuredQuantity],
    values: Mapping[str, float],
    free: Sequence[str],
    count: Count,
) -> tuple[Match, tuple[Branch, ...]]:
    """Return the motions nearest to all data on branches traced at given values, and the branches.

    Raises AbsentError for a branch that has nothing near.
    """
    own = {name: values[name] for name in free}
    parts: list[Foot | Single] = []
    branches: list[Branch] = []
    for each, sensors in zip(data, sensors_of(data), strict=True):
        if isinstance(each, MeasuredQuantity):
            reading = traced(system, [each.quantity], own, count)
            parts.append(Single(each, reading.decisive[0]))
            branches += reading.branches
            continue
        begun = [Spot(each, k, sensors, values) for k in range(len(each.places))]
        nearest = {f"nearest to point {k}": spot.misfit for k, spot in enumerate(begun)}
        branch = each.response.traced(system, own, nearest)
        count.orbits += len(branch)
        if not branch.points:
            raise AbsentError(f"the branch over {branch.parameter} has no points: {branch.ending}")
        way = each.response.way(system, count)
        parts += [_foot(spot, way, branch, label, own) for spot, label in zip(begun, nearest, strict=True)]
        branches.append(branch)
    return Match(dict(values), tuple(free), tuple(parts)), tuple(branches)


def _foot(spot: Spot, way: Way, branch: Branch, label: str, values: Mapping[str, float]) -> Foot:
    """The motion of a branch that is nearest to a measured point. Raises AbsentError.

    The branch has points where the misfit is stationary along it. Beyond its ends, or where two such places
    lie within one step, Newton's method leads there from the points that are nearest.
    """
    misfit = spot.misfit
    size = {id(point): misfit(way.system, point.orbit) for point in branch}
    order = sorted(branch, key=lambda point: size[id(point)])
    located = [point for point in order if point.event == label]
    if located and located[0] is order[0]:
        return Foot(spot, way, located[0])
    said = ""
    for point in order[:TRIES]:
        try:
            found = Foot(spot, way, point).moved(values)
        except LostError as error:
            said = said or str(error)
            continue
        if not located or misfit(way.system, found.point.orbit) < size[id(located[0])]:
            return found
    if located:
        return Foot(spot, way, located[0])
    raise AbsentError(said)
