"""Motions integrated until they settle: a guess of an orbit where Newton's method finds none."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import cast

import numpy as np

from periodic.correction.discretisation import Discretisation
from periodic.correction.outcome import FAILURES
from periodic.correction.tolerance import Accuracy
from periodic.events.motions import STILL, has_words
from periodic.orbit.orbit import Orbit
from periodic.orbit.sampling import sampled
from periodic.system import STUCK, Moving, System, TrajectoryLike, surfaces_of
from periodic.tracing.transient import CLOSE, Transient


def settled(method: Discretisation, system: System, start: Orbit) -> Iterator[Orbit]:
    """Yield the motion to which a system settles from the beginning of an orbit, with its parameters.

    By the method's own simulation, or by integration of all states; then the same motion settled further.
    Of a system without words whose motion does not settle within PERIODS the periods that came back closest;
    of others nothing then, nor for a system that cannot be integrated. Raises FAILURES where its integration
    fails.
    """
    own = method.settled(system, start)
    yield from _integrated(method, system, start) if own is None else own


def settled_or_none(method: Discretisation, system: System, start: Orbit) -> Iterator[Orbit]:
    """Yield the same; nothing where the integration fails."""
    with contextlib.suppress(*FAILURES):
        yield from settled(method, system, start)


def _integrated(method: Discretisation, system: System, start: Orbit) -> Iterator[Orbit]:
    """The motion of a system with all its states, and the same settled further."""
    if not hasattr(system, "motion"):
        return
    begin = start.nodes[0], start.algebraic[0, 0], None
    motion = Transient(method, cast(Moving, system), start.parameter, begin)
    for wanted in (STILL, CLOSE):
        if not motion.settles(wanted):
            if not has_words(motion.system):
                yield from (_through(system, path, start) for path in motion.returns())
            return
        if (orbit := motion.orbit()) is None:
            yield _through(system, motion.samples(), start)
            return
        yield orbit


def _through(system: System, path: TrajectoryLike, start: Orbit) -> Orbit:
    """The orbit through a path, with the parameters of the beginning."""
    return sampled(path.phase, path.state, path.algebraic, start.parameter, system=system)


def held(system: System, motion: Orbit) -> list[str]:
    """Return along which jumps of the equations a motion slides all the time, by their switches' names.

    There orbits are not isolated: the place at which friction holds is not determined. By its modes,
    or by its values where it is at rest there.
    """
    states, tau = motion.nodes[:-1], motion.grid.left
    values = np.abs(system.switch(states, tau, motion.parameter)).max(axis=0)
    slopes = np.abs(system.switch_gradient(states, tau, motion.parameter)[0]).sum(axis=2).max(axis=0)
    still = values <= Accuracy.STANDARD * slopes * motion.span()
    stuck = nowhere(system, motion)
    return [system.switches[k].name for k in _without_place(system) if still[k] or k in stuck]


def nowhere(system: System, orbit: Orbit) -> list[int]:
    """Return the switches of jumps that an orbit's modes hold all along where no place is given."""
    modes = dict(orbit.mesh.modes)
    return [k for k in _without_place(system) if modes.get(k) == STUCK]


def _without_place(system: System) -> list[int]:
    """The switches of jumps along which motions slide, but not those of what says where, or need not."""
    each = [s for s in surfaces_of(system) if s.releases is not None]
    return [s.switch for s in each if s.place is None and not s.alone]
