"""What a notebook shows of a compiled system: its equations, and tables of all that has a name."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence

from symbolic.equations.variables import SwitchInfo, Variable
from symbolic.tables import table


def overview(latex: str, groups: Mapping[str, Sequence[Variable]], switches: Sequence[SwitchInfo]) -> str:
    """Return equations, given as LaTeX or empty, and tables of variables and switches, as HTML."""
    shown = [f"$$\n{html.escape(latex, quote=False)}\n$$"] if latex else []
    for title, variables in groups.items():
        shown.append(table(*_columns(variables), title))
    shown.append(table(["name", "passed"], [[s.name, WAYS[s.direction]] for s in switches], "switches"))
    return "\n".join(filter(None, shown))


WAYS = {-1: "falling", 0: "both ways", 1: "rising"}


def _columns(variables: Sequence[Variable]) -> tuple[list[str], list[list[str]]]:
    """Headings and rows; only parameters have values."""
    if any(math.isfinite(v.value) for v in variables):
        return ["name", "value", "unit"], [[v.name, f"{v.value:.8g}", v.unit] for v in variables]
    return ["name", "unit"], [[v.name, v.unit] for v in variables]
