"""Second derivatives of a system, contracted: what curves of bifurcation points and of peaks need.

For rows F(x', x, z, tau, p), weights w and a direction v = (v_x', v_x, v_z, v_p) at each point

    b = w . (F_x' v_x' + F_x v_x + F_z v_z + F_p v_p),

and wanted is the gradient of b in (x', x, z, tau, p) at fixed w and v. CasADi differentiates forwards along
v, then backwards: the cost is a few times that of F, whatever the number of states.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np

from symbolic.arrays import Array
from symbolic.interrupts import interruptible
from symbolic.kernels.choice import Kernels
from symbolic.kernels.kernel import Argument, batch, build, points, vector


@dataclass(frozen=True)
class Gradient:
    """Gradient of b at N points: rate, state (N, n), algebraic (N, m), phase (N,), parameter (N, p)."""

    rate: Array
    state: Array
    algebraic: Array
    phase: Array
    parameter: Array


@dataclass(frozen=True)
class Symbols:
    """What the rows are written in: x', x, z, tau and p."""

    rate: ca.SX
    state: ca.SX
    algebraic: ca.SX
    phase: ca.SX
    parameter: ca.SX


@interruptible()
def contraction(symbols: Symbols, rows: ca.SX, kernels: Kernels = Kernels.NUMPY) -> Callable[..., Gradient]:
    """Return (x', x, z, tau, p, w, v_x', v_x, v_z, v_p) -> Gradient for batches of points.

    w (N, rows), v_p (p,); the others as their symbols.
    """
    base = (symbols.rate, symbols.state, symbols.algebraic, symbols.phase, symbols.parameter)
    weights = ca.SX.sym("weights", rows.size1())
    along = [
        ca.SX.sym(f"v_{name}", symbol.size1())
        for name, symbol in zip(
            ("rate", "state", "algebraic", "parameter"), (*base[:3], base[4]), strict=True
        )
    ]
    moved = [ca.jtimes(rows, base[i], v) for i, v in zip((0, 1, 2, 4), along, strict=True) if v.size1()]
    form = ca.dot(weights, sum(moved, ca.SX.zeros(rows.size1())))
    arguments: list[Argument] = [
        batch(base[0], "rate"),
        batch(base[1], "state"),
        batch(base[2], "algebraic"),
        points(base[3], "phase"),
        vector(base[4], "parameter"),
        batch(weights, "weights"),
        batch(along[0], "v_rate"),
        batch(along[1], "v_state"),
        batch(along[2], "v_algebraic"),
        vector(along[3], "v_parameter"),
    ]
    kernel = build(arguments, [ca.gradient(form, symbol) for symbol in base], kernels)

    def evaluated(*given: Array) -> Gradient:
        count = len(given[3])
        arrays = [np.zeros((count, symbol.size1())) for symbol in base]
        with np.errstate(all="ignore"):
            kernel(*given, *arrays)
        return Gradient(arrays[0], arrays[1], arrays[2], arrays[3][:, 0], arrays[4])

    return evaluated
