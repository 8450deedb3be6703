"""What a scene file may say: tables, keys, units and ranges. The description of a field is what it allows."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from reports.errors import InputError, listed, refused


def number(low: float, high: float, unit: str = "") -> Any:
    """A field that takes finite numbers from low to high."""
    return Field(ge=low, le=high, description=f"a number from {low:g} to {high:g}{unit and f' ({unit})'}")


def whole(low: int, high: int) -> Any:
    """A field that takes whole numbers from low to high."""
    return Field(ge=low, le=high, description=f"a whole number from {low} to {high}")


Speed = Annotated[float, number(0.1, 1e5, "rev/min")]
Frequency = Annotated[float, number(1e-9, 1e9, "rad/s")]


class Table(BaseModel):
    """A table of a scene file: no unknown keys, no conversions, no infinities."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class Discs(Table):
    """Two equal discs."""

    mass: float = number(1e-6, 1e6, "kg")
    diameter: float = number(1e-4, 100, "m")


class Contact(Table):
    """Hertz contact under a constant preload: load = stiffness * deflection^exponent."""

    stiffness: float = number(1, 1e24, "N/m^exponent")
    exponent: float = number(1, 4)
    preload: float = number(1e-2, 1e8, "N")


class Waviness(Table):
    """Sinusoidal corrugations on one disc."""

    amplitude: float = number(1e-10, 1e-3, "m")
    waves: int = whole(1, 100_000)


class Film(Table):
    """The lubricant film; a viscosity given beside a lubricant replaces the lubricant's."""

    law: Literal["squeeze", "quasistatic"] = Field(description='"squeeze" or "quasistatic"')
    lubricant: str | None = Field(None, description="the name of a lubricant")
    viscosity: float = number(1e-5, 1e3, "Pa s")
    piezoviscosity: float = number(1e-10, 1e-6, "m^2/N")
    beta: float = number(0.5, 200)
    squeeze: float | None = Field(
        None, ge=1e-3, le=1e7, description='a number from 0.001 to 1e+07 (law = "quasistatic" has none)'
    )

    @model_validator(mode="before")
    @classmethod
    def _lubricated(cls, table: Any) -> Any:
        if not isinstance(table, dict) or not isinstance(table.get("lubricant"), str):
            return table
        known = lubricants()
        if table["lubricant"] not in known:
            raise refused("film.lubricant", table["lubricant"], listed(sorted(known)))
        return {**known[table["lubricant"]], **table}

    @model_validator(mode="after")
    def _squeezed(self) -> Film:
        allowed = str(type(self).model_fields["squeeze"].description)
        if self.law == "squeeze" and self.squeeze is None:
            raise InputError("film.squeeze", "is missing", f"it must be {allowed}")
        if self.law == "quasistatic" and self.squeeze is not None:
            raise InputError("film.squeeze", f"is {self.squeeze:g}", 'law = "quasistatic" must have none')
        return self


class Damping(Table):
    """Viscous damping of the contact's approach, relative to critical damping."""

    ratio: float = number(0, 5)


class SpeedRange(Table):
    """Where the trace starts and which way it goes, in rev/min of the discs."""

    from_rpm: Speed
    to_rpm: Speed

    @property
    def ends(self) -> tuple[float, float]:
        """Where the trace starts and ends."""
        return self.from_rpm, self.to_rpm

    @model_validator(mode="after")
    def _two_ends(self) -> SpeedRange:
        if self.from_rpm == self.to_rpm:
            raise _one_point("trace.to_rpm", self.to_rpm, "trace.from_rpm")
        return self


class DiscScene(Table):
    """Two discs in rolling contact, one of them wavy."""

    title: str = Field(description="text")
    kind: Literal["disc"]
    discs: Discs
    contact: Contact
    waviness: Waviness
    film: Film | None = None
    damping: Damping | None = None
    trace: SpeedRange


class Oscillator(Table):
    """mass x'' + damping x' + stiffness x + cubic x^3 = force cos(Omega t)."""

    mass: float = number(1e-12, 1e12, "kg")
    damping: float | None = Field(None, ge=0, le=1e12, description="a number from 0 to 1e+12 (N s/m)")
    stiffness: float = number(0, 1e18, "N/m")
    cubic: float | None = Field(None, ge=-1e24, le=1e24, description="a number from -1e+24 to 1e+24 (N/m^3)")
    force: float = number(1e-12, 1e12, "N")

    @model_validator(mode="after")
    def _restored(self) -> Oscillator:
        if self.stiffness == 0 and (self.cubic or 0) <= 0:
            raise InputError("oscillator.stiffness", "is 0", "it must be greater than 0 where cubic is not")
        return self


class FrequencyRange(Table):
    """Where the trace starts and which way it goes: angular frequency Omega in rad/s."""

    from_frequency: Frequency
    to_frequency: Frequency

    @property
    def ends(self) -> tuple[float, float]:
        """Where the trace starts and ends."""
        return self.from_frequency, self.to_frequency

    @model_validator(mode="after")
    def _two_ends(self) -> FrequencyRange:
        if self.from_frequency == self.to_frequency:
            raise _one_point("trace.to_frequency", self.to_frequency, "trace.from_frequency")
        return self


class OscillatorScene(Table):
    """A forced oscillator with a linear and a cubic spring."""

    title: str = Field(description="text")
    kind: Literal["oscillator"]
    oscillator: Oscillator
    trace: FrequencyRange


Scene = DiscScene | OscillatorScene

KINDS: dict[str, type[DiscScene] | type[OscillatorScene]] = {"disc": DiscScene, "oscillator": OscillatorScene}


def _one_point(field: str, value: float, other: str) -> InputError:
    return InputError(field, f"is {value:g}", f"it must differ from {other} so that there is a range")


@cache
def lubricants() -> dict[str, dict[str, float]]:
    """Return viscosity (Pa s) and piezoviscosity (m^2/N) of the lubricants that scenes can name."""
    return tomllib.loads(resources.files("reports").joinpath("lubricants.toml").read_text("utf-8"))
