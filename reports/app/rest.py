"""What is said of a model composed in text that rests nowhere: bad input, not a numerical failure."""

from __future__ import annotations

from symbolic.motion.linear import NoRestError, modes
from symbolic.scenes.building import build
from symbolic.scenes.errors import InputError
from symbolic.scenes.model.scene import ModelScene

from .request import Task
from .view import view_of


def check_rest(task: Task) -> None:
    """Raise InputError for a model without equilibrium at the beginning of its range."""
    if not isinstance(task.scene, ModelScene):
        return
    parameter, begin = view_of(task.scene).parameter, task.scene.trace.bounds[0]
    try:
        modes(build(task.scene, condense=False), {parameter: begin})
    except NoRestError:
        raise InputError(
            "scene",
            f"has no equilibrium that was found at {parameter} = {begin:g}",
            "something must carry each constant load, and start of a [[coordinate]] lie beyond a clearance",
        ) from None
