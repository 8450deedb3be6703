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
    HOMOCLINIC = "homoclinic orbit reached"
    VANISHED = "orbits without size reached"
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
    def limit(cls, name: str) -> Stop:
        """Return that another parameter reached an end of its limits.

        Parameters
        ----------
        name : str
            Which limit, of what.
        """
        return cls(Reason.BOUND, name)

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
    def closed(cls, count: int) -> Stop:
        """Return that the branch came back to its start.

        Parameters
        ----------
        count : int
            How many points there are.
        """
        return cls(Reason.CLOSED, f"it came back to its start after {count} points")

    @classmethod
    def equilibrium(cls, count: int) -> Stop:
        """Return that autonomous orbits shrank to a point.

        Parameters
        ----------
        count : int
            How many points there are.
        """
        return cls(Reason.EQUILIBRIUM, f"the orbits shrank to it after {count} points")

    @classmethod
    def homoclinic(cls, period: float) -> Stop:
        """Return that autonomous orbits grow longer without bound.

        Parameters
        ----------
        period : float
            The last one's (s).
        """
        return cls(Reason.HOMOCLINIC, f"the period grows without bound, {period:.4g} s here")

    @classmethod
    def vanished(cls, span: float) -> Stop:
        """Return that the orbits have shrunk until their motion is rounding, at one parameter.

        Parameters
        ----------
        span : float
            The last one's largest peak to peak (scaled).
        """
        return cls(Reason.VANISHED, f"the motion has shrunk to rounding, {span:.2g} peak to peak (scaled)")

    @classmethod
    def interrupted(cls, count: int) -> Stop:
        """Return that the branch was cut short by the user, or is not at its end yet.

        Parameters
        ----------
        count : int
            How many points there are.
        """
        return cls(Reason.INTERRUPTED, f"after {count} points")

    @classmethod
    def max_points(cls, count: int) -> Stop:
        """Return that the allowed number of points was used up.

        Parameters
        ----------
        count : int
            That number.
        """
        return cls(Reason.MAX_POINTS, f"{count} points")

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

    @classmethod
    def small_step(cls, why: str) -> Stop:
        """Return that even the smallest step was rejected.

        Parameters
        ----------
        why : str
            Why.
        """
        return cls(Reason.SMALL_STEP, why)

    @classmethod
    def no_start(cls, why: str) -> Stop:
        """Return that there is no first orbit.

        Parameters
        ----------
        why : str
            Why.
        """
        return cls(Reason.NO_START, why)

    @classmethod
    def inaccurate(cls, shortfall: str) -> Stop:
        """Return that an orbit misses the tolerance.

        Parameters
        ----------
        shortfall : str
            By how much.
        """
        return cls(Reason.INACCURATE, shortfall)
