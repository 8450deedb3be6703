"""Tori that begin at a torus bifurcation, followed over the parameter of its branch."""

from __future__ import annotations

from typing import cast

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.switching import FIRST_DISTANCE
from periodic.checks import number, whole
from periodic.orbit.layout import layout_of
from periodic.orbit.scheme import Array
from periodic.phasespace.following.crowd import Crowd
from periodic.results.point import Point
from periodic.system import System, check_system, index_of
from periodic.tori.family import Family, family_of
from periodic.tori.invariance import Unknowns, solved
from periodic.tori.section import TorusError
from periodic.tori.torus import Torus


def torus(
    system: System,
    point: Point,
    parameter: str,
    value: float,
    *,
    angles: int = 41,
    tol: float = 1e-8,
    step: float = 0.2,
    max_steps: int = 100,
) -> Torus:
    """Return the torus at a value of a parameter, followed from the torus bifurcation where it begins.

    The first torus is u = x + eps Re(v e^{i theta}) about the orbit x with the multiplier's vector v. The
    family is followed by arclength, by Newton's method on the invariance of the stroboscopic map, whose
    derivatives are integrated with it.

    Parameters
    ----------
    system : System
        The system; one that integrates itself in time, as those of `symbolic.compile` do.
    point : Point
        A point "NS" of a branch over `parameter`.
    parameter : str
        The parameter.
    value : float
        Its value (SI), on the side of the point on which the tori are.
    angles : int
        Number of angles theta on the invariant circle, odd.
    tol : float
        Largest residual, scaled; integration is a hundred times finer.
    step : float
        Longest step along the family, in amplitudes of the scaled states.
    max_steps : int
        Largest number of steps.

    Returns
    -------
    Torus
        The torus; its `tail` estimates the error.

    Raises
    ------
    ValueError
        For a point that is no NS, a number of angles that is not odd, and a system that does not integrate.
    TorusError
        Where no torus is found: on the other side of the bifurcation, or where the motion locks.
    """
    check_system(system)
    if not isinstance(point, Point) or point.label != Label.TORUS:
        raise ValueError(f"point is {point!r}; it must be a point NS of a branch")
    check_angles(angles)
    free, aim = index_of(system, parameter), number("value", value)
    aim /= layout_of(system).parameters[free].scale
    family = family_of(system, free, tol)
    now, tangent = start(family, *first(system, point, angles, family.equations.tolerance))
    length = min(step, 0.1)
    for _ in range(whole("max_steps", max_steps)):
        found = family.corrected(now, tangent, length)
        if found is None:
            length /= 2
            if length < 1e-5:
                break
            continue
        before, now, tangent = now, cast(Torus, found[0]), found[1]
        low, high = sorted((before.parameter[free], now.parameter[free]))
        if low <= aim <= high and low < high:
            if (there := family.between(before, now, aim)) is None:
                raise TorusError("Newton's method does not converge at the value asked for")
            return cast(Torus, there)
        length = min(1.3 * length, step)
    reached = now.parameters[parameter]
    raise TorusError(
        f"the family of tori was followed to {parameter} = {reached:.9g} only, not to {value:.9g}; the tori "
        f"are on the other side, or lock there"
    )


def check_angles(angles: int) -> None:
    """Refuse a number of angles that is not odd. Raises ValueError."""
    if whole("angles", angles, 5) % 2 == 0:
        raise ValueError(f"angles is {angles}; it must be odd")


def first(system: System, point: Point, angles: int, tolerance: float = 1e-10) -> tuple[Torus, Array]:
    """Return the bifurcation's orbit as a circle of radius 0, and the direction of tori that grow from it."""
    orbit = point.orbit
    period = float(orbit.mesh.period)
    begin = orbit.state(np.zeros(1))
    crowd = Crowd(system, orbit.parameter, tolerance)
    y = crowd.begin(begin)
    found = crowd.run(y, 1, period, tangents=crowd.tangents(y), raw=True)
    n = begin.shape[1]
    values, vectors = np.linalg.eig(found.tangents[0, :, :n].T)
    k = int(np.argmin(np.abs(np.abs(values) - 1) + (np.abs(values.imag) < 1e-8)))
    turn = np.exp(2j * np.pi * np.arange(angles) / angles)
    vector = vectors[:, k] / np.linalg.norm(vectors[:, k])
    circle = np.real(turn[:, None] * vector)
    states, angle = np.tile(begin[0], (angles, 1)), float(np.angle(values[k]))
    base = Torus(states, angle, orbit.parameter.copy(), period, layout_of(system), 0.0, 0.0)
    return base, np.append(circle.ravel(), [0.0, 0.0])


def start(family: Family, base: Torus, way: Array) -> tuple[Torus, Array]:
    """Return the first torus of a family and its direction. Raises TorusError."""
    unknowns = Unknowns(family.equations, base)
    way = way / np.sqrt(unknowns.weights @ way**2)
    values = unknowns.of(base)
    small = unknowns.torus(values + FIRST_DISTANCE * way)
    held = unknowns.weights * way
    level = float(held @ (values + FIRST_DISTANCE * way))
    found = solved(family.equations, small, small, held, level, family.tol)
    if found is None:
        raise TorusError("no torus is found beside the bifurcation; it may be degenerate")
    return cast(Torus, found[0]), found[1]
