"""What the docstring of a class says of it, in numpydoc's form: one source for Python and for text scenes."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass

HEADING = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)
ENTRY = re.compile(r"^(\S[^:\n]*?)(?: : (.*))?$")


@dataclass(frozen=True)
class Described:
    """The summary line (with the formula), what follows it, a text for each parameter, and the sources."""

    summary: str
    more: str
    parameters: dict[str, str]
    references: str


def described(owner: Callable[..., object]) -> Described:
    """Return what the docstring of a class or function says."""
    text = inspect.cleandoc(owner.__doc__ or "")
    sections = HEADING.split(text)
    summary, _, more = sections[0].strip().partition("\n\n")
    found = {
        name.strip(): body.strip("\n") for name, body in zip(sections[1::2], sections[2::2], strict=True)
    }
    return Described(
        " ".join(summary.split()),
        more.strip(),
        _entries(found.get("Parameters", "")),
        " ".join(found.get("References", "").split()),
    )


def _entries(section: str) -> dict[str, str]:
    """Texts by name; "m1, m2 : float" stands for both."""
    found: dict[str, str] = {}
    names: list[str] = []
    for line in section.splitlines():
        entry = ENTRY.match(line)
        if line and not line[0].isspace() and entry:
            names = [name.strip(" *") for name in entry[1].split(",")]
            found |= dict.fromkeys(names, "")
        else:
            found |= {name: f"{found[name]} {line.strip()}".strip() for name in names}
    return found
