"""Tables as HTML."""

from __future__ import annotations

import html
from collections.abc import Sequence

AS_IT_IS = "class='tex2jax_ignore mathjax_ignore'"
"""Where MathJax, which notebooks run, shall look for no formula: names may have dollars in them."""


def table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table, texts as they are; nothing where it has no rows."""
    if not rows:
        return ""
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in headings)
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table {AS_IT_IS}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def beside(*blocks: str) -> str:
    """Return blocks side by side, where there is room for that."""
    cells = "".join(f"<div>{block}</div>" for block in blocks if block)
    return f"<div style='display:flex;flex-wrap:wrap;gap:1.5em;align-items:flex-start'>{cells}</div>"


def paragraph(text: str) -> str:
    """Return a line of text."""
    return f"<p {AS_IT_IS}>{html.escape(text)}</p>"


def with_unit(name: str, unit: str) -> str:
    """Return the heading of a quantity."""
    return f"{name} ({unit})" if unit else name
