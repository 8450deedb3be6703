"""Orbits held against CVODES: what a step of multiple shooting would still change in them.

The orbit is cut into segments; the flow phi from each start x_k and its derivative G_k give the linear system

    d_{k+1} - G_k d_k = phi(x_k) - x_{k+1},   d_S = d_0,

whose solution is the orbit's error to first order; the product of all G_k is the monodromy matrix. Neither
knows anything of collocation. The segments begin at the orbit's event nodes as well, so that CVODES does not
step over a contact that is briefer than its steps. Where CVODES gives up, the orbit is solved for again with
accuracy `fine`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import periodic as per
import symbolic as sym
from periodic.correction.error import AT_WORST
from periodic.orbit.scheme import Array
from periodic.system import index_of

Spectrum = NDArray[np.complex128]

SEGMENTS = 16
"""Trajectories of an orbit; perturbations must not outgrow CVODES's errors on any."""

TOLERANCE = 1e-12
"""Of CVODES, relative and absolute in scaled variables."""

ORBITS = 4
"""Orbits spread over a branch that are confirmed, beside the one with the largest multiplier."""

CRITICAL = 0.05
"""Distance of a multiplier from 1 below which the nearest orbit of the branch counts, at any parameter."""

RANK = 1e-9
"""Relative size of singular values that count as zero then: at a branch point there are two ways to go."""

PHASES = np.linspace(0, 2 * np.pi, 512, endpoint=False)

TOLD = 1e-3
"""Error of the multipliers' sums that no estimate needs to tell; larger ones it must, within AT_WORST."""

SLACK = 10.0
"""How many tolerances, or estimates, a true error may have to count as confirmed."""

MARGINAL = 1e-9
"""Distance of the largest multiplier from the unit circle up to which either stability is right."""

CVODES, FINE, EXACT = "CVODES", "fine", "exact"
"""How an orbit was confirmed."""


@dataclass(frozen=True, kw_only=True)
class Checked:
    """True errors, the largest over `count` orbits: of the states over their largest peak to peak, and of the
    sums of the multipliers and of their squares, relative to the largest one where that exceeds 1.

    near: whether each error is at most SLACK times the tolerance or the orbit's own estimate. stable: whether
    all agree on which orbits are stable. told: whether every orbit's own estimate owns to the error of its
    multipliers, where that is large.
    """

    error: float
    multiplier_error: float
    near: bool
    stable: bool
    count: int
    by: str
    told: bool = True

    @property
    def right(self) -> bool:
        """Whether the branch is what it says."""
        return self.near and self.told and self.stable

    @property
    def verdict(self) -> str:
        """Say what is wrong."""
        if not self.near:
            return f"true error {self.error:.1e}"
        if not self.stable:
            return "stability is not confirmed"
        return f"true error of the multipliers {self.multiplier_error:.1e}"


def joined(found: Sequence[Checked]) -> Checked:
    """Return what several orbits show together."""
    return Checked(
        error=float(np.max([f.error for f in found])),
        multiplier_error=float(np.max([f.multiplier_error for f in found])),
        near=all(f.near for f in found),
        stable=all(f.stable for f in found),
        told=all(f.told for f in found),
        count=len(found),
        by=" and ".join(sorted({f.by for f in found})),
    )


def confirmed(
    system: sym.CompiledSystem, branch: per.Branch, free: tuple[str, ...] = (), orbits: int = ORBITS
) -> Checked:
    """Confirm orbits spread over a branch, and the one with the largest multiplier."""
    spread = np.linspace(0, len(branch) - 1, min(orbits, len(branch))).round().astype(int)
    strongest = int(np.argmax([abs(p.multipliers[0]) for p in branch]))
    chosen = [branch[int(k)] for k in sorted({*spread, strongest})]
    return joined([check(system, point, branch.parameter, free) for point in chosen])


def check(system: sym.CompiledSystem, point: per.Point, parameter: str, free: tuple[str, ...]) -> Checked:
    """Confirm one orbit by CVODES, else by collocation with accuracy `fine`."""
    critical = not free and bool((np.abs(point.multipliers - 1) < CRITICAL).any())
    moving = (parameter,) if critical else free
    try:
        error, monodromy = shot(system, point.orbit, tuple(index_of(system, name) for name in moving))
    except (ArithmeticError, np.linalg.LinAlgError):
        return compared(point, *finer(system, point, parameter, free), FINE)
    return compared(point, error, np.linalg.eigvals(monodromy).astype(np.complex128), CVODES)


def compared(point: per.Point, error: float, multipliers: Spectrum, by: str) -> Checked:
    """Return the verdict on a point whose true error and multipliers are known.

    Of an autonomous orbit one multiplier is 1: that tells its error better than any integration.
    """
    ours, true = float(np.abs(point.multipliers).max()), float(np.abs(multipliers).max())
    scale = max(1.0, true)
    first, second = (abs(np.sum(point.multipliers**k) - np.sum(multipliers**k)) / scale**k for k in (1, 2))
    off = float(max(first, second / 2)) if point.trivial is None else point.trivial
    told = off <= max(TOLD, AT_WORST * point.error.multiplier)
    unsure = abs(ours - 1) <= max(point.floor, MARGINAL) or point.label.critical or point.trivial is not None
    stable = unsure or (ours < 1) == (true < 1)
    return Checked(
        error=error,
        multiplier_error=off,
        near=near(error, point.error.orbit),
        stable=stable,
        count=1,
        by=by,
        told=told,
    )


def near(error: float, estimate: float = 0.0) -> bool:
    """Whether a true error is near enough to what was asked for, or to its estimate."""
    return bool(error <= SLACK * max(per.Accuracy.STANDARD.value, estimate))


def shot(system: sym.CompiledSystem, orbit: per.Orbit, free: tuple[int, ...]) -> tuple[float, Array]:
    """Return the error of an orbit over its span, and its monodromy matrix, by multiple shooting.

    With `free` parameters the error is the least that a shift in phase (of autonomous orbits) or along the
    branch leaves.
    Raises ArithmeticError where CVODES fails.
    """
    n, q = orbit.nodes.shape[1], len(free)
    marks = np.linspace(0, orbit.mesh.period, SEGMENTS * orbit.periods + 1)
    marks = np.union1d(marks, np.mod(orbit.phases, orbit.mesh.period))  # the flow is smooth between events
    state, guess = orbit.state(marks), orbit.algebraic_guess(marks)
    count = len(marks) - 1
    matrix, gap, monodromy = np.zeros((count * n, count * n + q)), np.zeros(count * n), np.eye(n)
    for k in range(count):
        flow = system.flow(state[k], guess[k], orbit.parameter, marks[k : k + 2], free, TOLERANCE)
        rows, after = slice(k * n, (k + 1) * n), (k + 1) % count * n
        by_state = flow.state_gradient[-1, :, :n]
        by_free = flow.state_gradient[-1, :, n:] * orbit.parameter[list(free)]
        matrix[rows, after : after + n] += np.eye(n)
        matrix[rows, k * n : (k + 1) * n] -= by_state
        matrix[rows, count * n :] -= by_free
        gap[rows] = flow.state[-1] - state[(k + 1) % count]
        monodromy = by_state @ monodromy
    solution = np.linalg.lstsq(matrix, gap, rcond=RANK)[0] if q else np.linalg.solve(matrix, gap)
    return float(np.abs(solution[: count * n]).max()) / orbit.span(), monodromy


def finer(
    system: sym.CompiledSystem, point: per.Point, parameter: str, free: tuple[str, ...]
) -> tuple[float, Spectrum]:
    """Return the distance of an orbit from the same one at accuracy `fine`, and the latter's multipliers."""
    one = per.ArclengthControl(max_points=1)
    bounds = sorted((point.parameter, point.parameter * (1 + 1e-3)))
    determined = {name: per.PhaseCondition() for name in free}
    again = per.trace(
        system, parameter, (bounds[0], bounds[1]), start=point.parameter, guess=point.orbit,
        determined=determined, tol=per.Accuracy.FINE, control=one,
    )  # fmt: skip
    if not len(again):
        return np.inf, point.multipliers
    away = np.abs(again[0].orbit.state(PHASES) - point.orbit.state(PHASES)).max()
    return float(away) / point.orbit.span(), again[0].multipliers
