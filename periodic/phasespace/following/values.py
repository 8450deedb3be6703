"""Parameters of a system by name."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from periodic.checks import named, number
from periodic.orbit.scheme import Array
from periodic.system import System, check_value, index_of


def parameters(system: System, values: Mapping[str, float] | None) -> Array:
    """Return the nominal parameters (p,) with some values (SI) replaced. Raises ValueError."""
    found = np.array(system.nominal, dtype=float)
    for name, value in named("values", {} if values is None else values, "parameters").items():
        k = index_of(system, name)
        if not np.isfinite(number(f"value of {name}", value)):
            raise ValueError(f"value of {name} is {value!r}; it must be finite")
        check_value(system.parameters[k], float(value))
        found[k] = float(value)
    return found
