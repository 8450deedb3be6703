"""The built-in scenes by name. Nothing large is imported: completing a command line asks for them."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path


def scene_names() -> list[str]:
    """Return the names of the built-in scenes, smaller numbers first.

    Returns
    -------
    list of str
        Names that `symbolic.scene` takes.
    """
    folder = resources.files("symbolic.scenes").joinpath("data")
    names = [file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml")]
    return sorted(names, key=lambda name: re.sub(r"\d+", lambda digits: digits[0].zfill(8), name))


def built_in(name: str) -> str:
    """Return the text of a built-in scene."""
    return resources.files("symbolic.scenes").joinpath("data", f"{name}.toml").read_text("utf-8")


def short_name(source: str) -> str:
    """Return what to call a scene: its name, or that of its file without folder and ending."""
    return source if source in scene_names() else Path(source).stem
