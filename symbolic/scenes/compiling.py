"""Loading of scenes: by name or file, with some entries changed, compiled."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from symbolic.interrupts import interruptible
from symbolic.scenes.errors import InputError, refused
from symbolic.scenes.names import scene_names
from symbolic.system.compiled import CompiledSystem


@interruptible()
def scene(source: str | Path, changes: Mapping[str, str | float | None] | None = None) -> CompiledSystem:
    """Return the compiled system of a scene; loading it executes nothing from its file.

    Parameters
    ----------
    source : str or Path
        The name of a built-in scene (see `scene_names`) or the path of a TOML file.
    changes : mapping of str to str or float, optional
        New values by key, dotted or its last component alone, as ``{"preload": 1200, "film.beta": 20}``; a
        number may be a text, as of a command line, and None takes an entry or a table out.

    Returns
    -------
    CompiledSystem
        Its parameters have the scene's values as nominal ones. The discs' parameter `speed` is in rad/s.

    Raises
    ------
    InputError
        In one sentence, for anything that a scene may not have.
    """
    # Not above: the schema's library takes longer to import than all the rest.
    from symbolic.scenes.building import build
    from symbolic.scenes.reading import load

    if not isinstance(source, str | Path):
        raise refused("scene", source, f"one of {', '.join(scene_names())} or the path of a TOML file")
    given = {} if changes is None else changes
    if not isinstance(given, Mapping):
        raise refused("changes", given, 'a mapping of keys to values, as {"preload": 1200}')
    try:
        return build(load(str(source), tuple(given.items())))
    except InputError as error:
        raise error.renamed({"--set key": "key"}) from None
