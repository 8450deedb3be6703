"""The fields of a dataclass by name."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def shallow(record: DataclassInstance) -> dict[str, Any]:
    """Return the fields of a dataclass by name, their values as they are: `asdict` copies them."""
    return {field.name: getattr(record, field.name) for field in fields(record)}
