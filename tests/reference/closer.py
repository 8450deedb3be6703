"""Orbits of `reference.contact` in extended precision, where doubles do not tell them.

What a period makes of a state's last digit grows with the fundamental matrices; beside grazing it is much of
a contact's depth, and so of the multipliers. Here the events found in doubles are followed in
`numpy.longdouble` (64 bits of mantissa on x86), exponentials by Taylor's series.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from reference.contact import Contact, Mode, Period, at_rest

Long = NDArray[np.longdouble]

TWO_PI = np.longdouble("6.28318530717958647692528676655900577")
EPSILON = float(np.finfo(np.longdouble).eps)
ROUNDING = 1e-15
"""Of a state in doubles."""

STEPS = 8
"""Newton's steps to an orbit, and to an event, at the most; derivatives are those of doubles."""

SEEN = 1e-9
"""Gap at the end of a period that a wrong pattern of events leaves at the least."""

SQUARED = 1 / 2
"""Norm up to which a series is summed; larger matrices are halved until theirs is, and the result squared."""


def closer(system: Contact, Omega: float, near: Period, phase: float = 0.0) -> Period:
    """Return the periodic orbit near one found in doubles that has the same events, in that order."""
    state, found = near.start.astype(np.longdouble), near
    left = 2 * max(float(np.abs(near.end - near.start).max()), SEEN, ROUNDING * near.growth)
    for _ in range(STEPS):
        following = _period(system, Omega, replace(found, start=state), phase)
        gap = following.end - following.start
        if not float(np.abs(gap).max()) < left / 2:
            break
        found, left = following, float(np.abs(gap).max())
        inverse = np.linalg.inv(np.eye(len(state)) - found.monodromy.astype(float))
        state = state + inverse @ gap
    return replace(found, monodromy=found.monodromy.astype(float))


def _period(system: Contact, Omega: float, near: Period, phase: float) -> Period:
    """Follow a period along known events."""
    n, begin, omega = len(near.start), np.longdouble(phase), np.longdouble(Omega)
    z = np.concatenate([near.start, [np.longdouble(1), np.cos(begin), np.sin(begin)]])
    mode, perturbed = system.begin(z.astype(float)), np.eye(n + 3, dtype=np.longdouble)
    t, events = np.longdouble(0), list[tuple[int, float]]()
    for i, place in near.events:
        length, flow, row = _until(system, Omega, mode, i, z, (np.longdouble(place) - begin) / omega - t)
        before = system.piece(Omega, mode).generator
        z, perturbed, t = flow @ z, flow @ perturbed, t + length
        mode, reset = system.passed(Omega, mode, i, z.astype(float))
        after = system.piece(Omega, mode).generator
        jump = after @ (reset @ z) - reset @ (before @ z)
        perturbed = (reset + np.outer(jump, row) / (row @ (before @ z))) @ perturbed
        z = at_rest(system.elements[i], reset @ z)
        events.append((i, float(begin + omega * t)))
    flow = exponential(system.piece(Omega, mode).generator, TWO_PI / omega - t)
    z, perturbed = flow @ z, flow @ perturbed
    return Period(near.start, z[:n], perturbed[:n, :n], near.growth, events)


def _until(
    system: Contact, Omega: float, mode: Mode, i: int, z: Long, length: np.longdouble
) -> tuple[np.longdouble, Long, Long]:
    """How long it is to an event of element i, about `length`; what it makes of z, and the event's row."""
    piece = system.piece(Omega, mode)
    flow = exponential(piece.generator, length)
    own = [k for k, owner in enumerate(piece.owners) if owner == i]
    row = piece.rows[min(own, key=lambda k: abs(piece.rows[k] @ flow @ z))]
    for _ in range(STEPS):
        later = flow @ z
        change = -(row @ later) / (row @ (piece.generator @ later))
        length, flow = length + change, exponential(piece.generator, change) @ flow
        if abs(change) * Omega < EPSILON:
            break
    return length, flow, row


def exponential(generator: NDArray[np.float64], t: np.longdouble) -> Long:
    """exp(G t), balanced: beside a stiff spring velocities are far larger than displacements."""
    balanced, (scale, _) = scipy.linalg.matrix_balance(generator, permute=False, separate=True)
    size = float(np.abs(balanced).sum(axis=1).max() * abs(t))
    halvings = max(0, int(np.ceil(np.log2(size / SQUARED)))) if size else 0
    matrix = balanced * (t / np.longdouble(2) ** halvings)
    found = term = np.eye(len(generator), dtype=np.longdouble)
    k = 0
    while np.abs(term).max() > EPSILON / 8:
        k += 1
        term = matrix @ term / k
        found = found + term
    for _ in range(halvings):
        found = found @ found
    return np.asarray(found * (scale[:, None] / scale))
