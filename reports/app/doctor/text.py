"""What the doctor says, as a terminal shows it and as JSON."""

from __future__ import annotations

import math
from typing import Any

from ..doctor.machine import Facts
from ..doctor.numbers import Check


def table(facts: Facts) -> list[str]:
    """Return groups of names and what there is, one a line."""
    width = max(len(name) for group in facts.values() for name in group)
    lines = []
    for title, group in facts.items():
        if group:
            lines += [title, *(f"  {name:{width}}  {value}" for name, value in group.items())]
    return lines


def record(check: Check) -> dict[str, Any]:
    """Return a check for JSON, which has no infinity."""
    return {
        "name": check.name,
        "right": check.right,
        "error": check.error if math.isfinite(check.error) else None,
        "allowed": check.allowed,
        "seconds": check.seconds,
        "failure": check.failure,
    }
