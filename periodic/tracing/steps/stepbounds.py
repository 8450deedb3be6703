"""Bounds of a step: how far the branch may turn and bend in it, and how far multipliers may move."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from periodic.bifurcations.codimension2 import codim2
from periodic.correction.solution import Solution
from periodic.linear.unknowns import Increment, size_of
from periodic.orbit.orbit import LEAST_SPAN
from periodic.stability.multipliers import Stability
from periodic.stability.winding import Motion, rotated
from periodic.system import jumps_of, resets_of
from periodic.tracing.steps.stepsize import ArclengthControl
from periodic.tracing.steps.wayacross import way_and_tangent


@dataclass(frozen=True)
class BoundRatio:
    """How far a step turns, bends or moves the multipliers, over its bound; about linear in its length.

    size: the ratio of this step. ahead: the one expected of the next step, if it is as long. why: the reason
    for which a step is rejected whose ratio exceeds 1.
    """

    size: float
    ahead: float
    why: str


def bound_ratios(
    base: Solution, new: Solution, ds: float, control: ArclengthControl, tolerance: float
) -> Iterator[BoundRatio]:
    """Yield the ratio of a step to each bound, the cheapest first.

    Its ends are on one mesh, or as `wayacross.way_and_tangent` takes them.
    """
    metric = base.orbit, base.problem.units(base.orbit), size_of(base.orbit)
    way, onward = way_and_tangent(base, new)
    onward = onward.scaled(1 / np.sqrt(onward.dot(onward, *metric)))
    angle = _angle(base.tangent.dot(onward, *metric), control.turn)
    yield BoundRatio(angle, angle, "the branch turns too sharply for the step")
    noise = control.noise * tolerance * base.orbit.span() / size_of(base.orbit)
    bend = float(np.sqrt(max(_bend(base, new, way, onward, ds) - noise, 0.0) / (control.bend * ds)))
    yield BoundRatio(bend, bend, "the step does not follow its tangents")
    if new.discretisation.stability is Stability.MULTIPLIERS:
        rotation = rotated(_motion(base, ds), _motion(new, ds), control.winding)
        yield BoundRatio(rotation.ratio, rotation.ahead, "a resonance may pass unseen in the step")
    angle = _angle(codim2.alignment(base, new), control.turn)
    yield BoundRatio(angle, angle, "the critical motion turns too far for the step")


def _motion(solution: Solution, ds: float) -> Motion:
    change = solution.spectrum.start(solution.tangent)
    return Motion(solution.spectrum, ds * change / max(solution.orbit.span(), LEAST_SPAN))


def _angle(cosine: float, least: float) -> float:
    return math.acos(min(max(cosine, -1.0), 1.0)) / math.acos(least)


def _bend(base: Solution, new: Solution, way: Increment, onward: Increment, ds: float) -> float:
    """Distance of the step's end from its begin + ds times the mean of the tangents at both."""
    problem = base.problem
    mean = (base.tangent + onward).scaled(-ds / 2)
    bend = Increment.of(
        base.orbit,
        way.nodes + mean.nodes,
        way.stages,
        way.algebraic,
        way.phases + mean.phases,
        way.parameters + mean.parameters,
    )
    metric = base.orbit, problem.units(base.orbit), size_of(base.orbit)
    moving = bend.dot(bend, *metric)
    jumping = resets_of(problem.system) or jumps_of(problem.system)  # then states jump at fixed tau
    if not len(base.orbit.mesh.exact_ends) or jumping:
        return float(np.sqrt(moving))
    # The end of an excursion moves as the root of the parameter, the states at fixed tau smoothly; beside a
    # hard stop they move with it. The smaller of the two distances is the one without the root.
    at = base.orbit.mesh.nodes(base.orbit.phases)
    bend = replace(bend, profile=new.orbit.state(at) - base.orbit.nodes + mean.profile)
    return float(np.sqrt(min(moving, bend.dot(bend, *metric))))
