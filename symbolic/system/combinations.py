"""Rows of equations that are combinations of a few forces with constant coefficients.

Each row is taken apart into terms with numbers before them: what is found of these numbers holds whatever the
values of the terms. Where a mass matrix was multiplied out, the force at one place stands in many rows.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np
import scipy
from numpy.typing import NDArray

from symbolic.arrays import Array
from symbolic.equations.branches import nodes

CANCELLED = 1e-13
"""Part of what was added up below which a number is what rounding left."""

RANK = 1e-10
"""Part of a term's largest number by which a row may miss the combination that it is."""

Sum = dict[Hashable, tuple[float, float]]
"""Terms, each with its number and the sum of all moduli that were added up to it."""

ONE: Hashable = ()


@dataclass(frozen=True)
class Combined:
    """Rows as combinations of k forces: matrix (r, k), and the forces of each column that was given.

    The first `moved` of them depend on the motion; `rows` (k,) are those that they are parts of.
    """

    rows: tuple[int, ...]
    moved: int
    matrix: Array
    forces: tuple[ca.SX, ...]


def combined(columns: Sequence[ca.SX], moving: ca.SX) -> Combined | None:
    """Return how few forces make all rows.

    Parameters
    ----------
    columns : sequence of casadi.SX
        Columns of r rows each, all to be combined alike.
    moving : casadi.SX
        Symbols of the motion.

    Returns
    -------
    Combined or None
        None where these are no fewer than the rows.
    """
    found = [_Terms(column) for column in columns]
    kept, moved, matrices = [], 0, []
    for by_motion in (True, False):
        chosen = [terms.depend(moving) == by_motion for terms in found]
        numbers = np.concatenate(
            [terms.numbers[:, which] for terms, which in zip(found, chosen, strict=True)], axis=1
        )
        rows = _spanning(numbers)
        if rows:
            matrix = np.linalg.lstsq(numbers[rows].T, numbers.T, rcond=None)[0].T
            size = np.abs(numbers).max(axis=0)
            if (np.abs(matrix @ numbers[rows] - numbers) > RANK * size).any():
                return None
            matrix[rows] = np.eye(len(rows))
            matrices.append(matrix)
        kept += [(row, chosen) for row in rows]
        moved = len(rows) if by_motion else moved
    if not kept or len(kept) >= columns[0].numel():
        return None
    forces = [
        ca.vertcat(*[terms.part(row, chosen[k]) for row, chosen in kept]) for k, terms in enumerate(found)
    ]
    return Combined(tuple(row for row, _ in kept), moved, np.concatenate(matrices, axis=1), tuple(forces))


def _spanning(numbers: Array) -> list[int]:
    """Rows that span all others."""
    size = np.abs(numbers).max(axis=0, initial=0.0)
    if not size.any():
        return []
    triangle, order = scipy.linalg.qr((numbers[:, size > 0] / size[size > 0]).T, mode="r", pivoting=True)
    left = np.abs(np.diag(triangle[: min(triangle.shape)]))
    return sorted(int(k) for k in order[: int((left > RANK * left[0]).sum())])


class _Terms:
    """The rows of a column as sums of terms: the terms, and the numbers before them, (r, t)."""

    def __init__(self, column: ca.SX) -> None:
        self._known: dict[int, Sum] = {}
        self._written: dict[Hashable, ca.SX] = {ONE: ca.SX(1.0)}
        for node in nodes(column):
            parts = [self._of(node.dep(i)) for i in range(node.n_dep())]
            self._known[node.element_hash()] = self._made(node, parts)
        sums = [self._of(column[i]) for i in range(column.numel())]
        self.terms = list(dict.fromkeys(term for each in sums for term in each))
        at = {term: k for k, term in enumerate(self.terms)}
        self.numbers = np.zeros((len(sums), len(self.terms)))
        for i, each in enumerate(sums):
            for term, (number, size) in each.items():
                self.numbers[i, at[term]] = number if abs(number) > CANCELLED * size else 0.0

    def depend(self, moving: ca.SX) -> NDArray[np.bool_]:
        """Whether each term depends on symbols, (t,)."""
        found = np.zeros(len(self.terms), dtype=bool)
        written = ca.vertcat(ca.SX(0, 1), *[self._written[term] for term in self.terms])
        found[list(set(ca.jacobian(written, moving).sparsity().row()))] = True
        return found

    def part(self, row: int, chosen: NDArray[np.bool_]) -> ca.SX:
        """Some terms of a row."""
        found = ca.SX(0.0)
        for k in np.flatnonzero(chosen & (self.numbers[row] != 0)):
            found += float(self.numbers[row, k]) * self._written[self.terms[k]]
        return found

    def _of(self, node: ca.SX) -> Sum:
        if node.is_constant():
            return {ONE: (float(node), abs(float(node)))}
        return self._single(node.element_hash(), node) if node.is_leaf() else self._known[node.element_hash()]

    def _single(self, term: Hashable, written: ca.SX) -> Sum:
        self._written.setdefault(term, written)
        return {term: (1.0, 1.0)}

    def _made(self, node: ca.SX, parts: list[Sum]) -> Sum:
        """The sum that an operation makes of its parts."""
        operation = node.op()
        if operation in (ca.OP_ADD, ca.OP_SUB):
            return _added(parts[0], parts[1], -1.0 if operation == ca.OP_SUB else 1.0)
        if operation in (ca.OP_NEG, ca.OP_TWICE):
            return _scaled(parts[0], -1.0 if operation == ca.OP_NEG else 2.0)
        if operation == ca.OP_MUL:
            for one, other in (parts, parts[::-1]):
                if len(one) == 1:
                    return self._times(one, other)
        if operation == ca.OP_DIV and len(parts[1]) == 1:
            ((term, (number, _)),) = parts[1].items()
            if number != 0:
                under = ONE if term == ONE else ("over", term)
                self._written.setdefault(under, 1 / self._written[term])
                return self._times({under: (1 / number, abs(1 / number))}, parts[0])
        return self._single((operation, *(_key(part) for part in parts)), node)

    def _times(self, single: Sum, other: Sum) -> Sum:
        """The product of a single term and a sum."""
        ((factor, (scale, _)),) = single.items()
        found: Sum = {}
        for term, value in _scaled(other, scale).items():
            product = ONE if factor == term == ONE else term if factor == ONE else factor
            if ONE not in (factor, term):
                product = ("times", frozenset({(factor, term), (term, factor)}))
                self._written.setdefault(product, self._written[factor] * self._written[term])
            found = _added(found, {product: value}, 1.0)
        return found


def _key(part: Sum) -> Hashable:
    return frozenset((term, number) for term, (number, _) in part.items())


def _added(one: Sum, other: Sum, sign: float) -> Sum:
    found = dict(one)
    for term, (number, size) in other.items():
        old, older = found.get(term, (0.0, 0.0))
        found[term] = (old + sign * number, older + size)
    return found


def _scaled(part: Sum, factor: float) -> Sum:
    return {term: (factor * number, abs(factor) * size) for term, (number, size) in part.items()}
