"""Tasks and numbers for tests of maps: importable by the processes that compute them."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import periodic as per
from support.numpy_systems import LinearOscillator

SWING = per.PeakToPeak("x")
BOUNDS = (0.4, 0.5)
GRID = {"F": [0.5, 1.0, 1.5], "zeta": [0.1, 0.2, 0.3, 0.4]}


def height(task: per.maps.Task, branch: per.Branch) -> float:
    """The highest of the points' peaks to peak: cheap, and exact nowhere but at the points."""
    return float(branch.peak_to_peak("x").max())


def ends(task: per.maps.Task, branch: per.Branch) -> list[float]:
    """Two numbers."""
    return [branch[0].parameter, branch[-1].parameter]


def process(task: per.maps.Task, branch: per.Branch) -> float:
    """Which process reads it."""
    return float(os.getpid())


class Deadly:
    """Kills its process at some values of a parameter; waits a little before."""

    def __init__(self, values: tuple[float, ...], parameter: str = "zeta", wait: float = 0.0) -> None:
        self.values, self.parameter, self.wait = values, parameter, wait

    def __call__(self, task: per.maps.Task, branch: per.Branch) -> float:
        """The value."""
        value = branch[0].orbit.parameters[self.parameter]
        time.sleep(self.wait)
        if value in self.values:
            os.kill(os.getpid(), signal.SIGKILL)
        return value


class Counted:
    """Leaves a file for each cell that it reads."""

    def __init__(self, folder: Path, wait: float = 0.0) -> None:
        self.folder, self.wait = folder, wait

    def __call__(self, task: per.maps.Task, branch: per.Branch) -> float:
        """The force."""
        time.sleep(self.wait)
        values = branch[0].orbit.parameters
        number = len(list(self.folder.iterdir()))
        (self.folder / f"{values['F']:g}-{values['zeta']:g}-{number}-{os.getpid()}").touch()
        return values["F"]


def task(**numbers: per.maps.Number) -> per.maps.Task:
    """A linear oscillator below its resonance: quickly traced."""
    steps = per.ArclengthControl(ds=0.5, ds_max=1.0)
    numbers = numbers or {"peak": height}
    return per.maps.Task(LinearOscillator(), "Omega", BOUNDS, numbers=numbers, tol=1e-3, control=steps)
