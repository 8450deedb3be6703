"""CasADi expressions written out as NumPy source: one vectorised statement per instruction.

A kernel takes batches (points along the first axis) and a parameter vector and fills dense arrays in
place. No compiler, no CasADi object and no conversion is left in the loop. `symbolic.kernels.csource` writes
the same kernel in C, `symbolic.kernels.choice` says which of the two runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
import scipy

from symbolic.interrupts import interruptible
from symbolic.kernels.choice import ChosenKernel, Kernels, Layout
from symbolic.kernels.csource import ARITHMETIC, FUNCTIONS, csource

_OPERATIONS = {
    **ARITHMETIC,
    **{operation: f"np.{call}" for operation, call in FUNCTIONS.items()},
    ca.OP_LT: "np.less({0}, {1}) * 1.0",
    ca.OP_LE: "np.less_equal({0}, {1}) * 1.0",
    ca.OP_EQ: "np.equal({0}, {1}) * 1.0",
    ca.OP_NE: "np.not_equal({0}, {1}) * 1.0",
    ca.OP_AND: "np.logical_and({0}, {1}) * 1.0",
    ca.OP_OR: "np.logical_or({0}, {1}) * 1.0",
    ca.OP_NOT: "np.logical_not({0}) * 1.0",
    ca.OP_FMIN: "np.minimum({0}, {1})",
    ca.OP_FMAX: "np.maximum({0}, {1})",
    ca.OP_IF_ELSE_ZERO: "np.where({0}, {1}, 0.0)",
    ca.OP_ERF: "scipy.special.erf({0})",
}


@dataclass(frozen=True)
class Argument:
    """One argument of a kernel: its symbol (a column), and how NumPy and C read component k of it."""

    symbol: ca.SX
    name: str
    read: str
    cread: str
    layout: Layout


def batch(symbol: ca.SX, name: str) -> Argument:
    """An argument of shape (points, components)."""
    width = symbol.size1()
    return Argument(symbol, name, name + "[:, {k}]", f"{name}[{width} * i + {{k}}]", Layout((width,)))


def vector(symbol: ca.SX, name: str) -> Argument:
    """An argument that is the same at every point, shape (components,)."""
    read = name + "[{k}]"
    return Argument(symbol, name, read, read, Layout((symbol.size1(),), shared=True))


def points(symbol: ca.SX, name: str) -> Argument:
    """A scalar argument of shape (points,)."""
    return Argument(symbol, name, name, name + "[i]", Layout(()))


@interruptible()
def build(
    arguments: Sequence[Argument],
    results: Sequence[ca.SX],
    kernels: Kernels = Kernels.NUMPY,
    iterated: bool = False,
) -> Callable[..., None]:
    """Return kernel(*arguments, *arrays), which writes result i into arrays[i].

    A result of shape (r, 1) goes to an array (points, r), one of shape (r, c) to (points, r, c). Only
    structural nonzeros are written: the arrays come zeroed. iterated: see `ChosenKernel`.
    """
    function = ca.Function("kernel", [a.symbol for a in arguments], ca.cse(list(results)))
    _check_operations(function)
    if kernels is Kernels.NUMPY or not function.n_instructions():
        return _numpy(function, arguments)
    layouts = [a.layout for a in arguments] + [_layout(result) for result in results]
    return ChosenKernel(
        source=csource(function, [a.name for a in arguments], [a.cread for a in arguments]),
        instructions=function.n_instructions(),
        layouts=layouts,
        results=len(results),
        kernels=kernels,
        numpy=lambda: _numpy(function, arguments),
        iterated=iterated,
    )


def _check_operations(function: ca.Function) -> None:
    known = {ca.OP_CONST, ca.OP_INPUT, ca.OP_OUTPUT, *_OPERATIONS}
    for k in range(function.n_instructions()):
        if (operation := function.instruction_id(k)) not in known:
            raise NotImplementedError(f"CasADi operation {operation} has no counterpart in symbolic.kernels")


def _layout(result: ca.SX) -> Layout:
    return Layout((result.size1(),) if result.size2() == 1 else result.shape)


def _numpy(function: ca.Function, arguments: Sequence[Argument]) -> Callable[..., None]:
    source = _source(function, [a.read for a in arguments])
    scope: dict[str, Any] = {"np": np, "scipy": scipy, "inf": np.inf, "nan": np.nan}
    exec(compile(source, "<orbitrace kernel>", "exec"), scope)  # source is made above from an operation table
    kernel: Callable[..., None] = scope["kernel"]
    return kernel


def _source(function: ca.Function, reads: list[str]) -> str:
    names = [read.partition("[")[0] for read in reads]
    arrays = [f"out{i}" for i in range(function.n_out())]
    targets = [_targets(function.sparsity_out(i), arrays[i]) for i in range(function.n_out())]
    lines = [f"def kernel({', '.join(names + arrays)}):"]
    for k in range(function.n_instructions()):
        lines.append("    " + _statement(function, k, reads, targets))
    return "\n".join([*lines, "    return None"])


def _targets(sparsity: ca.Sparsity, array: str) -> list[str]:
    rows, columns = sparsity.get_triplet()
    if sparsity.size2() == 1:
        return [f"{array}[:, {r}]" for r in rows]
    return [f"{array}[:, {r}, {c}]" for r, c in zip(rows, columns, strict=True)]


def _statement(function: ca.Function, k: int, reads: list[str], targets: list[list[str]]) -> str:
    operation = function.instruction_id(k)
    inputs, outputs = function.instruction_input(k), function.instruction_output(k)
    if operation == ca.OP_CONST:
        return f"w{outputs[0]} = {function.instruction_constant(k)!r}"
    if operation == ca.OP_INPUT:
        return f"w{outputs[0]} = {reads[inputs[0]].format(k=inputs[1])}"
    if operation == ca.OP_OUTPUT:
        return f"{targets[outputs[0]][outputs[1]]} = w{inputs[0]}"
    return f"w{outputs[0]} = {_OPERATIONS[operation].format(*[f'w{i}' for i in inputs])}"
