"""The place at which a joint that never slips is held, in a first orbit: midway between its bounds.

A motion determines the place only within bounds. Midway the force on the joint is as far from its limit one
way as the other, and along the branch both limits are reached at once: there slips in both directions begin.
Where the bounds move along a branch one of them is reached first: the joint is pulled to another place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.conditions.twoparameter.grazing import GrazingCondition
from periodic.correction.identity import distance
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.events.modes import held_all_along
from periodic.events.switchpolynomials import SwitchPolynomials
from periodic.events.thresholds import TOGETHER
from periodic.linear.unknowns import size_of
from periodic.orbit.mesh import Mesh
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array
from periodic.refinement.adaptation import refined
from periodic.results.stop import Reason
from periodic.system import SurfaceLike, System, surfaces_of
from periodic.tracing.follow import Follow

DIFFERENCE = 1e-3
"""Step of a place, as a part of the largest range of a state: the force is about linear in the place."""

MOST_MOVES = 3
"""How often the places are moved."""

MOST_SPLITS = 4
"""How often a move at which no orbit is found is split into halves, and these again."""

FOLLOWED = 5
"""Steps along the branch in a place after which it is seen how near the middle is, ..."""

MOST_FOLLOWED = 20
"""... and how often at the most. As many points are those that reach one limit followed to one at both."""

MOST_HALVINGS = 8
"""How often a move is halved beyond which other events of the orbit change."""


Measure = Callable[[System, Orbit, list[SurfaceLike]], Array]
"""A number for each joint that is held all along, as it is pulled in an orbit."""

Solve = Callable[[Solver, Orbit, float], Solution]
"""Returns the orbit near a guess, given the sign with which the parameter changes along the branch."""


def unplaced(system: System, orbit: Orbit, guess: Mesh) -> list[SurfaceLike]:
    """Return the joints held all along in an orbit, at places that a guess does not give."""
    return [surface for surface in _held(system, orbit) if not held_all_along(guess, surface)]


def at_limit(system: System, orbit: Orbit) -> list[SurfaceLike]:
    """Return the joints held all along in an orbit that just reach one of their limits."""
    held = _held(system, orbit)
    return [surface for surface, pull in zip(held, _pulls(system, orbit, held), strict=True) if pull.reached]


def amid(solver: Solver, found: Solution, loose: list[SurfaceLike], sign: float) -> Solution:
    """Return an orbit with joints that are held all along midway between their bounds.

    It is the orbit given where there are no such joints, or no better orbit is found.
    """
    system = solver.problem.system
    tolerance = solver.tolerance.orbit
    for _ in range(MOST_MOVES if loose else 0):
        off = _off_centre(system, found.orbit, loose)
        if np.abs(off).max() <= tolerance:
            break
        slopes = _slopes(solver, found, loose, _off_centre, sign)
        if slopes is None:
            break
        moved = _moved(solver, found, loose, _solved(slopes, -off), sign)
        if not _better(moved, system, loose, off):
            break
        found = moved
    return found


def off_limits(
    solver: Solver, found: Solution, sign: float, solve: Solve, follow: Follow | None, farthest: float
) -> Solution:
    """Return an orbit with the joints that just reach a limit moved away from it: midway, or less far.

    Where events change on the way, it is one at which a joint reaches both limits, from which slips in both
    directions begin. It is the orbit given where no joint is at one limit, or no such orbit is found. solve:
    finds orbits that may have other events. follow: follows branches, on which events may change, if it may.
    farthest: how far off an orbit at both limits may be, in the metric of continuation.
    """
    problem, system = solver.problem, solver.problem.system
    each = at_limit(system, found.orbit)
    loose = [surface for surface in each if surface.place is not None and surface.place[0] != problem.index]
    moved = amid(solver, found, loose, sign)
    if moved is not found or not loose or _at_both(system, found.orbit, loose):
        return moved
    if follow is not None:
        near = (led for led in _corners(solver, found, loose, sign, follow) if _apart(found, led) <= farthest)
        led = next(near, None) or _followed(solver, found, loose, sign, follow)
        if led is not None:
            return led
    room, most = _room(system, found.orbit, loose), _room(system, found.orbit, loose, max)
    slopes = _slopes(solver, found, loose, _room, sign)
    if slopes is None:
        return found
    for halvings in range(1, MOST_HALVINGS + 1):
        step = _solved(slopes, most / 2**halvings - room)
        moved = _moved(solver, found, loose, step, sign, solve)
        if _valid(moved) and not at_limit(system, moved.orbit):
            return moved
    return found


def _followed(
    solver: Solver, found: Solution, loose: list[SurfaceLike], sign: float, follow: Follow
) -> Solution | None:
    """The orbit to which branches in the places of joints at a limit lead, one joint after the other."""
    moved, system = found, solver.problem.system
    for surface in loose:
        each = (_along_place(solver, moved.orbit, surface, way, follow) for way in (1, -1))
        away = (orbit for orbit in each if orbit is not None and surface not in at_limit(system, orbit))
        orbit = next(away, None)
        if orbit is None:
            return None
        moved = _fixed(solver, orbit, sign)
        if not _valid(moved):
            return None
    return None if at_limit(system, moved.orbit) else moved


def _along_place(
    solver: Solver, orbit: Orbit, surface: SurfaceLike, way: int, follow: Follow
) -> Orbit | None:
    """The orbit at which a joint is half as far off the middle, or at least nearer; None if there is none.

    way: 1 where the place grows.
    """
    assert surface.place is not None
    system, index = solver.problem.system, surface.place[0]
    begin, span = float(orbit.parameter[index]), float(np.max(orbit.span()))
    name, bounds = system.parameters[index].name, (begin - span, begin + span)
    own = replace(solver, problem=replace(solver.problem, parameter=name, bounds=bounds))
    first = off = abs(float(_off_centre(system, orbit, [surface])[0]))
    last = None
    for _ in range(MOST_FOLLOWED):
        ahead, stop = follow(own, orbit if last is None else last, way, FOLLOWED)
        if ahead is None or not held_all_along(ahead.mesh, surface):
            break
        left = abs(float(_off_centre(system, ahead, [surface])[0]))
        if left >= off:
            break
        last, off = ahead, left
        if off <= first / 2 or stop.reason is not Reason.MAX_POINTS:
            break
    return last


def _corners(
    solver: Solver, found: Solution, loose: list[SurfaceLike], sign: float, follow: Follow
) -> Iterator[Solution]:
    """Yield orbits at which one of the joints reaches both limits, along those at which it reaches one.

    The places in which a joint can be held lie between its limits: two curves over the parameter, that end
    where they meet. Midway between them is no way there where one of them turns back in the parameter.
    """
    for surface in loose:
        for way in (1, -1):
            orbit = _along_limit(solver, found.orbit, surface, int(way * sign), follow)
            if orbit is not None and _at_both(solver.problem.system, orbit, [surface]):
                yield _fixed(solver, orbit, sign)


def _apart(found: Solution, other: Solution) -> float:
    """The distance of two orbits in the metric of continuation."""
    return distance(found.problem, found.orbit, other.orbit) / size_of(found.orbit)


def _along_limit(
    solver: Solver, orbit: Orbit, surface: SurfaceLike, way: int, follow: Follow
) -> Orbit | None:
    """The last orbit along those at which a joint reaches the limit that it is nearest to, one way.

    way: the sign with which the parameter changes at first.
    """
    assert surface.place is not None and surface.releases is not None
    system = solver.problem.system
    (pull,) = _pulls(system, orbit, [surface])
    release = surface.releases[0 if pull.off_centre > 0 else 1]
    name = system.parameters[surface.place[0]].name
    limit = GrazingCondition(system.switches[release].name)
    span = float(np.max(orbit.span()))
    problem = replace(solver.problem, determined={name: limit}, sizes=(span,))
    return follow(replace(solver, problem=problem), orbit, way, MOST_FOLLOWED)[0]


def _at_both(system: System, orbit: Orbit, held: list[SurfaceLike]) -> bool:
    """Whether one of the joints held all along in an orbit reaches both its limits."""
    return any(min(pull.up, -pull.down) > -TOGETHER for pull in _pulls(system, orbit, held))


def _held(system: System, orbit: Orbit) -> list[SurfaceLike]:
    """The joints held all along, at a place."""
    each = (s for s in surfaces_of(system) if s.releases is not None and s.place is not None)
    return [surface for surface in each if held_all_along(orbit.mesh, surface)]


@dataclass(frozen=True)
class _Pull:
    """A joint's releases, up < 0 < down, where they are nearest to 0, over the distance of its limits."""

    up: float
    down: float

    @property
    def off_centre(self) -> float:
        """How much nearer to one limit than to the other."""
        return self.up + self.down

    @property
    def reached(self) -> bool:
        """Whether it is at one of them."""
        return max(self.up, -self.down) > -TOGETHER


def _pulls(system: System, orbit: Orbit, held: list[SurfaceLike]) -> list[_Pull]:
    """The pull on each joint along an orbit."""
    dense, found = SwitchPolynomials(system, orbit), list[_Pull]()
    for surface in held:
        assert surface.releases is not None
        up, down = surface.releases
        apart = float(np.abs(dense.knots[:, :, down] - dense.knots[:, :, up]).max())
        most, least = (dense.along(k, everywhere=True).value for k in (up, down))
        found.append(_Pull(float(most.max()) / apart, float(least.min()) / apart))
    return found


def _off_centre(system: System, orbit: Orbit, held: list[SurfaceLike]) -> Array:
    """How much nearer to one limit than to the other each is pulled, as a part of the way between both."""
    return np.array([pull.off_centre for pull in _pulls(system, orbit, held)])


def _room(system: System, orbit: Orbit, held: list[SurfaceLike], which: Callable[..., float] = min) -> Array:
    """How far each is pulled short of the nearer of its limits, as a part of the way between both."""
    return np.array([which(-pull.up, pull.down) for pull in _pulls(system, orbit, held)])


def _slopes(
    solver: Solver, found: Solution, held: list[SurfaceLike], measure: Measure, sign: float
) -> Array | None:
    """The derivatives of a measure in the places, by differences; None where an orbit is not found."""
    step, system = DIFFERENCE * float(np.max(found.orbit.span())), solver.problem.system
    columns, here = list[Array](), measure(system, found.orbit, held)
    for k in range(len(held)):
        beside = _moved(solver, found, held, step * np.eye(len(held))[k], sign)
        if not beside.ok:
            return None
        columns.append((measure(system, beside.orbit, held) - here) / step)
    return np.array(columns).T


def _solved(slopes: Array, wanted: Array) -> Array:
    """The least step of the places by which a measure changes as wanted."""
    return np.asarray(np.linalg.lstsq(slopes, wanted, rcond=DIFFERENCE)[0], dtype=float)


def _fixed(solver: Solver, guess: Orbit, sign: float) -> Solution:
    return refined(solver, solver.at_parameter(guess, sign), fixed=True)


def _moved(
    solver: Solver,
    found: Solution,
    held: list[SurfaceLike],
    step: Array,
    sign: float,
    solve: Solve = _fixed,
    splits: int = MOST_SPLITS,
) -> Solution:
    """The orbit with the places moved, at once or by halves; not ok where none is found."""
    parameter = found.orbit.parameter.copy()
    for surface, way in zip(held, step, strict=True):
        assert surface.place is not None
        parameter[surface.place[0]] += way
    moved = solve(solver, replace(found.orbit, parameter=parameter), sign)
    if moved.ok or not splits:
        return moved
    half = _moved(solver, found, held, step / 2, sign, solve, splits - 1)
    return _moved(solver, half, held, step / 2, sign, solve, splits - 1) if half.ok else half


def _better(moved: Solution, system: System, held: list[SurfaceLike], off: Array) -> bool:
    """Whether an orbit was found, and has its joints nearer to the middle."""
    if not _valid(moved):
        return False
    return bool(np.abs(_off_centre(system, moved.orbit, held)).max() < np.abs(off).max())


def _valid(moved: Solution) -> bool:
    """Whether an orbit was found that does not violate its word."""
    return moved.ok and bool(np.isfinite(moved.error.motion))
