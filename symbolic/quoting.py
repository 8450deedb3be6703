"""How much of a value a sentence quotes. Nothing large is imported: completing a command line asks for it."""

from __future__ import annotations

LONGEST_QUOTE = 60
"""Names and values longer than this are cut in a sentence."""


def shortened(text: str, longest: int = LONGEST_QUOTE) -> str:
    """Return a text, or as much of its beginning as is not too long."""
    return text if len(text) <= longest else text[: longest - 3] + "..."
