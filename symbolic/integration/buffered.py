"""A CasADi function evaluated point by point, without conversion of its arguments and results."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from symbolic.arrays import Array


class Buffered:
    """A function of dense vectors; a matrix that it returns is filled by columns.

    Attributes
    ----------
    given : list of ndarray
        Its arguments; they are written to before a call.
    results : list of ndarray
        What it returned, of shape (size,) or, of a matrix, (columns, rows).
    """

    def __init__(self, function: ca.Function) -> None:
        self.given: list[Array] = [np.zeros(function.numel_in(k)) for k in range(function.n_in())]
        self.results: list[Array] = [np.zeros(_turned(function.size_out(k))) for k in range(function.n_out())]
        buffer: Any
        buffer, self._run = function.buffer()
        self._buffer = buffer  # it must live as long as `_run`
        for k, array in enumerate(self.given):
            buffer.set_arg(k, array.data)
        for k, array in enumerate(self.results):
            buffer.set_res(k, array.reshape(-1).data)

    def __call__(self) -> list[Array]:
        """Return the results, in the same arrays each time."""
        self._run()
        return self.results


def _turned(size: tuple[int, int]) -> tuple[int, ...]:
    rows, columns = size
    return (rows,) if columns == 1 else (columns, rows)
