"""Joints at which a motion may be held, as time steps need them, and which friction stops which sliders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from periodic.events.twinguards import holding
from periodic.system import Kind, System, surfaces_of

MOST_FRICTION = 10
"""Joints with friction up to which it is tabulated which sets of them stop sliders."""


@dataclass(frozen=True)
class Joint:
    """A surface at which motions may be held: its index among all, and what `SurfaceLike` has."""

    index: int
    slides: bool
    switch: int
    up: int
    down: int
    column: int
    place: tuple[int, tuple[float, ...]] | None


def joints_of(system: System) -> list[Joint]:
    """Return the surfaces of a system at which motions may be held."""
    return [
        Joint(i, s.kind == Kind.SLIDING, s.switch, *s.releases, s.column, s.place)
        for i, s in enumerate(surfaces_of(system))
        if s.releases is not None and s.column is not None
    ]


def stops(system: System, joint: Joint, held: Sequence[int]) -> bool:
    """Return whether friction that is held, by its guards, keeps a slider's strain: it may be its limit."""
    return not joint.slides and bool(holding(system, joint.switch, sorted(held)))


def stopping_sets(system: System, joints: Sequence[Joint]) -> NDArray[np.int_] | None:
    """Return `stops` of all joints by all sets of friction, shape (joints, 2^f); None for too many of these.

    The k-th sliding joint is in a set whose index has bit k.
    """
    friction = [joint.switch for joint in joints if joint.slides]
    if len(friction) > MOST_FRICTION:
        return None
    sets = [[g for k, g in enumerate(friction) if chosen >> k & 1] for chosen in range(2 ** len(friction))]
    each = [[stops(system, joint, held) for held in sets] for joint in joints]
    return np.array(each, dtype=np.intp).reshape(len(joints), len(sets))
