"""The units that a picture shows quantities in: those asked for, else SI with a prefix that suits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from periodic.checks import named, positive
from periodic.orbit.layout import Layout

Units = Mapping[str, str | tuple[str, float]]
"""By a quantity's name the unit it is shown in: "rev/min", or its name and its SI value, ("tooth/s", 0.2)."""

OTHERS = {
    "rev/min": ("rad/s", math.pi / 30),
    "krpm": ("rad/s", 1e3 * math.pi / 30),
    "Hz": ("rad/s", 2 * math.pi),
    "kHz": ("rad/s", 2e3 * math.pi),
    "°": ("rad", math.pi / 180),
    "deg": ("rad", math.pi / 180),
    "min": ("s", 60.0),
}
"""Units besides SI with its prefixes: what they measure, and their size."""

PREFIXES = {"n": 1e-9, "µ": 1e-6, "u": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}

SHOWN = ("n", "µ", "m", "", "k", "M", "G")
PREFIXED = ("m", "m/s", "m/s^2", "N", "s", "Pa", "W", "J", "V", "A")
"""Units that take a prefix by themselves."""


@dataclass(frozen=True)
class Unit:
    """A unit's name and the SI value of one of it."""

    text: str
    size: float = 1.0

    def label(self, name: str) -> str:
        """Return what an axis says: a name and this unit."""
        return f"{name} ({self.text})" if self.text else name


def prefixed(unit: str, values: ArrayLike) -> Unit:
    """Return a unit of SI with the prefix that brings the largest of some values between 0.1 and 100."""
    largest = float(np.max(np.abs(values), initial=0.0))
    if unit not in PREFIXED or not 0 < largest < math.inf or 0.1 <= largest < 1e3:
        return Unit(unit)
    step = min(max(math.floor(math.log10(largest) / 3 + 1e-9), -3), 3)
    prefix = SHOWN[step + 3]
    return Unit(prefix + unit, PREFIXES[prefix])


def quantities(layout: Layout) -> dict[str, str]:
    """Return the units in SI of outputs, parameters, states, unknowns and time, by name."""
    groups = (layout.outputs, layout.parameters, layout.states, layout.algebraics)
    return {"time": "s"} | {q.name: q.unit for group in groups for q in group}


class Shown:
    """The units of quantities in a picture.

    Parameters
    ----------
    quantities : dict
        Their units in SI, by name.
    units : dict, optional
        Units asked for, by name.

    Raises
    ------
    ValueError
        For names that are none of theirs, and units that do not fit.
    """

    def __init__(self, quantities: Mapping[str, str], units: Units | None = None) -> None:
        self._si = dict(quantities)
        self._asked: dict[str, Unit] = {}
        for name, unit in named("units", units or {}, "units").items():
            if name not in self._si:
                raise ValueError(f"units has {name!r}; its names must be among {', '.join(self._si)}")
            self._asked[name] = self._read(name, unit)

    def _read(self, name: str, unit: object) -> Unit:
        """Return a unit that was asked for."""
        si = self._si[name]
        if isinstance(unit, str):
            for prefix, size in PREFIXES.items():
                if unit == prefix + si:
                    return Unit(unit, size)
            if unit in OTHERS and OTHERS[unit][0] == si:
                return Unit(unit, OTHERS[unit][1])
            known = [other for other, (base, _) in OTHERS.items() if base == si]
            raise ValueError(
                f"units has {unit!r} for {name}, which is in {si or 'no unit'}; it must be "
                f"{', '.join(known) or 'that with a prefix such as m or k'}, or a pair of name and SI value"
            )
        if isinstance(unit, tuple) and len(unit) == 2 and isinstance(unit[0], str):
            return Unit(unit[0], positive(f"the SI value of {unit[0]}", unit[1]))
        raise ValueError(f"units has {unit!r} for {name}; it must be a unit, or a pair of name and SI value")

    def unit(self, name: str, values: ArrayLike = ()) -> Unit:
        """Return the unit of a quantity, of velocities x' that of x in a second.

        Parameters
        ----------
        name : str
            Its name.
        values : array_like
            The SI values that are shown: they choose the prefix where no unit was asked for.

        Returns
        -------
        Unit
            Its name and size.
        """
        if name in self._asked:
            return self._asked[name]
        order = len(name) - len(name.rstrip("'"))
        origin = name[: len(name) - order] if order else name
        if order and origin in self._si:
            over = "/s" if order == 1 else f"/s^{order}"
            if origin in self._asked:
                asked = self._asked[origin]
                return Unit(f"{asked.text}{over}", asked.size)
            return prefixed(f"{self._si[origin] or '1'}{over}", values)
        return prefixed(self._si.get(name, ""), values)
