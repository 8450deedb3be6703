"""The command `orbitrace scenes`."""

from __future__ import annotations

import typer


def scenes() -> None:
    """List the built-in scenes."""
    from symbolic.scenes.names import scene_names
    from symbolic.scenes.reading import load

    names = scene_names()
    width = max(map(len, names))
    for name in names:
        typer.echo(f"{name:{width}}  {load(name).title}")
