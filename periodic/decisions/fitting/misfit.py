"""How far a motion is from what was measured, a functional: its least value along a branch picks one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from periodic.conditions.functionals import Smooth, apart
from periodic.orbit.orbit import Orbit
from periodic.orbit.row import Row
from periodic.system import System


@dataclass(frozen=True)
class Target:
    """A measured number y of a functional f: its residual is (gain f + offset - y) / sigma."""

    functional: Smooth
    value: float
    sigma: float
    gain: float = 1.0
    offset: float = 0.0

    def residual(self, model: float) -> float:
        """Return the residual of a value of the functional."""
        return apart(self.functional, self.gain * model + self.offset, self.value) / self.sigma


@dataclass(frozen=True)
class Misfit:
    """Half the sum of the squares of the residuals of several targets."""

    targets: Sequence[Target]

    def __call__(self, system: System, orbit: Orbit) -> float:
        """Return the misfit."""
        return sum(t.residual(t.functional(system, orbit)) ** 2 for t in self.targets) / 2

    def linearise(self, system: System, orbit: Orbit, free: tuple[int, ...]) -> Row:
        """Return value and gradient."""
        value, total = 0.0, None
        for target in self.targets:
            row = target.functional.linearise(system, orbit, free)
            residual = target.residual(row.value)
            value += residual**2 / 2
            own = row.scaled(residual * target.gain / target.sigma)
            total = own if total is None else total + own
        assert total is not None  # there is at least the place
        return Row(value, total.nodes, total.outer, total.stages)
