"""Tables and lists as notebooks and terminals show them."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence

MOST_LISTED = 12
"""Largest number of names that a list gives, and of rows of a table that is shown unfolded."""

AS_IT_IS = "class='tex2jax_ignore mathjax_ignore'"
"""Keeps MathJax, which notebooks run, from reading dollar signs in names as formulas."""


def listed(names: Iterable[str]) -> str:
    """Return names in one line; of more than MOST_LISTED the first ones and how many there are."""
    known = list(names)
    shown = ", ".join(known[:MOST_LISTED]) or "none"
    return shown if len(known) <= MOST_LISTED else f"{shown}, ... ({len(known)})"


def table(headings: Sequence[str], rows: Sequence[Sequence[str]], title: str = "") -> str:
    """Return an HTML table under a title, folded if it is long; an empty text without rows."""
    if not rows:
        return ""
    head = "".join(f"<th style='text-align:left'>{html.escape(cell)}</th>" for cell in headings)
    body = "".join(
        "<tr>" + "".join(f"<td style='text-align:left'>{html.escape(c)}</td>" for c in row) + "</tr>"
        for row in rows
    )
    inner = f"<table {AS_IT_IS}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    opened = " open" if len(rows) <= MOST_LISTED else ""
    return f"<details{opened}><summary>{html.escape(title)} ({len(rows)})</summary>{inner}</details>"
