"""The jumping operations of equations, as they are on a side, or as an affine function of a number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from symbolic.equations.branches import nodes

LOGICAL = (ca.OP_NOT, ca.OP_AND, ca.OP_OR)
"""Operations of conditions that are conditions again."""


@dataclass(frozen=True)
class Operations:
    """Rows, and of their jumping operations by hash: the switch of their argument, and its sign in it.

    Parameters
    ----------
    rows : casadi.SX
        A column of expressions.
    found : dict
        Hash to operation, index of its switch, and the sign of their ratio.
    """

    rows: ca.SX
    found: Mapping[int, tuple[ca.SX, int, float]]

    @property
    def switches(self) -> list[int]:
        """Indices of the switches at which operations jump."""
        return sorted({k for _, k, _ in self.found.values()})

    def on(self, sides: Mapping[int, ca.SX], weights: Mapping[int, ca.SX] | None = None) -> ca.SX:
        """Return the rows on sides of the switches.

        Parameters
        ----------
        sides : mapping of int to casadi.SX
            By switch: 1 or -1, or 0 where the state decides.
        weights : mapping of int to casadi.SX, optional
            By switch a number sigma, of which its operations become affine functions: at 1 and -1 the rows
            are those of either side, in between a mean of both.

        Returns
        -------
        casadi.SX
            The rows.
        """
        soft, replaced = weights or {}, {}
        for key, (node, k, sign) in self.found.items():
            if k in soft:
                replaced[key] = sign * soft[k] if node.op() == ca.OP_SIGN else (1 - sign * soft[k]) / 2
            else:
                side = sides[k]
                known = sign * side if node.op() == ca.OP_SIGN else sign * side < 0
                replaced[key] = ca.if_else(side == 0, node, known)
        graded = {key for key, (node, k, _) in self.found.items() if k in soft and node.op() != ca.OP_SIGN}
        return _rebuilt(self.rows, replaced, graded) if replaced else self.rows


def _rebuilt(rows: ca.SX, replaced: Mapping[int, ca.SX], graded: set[int]) -> ca.SX:
    """Return expressions with some operations replaced; `graded` conditions are from 0 to 1 then."""
    new: dict[int, ca.SX] = {}
    graded = set(graded)

    def of(node: ca.SX) -> ca.SX:
        return node if node.is_leaf() else new[node.element_hash()]

    for node in nodes(rows):
        key, old = node.element_hash(), [node.dep(i) for i in range(node.n_dep())]
        parts = [of(part) for part in old]
        if key in replaced:
            new[key] = replaced[key]
        elif all(a.element_hash() == b.element_hash() for a, b in zip(parts, old, strict=True)):
            new[key] = node
        elif any(not part.is_leaf() and part.element_hash() in graded for part in old):
            new[key] = _weighed(node.op(), parts)
            graded |= {key} if node.op() in LOGICAL else set()
        else:
            new[key] = _made(node.op(), parts)
    return ca.vertcat(*[of(rows[i]) for i in range(rows.numel())])


def _made(operation: int, parts: list[ca.SX]) -> ca.SX:
    return ca.SX.unary(operation, *parts) if len(parts) == 1 else ca.SX.binary(operation, *parts)


def _weighed(operation: int, parts: list[ca.SX]) -> ca.SX:
    """An operation on conditions from 0 to 1."""
    if operation == ca.OP_NOT:
        return 1 - parts[0]
    if operation in (ca.OP_AND, ca.OP_IF_ELSE_ZERO):
        return parts[0] * parts[1]
    if operation == ca.OP_OR:
        return parts[0] + parts[1] - parts[0] * parts[1]
    return _made(operation, parts)
