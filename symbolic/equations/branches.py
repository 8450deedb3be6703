"""The graph of expressions: where its operations pass from one branch to the other, at a zero of

    fmax(a, b), fmin(a, b), a < b, a <= b:  s = a - b;    fabs(a), sign(a):  s = a

Of max(0, a b), min(0, a b) and |a b| they are a and b, but for those that are not negative by their form: a
force max(0, k d (1 + c v)), d = max(0, x - g), which is 0 in flight, switches at x = g and at 1 + c v = 0.
A comparison for equality holds at single points, where it mends a value; it is no branch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Flag, auto

import casadi as ca

COMPARED = (ca.OP_FMAX, ca.OP_FMIN, ca.OP_LT, ca.OP_LE)
"""Operations of two arguments that switch where these are equal."""

SIGNED = (ca.OP_FABS, ca.OP_SIGN)
"""Operations of one argument that switch where it vanishes."""

BENT = (ca.OP_FMAX, ca.OP_FMIN, ca.OP_FABS)
"""Those of them that do not jump where they switch."""

KEEP_POSITIVE = (ca.OP_ADD, ca.OP_MUL, ca.OP_DIV, ca.OP_FMIN, ca.OP_TWICE, ca.OP_INV, ca.OP_SQRT, ca.OP_SQ)
POSITIVE = (ca.OP_EXP, ca.OP_COSH)
"""Operations that are positive where all their arguments are, and always."""

JUMPING = (ca.OP_SIGN, ca.OP_LT, ca.OP_LE)
"""Operations that jump where their switching argument vanishes."""

NOT_NEGATIVE = (ca.OP_FABS, ca.OP_SQ, ca.OP_SQRT, ca.OP_LT, ca.OP_LE, ca.OP_NOT, ca.OP_AND, ca.OP_OR)
"""Operations that are never negative."""

PRODUCTS = (ca.OP_MUL, ca.OP_DIV, ca.OP_IF_ELSE_ZERO)
"""Operations whose sign is that of both arguments; the last is a b with a condition a, 0 or 1."""

STEPPED = {ca.OP_FLOOR: "floor", ca.OP_CEIL: "ceil", ca.OP_FMOD: "fmod", ca.OP_COPYSIGN: "copysign"}
"""Operations that jump at places which no switch tells of: rounding, remainders, signs of others."""

STANDS_FOR_ZERO = 1e-200
"""A constant below this stands for 0, as in max(delta, 1e-300)^n."""


FUNCTIONS = "they must use the functions of symbolic.functions"
STEPS = "they must say where it jumps by if_else of symbolic.functions, or be periodic by sin and cos"
"""What equations that cannot be traced must do."""


class Traits(Flag):
    """What an expression is made of, and its sign.

    MOVING: states or the phase; OTHER: rates or unknowns, which a switch is no function of; POSITIVE: greater
    than 0 by its form; NOT_NEGATIVE: 0 or greater.
    """

    NONE = 0
    MOVING = auto()
    OTHER = auto()
    POSITIVE = auto()
    NOT_NEGATIVE = auto()


def _sign(positive: bool, not_negative: bool) -> Traits:
    return (Traits.POSITIVE if positive else Traits.NONE) | (
        Traits.NOT_NEGATIVE if not_negative else Traits.NONE
    )


@dataclass(frozen=True)
class _Known:
    """Traits of the nodes of a graph by their hashes; `given` has those of symbols."""

    given: Callable[[ca.SX], Traits]
    found: dict[int, Traits]

    def of(self, node: ca.SX) -> Traits:
        if node.is_constant():
            if math.isnan(float(node)):
                raise ValueError(f"the equations have NaN in them; {FUNCTIONS}, not those of math")
            return _sign(float(node) > 0, float(node) >= 0)
        return self.given(node) if node.is_symbolic() else self.found[node.element_hash()]

    def add(self, node: ca.SX) -> None:
        parts = [self.of(node.dep(i)) for i in range(node.n_dep())]
        signs = [Traits.POSITIVE in part for part in parts]
        kept = node.op() in KEEP_POSITIVE and all(signs)
        positive = kept or node.op() in POSITIVE or (node.op() == ca.OP_FMAX and any(signs))
        traits = _sign(positive, node.op() in NOT_NEGATIVE or self._kept(node))
        for part in parts:
            traits |= part & (Traits.MOVING | Traits.OTHER)
        self.found[node.element_hash()] = traits

    def _kept(self, node: ca.SX) -> bool:
        """Whether a node is not negative by what it is made of."""
        parts = [self.not_negative(node.dep(i)) for i in range(node.n_dep())]
        if node.op() in (ca.OP_CONSTPOW, ca.OP_POW):
            return parts[0]
        return node.op() in KEEP_POSITIVE and all(parts) or node.op() == ca.OP_FMAX and any(parts)

    def not_negative(self, node: ca.SX) -> bool:
        """Whether an expression is 0 or greater by its form."""
        return bool(self.of(node) & (Traits.POSITIVE | Traits.NOT_NEGATIVE))

    def moves(self, parts: list[ca.SX]) -> bool:
        """Whether a switch of these is a function of state and phase, and not a constant."""
        traits = [self.of(part) for part in parts]
        return not any(Traits.OTHER in t for t in traits) and any(Traits.MOVING in t for t in traits)

    def factors(self, node: ca.SX) -> list[ca.SX]:
        """The factors of a product at whose zeros it changes its sign; parameters with one alone stay."""
        if self.not_negative(node):
            return []
        if node.op() not in (*PRODUCTS, ca.OP_NEG, ca.OP_TWICE):
            return [node]
        parts = [part for part in map(node.dep, range(node.n_dep())) if self.moves([part])]
        found = [factor for part in parts for factor in self.factors(part)]
        alone = len(parts) == len(found) == 1 and found[0].element_hash() == parts[0].element_hash()
        return [node] if alone and self.moves([node]) else found


def switching(rows: ca.SX, given: Callable[[ca.SX], Traits]) -> list[ca.SX]:
    """Return the switching arguments of expressions that are functions of state and phase, inner ones first.

    Parameters
    ----------
    rows : casadi.SX
        A column of expressions.
    given : callable
        Traits of a symbol.

    Returns
    -------
    list of casadi.SX
        s of every fmax, fmin, fabs, sign, < and <=, but for those that depend on rates or unknowns, on
        parameters alone, or are positive by their form.

    Raises
    ------
    ValueError
        For expressions that jump where no switch tells, and for constants that are NaN.
    """
    known, found = _Known(given, {}), []
    for node in nodes(rows):
        known.add(node)
        if node.op() in STEPPED and Traits.MOVING in known.of(node):
            raise ValueError(f"the equations use {STEPPED[node.op()]} of what moves, as % does; {STEPS}")
        if node.op() not in COMPARED + SIGNED:
            continue
        parts = [node.dep(i) for i in range(node.n_dep())]
        parts = [p for p in parts if not (p.is_constant() and abs(float(p)) < STANDS_FOR_ZERO)]
        if len(parts) == 1 and node.op() in BENT:
            found += [factor for factor in known.factors(parts[0]) if known.moves([factor])]
        elif known.moves(parts) and len(parts) == 2:
            found.append(parts[0] - parts[1] if known.moves(parts[:1]) else parts[1] - parts[0])
        elif known.moves(parts) and Traits.POSITIVE not in known.of(parts[0]):
            found.append(parts[0])
    return [s.dep(0) if s.op() == ca.OP_NEG else s for s in found]


def jumps_with(rows: ca.SX, symbols: ca.SX) -> bool:
    """Return whether expressions have operations that jump with some of their symbols."""
    return any(node.op() in JUMPING and ca.depends_on(node, symbols) for node in nodes(rows))


def nodes(rows: ca.SX) -> Iterator[ca.SX]:
    """Yield the operations of a graph, each once and after what it is made of.

    Parameters
    ----------
    rows : casadi.SX
        A column of expressions.

    Yields
    ------
    casadi.SX
        One operation.
    """
    seen: set[int] = set()
    pending = [(rows[i], False) for i in reversed(range(rows.numel()))]
    while pending:
        node, ready = pending.pop()
        if ready:
            yield node
        elif not node.is_leaf() and node.element_hash() not in seen:
            seen.add(node.element_hash())
            pending.append((node, True))
            pending.extend((node.dep(i), False) for i in reversed(range(node.n_dep())))
