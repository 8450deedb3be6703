"""Predictors: the tangent from one solution, the cubic between two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from periodic.correction.newton import moved
from periodic.correction.problem import Problem
from periodic.correction.solution import Solution
from periodic.correction.solver import Solver
from periodic.linear.unknowns import Increment
from periodic.orbit.orbit import Orbit
from periodic.orbit.scheme import Array


def tangent(problem: Problem, solution: Solution, distance: float) -> Orbit:
    """Return the orbit moved by a distance along the tangent of its branch."""
    return moved(problem.system, problem.free, solution.orbit, solution.tangent, distance)


def spaced(before: Orbit, guess: Orbit) -> Orbit:
    """Return a guess with event nodes in order that a step along the tangent has brought past each other.

    As friction lets go, the way slipped grows as the cube of time, so two events that merge as it does are as
    far apart as the cube of their distance from it: a length l that changes by d along the tangent becomes
    l (1 + d / 3 l)^3. A guess in which events pass each other is left as it is.
    """
    if not before.mesh.events:
        return guess
    lengths, ahead = (orbit.mesh.segment_lengths(orbit.phases) for orbit in (before, guess))
    crossed = ahead <= 0
    if not crossed.any() or (ahead <= -2 * lengths).any():
        return guess
    kept = np.where(crossed, lengths * (1 + (ahead - lengths) / (3 * lengths)) ** 3, ahead)
    kept[~crossed] *= 1 - (kept.sum() - ahead.sum()) / ahead[~crossed].sum()
    return replace(guess, phases=guess.phases[0] + np.append(0.0, np.cumsum(kept[:-1])))


def at_fixed_phases(problem: Problem, solution: Solution, distance: float) -> Orbit:
    """Return the orbit moved along the tangent of its branch on a mesh that stays where it is."""
    rates, way = rates_at_fixed_phases(solution), solution.tangent
    still = replace(way, nodes=way.profile, stages=rates[:, 1:], phases=np.zeros_like(way.phases))
    return moved(problem.system, problem.free, solution.orbit, still, distance)


def rates_at_fixed_phases(solution: Solution) -> Array:
    """Return how the states change along the branch at the knots, these held in tau, shape (N, ncol+1, n)."""
    orbit, way = solution.orbit, solution.tangent
    left, width = (
        gradient @ way.phases for gradient in (orbit.grid.left_gradient, orbit.grid.width_gradient)
    )
    later = left[:, None] + width[:, None] * orbit.mesh.scheme.points
    stages = way.stages - orbit.knot_rates[:, 1:] * later[:, :, None]
    return np.concatenate([way.profile[:-1, None], stages], axis=1)


def cubic(
    solver: Solver, a: Solution, b: Solution, distance: float, place: float, along: Solution | None = None
) -> Orbit:
    """Return the cubic through two solutions on one mesh and their tangents, at `place` from the first.

    `place`, and `distance` of the second, are measured along the tangent of the first or of `along`, a
    solution on this mesh.
    """
    origin = along or a
    constraint = solver.constraint(origin.orbit, origin.tangent, 0.0)
    theta, problem = place / distance, solver.problem
    chord = difference(problem, a.orbit, b.orbit).scaled(theta**2 * (3 - 2 * theta))
    begin = a.tangent.scaled(distance * theta * (1 - theta) ** 2 / constraint.rate(a.tangent))
    end = b.tangent.scaled(distance * theta**2 * (theta - 1) / constraint.rate(b.tangent))
    return moved(problem.system, problem.free, a.orbit, chord + begin + end)


def difference(problem: Problem, a: Orbit, b: Orbit) -> Increment:
    """Return the way from a to b, on one mesh."""
    free = list(problem.free)
    return Increment.of(
        a,
        b.nodes - a.nodes,
        b.stages - a.stages,
        b.algebraic - a.algebraic,
        b.phases - a.phases,
        b.parameter[free] - a.parameter[free],
    )
