"""What functionals are called where people read."""

from __future__ import annotations

import re

from periodic.conditions.functionals import Component, Functional, Value


def called(functional: Functional) -> str:
    """Return a functional in words: "peak to peak of x", "amplitude of x, order 3"."""
    if isinstance(functional, Value):
        return functional.parameter
    output = getattr(functional, "output", None)
    if not isinstance(output, str):
        return repr(functional)
    order = float(getattr(functional, "order", 1.0))
    if isinstance(functional, Component) and order == 0:
        return f"mean of {output}"
    kind = re.sub(r"(?<!^)(?=[A-Z])", " ", type(functional).__name__).lower()
    of = f"{kind} of {output}" + (f", order {order:g}" if order != 1 else "")
    phase = getattr(functional, "phase", None)
    return of if phase is None else f"{of}, phase {phase:.3g}"
