"""One look for all figures of the report."""

from __future__ import annotations

from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

STYLE: Any = {"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.fontsize": 8}

TRUSTED, PAPER, SECOND = "tab:blue", "tab:red", "tab:green"
"""Colours: our curves, what the paper reports or its method gives, a second curve of ours."""


def panels(
    rows: int, columns: int, width: float = 7.0, height: float = 3.0, **options: Any
) -> tuple[Figure, Any]:
    """Return a figure of `rows` x `columns` axes, each row `height` inches high; saved at 150 dpi."""
    with rc_context(STYLE):
        figure = Figure(figsize=(width, height * rows), dpi=150, layout="constrained")
        return figure, figure.subplots(rows, columns, **options)
