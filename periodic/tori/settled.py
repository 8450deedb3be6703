"""A torus from a motion that has settled on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
import scipy
from threadpoolctl import threadpool_limits

from periodic.checks import whole
from periodic.conditions.phase import excited
from periodic.orbit.layout import layout_of
from periodic.orbit.orbit import FORCED
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.phasespace.following.values import parameters
from periodic.phasespace.lyapunov import beginning
from periodic.phasespace.search.birkhoff import lines
from periodic.system import System, check_system
from periodic.system.ensembles import FOLLOWED
from periodic.tori.born import check_angles
from periodic.tori.family import family_of, not_resolved
from periodic.tori.grid import FEWEST, TURN, Grid
from periodic.tori.section import TorusError
from periodic.tori.torus import Torus

SECTIONS = 4000
"""Sections by which the second frequency is found."""

PERIODS, PER_PERIOD = 400, 16
"""Periods of a motion to which a first torus is fitted, and samples in each,"""

ORDERS = 6, 5
"""... with so many harmonics of either frequency."""

LINES = 6
"""Lines of the spectrum that may be the second frequency, or a multiple of it."""

PER_TURN = 32
"""Samples of a free motion in each turn of its strongest line, at least."""

SAMPLES, MANY = 4096, 65536
"""Samples by which that line is found, and its period then: a section at another drifts along the motion."""

NEAR = 0.05
"""Part of its size by which a first torus may miss the motion: Newton's method does the rest."""

ROUGHEST = 1e-3
"""Tail beyond which a result would be none."""

GOOD = 1e-2
"""... and by which the first of several that fit, with the fewest harmonics, is taken."""


def settled_torus(
    system: System,
    values: Mapping[str, float] | None = None,
    *,
    start: Mapping[str, float] | None = None,
    settle: int = 1000,
    angles: int = 41,
    tol: float = 1e-8,
    rough: float = 1e-6,
) -> Torus:
    """Return the torus on which a motion settles: of an excited system, or of one with two own frequencies.

    Of an excited system the section is taken once in each period; of another at its strongest line, whose
    period is then determined with the torus. A second excitation whose frequency has no common period with
    the first is two states of the model, as c and s with c' = -w s + (1 - c^2 - s^2) c, s' = w c +
    (1 - c^2 - s^2) s.

    Parameters
    ----------
    system : System
        The equations; one that integrates itself in time, as those of `symbolic.compile` do.
    values : mapping of str to float, optional
        Parameters (SI) that differ from their nominal values.
    start : mapping of str to float, optional
        States (SI) where the motion begins, x' being the velocity; the others, and by default all, at rest.
    settle : int
        Periods after which the motion is looked at.
    angles : int
        Number of angles theta on the section, odd; more are added as `rough` asks for them.
    tol : float
        Largest residual, scaled; integration is a hundred times finer.
    rough : float
        Largest `tail` of the result, up to 641 angles.

    Returns
    -------
    Torus
        The torus: `trace` takes it as a guess.

    Raises
    ------
    ValueError
        For names and numbers that are not allowed.
    TorusError
        Where the motion is not quasi-periodic, no torus is found near it, or it cannot be resolved.
    """
    check_system(system)
    check_angles(angles)
    parameter = parameters(system, values)
    family = family_of(system, 0, tol, rough=rough)
    crowd = Crowd(system, parameter, family.equations.tolerance)
    found = crowd.run(
        crowd.begin(beginning(system, parameter, start)[None]), whole("settle", settle, 0), FORCED
    )
    _check(found.outcome[0])
    motion = Settled(crowd, found.ends, found.modes)
    free = not excited(system, parameter)
    period = motion.period() if free else FORCED
    guess = motion.section(period, angles, free)
    held = family.held(guess, float(parameter[0]))
    refined = None if held is None else family.refined(held)
    if refined is None:
        raise TorusError(
            f"no torus is found near the motion, whose rotation number is about {guess.rotation_number:.6g}; "
            f"another number of angles or a longer settle may lead to one"
        )
    if refined[0].tail > ROUGHEST:
        raise TorusError(
            f"{not_resolved(refined[0])}; motions that just touch something make it so, or an orbit nearby "
            f"on which it locks"
        )
    return cast(Torus, refined[0])


@dataclass(frozen=True, eq=False)
class Settled:
    """A motion on a torus, from y (1, w) with its modes."""

    crowd: Crowd
    y: Array
    modes: Array

    def period(self) -> float:
        """Return the period (rad in tau) of the strongest line of a free motion. Raises TorusError."""
        width = FORCED / PER_TURN
        for _ in range(LINES):
            states = self._states(SAMPLES, width)
            line = lines(states, np.maximum(np.ptp(states, axis=0), 1e-12), 1)
            if len(line) and line[0] * PER_TURN < 1.5:
                break
            width /= 2
        if not len(line) or line[0] * SAMPLES < PER_TURN:
            raise TorusError("the motion is at rest, or too slow for the parameter omega; it must turn")
        states = self._states(MANY, width)
        fine = lines(states, np.maximum(np.ptp(states, axis=0), 1e-12), 1)
        return float(width / fine[0])

    def section(self, period: float, angles: int, free: bool) -> Torus:
        """Return a first curve through the motion's sections. Raises TorusError."""
        states = self._states(PERIODS * PER_PERIOD, period / PER_PERIOD)
        size = np.maximum(np.ptp(states, axis=0), 1e-12)
        sections = self._states(SECTIONS, period)
        with threadpool_limits(limits=1):  # threads that wait for each other take ten times as long
            tried = [_fitted(states, size, turns, angles) for turns in _turns(sections, size)]
        least = min((off for off, *_ in tried), default=np.inf)
        if least > NEAR:
            raise TorusError(
                "the motion is not quasi-periodic with two frequencies, or has not settled; "
                "per.motions tells what it is"
            )
        _, turns, curve = next(each for each in tried if each[0] < max(2 * least, GOOD))
        layout, rotation = layout_of(self.crowd.system), 2 * np.pi * turns
        found = Torus(curve, rotation, self.crowd.parameter.copy(), period, layout, free=free)
        return found if free else self._broken(found, sections)

    def _broken(self, torus: Torus, sections: Array) -> Torus:
        """A first curve in pieces, through all sections, where they are on both sides of a surface."""
        system, at = self.crowd.system, np.mod(torus.rotation * np.arange(float(len(sections))), TURN)
        order = np.argsort(at)
        at, states = at[order], sections[order]
        signs = np.sign(system.switch(states, np.zeros(len(states)), torus.parameter))
        crossed = np.flatnonzero((signs != np.roll(signs, -1, axis=0)).any(axis=1))
        count = len(torus.states)
        if not 1 < len(crossed) <= count // FEWEST:
            return torus
        middle = at[crossed] + np.mod(at[(crossed + 1) % len(at)] - at[crossed], TURN) / 2
        grid = Grid(count, np.sort(np.mod(middle, TURN)))
        curve = np.asarray(np.linalg.lstsq(grid.interpolation(at)[0], states, rcond=None)[0], dtype=float)
        return replace(torus, states=curve, breaks=grid.breaks, tail=grid.tail(curve))

    def _states(self, count: int, width: float) -> Array:
        """States of the motion at equal times, (count, n)."""
        path = self.crowd.run(self.y, count - 1, width, modes=self.modes, keep=True)
        _check(path.outcome[0])
        assert path.sections is not None
        return path.sections[0, :, : len(self.crowd.system.states)]


def _turns(states: Array, size: Array) -> list[float]:
    """Rotation numbers that the section may have: of its lines, and of halves and thirds of these."""
    found = lines(states, size, LINES)
    parts = (1, 2, 3)
    return [(line + more) / part for part in parts for line in found for more in range(part)]


def _fitted(states: Array, size: Array, turns: float, angles: int) -> tuple[float, float, Array]:
    """How far a torus of a rotation number is from a motion, that number, and its section (M, n).

    The motion is a sum of cos(k tau + j theta) and sin(k tau + j theta), of few k and j: those of tori near a
    resonance, whose motions come back after a very long time only, can be told from each other.
    """
    tau = 2 * np.pi * np.arange(len(states)) / PER_PERIOD
    first = np.arange(-ORDERS[0], ORDERS[0] + 1)
    pairs = [(k, order) for order in range(ORDERS[1] + 1) for k in first if order or k >= 0]
    k, orders = np.array(pairs).T
    both = np.multiply.outer(tau, k + orders * turns)
    matrix = np.hstack([np.cos(both), np.sin(both)])
    found, *_ = scipy.linalg.lstsq(matrix, states / size, cond=1e-10, lapack_driver="gelsy")
    off = float(np.sqrt(((matrix @ found - states / size) ** 2).mean(axis=0)).max())
    at = np.multiply.outer(Grid(angles).angles, orders)
    curve = np.hstack([np.cos(at), np.sin(at)]) @ found
    return off, turns, curve * size


def _check(outcome: int) -> None:
    if outcome != FOLLOWED:
        raise TorusError("the motion could not be followed; another start= may settle")
