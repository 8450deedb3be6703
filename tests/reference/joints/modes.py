"""Modes of joints: of a state, and after an event.

Coulomb joints at rest are decided together: of the forces |r| <= F exactly one set lets each joint stick or
begin to slip the way its force gives in (rows independent, M positive definite; Moreau). Sliders beside a
joint that turns turn with it; one at its limit slips where its spring would be stretched further.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from reference.joints.model import Array, Coulomb, Jointed, Mode, Slider, Stop
from reference.joints.series import step, taylor

NEAR = 1e-5
"""Speeds, in scale Omega, and forces beside a limit, in F, of a state that is known to so much only."""

AT = 1e-10
"""The same where a state is known to rounding."""


def changed(mode: Mode, sides: dict[int, int]) -> Mode:
    """A mode with other sides of some joints."""
    return tuple(sides.get(i, side) for i, side in enumerate(mode))


def begun(system: Jointed, Omega: float, z: Array) -> Mode:
    """The mode at a state away from events."""
    n = system.freedoms
    speeds = [float(joint.row @ z[n : 2 * n]) / (system.scale * Omega) for joint in system.joints]
    sides, resting = dict[int, int](), list[int]()
    for i, (joint, speed) in enumerate(zip(system.joints, speeds, strict=True)):
        if isinstance(joint, Stop):
            sides[i] = int(joint.row @ z[:n] > joint.gap)
        elif isinstance(joint, Coulomb):
            sides[i] = int(np.sign(speed))
            if abs(speed) < NEAR:
                resting.append(i)
        else:
            force = float(system.stretch(i) @ z)
            slips = abs(force) > 1 - NEAR and force * speed > 0 and abs(speed) > NEAR
            sides[i] = int(np.sign(force)) if slips else 0
    mode = tuple(sides[i] for i in range(len(system.joints)))
    return at_rest(system, z, mode, resting)


def at_rest(system: Jointed, z: Array, mode: Mode, resting: list[int]) -> Mode:
    """The mode in which Coulomb joints at rest stick or begin to slip."""
    if not resting:
        return mode
    free = changed(mode, dict.fromkeys(resting, 0))
    others = [i for i in system.held(free) if i not in resting]
    resting = sorted([*resting, *others])
    n = system.freedoms
    rows, limits = (
        np.array([system.joints[i].row for i in resting]),
        np.array([system.joints[i].limit for i in resting]),
    )
    force = system.forces(free) @ z
    for cubic in system.cubics:
        force -= cubic.stiffness * float(cubic.row @ z[:n]) ** 3 * cubic.row
    begin, matrix = rows @ system.inverse @ force, rows @ system.inverse @ rows.T
    trials = sorted(product((0, 1, -1), repeat=len(resting)), key=np.count_nonzero)
    size = float(np.abs(begin).max()) + 1e-300
    for trial in trials:
        sides = np.array(trial)
        stuck, taken = sides == 0, sides * limits
        taken[stuck] = np.linalg.solve(matrix[np.ix_(stuck, stuck)], (begin - matrix @ taken)[stuck])
        after = begin - matrix @ taken
        if (np.abs(taken[stuck]) <= limits[stuck] * (1 + AT)).all() and (sides * after >= -AT * size).all():
            return changed(free, dict(zip(resting, trial, strict=True)))
    raise ArithmeticError("no mode of the joints at rest")


def followed(system: Jointed, Omega: float, mode: Mode, guard: int, z: Array) -> Mode:
    """The mode after an event: a guard of the mode has come to 0."""
    equations = system.equations(Omega, mode)
    i = equations.owners[guard]
    joint = system.joints[i]
    if isinstance(joint, Stop):
        mode = changed(mode, {i: 1 - mode[i]})
    elif mode[i]:
        turning = together(system, mode, i)
        coulombs = [k for k in turning if isinstance(system.joints[k], Coulomb)]
        mode = changed(mode, dict.fromkeys(turning, 0))
        if coulombs:
            mode = at_rest(system, z, mode, coulombs)
    elif isinstance(joint, Coulomb):
        mode = changed(mode, {i: 1 if equations.owners[guard - 1] != i or guard == 0 else -1})
    return slipping(system, Omega, mode, z)


def together(system: Jointed, mode: Mode, i: int) -> list[int]:
    """The joints that slip at no speed where joint i does, beside those that stick."""
    known = np.array([system.joints[k].row for k in [*system.held(mode), i]]).T
    found = []
    for k, (joint, side) in enumerate(zip(system.joints, mode, strict=True)):
        if not isinstance(joint, Stop) and side:
            left = joint.row - known @ np.linalg.lstsq(known, joint.row, rcond=None)[0]
            if np.abs(left).max() < AT * np.abs(joint.row).max():
                found.append(k)
    return found


def slipping(system: Jointed, Omega: float, mode: Mode, z: Array) -> Mode:
    """The mode in which sliders at their limits slip that are stretched further."""
    equations, sides = system.equations(Omega, mode), dict[int, int]()
    at_limit = [i for i in system.sliders if mode[i] == 0 and abs(system.stretch(i) @ z) > 1 - AT]
    if not at_limit:
        return mode
    series = taylor(equations, z, step(equations.linear, Omega))[:4]
    for i in at_limit:
        row = system.row(v=system.joints[i].row) / (system.scale * Omega)
        felt = [value for value in series @ row if abs(value) > AT]
        side = np.sign(system.stretch(i) @ z)
        if felt and np.sign(felt[0]) == side:
            sides[i] = int(side)
    return changed(mode, sides)


def placing(system: Jointed, mode: Mode) -> Array:
    """What takes z to what its mode holds: no speed where joints stick, the limit where sliders slip."""
    n, found = system.freedoms, np.eye(system.states + 3)
    rows = [system.joints[i].row for i in system.held(mode)]
    if rows:
        found[n : 2 * n, n : 2 * n] -= np.linalg.pinv(np.array(rows)) @ np.array(rows)
    for i in system.sliders:
        joint = system.joints[i]
        assert isinstance(joint, Slider)
        if mode[i]:
            place = system.row(joint.row)
            place[-3] = -mode[i] * joint.limit / joint.stiffness
            found[2 * n + system.sliders.index(i)] = place
    return found
