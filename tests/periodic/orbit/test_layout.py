"""Names, units and scales of signals, by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.surfaces import along

from periodic.orbit.layout import Column, Layout, Quantity, Source
from periodic.orbit.layout import _per_time as per_time

LAYOUT = Layout(
    states=(Quantity("x", "m", 1e-3), Quantity("x'", "m", 2e-3), Quantity("z", "", 0.5)),
    algebraics=(Quantity("F", "N", 10.0), Quantity("x", "Pa", 7.0)),
    outputs=(),
    parameters=(Quantity("Omega", "rad/s", 2.0), Quantity("order", "", 1.0)),
    frequency=("Omega", "order"),
    factor=0.5,
)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("x", Column("x", "m", 0, 1e-3)),
        ("x'", Column("x'", "m/s", 1, 2e-3, 1)),
        ("x''", Column("x''", "m/s^2", 1, 2e-3, 2, Source.RATE)),
        ("z", Column("z", "", 2, 0.5)),
        ("z'", Column("z'", "1/s", 2, 0.5, 1, Source.RATE)),
        ("F", Column("F", "N", 0, 10.0, source=Source.ALGEBRAIC)),
    ],
)
def test_where_signals_are_found(name: str, expected: Column) -> None:
    """Assert array, column, unit and scale: of states before unknowns of their names, of rates of states."""
    assert LAYOUT.column(name) == expected


@pytest.mark.parametrize("name", ["y", "F'", "x'''", "z''", "'", ""])
def test_signals_that_there_are_not(name: str) -> None:
    """Assert which there are."""
    with pytest.raises(ValueError, match="; it has x, x', z, F, x$"):
        LAYOUT.column(name)


def test_angular_frequency() -> None:
    """Assert the product of parameters in SI times the factor, where what is held has its value."""
    parameter = np.array([3.0, 4.0])
    assert LAYOUT.omega(parameter) == 12.0
    held = replace(LAYOUT, held=(("order", 4.0),))
    assert held.omega(parameter) == 12.0
    with pytest.raises(ValueError, match="^times in s are not known for order = 5, only for 4, its nominal"):
        held.omega(np.array([3.0, 5.0]))
    for wrong in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(ValueError, match=r"^frequency Omega \* order is .*; it must be positive$"):
            LAYOUT.omega(np.array([wrong, 4.0]))
    with pytest.raises(ValueError, match="^frequency has 'speed'; it must name parameters: Omega, order$"):
        replace(LAYOUT, frequency=("speed",))


def test_units_of_rates() -> None:
    """Assert powers of a second from the second on, and 1 for what has no unit."""
    assert [per_time("m", k) for k in range(4)] == ["m", "m/s", "m/s^2", "m/s^3"]
    assert [per_time("", k) for k in range(3)] == ["", "1/s", "1/s^2"]


def test_factors_between_layouts() -> None:
    """Assert own scales over the other's, and the sentence where a name or a unit differs."""
    other = replace(
        LAYOUT,
        states=tuple(replace(q, scale=4 * q.scale) for q in LAYOUT.states),
        algebraics=tuple(replace(q, scale=q.scale / 2) for q in LAYOUT.algebraics),
    )
    assert LAYOUT.factors(other) == ([0.25] * 3, [2.0] * 2, [1.0] * 2)
    assert other.factors(LAYOUT) == ([4.0] * 3, [0.5] * 2, [1.0] * 2)
    unlike = [
        replace(LAYOUT, states=LAYOUT.states[:2]),
        replace(LAYOUT, states=(replace(LAYOUT.states[0], unit="N"), *LAYOUT.states[1:])),
        replace(LAYOUT, algebraics=(replace(LAYOUT.algebraics[0], name="G"), LAYOUT.algebraics[1])),
    ]
    for wrong in unlike:
        with pytest.raises(ValueError, match="^guess has the .*; it must have the system's, "):
            LAYOUT.factors(wrong, "guess")


def test_layouts_that_fit_a_system() -> None:
    """Assert it of equal names, units and scales of states, unknowns and parameters; outputs do not count."""
    system: Any = replace(LAYOUT, outputs=(Quantity("power", "W"),))
    assert LAYOUT.fits(system)
    for kind in ("states", "algebraics", "parameters"):
        own = getattr(LAYOUT, kind)
        for change in ({"name": "other"}, {"unit": "kg"}, {"scale": 3.0}):
            wrong: Any = replace(LAYOUT, frequency=(), **{kind: (replace(own[0], **change), *own[1:])})
            assert not LAYOUT.fits(wrong)
        shorter: Any = replace(LAYOUT, frequency=(), **{kind: own[:-1]})
        assert not LAYOUT.fits(shorter)


def test_signals_of_orbits_in_time() -> None:
    """Assert states, rates and second rates over t, d/dt = Omega d/dtau; of an equilibrium over tau."""
    layout = replace(LAYOUT, algebraics=(), states=LAYOUT.states[:2], frequency=("Omega",), factor=1.0)

    def states(tau: Any) -> Any:
        return np.column_stack([np.sin(tau), np.cos(tau) / 2])

    orbit = replace(along(states), parameter=np.array([1.5, 1.0]), layout=layout)
    t = np.array([[0.0, 0.3], [1.0, 2.0]])
    assert orbit.omega == 3.0 and orbit["x"].unit == "m" and orbit["x''"].name == "x''"
    assert orbit["x"](t) == pytest.approx(1e-3 * np.sin(3 * t), abs=1e-8)
    assert orbit["x'"](t) == pytest.approx(3 * 2e-3 * np.cos(3 * t) / 2, abs=1e-7)
    assert orbit["x''"](t) == pytest.approx(-9 * 2e-3 * np.sin(3 * t) / 2, abs=1e-4)
    scaled = tuple(replace(q, scale=k * q.scale) for q, k in zip(layout.states, (4.0, 0.5), strict=True))
    given = replace(layout, states=scaled, parameters=tuple(replace(q, scale=0.5) for q in layout.parameters))
    again = orbit.expressed_in(given)
    assert again.nodes == pytest.approx(orbit.nodes * [0.25, 2.0])
    assert again.stages == pytest.approx(orbit.stages * [0.25, 2.0])
    assert again.parameter.tolist() == [6.0, 2.0] and again.layout == given
    assert orbit.expressed_in(layout) is orbit
    still = replace(orbit, equilibrium=True, nodes=orbit.nodes[:1] * 0 + 2.0)
    assert still["x"].omega == 1.0
