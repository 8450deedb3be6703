"""CasADi expressions written out as C: one loop over the points, one statement per instruction.

What depends on no point (parameters and constants) is evaluated once, before the loop.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import casadi as ca

HEAD = """#include <math.h>
#include <stddef.h>
static inline double least(double a, double b) { return a < b || a != a ? a : b; }
static inline double most(double a, double b) { return a > b || a != a ? a : b; }
static inline double sign(double a) { return a != a ? a : (double)((a > 0) - (a < 0)); }
"""
"""NumPy's minimum, maximum and sign, which keep NaN where C's own do not."""

ARITHMETIC = {
    ca.OP_ADD: "{0} + {1}",
    ca.OP_SUB: "{0} - {1}",
    ca.OP_MUL: "{0} * {1}",
    ca.OP_DIV: "{0} / {1}",
    ca.OP_ASSIGN: "{0}",
    ca.OP_NEG: "-{0}",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_TWICE: "{0} + {0}",
    ca.OP_INV: "1.0 / {0}",
}
FUNCTIONS = {
    ca.OP_POW: "pow({0}, {1})",
    ca.OP_CONSTPOW: "pow({0}, {1})",
    ca.OP_FMOD: "fmod({0}, {1})",
    ca.OP_COPYSIGN: "copysign({0}, {1})",
    ca.OP_ATAN2: "atan2({0}, {1})",
    ca.OP_HYPOT: "hypot({0}, {1})",
    ca.OP_EXP: "exp({0})",
    ca.OP_EXPM1: "expm1({0})",
    ca.OP_LOG: "log({0})",
    ca.OP_LOG1P: "log1p({0})",
    ca.OP_SQRT: "sqrt({0})",
    ca.OP_SIN: "sin({0})",
    ca.OP_COS: "cos({0})",
    ca.OP_TAN: "tan({0})",
    ca.OP_ASIN: "asin({0})",
    ca.OP_ACOS: "acos({0})",
    ca.OP_ATAN: "atan({0})",
    ca.OP_SINH: "sinh({0})",
    ca.OP_COSH: "cosh({0})",
    ca.OP_TANH: "tanh({0})",
    ca.OP_ASINH: "asinh({0})",
    ca.OP_ACOSH: "acosh({0})",
    ca.OP_ATANH: "atanh({0})",
    ca.OP_FLOOR: "floor({0})",
    ca.OP_CEIL: "ceil({0})",
    ca.OP_FABS: "fabs({0})",
    ca.OP_SIGN: "sign({0})",
}
"""What C and NumPy write alike, and functions that they call by the same names."""

OPERATIONS = {
    **ARITHMETIC,
    **FUNCTIONS,
    ca.OP_LT: "{0} < {1}",
    ca.OP_LE: "{0} <= {1}",
    ca.OP_EQ: "{0} == {1}",
    ca.OP_NE: "{0} != {1}",
    ca.OP_AND: "{0} != 0 && {1} != 0",
    ca.OP_OR: "{0} != 0 || {1} != 0",
    ca.OP_NOT: "{0} == 0",
    ca.OP_FMIN: "least({0}, {1})",
    ca.OP_FMAX: "most({0}, {1})",
    ca.OP_IF_ELSE_ZERO: "{0} != 0 ? {1} : 0",
    ca.OP_ERF: "erf({0})",
}


def csource(function: ca.Function, names: Sequence[str], reads: Sequence[str]) -> str:
    """Return C for kernel(points, arguments, out0, out1, ...), every array contiguous.

    reads: how component {k} of an argument is read at point i; without an i it is the same at every point.
    """
    taken = [f"const double *restrict {name}" for name in names]
    filled = [f"double *restrict out{i}" for i in range(function.n_out())]
    places = [_places(function.sparsity_out(i)) for i in range(function.n_out())]
    moving = ["i" in read.partition("[")[2] for read in reads]
    once, each = statements(function, reads, moving, places)
    signature = ", ".join(["ptrdiff_t points", *taken, *filled])
    loop = ["for (ptrdiff_t i = 0; i < points; i++) {", *each, "}"]
    return "\n".join([f"{HEAD}void kernel({signature}) {{", *once, *loop, "}", ""])


def statements(
    function: ca.Function, reads: Sequence[str], moving: Sequence[bool], places: Sequence[Sequence[str]]
) -> tuple[list[str], list[str]]:
    """Return a function's instructions as C: those that depend on no moving argument, and the others.

    reads: how component {k} of each argument is read; places: where each result's nonzeros are written, what
    follows ``out0``.
    """
    once: list[str] = []
    each: list[str] = []
    values: dict[int, str] = {}
    varying: set[str] = set()
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        inputs, outputs = function.instruction_input(k), function.instruction_output(k)
        if operation == ca.OP_CONST:
            values[outputs[0]] = _literal(function.instruction_constant(k))
        elif operation == ca.OP_OUTPUT:
            each.append(f"out{outputs[0]}{places[outputs[0]][outputs[1]]} = {values[inputs[0]]};")
        else:
            if operation == ca.OP_INPUT:
                text, given = reads[inputs[0]].format(k=inputs[1]), []
                moves = moving[inputs[0]]
            else:
                given = [values[i] for i in inputs]
                text, moves = OPERATIONS[operation].format(*given), not varying.isdisjoint(given)
            values[outputs[0]] = name = f"v{k}"
            (each if moves else once).append(f"const double {name} = {text};")
            if moves:
                varying.add(name)
    return once, each


def _places(sparsity: ca.Sparsity) -> list[str]:
    """Where the nonzeros of a result lie in its array (points, rows, columns)."""
    rows, columns = sparsity.get_triplet()
    high, wide = sparsity.shape
    return [f"[{high * wide} * i + {wide * r + c}]" for r, c in zip(rows, columns, strict=True)]


def _literal(value: float) -> str:
    """A constant, exact to the last bit."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    return f"({value.hex()})"
