"""Why a branch ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from periodic.checks import plain


class Reason(Enum):
    """Named reasons; `numerical` tells those that cut a branch short of what was asked."""

    BOUND = "bound reached"
    CLOSED = "branch closed"
    ASKED = "stopped as asked"
    EQUILIBRIUM = "equilibrium reached"
    HOMOCLINIC = "homoclinic orbit reached"
    VANISHED = "orbits without size reached"
    UNBOUNDED = "orbits grow without bound"
    MAX_POINTS = "largest number of points reached"
    MAX_NEWTON = "largest number of Newton iterations reached"
    SMALL_STEP = "step size below its minimum"
    RETRACED = "branch goes back over itself"
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
            Reason.RETRACED,
            Reason.NO_START,
            Reason.INACCURATE,
        )

    @property
    def resumable(self) -> bool:
        """Whether the branch goes on from there when it is allowed to."""
        return self in (Reason.MAX_POINTS, Reason.MAX_NEWTON, Reason.INTERRUPTED)


COUNTED = {
    Reason.CLOSED: "it came back to its start after {} points",
    Reason.EQUILIBRIUM: "the orbits shrank to it after {} points",
    Reason.HOMOCLINIC: "the period grows without bound, {:.4g} s here",
    Reason.VANISHED: "the motion has shrunk to rounding, {:.2g} peak to peak (scaled)",
    Reason.UNBOUNDED: "the parameter stands still, {:.2g} peak to peak (scaled) here",
    Reason.INTERRUPTED: "after {} points",
    Reason.MAX_POINTS: "{} points",
}
"""Details of reasons that state a count or a size."""


@dataclass(frozen=True)
class Stop:
    """Why a branch ends.

    Parameters
    ----------
    reason : Reason
        The named reason.
    detail : str
        What goes with it.
    """

    reason: Reason
    detail: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "detail", plain(self.detail))  # of a file, or with names that a user gave

    def __str__(self) -> str:
        return f"{self.reason.value}: {self.detail}"

    @classmethod
    def bound(cls, bounds: tuple[float, float], value: float, begun: float) -> Stop:
        """Return that the parameter reached an end of its range.

        Parameters
        ----------
        bounds : tuple of float
            The range (SI).
        value : float
            Where it ended (SI).
        begun : float
            Where it began (SI).
        """
        side = "lower" if abs(value - bounds[0]) < abs(value - bounds[1]) else "upper"
        back = ", where it began: it turned back" if value == begun else ""
        return cls(Reason.BOUND, f"{side} end of the range{back}")

    @classmethod
    def after(cls, reason: Reason, size: float) -> Stop:
        """Return that a branch ended, with the count or the size that goes with the reason.

        Parameters
        ----------
        reason : Reason
            One of `COUNTED`.
        size : float
            How many points there are, for an orbit that grows or shrinks its period (s) or peak to peak.
        """
        return cls(reason, COUNTED[reason].format(size))

    @classmethod
    def asked(cls, name: str, count: int) -> Stop:
        """Return that the branch has as many points of a kind as were asked for.

        Parameters
        ----------
        name : str
            The label or event.
        count : int
            How often it was met.
        """
        return cls(Reason.ASKED, f"{name} met {count} time{'s' if count > 1 else ''}")

    @classmethod
    def max_newton(cls, count: float, spent: str = "") -> Stop:
        """Return that the allowed number of Newton iterations was used up.

        Parameters
        ----------
        count : float
            That number.
        spent : str
            What on, where there is no point yet.
        """
        plural = "" if count == 1 else "s"
        return cls(Reason.MAX_NEWTON, f"{count:g} iteration{plural}{', ' if spent else ''}{spent}")
