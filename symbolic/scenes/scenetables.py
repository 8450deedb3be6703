"""Tables of a scene file and their fields. The description of a field is what it allows."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field


def number(low: float, high: float, unit: str = "") -> Any:
    """A field that takes finite numbers from low to high."""
    return Field(ge=low, le=high, description=f"a number from {low:g} to {high:g}{unit and f' ({unit})'}")


def whole(low: int, high: int) -> Any:
    """A field that takes whole numbers from low to high."""
    return Field(ge=low, le=high, description=f"a whole number from {low} to {high}")


def one_line(text: str) -> str:
    """Refuse a text that a terminal would not show as a line."""
    if not text.isprintable():
        raise ValueError
    return text


Title = Annotated[
    str,
    AfterValidator(one_line),
    Field(max_length=200, description="one line of text, at most 200 characters"),
]


class Table(BaseModel):
    """A table of a scene file: no unknown keys, no conversions, no infinities."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
