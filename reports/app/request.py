"""What is asked for, as text, and the scene and points that it stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symbolic.scenes.axes import AXES
from symbolic.scenes.errors import InputError, listed, refused
from symbolic.scenes.model.scene import ModelScene
from symbolic.scenes.reading import Override, ends, load
from symbolic.scenes.schema import Scene

from .view import view_of


@dataclass(frozen=True, kw_only=True)
class Request:
    """What is asked for, as text: the range replaces the scene's own, `at` is a list with commas.

    All three are in the unit `axis`, by default the scene's.
    """

    source: str
    begin: str | None = None
    end: str | None = None
    at: str | None = None
    overrides: tuple[Override, ...] = ()
    axis: str | None = None


@dataclass(frozen=True, kw_only=True)
class Task:
    """A validated request; `at` in the units of the scene's view."""

    scene: Scene
    at: tuple[float, ...]


def validated(request: Request) -> Task:
    """Return the scene and points that a request asks for. Raises InputError, naming the option at fault."""
    if request.axis is not None and request.axis not in AXES:
        raise refused("--axis", request.axis, listed(list(AXES)))
    scene = load(request.source, request.overrides)
    options = dict(zip(ends(scene), ("--from", "--to"), strict=True))
    given = {
        key: _converted(scene, request.axis, text)
        for key, text in zip(options, (request.begin, request.end), strict=True)
        if text is not None
    }
    if given:
        try:
            scene = load(request.source, (*request.overrides, *given.items()))
        except InputError as error:
            raise error.renamed({key: options[key] for key in given}) from None
    if request.axis is not None:
        scene = _on_axis(scene, request.axis)
    return Task(scene=_titled(scene, request.overrides), at=values(scene, request.at, "--at"))


def _on_axis(scene: Scene, axis: str) -> Scene:
    """Return the scene with its range shown in another unit. Raises InputError where that cannot be."""
    if isinstance(scene, ModelScene) and scene.continued.unit not in ("rad/s", ""):
        what = f'is "{axis}" for {scene.continued.name} in {scene.continued.unit}'
        raise InputError("--axis", what, "only an angular frequency (rad/s) may have one")
    return scene.model_copy(update={"trace": scene.trace.shown_in(axis)})


def _converted(scene: Scene, axis: str | None, text: str) -> str:
    """An end of the range in the scene's own unit."""
    number, own = _number(text), scene.trace.own
    if axis in (None, own) or not math.isfinite(number):
        return text
    return f"{number * AXES[str(axis)] / (AXES[own] if own else 1.0):.15g}"


def _titled(scene: Scene, overrides: tuple[Override, ...]) -> Scene:
    """Return the scene with what was changed in its title."""
    changes = [f"{key} = {value or 'none'}" for key, value in overrides if key != "title"]
    return scene.model_copy(update={"title": ", ".join([scene.title, *changes])})


def values(scene: Scene, text: str | None, option: str) -> tuple[float, ...]:
    """Return the numbers of a comma-separated list that all lie in the scene's range. Raises InputError."""
    low, high = sorted(scene.trace.ends)
    found = [_number(item) for item in text.split(",")] if text is not None else []
    if not all(low <= value <= high for value in found):
        unit = view_of(scene).unit_name
        raise refused(option, text, f"numbers from {low:g} to {high:g} ({unit}) with commas between them")
    return tuple(sorted(set(found)))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
