"""The commented start of a user's own scene: the text of a built-in one, with its parts' keys explained."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

from symbolic.scenes.errors import InputError, plain, refused
from symbolic.scenes.model.catalogue import KIND, Entry, catalogue
from symbolic.scenes.names import built_in, scene_names

from ..parts.text import said, toml

MODEL = "model"
"""The start of any model."""

PART = re.compile(r"^\s*\[\[part\]\]")
KIND_LINE = re.compile(rf'^\s*{KIND}\s*=\s*"(\w+)"')


def write_start(kind: str, file: Path) -> Path:
    """Write the start of a scene and return its file. Raises InputError."""
    text = "".join(_commented(kind, file))
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        raise InputError("FILE", f'is "{file}", which exists', "it must be a new file") from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError("FILE", f'is "{file}" ({why})', "it must be a file that can be written") from None
    return file


def _named(kind: str) -> str:
    """The built-in scene that a word stands for. Raises InputError."""
    names = scene_names()
    found = [name for name in names if kind == name] or [n for n in names if kind and kind in n.split("-")]
    if not found:
        raise refused("KIND", kind, f"{MODEL}, or a word of {', '.join(names)}")
    return found[0]


def _commented(kind: str, file: Path) -> Iterator[str]:
    text = START if kind == MODEL else built_in(_named(kind))
    name = plain(str(file))
    yield f"# orbitrace trace {name}    traces its orbits\n"
    yield f"# orbitrace linear {name}   shows its small motions about rest\n"
    if tomllib.loads(text).get(KIND) == MODEL:
        yield "# orbitrace parts [NAME]   lists the parts, or shows one with all its keys\n"
        yield "# Numbers are in SI, or all without dimension.\n"
    yield "\n"
    within = False
    for line in text.splitlines(keepends=True):
        within = bool(PART.match(line)) or (within and not line.lstrip().startswith("["))
        yield line
        named = KIND_LINE.match(line) if within else None
        if named and named[1] in catalogue():
            yield from _explained(catalogue()[named[1]])


def _explained(entry: Entry) -> Iterator[str]:
    """What a part is, and its keys."""
    yield f"# {entry.text.summary}\n"
    for key in entry.keys:
        yield f"#   {key.name}: {said(key)}\n"


START = f'''title = "Forced oscillator with a stop"
{KIND} = "{MODEL}"

# Numbers under [parameters] are shared by the parts that name them; all others get names by themselves.
[parameters]
Omega = {{value = 1.0, unit = "rad/s"}}

[[coordinate]]
name = "x"
unit = "m"
start = 0.0  # where the search for a rest begins

[[part]]
{KIND} = "Mass"
q = "x"
m = 1.0

[[part]]
{KIND} = "Damper"
q = "x"
c = 0.1

[[part]]
{KIND} = "Spring"
q = "x"
k = 1.0

[[part]]
{KIND} = "OneSidedSpring"
q = "x"
k = 2.0
gap = 0.8

[[part]]
{KIND} = "HarmonicForce"
q = "x"
force = 0.2
frequency = "Omega"

[trace]
parameter = "Omega"
from = 0.4
to = 1.8
# axis = {toml("Hz")}  # then from and to are in Hz (or rev/min)
'''
"""A start for any model."""
