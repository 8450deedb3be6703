"""The deflection of a contact under a film as a function of its algebraic unknown xi.

With delta/delta0 = s(xi) = ln(1 + e^xi) both s (in contact) and ln s (out of contact) are mild in xi.
"""

from __future__ import annotations

import math

import casadi as ca

REST_XI = math.log(math.e - 1)
"""xi at rest, where s(xi) = 1."""

LEAST_LEFT = 0.1
"""Least part of the deflection that a Newton step in the deflection leaves; a larger step is taken in xi."""

EMPTY = -27.0
"""xi below which the deflection (1e-12 of the steady one) no longer matters to geometry."""


def softplus(xi: ca.SX) -> ca.SX:
    """s = ln(1 + e^xi), without overflow."""
    return ca.log1p(ca.exp(ca.fmin(xi, 40))) + ca.fmax(xi - 40, 0)


def log_softplus(xi: ca.SX) -> ca.SX:
    """ln s = ln ln(1 + e^xi), without underflow: it tends to xi where e^xi vanishes."""
    middle = ca.fmax(ca.fmin(xi, 40), -30)
    far = ca.log1p(ca.fmax(xi - 40, 0) / 40)
    return ca.log(ca.log1p(ca.exp(middle))) + ca.fmin(xi + 30, 0) + far


def move_xi(xi: ca.SX, increment: ca.SX) -> ca.SX:
    """Where a Newton increment takes xi: linear in s = softplus(xi) where that stays positive.

    Geometry is linear in s, the film law in ln s. A rise by Newton's tangent in xi overshoots geometry
    exponentially; a fall that would empty the contact is taken in xi, by no more than 10 at a time. Below
    EMPTY, where geometry no longer notices s, xi moves freely.
    """
    s = softplus(xi)
    change = increment / (1 + ca.exp(-ca.fmax(xi, -30)) * ca.exp(-ca.fmin(xi + 30, 0))) / s
    kept = ca.log1p(ca.fmax(change, LEAST_LEFT - 1)) + ca.log(s)
    linear_in_s = _inverse_log_softplus(kept)
    fall = xi + ca.fmax(ca.fmin(increment, math.log(LEAST_LEFT)), -10)
    moved = ca.if_else(change > LEAST_LEFT - 1, linear_in_s, fall)
    free = ca.fmin(xi + increment, EMPTY)
    return ca.if_else(xi < EMPTY, ca.if_else(increment > 0, ca.fmax(moved, free), free), moved)


def _inverse_log_softplus(y: ca.SX) -> ca.SX:
    """xi with ln s(xi) = y: ln(expm1(e^y)) without overflow or underflow."""
    s = ca.exp(ca.fmin(y, 700))
    small = y + ca.log(ca.expm1(ca.fmax(ca.fmin(s, 1), 1e-12)) / ca.fmax(ca.fmin(s, 1), 1e-12))
    large = s + ca.log(-ca.expm1(-ca.fmax(s, 1)))
    return ca.if_else(s > 1, large, small)
