"""How the modes of a structure change with the speed, from its matrices at one speed.

Of modes (M lambda^2 + C lambda + K) phi = 0 with inputs w,

    T_ij = -w_i' (M' lambda_j^2 + C' lambda_j + K') phi_j,   dlambda_j = T_jj,
    dphi_j = sum_i phi_i c_ij,   dw_i = -sum_j c_ij w_j - w_i' M' M^-1,   c_ij = T_ij/(lambda_j - lambda_i),

with all modes, their conjugates included (R. B. Nelson, AIAA Journal 14, 1976, 1201, of the state matrix).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symbolic.arrays import Array, Complex
from symbolic.structures.matrices import dense
from symbolic.structures.modal import DEFECTIVE, ModalForm

NOT_COUPLED = 1e-12
"""Relative size of T_ij below which two modes of one exponent do not turn into each other."""


@dataclass(frozen=True)
class ModalSlope:
    """Derivatives in the speed of a `ModalForm`'s exponents (J,), shapes (n, J) and inputs (J, n)."""

    exponents: Complex
    shapes: Complex
    inputs: Complex


def modal_slope(form: ModalForm, mass: Array, damping: Array, stiffness: Array) -> ModalSlope:
    """Return how modes change where their matrices do.

    Parameters
    ----------
    form : ModalForm
        All modes of a structure.
    mass, damping, stiffness : ndarray, shape (n, n)
        Derivatives of M, of C + Omega G and of K.

    Returns
    -------
    ModalSlope
        The derivatives.

    Raises
    ------
    ArithmeticError
        Where two modes meet.
    """
    count, paired = len(form.exponents), np.flatnonzero(form.exponents.imag)
    shapes = form.shapes.copy()
    shapes[:, paired] /= 2
    values = np.concatenate([form.exponents, form.exponents[paired].conj()])
    shapes = np.concatenate([shapes, shapes[:, paired].conj()], axis=1)
    inputs = np.concatenate([form.inputs, form.inputs[paired].conj()])
    turned = -inputs @ (mass @ shapes * values**2 + damping @ shapes * values + stiffness @ shapes)
    gaps = values - values[:, None]
    apart = np.abs(turned) > NOT_COUPLED * np.abs(turned).max(initial=0.0)
    mixed = np.where(apart & (gaps != 0), turned / np.where(gaps == 0, 1.0, gaps), 0.0)
    np.fill_diagonal(mixed, 0.0)
    met = apart & (gaps == 0)
    np.fill_diagonal(met, False)
    if met.any() or not np.abs(mixed).max(initial=0.0) < 1 / DEFECTIVE:
        raise ArithmeticError("modes of the structure cannot be followed in the speed: two of them meet")
    found = (shapes @ mixed)[:, :count]
    found[:, paired] *= 2
    driven = -mixed @ inputs
    if mass.any():
        driven -= inputs @ np.linalg.solve(dense(form.matrices.M).T, mass.T).T
    return ModalSlope(np.diag(turned)[:count].copy(), found, driven[:count])
