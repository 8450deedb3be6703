"""Why a branch ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Reason(Enum):
    """Named reasons; `numerical` tells those that cut a branch short of what was asked."""

    BOUND = "bound reached"
    CLOSED = "branch closed"
    ASKED = "stopped as asked"
    EQUILIBRIUM = "equilibrium reached"
    MAX_POINTS = "largest number of points reached"
    MAX_NEWTON = "largest number of Newton iterations reached"
    SMALL_STEP = "step size below its minimum"
    NO_START = "no orbit found at the start"
    INACCURATE = "tolerance not reached"
    INTERRUPTED = "interrupted"

    @property
    def numerical(self) -> bool:
        """Whether the branch ended for a numerical reason."""
        return self in (
            Reason.MAX_POINTS,
            Reason.MAX_NEWTON,
            Reason.SMALL_STEP,
            Reason.NO_START,
            Reason.INACCURATE,
        )

    @property
    def resumable(self) -> bool:
        """Whether the branch goes on from there when it is allowed to."""
        return self in (Reason.MAX_POINTS, Reason.MAX_NEWTON, Reason.INTERRUPTED)


@dataclass(frozen=True)
class Stop:
    """A named reason and the detail that goes with it."""

    reason: Reason
    detail: str

    def __str__(self) -> str:
        return f"{self.reason.value}: {self.detail}"

    @classmethod
    def bound(cls, bounds: tuple[float, float], value: float) -> Stop:
        """The parameter reached an end of its range."""
        side = "lower" if abs(value - bounds[0]) < abs(value - bounds[1]) else "upper"
        return cls(Reason.BOUND, f"{side} end of the range")

    @classmethod
    def limit(cls, name: str) -> Stop:
        """Another parameter reached an end of its limits."""
        return cls(Reason.BOUND, name)

    @classmethod
    def asked(cls, name: str, count: int) -> Stop:
        """The branch has as many points of a kind as were asked for."""
        return cls(Reason.ASKED, f"{name} met {count} time{'s' if count > 1 else ''}")

    @classmethod
    def closed(cls, count: int) -> Stop:
        """The branch came back to its start."""
        return cls(Reason.CLOSED, f"it came back to its start after {count} points")

    @classmethod
    def equilibrium(cls, count: int) -> Stop:
        """Autonomous orbits shrank to a point."""
        return cls(Reason.EQUILIBRIUM, f"the orbits shrank to it after {count} points")

    @classmethod
    def max_points(cls, count: int) -> Stop:
        """The allowed number of points was used up."""
        return cls(Reason.MAX_POINTS, f"{count} points")

    @classmethod
    def max_newton(cls, count: float) -> Stop:
        """The allowed number of Newton iterations was used up."""
        return cls(Reason.MAX_NEWTON, f"{count:g} iterations")

    @classmethod
    def small_step(cls, why: str) -> Stop:
        """Even the smallest step was rejected."""
        return cls(Reason.SMALL_STEP, why)

    @classmethod
    def no_start(cls, why: str) -> Stop:
        """No first orbit."""
        return cls(Reason.NO_START, why)

    @classmethod
    def inaccurate(cls, shortfall: str) -> Stop:
        """An orbit misses the tolerance."""
        return cls(Reason.INACCURATE, shortfall)
