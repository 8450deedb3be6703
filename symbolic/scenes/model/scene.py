"""The scene of the kinds "model" and "structure": tables of coordinates, structures and parts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from symbolic.equations.model import Model
from symbolic.equations.variables import Coordinate, Parameter, Variable, coordinates
from symbolic.kernels.choice import Kernels
from symbolic.scenes.errors import InputError, refused, shown
from symbolic.scenes.model.bench import unknown
from symbolic.scenes.model.composing import composed
from symbolic.scenes.model.structures import StructureTable
from symbolic.scenes.ranges import Range
from symbolic.scenes.scenetables import Table, Title
from symbolic.system.compile import compile, with_nominal
from symbolic.system.compiled import CompiledSystem, with_values

TEXT = "one line of text that is not empty"


class CoordinateTable(Table):
    """A coordinate; with a count, a vector of them, called by the name and a number from 1."""

    name: str = Field(min_length=1, max_length=60, description=TEXT)
    unit: str = Field("m", max_length=30, description="one line of text")
    scale: float | None = Field(None, gt=0, description="a positive number (SI)")
    start: float = Field(0.0, description="a number (SI)")
    count: int | None = Field(None, ge=1, le=1000, description="a whole number from 1 to 1000")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The coordinates. Raises ValueError."""
        if self.count is None:
            return (Coordinate(self.name, self.unit, self.scale, self.start),)
        return coordinates(self.name, self.count, self.unit, self.scale, self.start)


class SharedTable(Table):
    """A parameter that several parts share."""

    value: float = Field(description="a number (SI)")
    unit: str = Field("", max_length=30, description="one line of text")


class ModelRange(Range):
    """The parameter that is continued, and where from and to: in its own unit, or that of the axis."""

    keys: ClassVar[tuple[str, str]] = ("begin", "end")
    parameter: str = Field(description="the name of a parameter of the model")
    begin: float = Field(alias="from", description="a number, in the unit of the axis")
    end: float = Field(alias="to", description="a number, in the unit of the axis")
    axis_unit: Literal["rev/min", "Hz", "rad/s"] | None = Field(
        None, alias="axis", description='"rev/min", "Hz" or "rad/s"'
    )

    @property
    def own(self) -> str | None:
        """The axis, if there is one."""
        return self.axis_unit


@dataclass(frozen=True)
class Compiled:
    """What is known of the compiled model: its parameters and outputs."""

    parameters: tuple[Variable, ...]
    outputs: tuple[Variable, ...]


class ModelScene(Table):
    """A model composed of coordinates and parts; `values` replace parameters of the model by name."""

    title: Title
    kind: Literal["model", "structure"]
    parameters: dict[str, SharedTable] = Field({}, description="a table of numbers")
    coordinate: list[CoordinateTable] = Field([], description="tables [[coordinate]]")
    structure: list[StructureTable] = Field([], description="tables [[structure]]")
    part: list[dict[str, Any]] = Field(min_length=1, description="tables [[part]]")
    values: dict[str, float] = Field({}, description="a table of numbers")
    trace: ModelRange
    _compiled: Compiled | None = PrivateAttr(None)
    _folder: Path = PrivateAttr(Path())

    @property
    def compiled(self) -> Compiled:
        """Parameters and outputs of the compiled model."""
        assert self._compiled is not None
        return self._compiled

    @property
    def continued(self) -> Variable:
        """The parameter that is continued."""
        return next(p for p in self.compiled.parameters if p.name == self.trace.parameter)

    def model(self) -> Model:
        """Return the model of the tables. Raises InputError."""
        with refusing():
            places = [q for table in self.coordinate for q in table.coordinates]
            shared = [Parameter(name, each.value, each.unit) for name, each in self.parameters.items()]
            structures = [table.structure(self._folder) for table in self.structure]
            return composed(places, shared, self.part, structures)

    def system(self, kernels: Kernels, *, condense: bool = True) -> CompiledSystem:
        """Return the compiled model, `values` put in, structures at their places alone or not.

        Raises InputError.
        """
        model = self.model()
        with refusing():
            system = compile(model, kernels, condense=condense)
        names = [p.name for p in system.parameters]
        for name in self.parameters:
            if name not in names:
                allowed = "a part must name it, or it must go"
                raise InputError(f"parameters.{name}", "is used by no part", allowed)
        for name in self.values:
            if name not in names:
                raise unknown("[values]", name, names, "the name of a parameter of the model")
        with refusing():
            return with_nominal(system, self.values) if self.values else system

    @field_validator("parameters", mode="before")
    @classmethod
    def _shared(cls, given: Any) -> Any:
        """A bare number is the value of a parameter."""
        if not isinstance(given, dict):
            return given
        for name, each in given.items():
            if isinstance(each, bool) or not isinstance(each, int | float | dict):
                allowed = 'a number, or a table as {value = 1.0, unit = "rad/s"}'
                raise refused(f"parameters.{name}", each, allowed)
        return {
            name: each if isinstance(each, dict) else {"value": float(each)} for name, each in given.items()
        }

    @model_validator(mode="after")
    def _sound(self, info: ValidationInfo) -> ModelScene:
        self._folder = (info.context or {}).get("folder", Path())
        if self.kind == "structure" and not self.structure:
            raise InputError("structure", "is missing", "it must be tables [[structure]]")
        system = self.system(Kernels.NUMPY)
        self._compiled = Compiled(system.parameters, system.outputs)
        names = [p.name for p in system.parameters]
        if self.trace.parameter not in names:
            allowed = "the name of a parameter of the model"
            raise unknown("trace.parameter", self.trace.parameter, names, allowed)
        if self.trace.own and self.continued.unit not in ("rad/s", ""):
            what = f"of a parameter in {shown(self.continued.unit or 'no unit')} is {shown(self.trace.own)}"
            raise InputError("trace.axis", what, "only an angular frequency (rad/s) may have one")
        for key, value, si in zip(self.trace.written, self.trace.ends, self.trace.bounds, strict=True):
            try:
                with_values(system, {self.trace.parameter: si})
            except ValueError as error:
                raise InputError(f"trace.{key}", f"is {value:g}", f"{error}") from None
        return self


@contextmanager
def refusing() -> Iterator[None]:
    """Let what Python functions refuse be refused as bad input. Raises InputError."""
    try:
        yield
    except ValueError as error:
        raise InputError.said(str(error)) from None
