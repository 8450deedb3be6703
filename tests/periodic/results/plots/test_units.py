"""Units of pictures: prefixes, what is asked for, and velocities."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from periodic.results.plots.units import OTHERS, Shown, Unit, prefixed

KNOWN = {"time": "s", "x": "m", "Omega": "rad/s", "phi": "rad", "r": "", "F": "N"}


@pytest.mark.parametrize(
    ("unit", "values", "text", "size"),
    [
        ("m", [0.1, -999.0], "m", 1.0),
        ("m", [1000.0], "km", 1e3),
        ("m", [0.0999], "mm", 1e-3),
        ("m", [-0.001], "mm", 1e-3),
        ("m", [0.00099], "µm", 1e-6),
        ("N", [2e6, 1.0], "MN", 1e6),
        ("N", [2e12], "GN", 1e9),
        ("m", [1e-15], "nm", 1e-9),
        ("m", [0.0], "m", 1.0),
        ("m", [math.inf], "m", 1.0),
        ("m", [], "m", 1.0),
        ("rad", [1e-5], "rad", 1.0),
    ],
)
def test_prefixes(unit: str, values: list[float], text: str, size: float) -> None:
    """Assert the prefix of the largest value where it is not between 0.1 and 1000; none of other units."""
    assert prefixed(unit, values) == Unit(text, size)


@pytest.mark.parametrize(
    ("name", "asked", "text", "size"),
    [
        ("x", "mm", "mm", 1e-3),
        ("x", "um", "um", 1e-6),
        ("x", "m", "m", 1.0),
        ("F", "MN", "MN", 1e6),
        ("Omega", "rev/min", "rev/min", math.pi / 30),
        ("Omega", "Hz", "Hz", 2 * math.pi),
        ("phi", "deg", "deg", math.pi / 180),
        ("time", "min", "min", 60.0),
        ("x", ("inch", 0.0254), "inch", 0.0254),
        ("r", ("%", 0.01), "%", 0.01),
    ],
)
def test_units_that_are_asked_for(name: str, asked: Any, text: str, size: float) -> None:
    """Assert their names and sizes, whatever the values."""
    assert Shown(KNOWN, {name: asked}).unit(name, [1e9]) == Unit(text, size)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"y": "mm"}, "units has 'y'; its names must be among time, x, Omega, phi, r, F$"),
        (
            {"x": "N"},
            "units has 'N' for x, which is in m; it must be that with a prefix such as m or k, or a",
        ),
        ({"x": "Hz"}, "units has 'Hz' for x, which is in m; it must be that with a prefix"),
        ({"time": "h"}, "units has 'h' for time, which is in s; it must be min, or a pair"),
        ({"r": "m/s"}, "units has 'm/s' for r, which is in no unit; "),
        ({"x": 3}, "units has 3 for x; it must be a unit, or a pair of name and SI value$"),
        ({"x": ("mm",)}, r"units has \('mm',\) for x; it must be a unit, or a pair"),
        ({"x": (1e-3, "mm")}, r"units has \(0.001, 'mm'\) for x; it must be a unit, or a pair"),
        ({"x": ("mm", 0.0)}, "the SI value of mm is 0.0; it must be"),
    ],
)
def test_units_that_are_refused(asked: Any, said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError, match=f"^{said}"):
        Shown(KNOWN, asked)


def test_units_of_velocities() -> None:
    """Assert that of x in a second for each prime, asked for or with a prefix; labels of axes."""
    plain, asked = Shown(KNOWN), Shown(KNOWN, {"x": "mm"})
    assert plain.unit("x'", [0.5]) == Unit("m/s") and plain.unit("x'", [5e3]) == Unit("km/s", 1e3)
    assert plain.unit("x''", [0.5]) == Unit("m/s^2") and plain.unit("r'", [2.0]) == Unit("1/s")
    assert asked.unit("x'", [5e3]) == Unit("mm/s", 1e-3) and asked.unit("x''") == Unit("mm/s^2", 1e-3)
    assert plain.unit("other", [1e9]) == Unit("") and plain.unit("other'", [1e9]) == Unit("")
    assert Unit("mm").label("x") == "x (mm)" and Unit("").label("r") == "r"
    assert OTHERS["krpm"][1] == pytest.approx(1000 * OTHERS["rev/min"][1])
    assert np.isclose(OTHERS["kHz"][1], 1000 * OTHERS["Hz"][1])
