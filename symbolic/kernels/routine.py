"""CasADi expressions as C functions of one point, for drivers in C that call them.

What depends on the parameters alone is evaluated once for each run, by a function of its own, and kept.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca

from symbolic.kernels.csource import statements

READS = ("y[{k}]", "tau", "p[{k}]", "side[{k}]")
"""How arguments are read: the variables, the phase, the parameters, the sides of jumps."""

MOVING = (True, True, False, True)
"""Which of them change along a motion."""

SIGNATURE = "const double *restrict y, double tau, const double *restrict side, const double *restrict kept"
"""What a routine takes before its results."""


@dataclass(frozen=True)
class Routine:
    """C of `NAME_once(p, kept)` and of `NAME(y, tau, side, kept, out0, ...)`; results are dense, row by row.

    kept: how many numbers the first leaves for the second.
    """

    text: str
    kept: int


def routine(name: str, arguments: Sequence[ca.SX], results: Sequence[ca.SX]) -> Routine:
    """Return the routine of some results in (y, tau, p, side)."""
    function = ca.Function(name, list(arguments), ca.cse([ca.densify(each) for each in results]))
    places = [_places(function.size_out(i)) for i in range(function.n_out())]
    once, each = statements(function, READS, MOVING, places)
    used = set(re.findall(r"\bv\d+\b", " ".join(each)))
    known = [match[1] for line in once if (match := re.match(r"const double (v\d+) =", line))]
    carried = [v for v in known if v in used]
    filled = ", ".join(f"double *restrict out{i}" for i in range(function.n_out()))
    lines = [
        f"static void {name}_once(const double *restrict p, double *restrict kept) {{",
        *once,
        *(f"kept[{i}] = {v};" for i, v in enumerate(carried)),
        "}",
        f"static void {name}({SIGNATURE}, {filled}) {{",
        *(f"const double {v} = kept[{i}];" for i, v in enumerate(carried)),
        *each,
        "}",
    ]
    return Routine("\n".join(lines), len(carried))


def _places(size: tuple[int, int]) -> list[str]:
    """Where the elements of a dense result lie, which CasADi has column by column."""
    high, wide = size
    return [f"[{wide * r + c}]" for c in range(wide) for r in range(high)]
