"""Heights of waves in a rolling bearing, multiblade coordinates, and a gear's transmission error, by hand."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import casadi as ca
import numpy as np
import pytest

import symbolic as sym
from symbolic.parts.bearings.multiblade import IDLE, Multiblade
from symbolic.parts.bearings.waves import Turns

A, PHI, PLACE, SHAFT, SPIN = 2e-6, 0.3, 0.7, 1.9, 2.3


def height(surface: Any, waves: int) -> float:
    """The height at an element."""
    assembly = sym.Assembly()
    turns = Turns(ca.SX(PLACE), ca.SX(SHAFT), ca.SX(SPIN))
    found = sym.RaceWave(surface, waves, A, PHI).height(assembly, turns)
    return number(found)


def number(expression: ca.SX) -> float:
    """An expression of amplitude and phase, at their values."""
    symbols = ca.symvar(expression)
    known = {"amplitude": A, "phase": PHI}
    values = [known[str(symbol).rsplit("_", 1)[1]] for symbol in symbols]
    return float(ca.Function("value", [ca.vcat(symbols)], [expression])(values))


def test_heights_of_waves() -> None:
    """Assert a cos(n theta + phi), a cos(n (theta - theta_s) + phi), and both sides of a ball."""
    assert height("outer", 3) == pytest.approx(A * math.cos(3 * PLACE + PHI), rel=1e-12)
    assert height("inner", 5) == pytest.approx(A * math.cos(5 * (PLACE - SHAFT) + PHI), rel=1e-12)
    assert height("ball", 4) == pytest.approx(2 * A * math.cos(4 * SPIN + PHI), rel=1e-12)
    assert height("ball", 3) == pytest.approx(0.0, abs=1e-12 * A)


@pytest.mark.parametrize(("surface", "needed"), [("inner", "passages"), ("ball", "passages and spin")])
def test_waves_without_a_common_period(surface: Any, needed: str) -> None:
    """Assert the sentence that names what is to be given."""
    turns = Turns(ca.SX(PLACE), None, None)
    said = (
        f"^waves on the {surface} have no common period .*; give the bearing {needed} per turn of the shaft"
    )
    with pytest.raises(ValueError, match=said):
        sym.RaceWave(surface, 3, A).height(sym.Assembly(), turns)


@pytest.mark.parametrize("waves", [0, -1, 1.5])
def test_waves_that_are_none(waves: Any) -> None:
    """Assert at least one, whole."""
    with pytest.raises(ValueError, match=f"^waves is {waves}; it must be a whole number of at least 1"):
        sym.RaceWave("outer", waves, A)


@pytest.mark.parametrize(
    ("surface", "spin", "order"),
    [
        ("outer", "5/2", "31/10"),
        ("inner", "5/2", 4),
        ("ball", "5/2", 10),
        ("ball", None, 4),
        ("ball", 3, 12),
    ],
)
def test_orders_of_waves(surface: Any, spin: Any, order: Any) -> None:
    """Assert passages for the outer race, waves for the inner one, and waves times spin for a ball."""
    found = sym.RaceWave(surface, 4, A).order("31/10", spin)
    assert found == order or Fraction(found) == Fraction(order)


def blades(count: int, values: list[float], passage: float) -> tuple[list[float], list[str]]:
    """What each of n elements has, and the names of the coefficients."""
    assembly, tau = sym.Assembly(), ca.SX.sym("tau")
    each = Multiblade.of(assembly, "v", count, tau)
    symbols = [state.symbol for state in each.states]
    elements = ca.vcat([each.element(i) for i in range(count)])
    found = ca.Function("elements", [ca.vcat(symbols), tau], [elements])(values, passage)
    return [float(value) for value in np.array(found).ravel()], [str(symbol) for symbol in symbols]


@pytest.mark.parametrize("count", [3, 4])
def test_elements_by_their_coefficients(count: int) -> None:
    """Assert the series at theta_i = (tau + 2 pi i)/n, with as many waves as half the elements."""
    waves = count // 2
    values = [0.5, *(0.1 * k for k in range(1, 2 * waves + 1))]
    found, names = blades(count, values, 0.4)
    assert len(names) == 1 + 2 * waves
    for i, element in enumerate(found):
        theta = (0.4 + 2 * math.pi * i) / count
        series = (
            values[2 * k - 1] * math.cos(k * theta) + values[2 * k] * math.sin(k * theta)
            for k in range(1, waves + 1)
        )
        assert element == pytest.approx(0.5 + sum(series), rel=1e-12)


def test_elements_take_each_others_places() -> None:
    """Assert that an element has a passage later what the next one has now."""
    values = [0.5, 0.1, 0.2]
    now, later = (blades(3, values, tau)[0] for tau in (0.4, 0.4 + 2 * math.pi))
    assert later == pytest.approx([*now[1:], now[0]], rel=1e-12)


def test_what_no_element_shows() -> None:
    """Assert that cos and sin of n/2 in quadrature move none of 4 elements, and that 3 have no such row."""
    tau = 0.4
    hidden = [0.0, 0.0, 0.0, -math.sin(tau / 2), math.cos(tau / 2)]
    assert blades(4, hidden, tau)[0] == pytest.approx([0.0] * 4, abs=1e-12)
    assembly = sym.Assembly()
    assert Multiblade.of(assembly, "v", 3, ca.SX.sym("tau")).idle() == []
    assert IDLE * 2 * math.pi == pytest.approx(-math.log(6.5e-9), abs=0.1)
