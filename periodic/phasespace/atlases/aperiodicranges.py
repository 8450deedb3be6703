"""Where over a parameter motions are that do not come back: tori, where they are born, chaos, escape."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from periodic.orbit.scheme import Array
from periodic.phasespace.motion import Motion, Motions, Sort
from periodic.results.branch import Branch


def aperiodic_ranges(values: Array, found: Sequence[Motions], branches: Sequence[Branch]) -> Iterator[str]:
    """Yield in words where stable motions of each sort that does not come back are, at neighbouring values.

    values: of the parameter (SI), (K,). found: all motions at each. branches: whose NS are where tori may be
    born, if they are no further from their first or last value than the next value is.
    """
    births = [point.parameter for branch in branches for point in branch.labelled("NS")]
    for sort in (Sort.TORUS, Sort.CHAOTIC, Sort.OPEN):
        each = [[m for m in motions.stable if m.point is None and m.sort == sort] for motions in found]
        for first, last in _runs([bool(own) for own in each]):
            where = _at(values[first], values[last])
            told = _told(sort, [motion for own in each[first : last + 1] for motion in own])
            near = values[max(first - 1, 0)], values[min(last + 1, len(values) - 1)]
            born = [f"{birth:.9g}" for birth in births if sort == Sort.TORUS and near[0] <= birth <= near[1]]
            yield f"{sort} {where}{told}" + (f"; NS at {' and '.join(born)}" if born else "")
    for name, counted in (("grows beyond all bounds", "diverged"), ("undecided", "undecided")):
        shares = 100 * np.array([getattr(motions, counted) / motions.starts for motions in found])
        for first, last in _runs(list(shares > 0)):
            own, where = shares[first : last + 1], _at(values[first], values[last])
            low, high = f"{own.min():.1f}", f"{own.max():.1f}"
            yield f"{name} {where}: {low if low == high else f'{low} to {high}'} % of the box"


def _runs(there: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """The first and the last place of each run of true ones."""
    padded = np.concatenate([[False], np.asarray(there, dtype=bool), [False]])
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    yield from ((int(a), int(b) - 1) for a, b in edges.reshape(-1, 2))


def _at(first: float, last: float) -> str:
    return f"at {first:.6g}" if first == last else f"from {first:.6g} to {last:.6g}"


def _told(sort: Sort, motions: Sequence[Motion]) -> str:
    """What is known of the motions of a range."""
    name = "rotation number" if sort == Sort.TORUS else "Lyapunov exponent"
    each = np.array([m.rotation if sort == Sort.TORUS else m.exponent for m in motions])
    each = each[np.isfinite(each)]
    if not len(each):
        return ""
    low, high = f"{each.min():.4g}", f"{each.max():.4g}"
    unit = "" if sort == Sort.TORUS else " 1/s"
    return f", {name} {low}{unit}" if low == high else f", {name} {low} to {high}{unit}"
