"""What people read of a branch: the columns of its table, in the units of the field.

A disc is read in rev/min, micrometres and newtons, an oscillator and a model in SI; the axis is that of the
scene or of the user.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from symbolic.scenes.axes import AXES, RPM, SHORT
from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.schema import DiscScene, Scene

if TYPE_CHECKING:
    from periodic import Point

    from .sweep import Settled

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
    plots, the branch's column `drawn` in units of so much; `settled` the same of a motion settled in time.
    Outputs in `micro` are read in micrometres.
    """

    parameter: str
    unit: float
    columns: tuple[Column, ...]
    height: Column
    drawn: tuple[str, float]
    settled: Callable[[Settled], float]
    axes: tuple[str, str]
    unit_name: str
    micro: tuple[str, ...] = ()

    @property
    def abscissa(self) -> Column:
        """The column of the continuation parameter."""
        return self.columns[0]

    @property
    def stem(self) -> str:
        """What the continuation parameter is called, without its unit."""
        return self.abscissa.heading.partition(" (")[0]

    @property
    def tabulated(self) -> tuple[Column, ...]:
        """The columns that special points are described by, the label first."""
        tabulated = [column for column in self.columns if column.heading]
        return tuple(sorted(tabulated, key=lambda column: column is not LABEL))

    def shown(self, value: float) -> float:
        """Return an SI value of the parameter in the unit shown."""
        return in_units(value, self.unit)


def view_of(scene: Scene) -> View:
    """Return how branches of a scene are read."""
    if isinstance(scene, ModelScene):
        usual = _model(scene)
    else:
        usual = DISC if isinstance(scene, DiscScene) else OSCILLATOR
    axis = scene.trace.axis
    return usual if axis in (None, usual.unit_name) else _on_axis(usual, axis)


def _on_axis(view: View, axis: str) -> View:
    """The same with the parameter in another unit."""
    column = Column(
        name=f"{view.abscissa.name.removesuffix('_rpm')}_{SHORT[axis]}",
        heading=f"{view.stem} ({axis})",
        value=_parameter(AXES[axis]),
    )
    return replace(
        view,
        unit=AXES[axis],
        columns=(column, *view.columns[1:]),
        axes=(column.heading, view.axes[1]),
        unit_name=axis,
    )


TOLD = 4
"""Outputs of a model that the table of special points tells of; the files have all."""


def _model(scene: ModelScene) -> View:
    """How a model is read: peak to peak of every output, SI."""
    continued, outputs = scene.continued, scene.compiled.outputs
    swings = tuple(
        Column(
            name=f"{o.name}_pp",
            heading=_with_unit(f"{o.name} p-p", o.unit) if k < TOLD else "",
            value=_ripple(o.name, 1.0),
        )
        for k, o in enumerate(outputs)
    )
    first = outputs[0]
    heading = _with_unit(continued.name, continued.unit)
    return View(
        parameter=continued.name,
        unit=1.0,
        columns=(
            Column(name=continued.name, heading=heading, value=_parameter(1.0)),
            *swings,
            MULTIPLIER,
            STABLE,
            LABEL,
            ERROR,
        ),
        height=swings[0],
        drawn=(f"{first.name} p-p", 1.0),
        settled=lambda motion: motion.maximum - motion.minimum,
        axes=(heading, _with_unit(f"{first.name} peak to peak", first.unit)),
        unit_name=continued.unit,
    )


def _with_unit(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


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
    drawn=("x p-p", MICRO),
    settled=lambda motion: (motion.maximum - motion.minimum) / MICRO,
    axes=("speed (rev/min)", "x peak to peak (µm)"),
    unit_name="rev/min",
    micro=("x", "film", "deflection"),
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
    drawn=("x max", 1.0),
    settled=lambda motion: motion.maximum,
    axes=("frequency (rad/s)", "largest x (m)"),
    unit_name="rad/s",
)
