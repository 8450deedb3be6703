"""Linear systems with joints, in SI, and the equations of a mode of the joints.

    M q'' + C q' + K q + sum_c k_c (c q)^3 c' + sum_i r_i(u_i, u_i') row_i' = f cos(Omega t),   u_i = row_i q

    Coulomb    r = F sign u'; |r| <= F where it sticks, u' = 0
    Slider     r = k (u - s), |r| <= F; s' = 0 while it sticks, s' = u' while it slips (Jenkins)
    Stop       r = k max(u - gap, 0)

With z = (q, q', s, 1, cos, sin) a mode is z' = G z + N (R z)^3, and lasts while its guards W z + P (R z)^3
stay positive. Forces of all Coulomb joints that stick follow together from row q'' = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mode = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Coulomb:
    """Dry friction: row (n,) of u, limit F in N. Modes 1, -1 (u' > 0, < 0) and 0 where it sticks."""

    row: Array
    limit: float


@dataclass(frozen=True, eq=False)
class Slider:
    """A spring of k N/m that gives way at F N. Modes 1, -1 while it slips, and 0."""

    row: Array
    stiffness: float
    limit: float


@dataclass(frozen=True, eq=False)
class Stop:
    """A one-sided spring of k N/m beyond a gap in m. Modes 1 (closed) and 0."""

    row: Array
    stiffness: float
    gap: float


Joint = Coulomb | Slider | Stop


@dataclass(frozen=True, eq=False)
class Cubic:
    """A force k u^3, k in N/m^3."""

    row: Array
    stiffness: float


@dataclass(frozen=True, eq=False)
class Equations:
    """One mode: G (N, N), N (N, c), R (c, N); guards W (g, N), P (g, c), and the joint of each guard."""

    linear: Array
    columns: Array
    rows: Array
    guards: Array
    cubes: Array
    owners: tuple[int, ...]

    def rate(self, z: Array) -> Array:
        """z'."""
        return np.asarray(self.linear @ z + self.columns @ (self.rows @ z) ** 3)

    def guard(self, k: int, z: Array) -> tuple[float, Array]:
        """A guard and its derivatives by z."""
        u = self.rows @ z
        slope = self.guards[k] + 3 * (self.cubes[k] * u**2) @ self.rows
        return float(self.guards[k] @ z + self.cubes[k] @ u**3), slope


@dataclass(frozen=True, eq=False)
class Jointed:
    """Matrices (n, n), amplitudes of the force (n,), joints and cubic springs; `scale` is a length in m."""

    mass: Array
    damping: Array
    stiffness: Array
    force: Array
    joints: Sequence[Joint]
    cubics: Sequence[Cubic] = ()
    scale: float = 1.0
    _known: dict[tuple[float, Mode], Equations] = field(default_factory=dict)

    @cached_property
    def inverse(self) -> Array:
        """The inverse of M."""
        return np.linalg.inv(self.mass)

    @cached_property
    def sliders(self) -> list[int]:
        """The joints that are sliders."""
        return [i for i, joint in enumerate(self.joints) if isinstance(joint, Slider)]

    @property
    def freedoms(self) -> int:
        """Number n of coordinates."""
        return len(self.mass)

    @property
    def states(self) -> int:
        """Number of coordinates, speeds and places of sliders."""
        return 2 * self.freedoms + len(self.sliders)

    def row(self, q: Array | float = 0.0, v: Array | float = 0.0, s: int | None = None) -> Array:
        """A row of z; s is the joint of a slider, whose place is taken away."""
        n, found = self.freedoms, np.zeros(self.states + 3)
        found[:n], found[n : 2 * n] = q, v
        if s is not None:
            found[2 * n + self.sliders.index(s)] = -1.0
        return found

    def stretch(self, i: int) -> Array:
        """The row of a slider's force over its limit."""
        joint = self.joints[i]
        assert isinstance(joint, Slider)
        return joint.stiffness / joint.limit * self.row(joint.row, s=i)

    def held(self, mode: Mode) -> list[int]:
        """Coulomb joints that stick."""
        return [i for i, joint in enumerate(self.joints) if isinstance(joint, Coulomb) and mode[i] == 0]

    def forces(self, mode: Mode) -> Array:
        """Rows (n, N) of the forces on the coordinates, but for joints that stick and cubic springs."""
        n = self.freedoms
        found = np.zeros((n, self.states + 3))
        found[:, :n], found[:, n : 2 * n], found[:, -2] = -self.stiffness, -self.damping, self.force
        for i, (joint, side) in enumerate(zip(self.joints, mode, strict=True)):
            if isinstance(joint, Coulomb) or (isinstance(joint, Slider) and side):
                found[:, -3] -= side * joint.limit * joint.row
            elif isinstance(joint, Slider):
                found -= np.outer(joint.row, joint.limit * self.stretch(i))
            elif side:
                found[:, :n] -= joint.stiffness * np.outer(joint.row, joint.row)
                found[:, -3] += joint.stiffness * joint.gap * joint.row
        return found

    def equations(self, Omega: float, mode: Mode) -> Equations:
        """The equations of a mode, kept."""
        if (Omega, mode) not in self._known:
            self._known[Omega, mode] = self._equations(Omega, mode)
        return self._known[Omega, mode]

    def carried(self, mode: Mode) -> tuple[Array, Array]:
        """Rows (held, N) and cubic columns (held, c) of r of the joints that stick; they may exceed F."""
        rows = np.array([self.joints[i].row for i in self.held(mode)]).reshape(-1, self.freedoms)
        across = rows @ self.inverse
        matrix = across @ rows.T
        springs = -np.array([c.stiffness * c.row for c in self.cubics]).reshape(-1, self.freedoms).T
        return np.linalg.solve(matrix, across @ self.forces(mode)), np.linalg.solve(matrix, across @ springs)

    def _equations(self, Omega: float, mode: Mode) -> Equations:
        n, size = self.freedoms, self.states + 3
        linear, columns = np.zeros((size, size)), np.zeros((size, len(self.cubics)))
        rows = np.array([self.row(c.row) for c in self.cubics]).reshape(-1, size)
        carried, cubed = self.carried(mode)
        held = np.array([self.joints[i].row for i in self.held(mode)]).reshape(-1, n)
        springs = -np.array([c.stiffness * c.row for c in self.cubics]).reshape(-1, n).T
        linear[:n, n : 2 * n] = np.eye(n)
        linear[n : 2 * n] = self.inverse @ (self.forces(mode) - held.T @ carried)
        columns[n : 2 * n] = self.inverse @ (springs - held.T @ cubed)
        for i in self.sliders:
            if mode[i]:
                linear[2 * n + self.sliders.index(i), n : 2 * n] = self.joints[i].row
        linear[-2, -1], linear[-1, -2] = -Omega, Omega
        guards, cubes, owners = self._guards(Omega, mode, carried, cubed)
        return Equations(linear, columns, rows, guards, cubes, owners)

    def _guards(
        self, Omega: float, mode: Mode, carried: Array, cubed: Array
    ) -> tuple[Array, Array, tuple[int, ...]]:
        """What stays positive: speeds in scale Omega, forces in F, depths in the scale."""
        guards: list[tuple[Array, Array, int]] = []
        none, one = np.zeros(len(self.cubics)), np.eye(self.states + 3)[-3]
        held = self.held(mode)
        for i, (joint, side) in enumerate(zip(self.joints, mode, strict=True)):
            if isinstance(joint, Stop):
                depth = (self.row(joint.row) - joint.gap * one) / self.scale
                guards.append((depth if side else -depth, none, i))
            elif side:
                guards.append((self.row(v=side * joint.row) / (self.scale * Omega), none, i))
            elif isinstance(joint, Slider):
                guards += [(one - sign * self.stretch(i), none, i) for sign in (1, -1)]
            else:
                at = held.index(i)
                force, cube = carried[at] / joint.limit, cubed[at] / joint.limit
                guards += [(one - sign * force, -sign * cube, i) for sign in (1, -1)]
        return (
            np.array([g[0] for g in guards]).reshape(len(guards), self.states + 3),
            np.array([g[1] for g in guards]).reshape(len(guards), len(self.cubics)),
            tuple(g[2] for g in guards),
        )
