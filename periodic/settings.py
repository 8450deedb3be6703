"""Settings of a trace: accuracy, steps, and the dial draft / standard / fine that chooses both."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from periodic.anchors import AnchorSettings
from periodic.newton import NewtonSettings
from periodic.scheme import Family, Scheme


@dataclass(frozen=True, kw_only=True)
class MeshSettings:
    """Accuracy of each orbit. tolerance bounds its error estimate; ntst runs from ntst_min to ntst_max."""

    tolerance: float = 1e-7
    scheme: Scheme = field(default_factory=Scheme)
    ntst: int = 24
    ntst_min: int = 8
    ntst_max: int = 1000
    anchors: AnchorSettings = field(default_factory=AnchorSettings)

    @property
    def shortest(self) -> float:
        """Width (rad) below which no interval is halved: what happens within it is below the tolerance."""
        return 0.005 * self.tolerance

    def __post_init__(self) -> None:
        if not 1e-13 <= self.tolerance <= 1e-1:
            raise ValueError(f"tolerance is {self.tolerance}; it must lie between 1e-13 and 0.1")
        for name in ("ntst", "ntst_min", "ntst_max"):
            if not (getattr(self, name) >= 1 and float(getattr(self, name)).is_integer()):
                raise ValueError(f"{name} is {getattr(self, name)}; it must be a whole number of at least 1")
        if not self.ntst_min <= self.ntst <= self.ntst_max:
            raise ValueError(f"ntst is {self.ntst}; it must lie from ntst_min to ntst_max")


@dataclass(frozen=True, kw_only=True)
class StepSettings:
    """Arclength steps, as parts of the parameter's range; `turn` is the least cosine between tangents.

    A step is tried at 10 ln(ds_max / ds_min) lengths at most, each on a few meshes, each with at most
    NewtonSettings.max_iterations. max_points bounds the steps in each direction; max_newton, up to one
    correction, the Newton iterations of one call, those for rejected steps and for the first orbit
    included. One costs a linear solve on about MeshSettings.ntst_max intervals at most.
    """

    ds: float = 0.02
    ds_min: float = 1e-7
    ds_max: float = 0.2
    turn: float = 0.8
    max_points: int = 5000
    max_newton: int = 1_000_000

    def __post_init__(self) -> None:
        if not 0 < self.ds_min <= self.ds <= self.ds_max:
            raise ValueError(
                f"ds is {self.ds}; it must lie from ds_min = {self.ds_min} to ds_max = {self.ds_max}"
            )
        if not 0 < self.turn < 1:
            raise ValueError(f"turn is {self.turn}; it must lie between 0 and 1")
        for name in ("max_points", "max_newton"):
            count = getattr(self, name)
            if isinstance(count, bool) or not isinstance(count, int | np.integer):
                raise ValueError(f"{name} is {count!r}; it must be a whole number")
            if count < 1:
                raise ValueError(f"{name} is {count}; it must be at least 1")
            object.__setattr__(self, name, int(count))


@dataclass(frozen=True, kw_only=True)
class Settings:
    """All settings of a trace."""

    mesh: MeshSettings = field(default_factory=MeshSettings)
    newton: NewtonSettings = field(default_factory=NewtonSettings)
    step: StepSettings = field(default_factory=StepSettings)


LEAST, MOST = 1e-11, 1e-2
"""Between these lies a tolerance."""

DEEPEST = 0.1
"""Shallowest switch level worth an anchor, in tolerances."""

CLOSE = 1e-4
"""How much closer to an orbit than a tolerance its multipliers are computed."""

DEGREES = {1e-2: 3, 1e-4: 4, 1e-6: 5, 1e-9: 6, 1e-11: 7}
"""Collocation points in each interval down to a tolerance."""


def settings(tol: float, step: StepSettings | None = None) -> Settings:
    """Return the settings that bring peaks to peak, places of folds and multipliers to a relative `tol`.

    Raises ValueError unless 1e-11 <= tol <= 1e-2.
    """
    if isinstance(tol, bool) or not isinstance(tol, int | float | np.number):
        raise ValueError(f"tol is {tol!r}; it must be a number between {LEAST:g} and {MOST:g}")
    tol = float(tol)
    if not LEAST <= tol <= MOST:
        raise ValueError(f"tol is {tol}; it must lie between {LEAST:g} and {MOST:g}")
    increment = max(1e-2 * tol, 1e-10) ** 0.75
    ncol = next((points for least, points in DEGREES.items() if tol >= least), max(DEGREES.values()))
    return Settings(
        mesh=MeshSettings(
            tolerance=tol,
            scheme=Scheme(Family.RADAU, ncol),
            anchors=AnchorSettings(deepest=DEEPEST * tol),
        ),
        newton=NewtonSettings(tolerance=increment, close=CLOSE * tol / increment, max_iterations=16),
        step=step or StepSettings(),
    )


class Accuracy(Enum):
    """The dial: the tolerances of peaks to peak, places of folds and multipliers."""

    DRAFT = 1e-4
    STANDARD = 1e-6
    FINE = 1e-9

    def settings(self, step: StepSettings | None = None) -> Settings:
        """Return the settings of this accuracy."""
        return settings(self.value, step)
