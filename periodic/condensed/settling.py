"""Time stepping of split systems: guesses of orbits that stick and slip, with event nodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from periodic.condensed.heldjoints import Joint
from periodic.condensed.linearised import answer
from periodic.condensed.timestepping import Changed, Motion
from periodic.correction.outcome import FAILURES
from periodic.events.eventnodes import exact_crossings
from periodic.events.modes import sides
from periodic.events.motions import PERIODS, STILL, word_of
from periodic.events.rewrites.sites import ordered
from periodic.events.twinguards import holding, twins
from periodic.orbit.construction import transfer
from periodic.orbit.orbit import FORCED, Orbit
from periodic.orbit.sampling import sampled
from periodic.refinement.equidistribution import redistribute
from periodic.system import HELD, STUCK, System, linear_of

STEPS = 512
"""Time steps in a period while the motion settles."""

FINE = 4096
"""Steps in the period that is kept."""

SHORTEST = 1e-6
"""Least width (rad) of steps and intervals, in which changes of mode are located."""

CLOSE = 10 * SHORTEST
"""As `STILL`, but small enough to have changes of mode near to each other in the right order."""

INTERVALS = 192
"""Intervals of the guess."""


def settled(system: System, start: Orbit) -> Iterator[Orbit]:
    """Yield the motion to which a system with sliding jumps settles from rest, at an orbit's parameters.

    Later ones have settled further, the last in finer steps: only then are changes of mode near to each other
    in order. The sequence ends where motion does not settle within PERIODS, or cannot be followed.
    """
    try:
        motion = Motion.at_rest(system, start.parameter, start.nodes[0], start.algebraic[0, 0])
        for steps, shortest, still in (
            (STEPS, np.inf, STILL),
            (STEPS, SHORTEST, CLOSE),
            (FINE, SHORTEST, CLOSE),
        ):
            motion.pace(steps, shortest)
            if not _settles(motion, still):
                return
            motion.pace(FINE, SHORTEST)
            motion.period()
            yield orbit_of(motion)
    except FAILURES:
        return


def _settles(motion: Motion, still: float) -> bool:
    """Advance a motion, up to PERIODS, until it repeats to `still` of its peak to peak; whether it does."""
    for _ in range(PERIODS):
        side = motion.side
        motion.period()
        states, same = np.array(motion.states), np.array_equal(side, motion.side)
        if same and np.abs(states[-1] - states[0]).max() <= still * np.ptp(states, axis=0).max():
            return True
    return False


def followed(system: System, orbit: Orbit, before: int = 0) -> Orbit | None:
    """Return a period of the motion from a state of an orbit, as an orbit; None where that fails.

    It comes after `before` others. The given orbit may violate its word; the motion does not violate its own.
    """
    part = linear_of(system)
    if part is None or orbit.mesh.period != FORCED:
        return None
    try:
        response, _ = answer(system, orbit, orbit.parameter, ())
        history = response.history(np.ascontiguousarray(orbit.algebraic[:, :, list(part.forces)]))
        k = _amid_segment(orbit)
        side = sides(system, orbit)[k]
        side = np.where(side == HELD, STUCK, side)
        begun = orbit.nodes[k], orbit.algebraic[k, 0], response.modes, history[k], side
        motion = Motion(system, orbit.parameter, *begun, begin=float(orbit.grid.left[k]))
        motion.pace(FINE, SHORTEST)
        for _ in range(before + 1):
            motion.period()
        return orbit_of(motion)
    except FAILURES:
        return None


def _amid_segment(orbit: Orbit) -> int:
    """The mesh point about the middle of the longest segment."""
    mesh = orbit.mesh
    if not mesh.events:
        return 0
    segment = int(np.argmax(mesh.segment_lengths(orbit.phases)))
    return int(mesh.starts[segment]) + (len(mesh.breaks[segment]) - 1) // 2


def orbit_of(motion: Motion) -> Orbit:
    """Return the last period of a motion as an orbit with its event nodes."""
    system, state = motion.system, motion.states[-1]
    guess = sampled(motion.phase, np.array(motion.states), np.array(motion.unknowns), motion.parameter)
    records = _lasting(motion)
    kinked = [(crossing.event, crossing.phase) for crossing in exact_crossings(system, guess)]
    word = word_of(system, _together(motion, records), _always(motion, records))
    events, phases = ordered([*word, *kinked], guess)
    mesh = redistribute(guess, INTERVALS, events, phases, SHORTEST)
    modes, parameter = list[tuple[int, int]](), motion.parameter.copy()
    for joint in motion.joints:
        if any(each.surface == joint.index for each in records):
            continue
        mode = int(motion.side[joint.column])
        if mode == STUCK and joint.place is not None:
            place, weights = joint.place
            parameter[place], mode = float(np.dot(weights, state)), HELD
        modes.append((joint.switch, mode))
    found = transfer(guess, replace(mesh, modes=tuple(modes)), phases)
    return replace(found, parameter=parameter)


def _always(motion: Motion, records: Sequence[Changed]) -> list[int]:
    """The guards of friction that sticks all along."""
    changed = {each.surface for each in records}
    joints = (joint for joint in motion.joints if joint.slides and joint.index not in changed)
    return [joint.switch for joint in joints if motion.side[joint.column] == STUCK]


def _lasting(motion: Motion) -> list[Changed]:
    """The changes of mode without those that are errors of the time steps.

    Errors are slips of one step amid sticking, stops of one step where the motion should pass through, and
    slips of sliders at their limits, until their strain falls, where friction lets the motion go back.
    """
    found = list(motion.events)
    for joint in motion.joints:
        own = [each for each in motion.events if each.surface == joint.index]
        for first, second in zip(own, own[1:] + own[:1], strict=True):
            if first not in found or second not in found or first is second:
                continue
            rest = [each for each in found if each not in (first, second)]
            slips = first.before == STUCK and second.after == STUCK
            if slips and (second.step == first.step + 1 or _goes_back(motion, joint, first)):
                found = rest
            elif first.after == STUCK and second.before == STUCK and _passes(motion, joint, first, second):
                passed = replace(first, after=second.after)
                found = rest if passed.before == passed.after else [*rest, passed]
    return found


def _goes_back(motion: Motion, joint: Joint, slip: Changed) -> bool:
    """Whether friction that stopped a slider lets go as its slip begins, to a motion the other way."""
    before, after = motion.sides[slip.step], motion.sides[slip.step + 1]
    friction = {each.switch: each.column for each in motion.joints if each.slides}
    held = sorted(guard for guard, column in friction.items() if before[column] == STUCK)
    signs = {} if joint.slides else holding(motion.system, joint.switch, held)
    gone = [sign * after[friction[guard]] for guard, sign in signs.items() if after[friction[guard]] != STUCK]
    return bool(gone) and all(way * slip.after < 0 for way in gone)


def _passes(motion: Motion, joint: Joint, stop: Changed, release: Changed) -> bool:
    """Whether a stop of one step is a crossing in fact: rates on both sides of the jump have one sign."""
    if release.step > stop.step + 1 or not joint.slides:
        return False
    k = stop.step + 1
    values = motion.values(motion.states[k], float(motion.phase[k]), motion.sides[k])
    return not values[joint.up] < 0 < values[joint.down]


def _together(motion: Motion, records: list[Changed]) -> list[Changed]:
    """The changes, with a release at the phase of another joint's stop or crossing that causes it at once."""
    records = _side_by_side(motion, records)
    sliding = {joint.index: joint for joint in motion.joints if joint.slides}
    own = [each for each in records if each.surface in sliding]
    causes = [each for each in own if each.before != STUCK]
    found = [each for each in records if each not in own or each in causes]
    for each in (each for each in own if each.before == STUCK):
        near = [c for c in causes if 0 <= each.step - c.step <= 1 and c.surface != each.surface]
        torn = (cause for cause in near if _tears(motion, cause, each, sliding[each.surface]))
        cause = next(torn, each)
        found.append(replace(each, phase=cause.phase))
    return found


def _side_by_side(motion: Motion, records: list[Changed]) -> list[Changed]:
    """The changes, with stops of joints that have one guard at one phase."""
    switches = {joint.index: joint.switch for joint in motion.joints}
    found = list[Changed]()
    for each in records:
        own = switches[each.surface]
        alike = twins(motion.system, own, _held(motion, each)) if each.after == STUCK else {own: 1}
        same = set(alike) - {own}
        stops = [other for other in found if other.after == STUCK and abs(each.step - other.step) <= 1]
        first = next((other for other in stops if switches[other.surface] in same), each)
        found.append(replace(each, phase=first.phase))
    return found


def _held(motion: Motion, each: Changed) -> list[int]:
    """The guards of friction that is held before and after a change."""
    about = motion.sides[each.step], motion.sides[each.step + 1]
    joints = (joint for joint in motion.joints if joint.slides and joint.index != each.surface)
    return [joint.switch for joint in joints if all(side[joint.column] == STUCK for side in about)]


def _tears(motion: Motion, cause: Changed, release: Changed, joint: Joint) -> bool:
    """Whether a joint that sticks before another's change could not stick in the modes after it."""
    k, held = cause.step, list[bool]()
    for modes in (motion.sides[k], motion.sides[release.step + 1]):
        side = np.where(np.arange(len(modes)) == joint.column, STUCK, modes)
        values = motion.values(motion.states[k], float(motion.phase[k]), side)
        held.append(bool(values[joint.up] < 0 < values[joint.down]))
    return held[0] and not held[1]
