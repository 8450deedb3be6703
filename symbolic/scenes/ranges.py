"""The table [trace]: where a trace starts and which way it goes, and the unit that this is told in."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from pydantic import PrivateAttr, model_validator

from symbolic.scenes.axes import AXES
from symbolic.scenes.errors import InputError
from symbolic.scenes.scenetables import Table, number

Speed = Annotated[float, number(0.1, 1e5, "rev/min")]
Frequency = Annotated[float, number(1e-9, 1e9, "rad/s")]


class Range(Table):
    """Where the trace starts and which way it goes; `keys` are its two ends, in `own` units."""

    keys: ClassVar[tuple[str, str]]
    _shown: str | None = PrivateAttr(None)

    @property
    def own(self) -> str | None:
        """The axis that the two ends are written in; None for the parameter's own unit."""
        raise NotImplementedError

    @property
    def written(self) -> tuple[str, str]:
        """What the two ends are called in a file."""
        begin, end = (type(self).model_fields[key].alias or key for key in self.keys)
        return begin, end

    @property
    def axis(self) -> str | None:
        """The axis that the range is shown in."""
        return self._shown or self.own

    @property
    def unit(self) -> float:
        """SI value of one unit of the axis shown."""
        return AXES[self.axis] if self.axis else 1.0

    @property
    def bounds(self) -> tuple[float, float]:
        """Where the trace starts and ends, SI."""
        unit = AXES[self.own] if self.own else 1.0
        begin, end = (getattr(self, key) * unit for key in self.keys)
        return begin, end

    @property
    def ends(self) -> tuple[float, float]:
        """Where the trace starts and ends, as shown."""
        if self._shown in (None, self.own):
            begin, end = (getattr(self, key) for key in self.keys)
        else:
            begin, end = (float(f"{value / self.unit:.14g}") for value in self.bounds)
        return begin, end

    def shown_in(self, axis: str) -> Self:
        """Return the range as shown in another unit."""
        copy = self.model_copy()
        copy._shown = axis
        return copy

    @model_validator(mode="after")
    def _two_ends(self) -> Self:
        begin, end = (getattr(self, key) for key in self.keys)
        if begin == end:
            field, other = (f"trace.{name}" for name in reversed(self.written))
            remedy = f"it must differ from {other} so that there is a range"
            raise InputError(field, f"is {end:g}", remedy)
        return self


class SpeedRange(Range):
    """Where the trace starts and which way it goes, in rev/min of the discs."""

    keys: ClassVar[tuple[str, str]] = ("from_rpm", "to_rpm")
    from_rpm: Speed
    to_rpm: Speed

    @property
    def own(self) -> str:
        """rev/min."""
        return "rev/min"


class FrequencyRange(Range):
    """Where the trace starts and which way it goes: angular frequency Omega in rad/s."""

    keys: ClassVar[tuple[str, str]] = ("from_frequency", "to_frequency")
    from_frequency: Frequency
    to_frequency: Frequency

    @property
    def own(self) -> str:
        """rad/s."""
        return "rad/s"
