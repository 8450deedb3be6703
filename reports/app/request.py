"""What is asked for, as text, and the scene and points that it stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from reports.app.view import view_of
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.files import Override, ends, load
from symbolic.scenes.schema import Scene


@dataclass(frozen=True, kw_only=True)
class Request:
    """What is asked for, as text: the range replaces the scene's own, `at` is a list with commas."""

    source: str
    begin: str | None = None
    end: str | None = None
    at: str | None = None
    overrides: tuple[Override, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Task:
    """A validated request; `at` in the units of the scene's view."""

    scene: Scene
    at: tuple[float, ...]


def validated(request: Request) -> Task:
    """Return the scene and points that a request asks for. Raises InputError, naming the option at fault."""
    scene = load(request.source, request.overrides)
    options = dict(zip(ends(scene), ("--from", "--to"), strict=True))
    given = {
        key: text for key, text in zip(options, (request.begin, request.end), strict=True) if text is not None
    }
    if given:
        try:
            scene = load(request.source, (*request.overrides, *given.items()))
        except InputError as error:
            raise error.renamed({key: options[key] for key in given}) from None
    return Task(scene=_titled(scene, request.overrides), at=_points(scene, request.at))


def _titled(scene: Scene, overrides: tuple[Override, ...]) -> Scene:
    """Return the scene with what was changed in its title."""
    changes = [f"{key} = {value or 'none'}" for key, value in overrides if key != "title"]
    return scene.model_copy(update={"title": ", ".join([scene.title, *changes])})


def _points(scene: Scene, text: str | None) -> tuple[float, ...]:
    """Return the numbers of a comma-separated list that all lie in the scene's range."""
    low, high = sorted(scene.trace.ends)
    values = [_number(item) for item in text.split(",")] if text is not None else []
    if not all(low <= value <= high for value in values):
        unit = view_of(scene).unit_name
        raise refused("--at", text, f"numbers from {low:g} to {high:g} ({unit}) with commas between them")
    return tuple(sorted(set(values)))


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
