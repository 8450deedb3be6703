"""What is exported of a branch: numbers of each point, and its signals over one period, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from periodic.orbit.scheme import Array
from periodic.results import frames
from periodic.results.branch import Branch
from periodic.results.point import Point, multipliers_of

Quantities = dict[str, tuple[str, Array]]
"""Values by name, each with its unit."""


@dataclass(frozen=True, kw_only=True)
class Content:
    """What is exported; where there are no orbits, of equilibria, `times` and `signals` have no samples.

    numbers: one value a point, each shape (points,). labels: "LP" and others, or a user's event. times: (s),
    shape (points, samples), over one period, its end left out; signals: likewise. multipliers: shape (points,
    n), largest first, filled up with NaN.
    """

    parameter: str
    outputs: tuple[str, ...]
    stop: str
    program: str
    numbers: Quantities
    labels: tuple[str, ...]
    stable: NDArray[np.bool_]
    multipliers: NDArray[np.complex128]
    times: Array
    signals: Quantities


def content(branch: Branch, samples: int) -> Content:
    """Return what is exported of a branch, with so many samples of each orbit."""
    rows = [frames.row(branch, point) for point in branch]
    moving = len(branch) > 0 and not any(point.equilibrium for point in branch)
    names = branch.points[0].orbit.names if moving else ()
    parts = np.arange(samples if moving else 0) / samples
    times = np.array([point.orbit.period * parts if moving else parts for point in branch])
    return Content(
        parameter=branch.parameter,
        outputs=tuple(output.name for output in branch.layout.outputs),
        stop=str(branch.stop),
        program=f"orbitrace {version('orbitrace')}",
        numbers={
            name: (unit, np.array([row[name] for row in rows], dtype=float))
            for name, unit in frames.units(branch).items()
        },
        labels=tuple(point.event or point.label.value for point in branch),
        stable=branch.stable,
        multipliers=multipliers_of(branch.points, len(branch.layout.states)),
        times=times.reshape(len(branch), -1) if len(branch) else np.empty((0, 0)),
        signals={name: _signal(branch.points, name, times) for name in names},
    )


def _signal(points: tuple[Point, ...], name: str, times: Array) -> tuple[str, Array]:
    read = [point.orbit[name] for point in points]
    return read[0].unit, np.array([signal(t) for signal, t in zip(read, times, strict=True)])
