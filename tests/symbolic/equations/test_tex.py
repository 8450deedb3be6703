"""Equations in LaTeX, written from the expressions themselves, and short texts of models and systems."""

from __future__ import annotations

import re
from typing import Any

import pytest
from support.traces import duffing_system

import symbolic as sym
from symbolic.equations.tex.products import Product, one, scaled, written

F = sym.functions
X = sym.coordinate("x")


def lines(parts: sym.Part | sym.Model) -> list[str]:
    """The equations of parts, one a line, without the space between factors."""
    model = parts if isinstance(parts, sym.Model) else sym.Model((parts,))
    inside = model.latex.removeprefix("\\begin{aligned}\n").removesuffix("\n\\end{aligned}")
    return [line.replace(r" \,", "") for line in inside.split(" \\\\\n")]


def equation(function: Any, names: str) -> str:
    """The first equation of a system of two states."""
    parameters = {"Omega": 1.0} | dict.fromkeys(names.split(), 1.0)
    states = {"q": 0.0, "v": 0.0}
    (first, *_) = lines(sym.Equations(function, states, parameters, frequency="Omega"))
    return first.partition(" &= ")[2]


def test_duffing() -> None:
    """Assert Duffing's equation, term by term in the order of the parts' sum."""
    model = (
        sym.Mass(X, 1.0)
        + sym.Damper(X, 0.1)
        + sym.Spring(X, 1.0)
        + sym.CubicSpring(X, 1.0)
        + sym.HarmonicForce(X, 0.5)
    )
    said = r"m \ddot{x} &= F \cos\left(\Omega t\right) - c \dot{x} - k x - k_{3} x^{3}"
    assert lines(model) == [said]
    assert model._repr_latex_() == f"$$\n{model.latex}\n$$"


def test_time_is_time() -> None:
    """Assert that rates are those in time, whatever the orders of the excitation make of the phase."""
    model = sym.Mass(X, 2.0) + sym.Damper(X, 0.1) + sym.HarmonicForce(X, 0.5, order="1/2")
    (line,) = lines(model + sym.Spring(X, 1.0))
    assert line == r"m \ddot{x} &= F \cos\left(\tfrac{1}{2} \Omega t\right) - c \dot{x} - k x"


@pytest.mark.parametrize(
    ("rate", "said"),
    [
        (lambda x, p: x.v, "v"),
        (lambda x, p: -p.c * x.v / p.k_s, r"-\frac{c v}{k_{s}}"),
        (lambda x, p: x.q + x.q - 3 * x.q, "-q"),
        (lambda x, p: 1e-5 * x.q**2 + 0.25, r"10^{-5} q^{2} + 0.25"),
        (lambda x, p: 1 / (1 + x.q**2), r"\frac{1}{\left(1 + q^{2}\right)}"),
        (lambda x, p: F.sqrt(x.q**2 + 1), r"\sqrt{q^{2} + 1}"),
        (lambda x, p: F.fmax(x.q, 1e-300) ** 1.5, r"\left(\max\left(q,\, 0\right)\right)^{1.5}"),
        (lambda x, p: F.fabs(x.q) * F.exp(-x.v), r"\left|q\right| e^{-v}"),
        (lambda x, p: F.if_else(x.v > 0, p.c, x.q), r"\left[0 < v\right] c + \left[0 \ge v\right] q"),
        (lambda x, p: F.sin(x.q) ** 2, r"\left(\sin\left(q\right)\right)^{2}"),
        (lambda x, p: x.q**0.25 - x.v**0.5, r"q^{0.25} - \sqrt{v}"),
        (lambda x, p: (x.q - x.v) ** 2, r"\left(q - v\right)^{2}"),
        (lambda x, p: 0.0, "0"),
    ],
)
def test_terms(rate: Any, said: str) -> None:
    """Assert how operations are written."""
    found = equation(lambda x, p, wave: {"q": rate(x, p), "v": wave.cos}, "c k_s")
    assert found == said


def test_unknowns_and_forces_on_coordinates() -> None:
    """Assert the rows of states, unknowns and coordinates of one model."""
    equations = sym.Equations(
        lambda x, p: {"s": -x.s / p.T, "z": x.z - F.tanh(x.s), "x": -x.z},
        {"s": 1.0},
        {"T": 2.0},
        unknowns={"z": 0.5},
        coordinates=[X],
    )
    assert lines(sym.Mass(X, 1.0) + sym.Spring(X, 1.0) + equations) == [
        r"m \ddot{x} &= -k x - z",
        r"\dot{s} &= -\frac{s}{T}",
        r"0 &= z - \tanh\left(s\right)",
    ]


@pytest.mark.parametrize("name", sym.scene_names())
def test_every_scene_is_written(name: str) -> None:
    """Assert that each scene is written: every operation has a sign, every brace its fellow."""
    system = sym.scene(name)
    text = system.latex
    assert len(repr(system)) < 400
    assert text.startswith("\\begin{aligned}") and "operatorname{op" not in text
    plain = re.sub(r"\\[{}]", "", text)
    assert plain.count("{") == plain.count("}") and text.count(r"\left") == text.count(r"\right")


def test_short_texts() -> None:
    """Assert that texts of models and systems fit in a line or two."""
    assert repr(X) == "Coordinate('x')" and repr(sym.parameter("k", 2.0)) == "Parameter('k', 2.0)"
    assert repr(sym.Mass(X, 1.0) + sym.Spring(X, 1.0)) == "Model(Mass, Spring)"
    system = duffing_system(0.1, 1.0, 0.5)
    assert repr(system) == "CompiledSystem(states x, x'; parameters m, c, k, k3, F, Omega; outputs x)"
    assert repr(system.parameters[1]) == "Variable(c = 0.1 N s/m)"


def test_system_in_a_notebook() -> None:
    """Assert equations and tables, with names that HTML could take for its own."""
    spring = sym.Spring(X, sym.parameter("k<b>", 1.0))
    text = sym.compile(sym.Mass(X, 1.0) + spring + sym.HarmonicForce(X, 1.0))._repr_html_()
    assert text.startswith("$$") and "<b>" not in text
    assert "<td style='text-align:left'>k&lt;b&gt;</td>" in text


def test_sum_of_parts() -> None:
    """Assert that Python's sum adds parts and models up."""
    parts = [sym.Mass(X, 1.0), sym.Spring(X, 1.0)]
    assert sum(parts) == parts[0] + parts[1] == sum([sym.Model(tuple(parts))])
    with pytest.raises(TypeError):
        1 + parts[0]  # type: ignore[operator]
    with pytest.raises(TypeError):
        -1 + sym.Model(tuple(parts))  # type: ignore[operator]


@pytest.mark.parametrize(
    ("terms", "said"),
    [
        ([], "0"),
        ([Product(0.0, {"x": 1.0})], "0"),
        ([Product(-1.0)], "-1"),
        ([Product(2.0, {"x": 1.0}), Product(-3.0, {"y": 2.0})], r"2 \, x - 3 \, y^{2}"),
        ([Product(2.0, {"x": 1.0}), Product(-3.0, {"x": 1.0})], "-x"),
        ([Product(2.0, {"x": 1.0}), Product(-2.0, {"x": 1.0})], "0"),
        ([Product(1.0, {"x": 1.0, "y": -2.0})], r"\frac{x}{y^{2}}"),
        ([Product(3.0, {"y": -1.0})], r"\frac{3}{y}"),
        ([Product(1.0, {"y": -0.5, "x": 0.5})], r"\frac{\sqrt{x}}{\sqrt{y}}"),
        ([Product(1.0, {r"\left(a + b\right)": 0.5})], r"\sqrt{a + b}"),
        ([Product(1.0, {r"\left(a\right) \left(b\right)": 0.5})], r"\sqrt{\left(a\right) \left(b\right)}"),
        ([Product(1.0, {"a + b": 2.0})], r"\left(a + b\right)^{2}"),
        ([Product(1.0, {"x_{1}^{2}": 3.0})], r"\left(x_{1}^{2}\right)^{3}"),
        ([Product(1.0, {r"\left(a + b\right)": 2.0})], r"\left(a + b\right)^{2}"),
        ([Product(1.0, {"x^{2}": 3.0})], r"\left(x^{2}\right)^{3}"),
        ([Product(1.0, {r"\dot{x}": 2.0, "k_{12}": 3.0})], r"\dot{x}^{2} \, k_{12}^{3}"),
        ([Product(1e-5)], "10^{-5}"),
        ([Product(-2.5e30)], r"-2.5 \cdot 10^{30}"),
        ([Product(0.1 + 0.2)], "0.3"),
        ([Product(1234567.0)], r"1.23457 \cdot 10^{6}"),
        ([Product(float("inf"))], r"\infty"),
        ([Product(float("-inf"))], r"-\infty"),
        ([Product(float("nan"))], r"\mathrm{NaN}"),
    ],
)
def test_sums_of_products(terms: list[Product], said: str) -> None:
    """Assert how numbers, powers, fractions and signs are written, and that terms of equal powers are one."""
    assert written(terms) == said


def test_products_of_sums() -> None:
    """Assert products and powers of products: what cancels is gone, and what is 0 stays 0."""
    x, y = Product(2.0, {"x": 1.0}), Product(4.0, {"x": 1.0, "y": 2.0})
    assert x.times(y) == Product(8.0, {"x": 2.0, "y": 2.0})
    assert x.times(y, -1.0) == Product(0.5, {"y": -2.0})
    assert x.times(y, 0.5) == Product(4.0, {"x": 1.5, "y": 1.0})
    assert x.times(Product(0.0, {"y": 1.0})) == Product(0.0, {"x": 1.0, "y": 1.0})
    assert one([]) == Product(0.0) and one([x]) == x
    assert one([x, y]) == Product(1.0, {r"\left(2 \, x + 4 \, x \, y^{2}\right)": 1.0})
    assert scaled([x, y], -3.0) == [Product(-6.0, {"x": 1.0}), Product(-12.0, {"x": 1.0, "y": 2.0})]
