"""What a certificate begins with: the text of a system's equations, and what is unknown in them."""

from __future__ import annotations

import re
from typing import Any, cast

from periodic.orbit.orbit import Orbit
from periodic.system import System, Writing, WrittenLike, frequency_of

COMPARISONS = ("max", "min", "abs", "sign", "less")
"""Functions of the text that pass from one branch to another."""


def needed(text: WrittenLike) -> tuple[list[str], list[str]]:
    """Return the lines that a text's rates need, and the outputs that need no comparison besides these."""
    words = {line.split(" = ")[0]: re.findall(r"\w+", line.split(" = ")[1]) for line in text.lines}

    def behind(names: list[str]) -> set[str]:
        found, left = set(), [name for name in names if name in words]
        while left:
            name = left.pop()
            if name not in found:
                found.add(name)
                left += [word for word in words[name] if word in words]
        return found

    struck = [name for guard, names in text.resets.items() for name in (guard, *names)]
    core = behind([*text.rates, *filter(None, [text.constraint]), *struck])
    compared = {name for name, (first, *_) in words.items() if first in COMPARISONS}
    outputs = [name for name in text.outputs if name[0] in "xv" and not (behind([name]) - core) & compared]
    kept = core | behind(outputs)
    return [line for line in text.lines if line.split(" = ")[0] in kept], outputs


def equations(
    system: System, orbit: Orbit, claim: str, parameter: str | None
) -> tuple[dict[str, Any], dict[str, float]]:
    """What a certificate begins with, and the values of all names. Raises ValueError without a text."""
    if not hasattr(system, "written"):
        raise ValueError("the system does not write its equations as text")
    text = cast(Writing, system).written
    lines, outputs = needed(text)
    named = {system.parameters[i].name: p for p, i in text.values.items()}
    values = {p: float(orbit.parameter[i]) for p, i in text.values.items()}
    unknown = []
    if not any(re.search(r"\bt\b", line) for line in lines):
        frequency = frequency_of(system)
        if len(frequency) != 1 or claim in ("fold", "doubling"):
            raise ValueError("folds and doublings of free oscillations are not proven, their orbits are")
        unknown = [named[frequency[0]]]
    if parameter is not None:
        if parameter not in named:
            raise ValueError(f"the equations do not depend on {parameter!r}")
        unknown.append(named[parameter])
    if claim in ("fold", "doubling") and (
        text.resets or any(word in line for line in lines for word in ("less(", "sign("))
    ):
        raise ValueError("folds and doublings of systems whose equations jump are not proven")
    names = {
        "states": [each.name for each in (*system.states, *system.algebraics)],
        "scales": [each.scale for each in (*system.states, *system.algebraics)],
        "values": {p: name for name, p in named.items()},
        "outputs": {
            v.name: line for v, line in zip(system.outputs, text.outputs, strict=True) if line in outputs
        },
        "impacts": dict(text.impacts),
    }
    given: dict[str, Any] = {
        "names": names,
        "equations": {
            "lines": lines,
            "rates": list(text.rates),
            "values": {p: repr(value) for p, value in values.items() if p not in unknown},
        },
        "turns": str(orbit.periods),
        "unknown": unknown,
    }
    if text.constraint is not None:
        given["equations"]["constraint"] = text.constraint
    if text.resets:
        given["equations"]["resets"] = {guard: list(names) for guard, names in text.resets.items()}
    return given, values
