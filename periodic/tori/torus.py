"""Tori that begin at a torus bifurcation, followed over the parameter of its branch."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np

from periodic.bifurcations.label import Label
from periodic.bifurcations.switching import FIRST_DISTANCE
from periodic.checks import number, positive, whole
from periodic.orbit.layout import layout_of
from periodic.orbit.scheme import Array
from periodic.results.point import Point
from periodic.system import Flowing, System, check_system, index_of
from periodic.system.precision import MOST_ITERATIONS
from periodic.tori.invariant import Invariance, Torus, moved, phase_row, tail_of, unknowns


class TorusError(ArithmeticError):
    """A torus is not found; the sentence says where and why."""


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
    if whole("angles", angles, 5) % 2 == 0:
        raise ValueError(f"angles is {angles}; it must be odd")
    if not hasattr(system, "flow"):
        raise ValueError(f"system is a {type(system).__name__}; it must integrate itself in time")
    free, aim = index_of(system, parameter), number("value", value)
    aim /= layout_of(system).parameters[free].scale
    equations = Invariance(cast(Flowing, system), free, positive("tol", tol) / 100)
    family = Family(equations, tol)
    base, way = first(system, point, angles)
    now, tangent = family.start(base, way)
    length = min(step, 0.1)
    for _ in range(whole("max_steps", max_steps)):
        found = family.corrected(now, tangent, length)
        if found is None:
            length /= 2
            if length < 1e-5:
                break
            continue
        before, (now, tangent) = now, found
        low, high = sorted((before.parameter[free], now.parameter[free]))
        if low <= aim <= high and low < high:
            return family.at(before, now, aim)
        length = min(1.3 * length, step)
    reached = now.parameters[parameter]
    raise TorusError(
        f"the family of tori was followed to {parameter} = {reached:.9g} only, not to {value:.9g}; the tori "
        f"are on the other side, or lock there"
    )


def first(system: System, point: Point, angles: int) -> tuple[Torus, Array]:
    """Return the bifurcation's orbit as a circle of radius 0, and the direction of tori that grow from it."""
    orbit = point.orbit
    flowing, period = cast(Flowing, system), float(orbit.mesh.period)
    begin = orbit.state(np.zeros(1))[0]
    guess = orbit.algebraic_guess(np.zeros(1))[0]
    flow = flowing.flow(begin, guess, orbit.parameter, np.array([0.0, period]), (), 1e-10)
    values, vectors = np.linalg.eig(flow.state_gradient[-1])
    k = int(np.argmin(np.abs(np.abs(values) - 1) + (np.abs(values.imag) < 1e-8)))
    turn = np.exp(2j * np.pi * np.arange(angles) / angles)
    vector = vectors[:, k] / np.linalg.norm(vectors[:, k])
    circle = np.real(turn[:, None] * vector)
    states = np.tile(begin, (angles, 1))
    angle = float(np.angle(values[k]))
    base = Torus(states, angle, orbit.parameter.copy(), period, layout_of(system), 0.0, 0.0)
    return base, np.append(circle.ravel(), [0.0, 0.0])


class Family:
    """The tori over a parameter: Newton's method with an arclength, or with the parameter held."""

    def __init__(self, equations: Invariance, tol: float) -> None:
        self._equations, self._tol, self._free = equations, tol, equations.free

    def start(self, base: Torus, way: Array) -> tuple[Torus, Array]:
        """Return the first torus and the direction of the family."""
        weights = self._weights(base)
        way = way / np.sqrt(weights @ way**2)
        small = moved(base, self._free, unknowns(base, self._free) + FIRST_DISTANCE * way)
        held = weights * way
        found = self._newton(small, small, held, float(held @ unknowns(small, self._free)))
        if found is None:
            raise TorusError("no torus is found beside the bifurcation; it may be degenerate")
        ahead = unknowns(found, self._free) - unknowns(base, self._free)
        return found, ahead / np.sqrt(weights @ ahead**2)

    def corrected(self, now: Torus, tangent: Array, length: float) -> tuple[Torus, Array] | None:
        """Return the torus a step along the family and the direction there; None where Newton fails."""
        weights, values = self._weights(now), unknowns(now, self._free)
        guess = moved(now, self._free, values + length * tangent)
        held = weights * tangent
        found = self._newton(guess, now, held, float(held @ (values + length * tangent)))
        if found is None:
            return None
        ahead = unknowns(found, self._free) - values
        return found, ahead / np.sqrt(weights @ ahead**2)

    def at(self, before: Torus, after: Torus, aim: float) -> Torus:
        """Return the torus at a value of the parameter between two."""
        low, high = unknowns(before, self._free), unknowns(after, self._free)
        share = (aim - low[-1]) / (high[-1] - low[-1])
        held = np.zeros(len(low))
        held[-1] = 1.0
        guess = moved(before, self._free, low + share * (high - low))
        found = self._newton(guess, after, held, aim)
        if found is None:
            raise TorusError("Newton's method does not converge at the value asked for")
        return found

    def _weights(self, torus: Torus) -> Array:
        """Weights of the unknowns in the arclength: states by 1/M, M the number of angles, others by 1."""
        count, n = torus.states.shape
        return np.concatenate([np.full(count * n, 1 / count), [1.0, 1.0]])

    def _newton(self, guess: Torus, phase: Torus, held: Array, level: float) -> Torus | None:
        """Return the torus with held . unknowns = level; None where Newton fails."""
        values = unknowns(guess, self._free)
        along = phase_row(guess)
        origin = unknowns(phase, self._free)
        for _ in range(MOST_ITERATIONS):
            torus = moved(guess, self._free, values)
            try:
                residual, jacobian = self._equations.linearise(torus)
            except ArithmeticError:
                return None
            size = float(np.abs(residual).max())
            if not np.isfinite(size) or size > 1e3:
                return None
            gaps = [along @ (values - origin), held @ values - level]
            if size < self._tol and max(map(abs, gaps)) < self._tol:
                return replace(torus, residual=size, tail=tail_of(torus.states))
            matrix = np.vstack([jacobian, along, held])
            try:
                values = values - np.linalg.solve(matrix, np.append(residual, gaps))
            except np.linalg.LinAlgError:
                return None
        return None
