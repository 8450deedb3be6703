"""The command `orbitrace scenes`."""

from __future__ import annotations

from .options import tell


def scenes() -> None:
    """List the built-in scenes."""
    from symbolic.scenes.names import scene_names
    from symbolic.scenes.reading import load

    names = scene_names()
    width = max(map(len, names))
    for name in names:
        tell(f"{name:{width}}  {load(name).title}")
