"""The equations of a system as text, a line for each operation, for those who are not to trust the engine.

    v3 = v1 * x0,    v4 = cos(t),    v5 = max(v3, v4),    v6 = v5 ^ p2

x0.. are the scaled states, t is tau, p0.. are the parameters in SI. less(a, b) is 1 where a < b, else 0.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

import casadi as ca

from symbolic.equations.expressions import Expressions
from symbolic.integration.rates import constraint_rows, explicit_rates

INFIX = {ca.OP_ADD: "+", ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/", ca.OP_POW: "^", ca.OP_CONSTPOW: "^"}
"""Operations with a sign between what they are of."""

CALLED = {
    ca.OP_SIN: "sin",
    ca.OP_COS: "cos",
    ca.OP_EXP: "exp",
    ca.OP_LOG: "log",
    ca.OP_SQRT: "sqrt",
    ca.OP_ATAN: "atan",
    ca.OP_INV: "inv",
    ca.OP_FMAX: "max",
    ca.OP_FMIN: "min",
    ca.OP_FABS: "abs",
    ca.OP_SIGN: "sign",
    ca.OP_LT: "less",
    ca.OP_LE: "less",
}
"""Operations that the text has as functions of one or two values; the last two differ at single points."""

COMPOSED: dict[int, Callable[..., list[tuple[str, ...]]]] = {
    ca.OP_NEG: lambda a: [("0", "-", a)],
    ca.OP_SQ: lambda a: [(a, "*", a)],
    ca.OP_TWICE: lambda a: [("2", "*", a)],
    ca.OP_NOT: lambda a: [("1", "-", a)],
    ca.OP_AND: lambda a, b: [(a, "*", b)],
    ca.OP_OR: lambda a, b: [(a, "*", b), (a, "+", b), ("{1}", "-", "{0}")],
    ca.OP_IF_ELSE_ZERO: lambda a, b: [(a, "*", b)],
    ca.OP_TAN: lambda a: [("sin", a), ("cos", a), ("{0}", "/", "{1}")],
    ca.OP_LOG1P: lambda a: [("1", "+", a), ("log", "{0}")],
    ca.OP_EXPM1: lambda a: [("exp", a), ("{0}", "-", "1")],
    ca.OP_TANH: lambda a: [
        ("2", "*", a),
        ("exp", "{0}"),
        ("{1}", "+", "1"),
        ("2", "/", "{2}"),
        ("1", "-", "{3}"),
    ],
    ca.OP_COSH: lambda a: [("exp", a), ("inv", "{0}"), ("{0}", "+", "{1}"), ("{2}", "*", "0.5")],
    ca.OP_SINH: lambda a: [("exp", a), ("inv", "{0}"), ("{0}", "-", "{1}"), ("{2}", "*", "0.5")],
    ca.OP_ASIN: lambda a: [(a, "*", a), ("1", "-", "{0}"), ("sqrt", "{1}"), (a, "/", "{2}"), ("atan", "{3}")],
}
"""Operations that are written with several lines; {0}, {1} are those before."""


@dataclass(frozen=True)
class Written:
    """Equations as text.

    Parameters
    ----------
    lines : tuple of str
        One for each operation.
    rates, outputs : tuple of str
        The names of the lines with dx/dtau, and with the outputs in SI.
    constraint : str, optional
        The name of the line that vanishes, where the system has an unknown: the last of x0..
    values : dict of str to int
        Names p0.. of the parameters that occur, with their indices.
    resets : dict of str to tuple of str
        By the line max(s, 0) of a wall, which a motion stays before, the names of the states after an impact.
    impacts : dict of str to int
        Indices of the walls' switches, by these lines.
    """

    lines: tuple[str, ...]
    rates: tuple[str, ...]
    outputs: tuple[str, ...]
    constraint: str | None
    values: dict[str, int]
    resets: dict[str, tuple[str, ...]]
    impacts: dict[str, int]


def written(e: Expressions) -> Written:
    """Return the equations of a system with one unknown at the most.

    Parameters
    ----------
    e : Expressions
        The system.

    Returns
    -------
    Written
        Rates and outputs as text.

    Raises
    ------
    ValueError
        For a system with several unknowns, sliders or relays, one that is condensed, one whose rows
        are not linear in the rates, and for operations that the text does not have.
    """
    if (m := e.algebraic.numel()) > 1:
        raise ValueError(
            f"the system has {m} unknowns beside its states; with more than one it is not written as text"
        )
    if e.resets and m:
        raise ValueError("the system has impacts and an unknown beside its states; it is not written as text")
    if e.sliders or e.relays:
        raise ValueError("the system has sliders or relays; they are not written as text")
    n = e.state.numel()
    rates, constraint = _explicit(e, n)
    outputs, x = ca.substitute(e.outputs, e.rate, rates), ca.vertcat(e.state, e.algebraic)
    names = [[f"x{i}" for i in range(n + m)], ["t"], [f"p{i}" for i in range(e.parameter.numel())]]
    walls = ca.vertcat(ca.SX(0, 1), *(e.switches[k] for k in e.resets))
    wanted = [rates, outputs, constraint, walls, *e.resets.values()]
    found = _Lines(ca.Function("text", [x, e.phase, e.parameter], wanted), names)
    first, second, third, fourth, *after = (tuple(each) for each in found.results)
    guards = [found.line("max", name, "0.0") for name in fourth]
    used = set(re.findall(r"\bp\d+\b", " ".join((*found.lines, *first, *second, *sum(after, ())))))
    values = {name: i for i, name in enumerate(names[2]) if name in used}
    resets, impacts = dict(zip(guards, after, strict=True)), dict(zip(guards, e.resets, strict=True))
    return Written(tuple(found.lines), first, second, third[0] if m else None, values, resets, impacts)


def _explicit(e: Expressions, n: int) -> tuple[ca.SX, ca.SX]:
    """dx/dtau, and what vanishes: the row without rates that determines an unknown; none without unknowns."""
    if not e.algebraic.numel():
        return explicit_rates(e), ca.SX(0, 1)
    if any(e.residual[i].is_zero() for i in range(n)):
        raise ValueError("the system's linear part is condensed; it is not written as text")
    constraints = constraint_rows(e)
    if len(constraints) != 1:
        raise ValueError(
            "the system's unknown is not determined by a row without rates; it is not written as text"
        )
    rows = ca.vertcat(*(e.residual[i] for i in range(n + 1) if i not in constraints))
    slope = ca.jacobian(rows, e.rate)
    if ca.depends_on(slope, e.rate):
        raise ValueError("the rows of the system are not linear in its rates; they are not written as text")
    rates = ca.solve(slope, -ca.substitute(rows, e.rate, ca.SX.zeros(n)))
    return rates, e.residual[constraints[0]]


@dataclass
class _Lines:
    """The instructions of a function as lines; its work vector has the name of what each place holds."""

    function: ca.Function
    names: list[list[str]]
    lines: list[str] = field(default_factory=list, init=False)
    known: dict[tuple[str, ...], str] = field(default_factory=dict, init=False)
    results: list[list[str]] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        f, work = self.function, {}
        self.results = [["0"] * f.numel_out(k) for k in range(f.n_out())]
        for k in range(f.n_instructions()):
            operation, of, to = f.instruction_id(k), f.instruction_input(k), f.instruction_output(k)
            if operation == ca.OP_INPUT:
                work[to[0]] = self.names[of[0]][of[1]]
            elif operation == ca.OP_OUTPUT:
                self.results[to[0]][to[1]] = work[of[0]]
            elif operation == ca.OP_CONST:
                work[to[0]] = repr(f.instruction_constant(k))
            else:
                work[to[0]] = self._written(operation, [work[i] for i in of])

    def _written(self, operation: int, of: list[str]) -> str:
        """The name of an operation's result."""
        if operation in CALLED:
            return self.line(CALLED[operation], *of)
        if operation in INFIX:
            return self.line(of[0], INFIX[operation], of[1])
        if operation not in COMPOSED:
            raise ValueError(
                f"the equations have an operation ({_name(operation)}) that the text does not have"
            )
        before: list[str] = []
        for terms in COMPOSED[operation](*of):
            before.append(self.line(*(term.format(*before) for term in terms)))
        return before[-1]

    def line(self, *terms: str) -> str:
        """The name of a line, one and the same for equal ones."""
        if terms not in self.known:
            self.known[terms] = f"v{len(self.lines)}"
            first, *rest = terms
            infix = len(terms) == 3 and terms[1] in INFIX.values()
            text = " ".join(terms) if infix else f"{first}({', '.join(rest)})"
            self.lines.append(f"{self.known[terms]} = {text}")
        return self.known[terms]


def _name(operation: int) -> str:
    """What CasADi calls an operation."""
    return next(n[3:].lower() for n in dir(ca) if n.startswith("OP_") and getattr(ca, n) == operation)
