"""The fields of a dataclass by name."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def shallow(record: DataclassInstance) -> dict[str, Any]:
    """Return the fields of a dataclass by name, their values as they are: `asdict` copies them."""
    return {name: getattr(record, name) for name in names(type(record))}


@cache
def names(record: type[DataclassInstance]) -> tuple[str, ...]:
    """Return the names of the fields of a dataclass, from a cache."""
    return tuple(field.name for field in fields(record))
