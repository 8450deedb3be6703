"""What people read of a branch: the columns of its table, in the units of the field.

A disc is read in rev/min, micrometres and newtons, an oscillator in SI.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from symbolic.scenes.building import RPM
from symbolic.scenes.schema import DiscScene, Scene

if TYPE_CHECKING:
    from periodic import Point
    from reports.app.sweep import Settled

MICRO = 1e-6

Cell = float | bool | str | None
"""None where the scene has no such quantity."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """A quantity of a point: its name in files, and its heading in a table for people."""

    name: str
    value: Callable[[Point], Cell]
    heading: str = ""


@dataclass(frozen=True, kw_only=True)
class View:
    """How the branches of one kind of scene are read.

    `unit` is the SI value of one shown unit of the continuation parameter, its column the first. `columns`
    go to the CSV file; those with a heading are told of special points too. `height` is what the picture
    plots, `settled` the same of a motion settled in time.
    """

    parameter: str
    unit: float
    columns: tuple[Column, ...]
    height: Column
    settled: Callable[[Settled], float]
    axes: tuple[str, str]
    unit_name: str

    @property
    def abscissa(self) -> Column:
        """The column of the continuation parameter."""
        return self.columns[0]

    @property
    def told(self) -> tuple[Column, ...]:
        """The columns that special points are described by, the label first."""
        told = [column for column in self.columns if column.heading]
        return tuple(sorted(told, key=lambda column: column is not LABEL))

    def shown(self, value: float) -> float:
        """Return an SI value of the parameter in the unit shown."""
        return in_units(value, self.unit)


def view_of(scene: Scene) -> View:
    """Return how branches of a scene are read."""
    return DISC if isinstance(scene, DiscScene) else OSCILLATOR


def in_units(value: float, unit: float) -> float:
    """Return an SI value in units of that value, without the digit that the conversion and back costs."""
    # 285 rpm should read 285.
    return float(f"{value / unit:.14g}")


def _parameter(unit: float) -> Callable[[Point], Cell]:
    return lambda point: in_units(point.parameter, unit)


def _ripple(output: str, unit: float) -> Callable[[Point], Cell]:
    return lambda point: point.peak_to_peak(output) / unit if output in point.maximum else None


def _least(output: str, unit: float) -> Callable[[Point], Cell]:
    return lambda point: point.minimum[output] / unit if output in point.minimum else None


def _most(output: str, unit: float) -> Callable[[Point], Cell]:
    return lambda point: point.maximum[output] / unit if output in point.maximum else None


LABEL = Column(name="label", heading="label", value=lambda point: point.label.value)
STABLE = Column(name="stable", heading="stable", value=lambda point: point.stable)
MULTIPLIER = Column(name="multiplier_max", value=lambda point: float(np.abs(point.multipliers[0])))
ERROR = Column(name="error_estimate", value=lambda point: point.error.worst)
SWING = Column(name="x_pp_um", heading="x p-p (µm)", value=_ripple("x", MICRO))
LARGEST = Column(name="x_max", heading="x max (m)", value=_most("x", 1.0))

DISC = View(
    parameter="speed",
    unit=RPM,
    columns=(
        Column(name="speed_rpm", heading="speed (rev/min)", value=_parameter(RPM)),
        SWING,
        Column(name="film_pp_um", heading="film p-p (µm)", value=_ripple("film", MICRO)),
        Column(name="film_min_um", value=_least("film", MICRO)),
        Column(name="deflection_pp_um", value=_ripple("deflection", MICRO)),
        Column(name="load_min_N", value=_least("load", 1.0)),
        Column(name="load_max_N", heading="load max (N)", value=_most("load", 1.0)),
        MULTIPLIER,
        STABLE,
        LABEL,
        ERROR,
    ),
    height=SWING,
    settled=lambda motion: (motion.maximum - motion.minimum) / MICRO,
    axes=("speed (rev/min)", "x peak to peak (µm)"),
    unit_name="rev/min",
)

OSCILLATOR = View(
    parameter="Omega",
    unit=1.0,
    columns=(
        Column(name="frequency", heading="frequency (rad/s)", value=_parameter(1.0)),
        LARGEST,
        MULTIPLIER,
        STABLE,
        LABEL,
        ERROR,
    ),
    height=LARGEST,
    settled=lambda motion: motion.maximum,
    axes=("frequency (rad/s)", "largest x (m)"),
    unit_name="rad/s",
)
