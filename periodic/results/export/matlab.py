"""Export to MATLAB (level 5, as GNU Octave reads it too): one struct `branch`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from periodic.results.export.content import Content, Quantities
from periodic.results.files import replacing

LONGEST_NAME = 63
"""Characters of a name in MATLAB."""


def write_mat(path: Path, content: Content) -> list[Path]:
    """Write branch.points.NAME (points, 1), branch.orbits.NAME (points, samples), their units and names.

    MATLAB's names have letters, digits and underscores only: "x p-p" is x_p_p, "x'" is x_dot; `names` has
    the names as they were.
    """
    from scipy.io import savemat

    points, orbits = identifiers(content.numbers), identifiers(content.signals)
    struct = {
        "parameter": content.parameter,
        "stop": content.stop,
        "program": content.program,
        "points": {
            "label": _cells(content.labels),
            "stable": content.stable[:, None],
            "multipliers": content.multipliers,
            **{points[name]: values[:, None] for name, (_, values) in content.numbers.items()},
        },
        "orbits": {"t": content.times} | {orbits[name]: v for name, (_, v) in content.signals.items()},
        "units": _units(points, content.numbers) | _units(orbits, content.signals) | {"t": "s"},
        "names": {new: old for names in (points, orbits) for old, new in names.items()},
    }
    with replacing(path) as part:
        savemat(str(part), {"branch": struct}, appendmat=False, long_field_names=True)
    return [path]


def identifiers(names: Iterable[str]) -> dict[str, str]:
    """Return a name of MATLAB's for each name, all different."""
    found: dict[str, str] = {}
    for name in names:
        plain = re.sub(r"\W", "_", name.replace("'", "_dot"), flags=re.ASCII)[: LONGEST_NAME - 3]
        base = plain if plain[:1].isalpha() else f"q_{plain}"
        number, new = 2, base
        while new in found.values() or new in ("t", "label", "stable", "multipliers"):
            number, new = number + 1, f"{base}_{number}"
        found[name] = new
    return found


def _units(names: dict[str, str], quantities: Quantities) -> dict[str, str]:
    return {names[name]: unit for name, (unit, _) in quantities.items()}


def _cells(texts: tuple[str, ...]) -> np.ndarray[Any, Any]:
    """Texts as MATLAB's cell array, shape (points, 1)."""
    cells = np.empty((len(texts), 1), dtype=object)
    cells[:, 0] = texts
    return cells
