"""Equations written as functions: rows, events and names, evaluated at numbers."""

from __future__ import annotations

from typing import Any

import casadi as ca
import pytest

import symbolic as sym
from symbolic.equations.assembly import Assembly
from symbolic.parts.equations import Names, _fitting, _flat


def at(expression: ca.SX, *given: tuple[ca.SX, float]) -> float:
    """An expression at numbers for symbols."""
    symbols, numbers = ca.vertcat(*(s for s, _ in given)), [number for _, number in given]
    return float(ca.Function("f", [symbols], [ca.SX(expression)])(numbers))


def test_rows_of_equations() -> None:
    """Assert omega x' - f over the scale of x, g of an unknown, a force on a coordinate, and outputs."""
    q, assembly = sym.coordinate("q", scale=1.0), Assembly()
    part = sym.Equations(
        lambda x, p: {"x": p.k * x.x + x.z, "z": x.z - 3 * x.x, "q": -2 * x.q_dot},
        {"x": 0.5},
        {"k": 4.0},
        unknowns={"z": 0.25},
        coordinates=[q],
        scales={"x": 0.1},
        outputs=lambda x, p: {"double": 2 * x.x},
        switches=lambda x, p: {"half": x.x - 0.5},
    )
    part.contribute(assembly)
    x, z = assembly.states[0], assembly.unknowns[0]
    known = ((x.symbol, 2.0), (z.symbol, 7.0), (x.derivative, 5.0), (assembly.omega, 3.0))
    (k,) = [s for s in ca.symvar(assembly.differential_rows[0]) if s.name() == "k"]
    assert at(assembly.differential_rows[0], *known, (k, 4.0)) == pytest.approx((15 - 8 - 7) / 0.1)
    assert at(assembly.algebraic_rows[0], *known) == 1.0
    assert (float(ca.DM(x.rest)), float(ca.DM(z.rest)), x.scale) == (0.5, 0.25, 0.1)
    motion = assembly.motion(q)
    assert at(motion.force, (assembly.omega, 3.0), (motion.velocity.symbol, 2.0)) == -12.0
    assert [v.name for v, _ in assembly.outputs] == ["x", "double"]
    assert [(i.name, i.direction) for i, _ in assembly.switches] == [("half", 0)]
    assert at(assembly.switches[0][1], *known) == 1.5


def test_resets_of_states() -> None:
    """Assert new values by state, those of speeds over omega, where the event falls."""
    q, assembly = sym.coordinate("q", scale=1.0), Assembly()
    sym.Equations(
        lambda x, p: {"v": -x.v},
        {"v": 0.0},
        coordinates=[q],
        resets=lambda x, p: {"wall": (1 - x.q, {"v": -0.5 * x.v, "q_dot": -0.8 * x.q_dot, "q": x.q + 1})},
    ).contribute(assembly)
    v, motion = assembly.states[0], assembly.motion(q)
    ((index, to),) = assembly.resets.items()
    known = (
        (v.symbol, 2.0),
        (motion.position.symbol, 4.0),
        (motion.velocity.symbol, 5.0),
        (assembly.omega, 3.0),
    )
    assert index == 0 and list(to) == [v, motion.velocity, motion.position]
    assert [at(new, *known) for new in to.values()] == pytest.approx([-1.0, -4.0, 5.0])
    info, switch = assembly.switches[0]
    assert (info.name, info.direction) == ("wall", -1) and at(switch, *known) == -3.0


@pytest.mark.parametrize(
    ("found", "said"),
    [
        ([1], "what resets returned is"),
        ({"a of b": (1, {"v": 0})}, "name of a reset is 'a of b'; it must be a name without ' of ' in it"),
        ({"a": [1, {"v": 0}]}, r"resets\['a'\] is .*; it must be a pair \(s, \{state: new value\}\)"),
        ({"a": (1, {"v": 0}, 2)}, r"resets\['a'\] is .*; it must be a pair"),
        ({"a": (1, {})}, r"resets\['a'\] is .*; it must be a pair"),
        ({"a": (1, [2])}, r"resets\['a'\] is .*; it must be a pair"),
        ({"a": (1,)}, r"resets\['a'\] is .*; it must be a pair"),
    ],
)
def test_resets_that_are_refused(found: Any, said: str) -> None:
    """Assert the sentence."""
    with pytest.raises(ValueError, match=f"^{said}"):
        _flat(lambda: found, [])


def test_resets_as_one_mapping() -> None:
    """Assert events and new values under names of their own, nothing without any function."""
    assert _flat(lambda p: {"a": (p, {"v": 2, "w": 3}), "b": (4, {"v": 5})}, [1]) == {
        "a": 1,
        "v of a": 2,
        "w of a": 3,
        "b": 4,
        "v of b": 5,
    }
    assert _flat(None, [1]) == {}


def test_names_that_fit() -> None:
    """Assert the sentences for names that are not wanted, and for such as are missing."""
    _fitting("it", ["a", "b"], ["a", "b"])
    _fitting("it", ["b", "c"], ["b"], ["c"])
    _fitting("it", ["b"], ["a", "b"], all_needed=False)
    with pytest.raises(ValueError, match="^it has 'c'; it must be one of a, b$"):
        _fitting("it", ["a", "b", "c"], ["a"], ["b"])
    with pytest.raises(ValueError, match="^it has 'c'; it must be one of none$"):
        _fitting("it", ["c"], [])
    with pytest.raises(ValueError, match="^it has no a, c; it must have a, b, c$"):
        _fitting("it", ["b"], ["a", "b", "c"])


def test_symbols_by_name() -> None:
    """Assert attributes and items, the sentence for others, and no private ones."""
    symbol = ca.SX.sym("v")
    names = Names("x", {"v": symbol})
    assert names.v is symbol and names["v"] is symbol
    with pytest.raises(ValueError, match="^the equations use x.w; x has v$"):
        _ = names.w
    with pytest.raises(AttributeError):
        _ = names._v


def test_resets_of_what_is_no_state() -> None:
    """Assert the sentences for a state that there is not, and for an unknown in an event."""
    for resets, said in (
        (lambda x, p: {"a": (x.v, {"w": 0 * x.v})}, r"resets\['a'\] has 'w'; it must be one of v"),
        (lambda x, p: {"a": (x.z, {"v": 0 * x.v})}, "switch 'a' depends on the unknown z; it must be a"),
        (lambda x, p: {"a": (x.v, {"v": x.z})}, "switch 'v of a' depends on the unknown z"),
    ):
        part = sym.Equations(
            lambda x, p: {"v": -x.v, "z": x.z},
            {"v": 0.0},
            unknowns={"z": 0.0},
            resets=resets,
        )
        with pytest.raises(ValueError, match=said):
            part.contribute(Assembly())


@pytest.mark.parametrize("index", [3, 2])
def test_unknown_that_no_equation_determines(index: int) -> None:
    """Assert the sentence for a pendulum on a rod, whose force only derivatives of its constraint tell."""

    def pendulum(x: Any, p: Any, wave: Any) -> dict[str, Any]:
        constraints = {3: x.x**2 + x.y**2 - 1, 2: x.x * x.u + x.y * x.v}
        return {
            **{"x": x.u, "y": x.v, "u": -x.rod * x.x + wave.cos, "v": -x.rod * x.y - 9.81},
            "rod": constraints[index],
        }

    states = {"x": 0.0, "y": -1.0, "u": 0.0, "v": 0.0}
    part = sym.Equations(pendulum, states, {"Omega": 1.0}, unknowns={"rod": 9.81}, frequency="Omega")
    said = "unknowns has 'rod', not determined by their equations: that of 'rod' contains none of them"
    with pytest.raises(ValueError, match=rf"^{said} \(index above 1\); they must be differentiated in time "):
        sym.compile(part)


def test_unknowns_that_too_few_equations_determine() -> None:
    """Assert the sentence where two equations contain one of two unknowns."""
    part = sym.Equations(
        lambda x, p: {"q": x.a + x.b, "a": x.a - x.q, "b": x.a + x.q},
        {"q": 0.0},
        {},
        unknowns={"a": 0.0, "b": 0.0},
    )
    with pytest.raises(ValueError, match="'a', 'b', not determined by .*: they contain too few of them"):
        sym.compile(part)
