"""C of a system's motions: its numbers, tables and routines, and what follows motions (`follow.c`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib import resources

import casadi as ca
import numpy as np
from scipy.integrate import DOP853

from symbolic.equations.expressions import Expressions
from symbolic.equations.surfaces import Kind, Surface
from symbolic.integration.field import VectorField
from symbolic.kernels.csource import HEAD
from symbolic.kernels.routine import SIGNATURE, routine

KINDS = (Kind.KINK, Kind.JUMP, Kind.SLIDING, Kind.SLIDER, Kind.RELAY, Kind.IMPACT, Kind.MARKER)
"""In the order of C's numbers for them."""

INCLUDED = "#include <stdlib.h>\n#include <string.h>\n"


def source(field: VectorField, surfaces: Sequence[Surface]) -> str:
    """Return the C source of a system's motions."""
    e = field.expressions
    at = [field.y, e.phase, e.parameter, e.sided.side]
    routines = {
        "field": [field.rates],
        "guards": _guards(field),
        "slope": [ca.jacobian(field.rates, field.y)],
        "constraint": [ca.jacobian(field.constraints, field.y)],
        "gradient": [ca.jacobian(e.guards, field.y), ca.jacobian(e.guards, e.phase)],
    }
    made = {name: routine(name, at, results) for name, results in routines.items()}
    mapped = {k: routine(f"reset{k}", at, [_mapped(field, k)]) for k in e.resets}
    sloped = {k: routine(f"reset_slope{k}", at, _sloped(field, k)) for k in e.resets}
    numbers = {
        "N": field.y.numel(),
        "STATES": e.state.numel(),
        "SWITCHES": e.guards.numel(),
        "SURFACES": len(surfaces),
        "SENSITIVITY": field.sensitivity,
        "SIDES": e.sided.side.numel(),
        "KINKS": sum(s.kind == Kind.KINK and s.column is None for s in surfaces),
        **{f"KEPT_{name.upper()}": each.kept for name, each in made.items()},
        "KEPT_RESET": sum(each.kept for each in mapped.values()),
        "KEPT_RESET_SLOPE": sum(each.kept for each in sloped.values()),
    }
    return "\n".join(
        [
            HEAD + INCLUDED,
            *(f"#define {name} {value}" for name, value in numbers.items()),
            *_tables(e, surfaces),
            *(each.text for each in (*made.values(), *mapped.values(), *sloped.values())),
            _chosen("reset", {k: each.kept for k, each in mapped.items()}, ["out"]),
            _chosen("reset_slope", {k: each.kept for k, each in sloped.items()}, ["mapping", "drift"]),
            resources.files(__package__).joinpath("follow.c").read_text(),
        ]
    )


def _guards(field: VectorField) -> list[ca.SX]:
    """All switches and their derivatives in tau along the motion."""
    e = field.expressions
    along = ca.jtimes(e.guards, e.state, field.rates[: e.state.numel()]) if e.guards.numel() else e.guards
    return [e.guards, along + ca.jacobian(e.guards, e.phase)]


def _mapped(field: VectorField, switch: int) -> ca.SX:
    """The variables after an impact; unknowns stay, which another place puts on their constraints."""
    return ca.vertcat(field.expressions.resets[switch], field.expressions.algebraic)


def _sloped(field: VectorField, switch: int) -> list[ca.SX]:
    """Their derivatives in the variables before it and in tau."""
    after = _mapped(field, switch)
    return [ca.jacobian(after, field.y), ca.jacobian(after, field.expressions.phase)]


def _chosen(name: str, kept: dict[int, int], results: Sequence[str]) -> str:
    """C of one routine out of several, by the index of a switch."""
    given, places = ", ".join(results), np.cumsum([0, *kept.values()])
    taken = ", ".join(f"double *restrict {each}" for each in results)
    cases = [
        f"if (k == {k}) {name}{k}(y, tau, side, kept + {place}, {given});"
        for k, place in zip(kept, places, strict=False)
    ]
    once = [f"{name}{k}_once(p, kept + {place});" for k, place in zip(kept, places, strict=False)]
    return "\n".join(
        [
            f"static void {name}(int k, {SIGNATURE}, {taken}) {{",
            *cases,
            "}",
            f"static void {name}_once(const double *restrict p, double *restrict kept) {{",
            *once,
            "}",
        ]
    )


def _tables(e: Expressions, surfaces: Sequence[Surface]) -> list[str]:
    """What the driver reads: the surfaces, and the coefficients of the method."""
    stages = DOP853.n_stages
    resting = [e.resting.get(s.switch) for s in surfaces]
    integers = {
        "KIND": [KINDS.index(s.kind) for s in surfaces],
        "SWITCH": [s.switch for s in surfaces],
        "COLUMN": [-1 if s.column is None else s.column for s in surfaces],
        "UP": [-1 if s.releases is None else s.releases[0] for s in surfaces],
        "DOWN": [-1 if s.releases is None else s.releases[1] for s in surfaces],
        "LEAVES": [-1 if s.leaves is None else s.leaves for s in surfaces],
        "POSITION": [0 if r is None else r.position for r in resting],
        "VELOCITY": [0 if r is None else r.velocity for r in resting],
    }
    weights = {"B": DOP853.B, "C": DOP853.C[:stages], "E5": DOP853.E5[:stages], "E3": DOP853.E3[:stages]}
    rows = [_listed(row[:stages]) for row in DOP853.A[:stages]]
    return [
        *(f"static const int {name}[] = {{{_joined([*map(str, v), '0'])}}};" for name, v in integers.items()),
        *(f"static const double {name}[] = {_listed(values)};" for name, values in weights.items()),
        f"static const double A[][{stages}] = {{{_joined(rows)}}};",
    ]


def _listed(values: Iterable[float]) -> str:
    """Numbers in C, exact to the last bit."""
    return f"{{{_joined(float(value).hex() for value in values)}}}"


def _joined(texts: Iterable[str]) -> str:
    return ", ".join(texts)
