"""A linear structure as uncoupled complex modes: what integrates it exactly in time.

    dz_j/dt = lambda_j z_j + sum_d input_jd f_d,   q_d = Re sum_j shape_dj z_j + sum_e residual_de f_e

One mode of each conjugate pair stands for both. Modes that are not kept contribute their static
flexibility, the residual.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy
from scipy.sparse.linalg import splu

from symbolic.arrays import Array, Complex
from symbolic.structures.damping import ModalDamping
from symbolic.structures.matrices import DENSE, Matrices, Matrix, dense, modes, sparse
from symbolic.structures.rounding import LEFT, hidden

MODES = 200
"""How many modes of a structure of more than DENSE degrees of freedom are kept by default."""

RIGID = 1e-14
"""Ratio of omega^2 to the largest below which a mode is a rigid-body mode."""

MOVED = 0.1
"""Part of the largest displacement from which on a degree of freedom is named among those that are loose."""

CRITICAL_DISTANCE = 3e-6
"""Relative distance to which the two exponents of a critically damped mode are moved apart. It changes the
square of its frequency by 1e-11, as much as rounding then costs."""

DEFECTIVE = 1e-12
"""Reciprocal condition of the eigenvectors below which they do not span the motion."""


class LooseError(ValueError):
    """A structure that is not held: it has rigid-body modes, or modes of negative stiffness."""


@dataclass(frozen=True)
class ModalForm:
    """The modes of a structure of n degrees of freedom.

    Parameters
    ----------
    exponents : ndarray of complex, shape (J,)
        lambda_j in 1/s.
    shapes : ndarray of complex, shape (n, J)
        Displacements q of z.
    inputs : ndarray of complex, shape (J, n)
        How forces drive z.
    matrices : Matrices
        The matrices that they are of.
    own : bool
        Whether they are all modes of M, C, K and G as given, and of modal damping as a matrix.
    undamped : ndarray, shape (n, J), optional
        The undamped modes phi, phi' M phi = 1, where some modes are left out.
    """

    exponents: Complex
    shapes: Complex
    inputs: Complex
    matrices: Matrices
    own: bool = False
    undamped: Array | None = field(default=None, repr=False)
    _residuals: dict[tuple[int, ...], Array] = field(default_factory=dict, init=False, repr=False)

    def residual(self, freedoms: Sequence[int]) -> Array:
        """Return the static flexibility (n, k) in m/N of the modes that are left out."""
        key = tuple(freedoms)
        if key not in self._residuals:
            self._residuals[key] = self._residual(key)
        return self._residuals[key]

    def _residual(self, freedoms: tuple[int, ...]) -> Array:
        """K^-1 applied to loads from which the kept modes have been projected out.

        The difference of whole and modal flexibility would cancel: the lowest modes are most of both.
        """
        n, k = len(self.shapes), len(freedoms)
        if self.undamped is None:
            return np.zeros((n, k))
        phi, mass, stiffness = self.undamped, self.matrices.M, self.matrices.K
        loads = np.zeros((n, k))
        loads[list(freedoms), np.arange(k)] = 1.0
        loads -= mass @ (phi @ (phi.T @ loads))
        found = _answer(stiffness, loads)
        return np.asarray(found - phi @ (phi.T @ (mass @ found)))

    def mobility(self, freedoms: Sequence[int]) -> Array:
        """Return by how much forces accelerate degrees of freedom at once, (k, k) in 1/kg."""
        at = list(freedoms)
        return np.asarray(((self.shapes[at] * self.exponents) @ self.inputs[:, at]).real)

    def static(self, freedoms: Sequence[int]) -> Array:
        """Return the static flexibility (n, k) in m/N of the modes."""
        return np.asarray(-(self.shapes @ (self.inputs[:, list(freedoms)] / self.exponents[:, None])).real)

    def error(self, freedoms: Sequence[int]) -> float:
        """Return by how much modes and residual miss the static flexibility K^-1 of degrees of freedom.

        As a part of it. It sees modes that are missing, or wrong: their sum is all of it.
        """
        loads = np.zeros((len(self.shapes), len(freedoms)))
        loads[list(freedoms), np.arange(len(freedoms))] = 1.0
        exact = _answer(self.matrices.K, loads)
        missed = self.static(freedoms) + self.residual(freedoms) - exact
        return float(np.abs(missed).max() / np.abs(exact).max())


def modal_form(
    name: str,
    matrices: Matrices,
    damping: ModalDamping,
    speed: float,
    count: int | None,
    held: Mapping[int, float] | None = None,
) -> ModalForm:
    """Return the modes of a structure at a speed Omega (rad/s), `count` of them where it is given.

    `held` are stiffnesses (N/m) added at some degrees of freedom; damping is that without them. Raises
    LooseError for a structure with rigid-body modes or modes of negative stiffness, ValueError for one whose
    modes do not span its motion.
    """
    n = matrices.size
    own = matrices.C if matrices.G is None else matrices.C + speed * matrices.G
    if held:
        if not damping.none:
            own = dense(own) + damping.matrix(matrices)
        matrices, damping = stiffened(matrices, held), ModalDamping()
    symmetric = abs(matrices.K - matrices.K.T).max() <= 1e-10 * abs(matrices.K).max()
    wanted = count or (n if n <= DENSE else min(MODES, n // 2))
    if symmetric:
        squares, shapes = _undamped(matrices, wanted)
        coupled = shapes.T @ (own @ shapes)
        rates = np.diag(coupled)
        size = np.abs(coupled).max(initial=0.0)
        if size == 0 or np.abs(coupled - np.diag(rates)).max() < 1e-10 * size:
            rates = rates + damping.rates(np.sqrt(np.maximum(squares, 0.0)))
            return _uncoupled(name, matrices, squares, rates, shapes)
    if n > DENSE or wanted < n:
        what = f"be reduced to {DENSE} at the most" if n > DENSE else f"keep all its modes, not {wanted}"
        raise ValueError(
            f"structure {name!r} has {n} degrees of freedom and damping or gyroscopic terms that couple its "
            f"modes; it must {what}"
        )
    if not damping.none:
        own = dense(own) + damping.matrix(matrices)
    return replace(_coupled(name, matrices, dense(own)), own=True)


def refuse_inexact(name: str, form: ModalForm, freedoms: Sequence[int]) -> None:
    """Refuse modes that miss more than `LEFT` of a structure's static flexibility. Raises ValueError."""
    if (error := form.error(freedoms)) > LEFT:
        raise ValueError(
            f"the modes of structure {name!r} miss its static flexibility by {100 * error:.2g} %, where "
            f"{100 * LEFT:g} % is taken: rounding hides it; take a coarser mesh"
        )


def stiffened(matrices: Matrices, held: Mapping[int, float]) -> Matrices:
    """Return matrices with stiffnesses (N/m) added at some degrees of freedom."""
    added = np.zeros(matrices.size)
    added[list(held)] = list(held.values())
    more = sparse.diags_array(added) if sparse.issparse(matrices.K) else np.diag(added)
    return Matrices(matrices.M, matrices.C, matrices.K + more, matrices.G, at=matrices.at)


def holding(matrices: Matrices, speed: float, freedoms: Sequence[int], others: Array) -> dict[int, float]:
    """Return stiffnesses (N/m) at degrees of freedom that hold a structure.

    Parameters
    ----------
    matrices : Matrices
        The structure.
    speed : float
        Omega in rad/s.
    freedoms : sequence of int
        k degrees of freedom.
    others : ndarray, shape (k,)
        How stiffly other parts hold them, N/m.

    Returns
    -------
    dict
        By degree of freedom its dynamic stiffness at the speed, or that of other parts if it is greater: the
        motion is then near that of the modes.
    """
    own = matrices.C if matrices.G is None else matrices.C + speed * matrices.G
    dynamic = dense(matrices.K) - speed**2 * dense(matrices.M) + 1j * speed * dense(own)
    loads = np.eye(matrices.size)[:, list(freedoms)]
    answer = np.abs(np.linalg.lstsq(dynamic, loads)[0][list(freedoms), np.arange(len(freedoms))])
    found = np.maximum(1 / answer, others)
    return {k: float(stiffness) for k, stiffness in zip(freedoms, found, strict=True)}


def _undamped(matrices: Matrices, count: int) -> tuple[Array, Array]:
    """The `count` lowest undamped modes; from M phi = omega^-2 K phi the lowest are the most accurate."""
    n = matrices.size
    if n <= DENSE or count > n // 2:
        try:
            inverse, shapes = scipy.linalg.eigh(dense(matrices.M), dense(matrices.K))
        except np.linalg.LinAlgError:  # K is not positive definite
            return modes(matrices.K, matrices.M, count)
        if (lowest := inverse[::-1][:count]).min() > 0:  # else K is positive definite by rounding alone
            return 1 / lowest, shapes[:, ::-1][:, :count] / np.sqrt(lowest)
    return modes(matrices.K, matrices.M, count)


def _uncoupled(name: str, matrices: Matrices, squares: Array, rates: Array, shapes: Array) -> ModalForm:
    """From real modes phi with q'' + rate q' + omega^2 q = phi' f."""
    rigid = np.abs(squares) <= RIGID * np.abs(squares).max()
    unsure = hidden(matrices.K, squares, shapes)
    loose = rigid | unsure | (squares < 0)
    if loose.any():
        kind = "modes of negative stiffness"
        if unsure.any() and not rigid.any():
            kind = "modes that rounding of K, of a free structure or too fine a mesh, leaves no stiffness"
        elif rigid.any():
            kind = "rigid-body modes"
        raise _loose(name, f"{int(loose.sum())} {kind}", matrices, shapes[:, loose])
    root = np.sqrt((rates / 2) ** 2 - squares + 0j)
    root = np.where(
        np.abs(root) < CRITICAL_DISTANCE * np.sqrt(squares), CRITICAL_DISTANCE * np.sqrt(squares), root
    )
    first, second = -rates / 2 + root, -rates / 2 - root
    oscillates = root.imag != 0
    single = np.flatnonzero(~oscillates)
    exponents = np.concatenate([first, second[single]])
    drive = np.concatenate([1 / (2 * root), -1 / (2 * root[single])])
    every = np.concatenate([shapes, shapes[:, single]], axis=1)
    twice = np.concatenate([np.where(oscillates, 2.0, 1.0), np.ones(len(single))])
    undamped = None if shapes.shape[1] == matrices.size else shapes
    return ModalForm(exponents, every * twice + 0j, drive[:, None] * every.T, matrices, undamped=undamped)


def _coupled(name: str, matrices: Matrices, damping: Array) -> ModalForm:
    """From the eigenvectors of the state matrix of (q, q')."""
    n = matrices.size
    mass = scipy.linalg.cho_factor(dense(matrices.M))
    if not _condition(dense(matrices.K)) < 1 / RIGID:
        _, stretched, motions = np.linalg.svd(dense(matrices.K))
        free = stretched <= max(RIGID * float(stretched[0]), float(stretched[-1]))
        raise _loose(name, "rigid-body modes", matrices, motions[free].T)
    state = np.zeros((2 * n, 2 * n))
    state[:n, n:] = np.eye(n)
    state[n:, :n] = -scipy.linalg.cho_solve(mass, dense(matrices.K))
    state[n:, n:] = -scipy.linalg.cho_solve(mass, damping)
    scale = np.sqrt(np.abs(state[n:, :n]).max())
    balance = np.repeat([1.0, 1 / scale], n)
    values, vectors = np.linalg.eig(balance[:, None] * state / balance)
    if not _condition(vectors) < 1 / DEFECTIVE:
        raise ValueError(
            f"structure {name!r} has modes that do not span its motion, as critically damped ones; "
            f"condensation needs their exponents apart: change its matrices a little"
        )
    drive = np.linalg.inv(vectors)[:, n:] * balance[n:] @ scipy.linalg.cho_solve(mass, np.eye(n))
    shapes = vectors[:n]
    kept = values.imag >= 0
    twice = np.where(values[kept].imag > 0, 2.0, 1.0)
    return ModalForm(values[kept] + 0j, shapes[:, kept] * twice + 0j, drive[kept] + 0j, matrices)


def _answer(stiffness: Matrix, loads: Array) -> Array:
    """K^-1 applied to loads."""
    if sparse.issparse(stiffness):
        return np.array(splu(sparse.csc_array(stiffness)).solve(loads), dtype=float)
    return np.asarray(np.linalg.solve(stiffness, loads), dtype=float)


def _loose(name: str, kind: str, matrices: Matrices, shapes: Array) -> LooseError:
    """The error that names what is loose by the degrees of freedom that it moves most."""
    names = {k: place for place, k in matrices.at.items()}
    largest = np.abs(shapes).max(axis=1)
    most = np.flatnonzero(largest > MOVED * largest.max())
    moved = [names.get(int(k), str(k)) for k in most]
    shown = moved if len(moved) <= 6 else [*moved[:6], f"{len(moved) - 6} more"]
    return LooseError(
        f"structure {name!r} has {kind} that forces at its places do not hold, of degrees of freedom "
        f"{', '.join(shown)}; add a stiffness there to K, take these out of its matrices, or compile it with "
        f"condense=False"
    )


def _condition(matrix: Array | Complex) -> float:
    """Condition of a matrix in the 1-norm, infinite of a singular one."""
    with np.errstate(all="ignore"):
        try:
            return float(np.linalg.norm(matrix, 1) * np.linalg.norm(np.linalg.inv(matrix), 1))
        except np.linalg.LinAlgError:
            return float("inf")
