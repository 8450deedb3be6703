"""What the files of a directory were made with: results of other settings never go beside them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any

from symbolic.guarded import content
from symbolic.scenes.errors import InputError, cut
from symbolic.scenes.schema import Scene

from .files import writable, write

RECORD = "settings.json"
"""File of the settings in a directory."""

LARGEST_RECORD = 2**24
"""Most bytes of it: a map may be over a million values."""

OUT = "orbitrace-out"
"""Where directories of scenes go unless told otherwise."""

Settings = dict[str, Any]
"""Scene and parameters, which all commands share, and under a command's name what it was asked for."""

SAME = "it must be empty or hold results of the same settings"


def settings(name: str, scene: Scene, command: str, **asked: Any) -> Settings:
    """Return what a command makes of a scene, as JSON reads it back."""
    made = {"scene": name, "parameters": parameters(scene), command: asked}
    return dict(json.loads(json.dumps(made)))


def parameters(scene: Scene) -> dict[str, Any]:
    """Return the entries of a scene, title and kind left out."""
    return scene.model_dump(exclude={"title", "kind"}, exclude_none=True, by_alias=True)


@contextmanager
def folder_for(out: Path | None, made: Settings, resume: bool = False) -> Iterator[Path]:
    """Give the directory for results, which can be written to and says what they are made with.

    Unless one is given it is the first of SCENE, SCENE-2, ... that holds nothing of other settings; to go
    on, the one of these settings. Raises InputError for a given one that does.
    """
    if out is None:
        folder = _resumed(made) if resume else next(p for p in _places(made) if not _other(p, made))
    elif not resume and (other := _other(out, made)):
        raise InputError("--out", f'is "{out}", made with {other}', SAME)
    else:
        folder = out
    writable(folder)
    if not resume or not _known(folder):
        _keep(folder, made)
    try:
        yield folder
    finally:
        _forget(folder)


def _forget(folder: Path) -> None:
    """Take the record out of a directory that holds nothing else."""
    if folder.is_dir() and [path.name for path in folder.iterdir()] == [RECORD]:
        (folder / RECORD).unlink()


def _places(made: Settings) -> Iterator[Path]:
    first = Path(OUT, made["scene"])
    yield first
    yield from (first.with_name(f"{first.name}-{number}") for number in count(2))


def _resumed(made: Settings) -> Path:
    """The directory of these settings; the first where there is none."""
    for place in _places(made):
        if not place.exists():
            return Path(OUT, made["scene"])
        if _known(place) and not _other(place, made):
            return place
    raise AssertionError("directories have no end")


def _known(folder: Path) -> Settings:
    """The settings that a directory tells; none where it tells nothing that can be read."""
    try:
        found = json.loads(content(folder / RECORD, LARGEST_RECORD).decode("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _other(folder: Path, made: Settings) -> str:
    """What a directory was made with that is not as now, in words; empty if nothing."""
    known = _known(folder)
    before = dict(_flat({key: known[key] for key in made if key in known}))
    now = dict(_flat({key: value for key, value in made.items() if key in known}))
    keys = [key for key in (*before, *now) if before.get(key) != now.get(key)]
    changed = [(key.removeprefix("parameters."), before.get(key, "none")) for key in dict.fromkeys(keys[:3])]
    return ", ".join(f"{key} = {cut(str(value))}" for key, value in changed)


def _flat(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _keep(folder: Path, made: Settings) -> None:
    """Write down the settings, beside those of other commands."""
    known = _known(folder)
    if (kept := {**known, **made}) != known:
        text = json.dumps(kept, indent=2) + "\n"
        write(folder, {RECORD: lambda path: path.write_text(text, "utf-8")})
