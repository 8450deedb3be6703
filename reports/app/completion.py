"""What a shell completes on the command line. What is imported here is small: a key press waits for it."""

from __future__ import annotations

from pathlib import Path

import typer

BARE = "_-.,:/@%+~"
"""Signs that stand for themselves in a shell, besides letters and digits."""


def scene_files(incomplete: str) -> list[str]:
    """Return the built-in scenes, and the TOML files and folders, that begin so."""
    from symbolic.scenes.names import scene_names

    return _begin(scene_names(), incomplete) + _files(incomplete, ".toml")


def branch_files(incomplete: str) -> list[str]:
    """Return the files of branches, and the folders, that begin so."""
    return _files(incomplete, ".nc")


def keys(context: typer.Context, incomplete: str) -> list[str]:
    """Return the keys of the scene named before that begin so, with the sign that a value follows."""
    from symbolic.scenes.errors import InputError
    from symbolic.scenes.reading import keys_of_scene

    # An option without its value stops the parser: what it has not taken yet are arguments.
    scene = context.params.get("scene") or next(iter(context.args), "")
    try:
        known = keys_of_scene(scene)
    except InputError:  # a line that is not complete yet
        return []
    return [f"{key}=" for key in _begin(known, incomplete)]


def axis_names(incomplete: str) -> list[str]:
    """Return the units of a frequency that begin so."""
    from symbolic.scenes.axes import AXES

    return _begin(list(AXES), incomplete)


def part_names(incomplete: str) -> list[str]:
    """Return the parts of scenes that begin so."""
    from symbolic.scenes.model.catalogue import catalogue

    return _begin(list(catalogue()), incomplete)


def starts(incomplete: str) -> list[str]:
    """Return what a scene of one's own may start from: "model", or a built-in scene."""
    from symbolic.scenes.names import scene_names

    return _begin(["model", *scene_names()], incomplete)


def _begin(names: list[str], incomplete: str) -> list[str]:
    """The names that begin so, without those that a shell would not take as they are: bash runs `$(name)`."""
    return [name for name in names if name.startswith(incomplete) and _bare(name)]


def _bare(name: str) -> bool:
    return all(letter.isalnum() or letter in BARE for letter in name)


def _files(incomplete: str, ending: str) -> list[str]:
    """Files of an ending and folders whose path begins so."""
    folder = Path(incomplete).parent if not incomplete.endswith("/") else Path(incomplete)
    if not folder.is_dir():
        return []
    prefix = incomplete[: incomplete.rfind("/") + 1]
    found = [f"{prefix}{p.name}/" if p.is_dir() else f"{prefix}{p.name}" for p in sorted(folder.iterdir())]
    chosen = [text for text in found if text.endswith((ending, "/")) and not Path(text).name.startswith(".")]
    return _begin(chosen, incomplete)
