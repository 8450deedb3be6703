"""How much of a text a sentence quotes."""

from __future__ import annotations

import pytest

from symbolic.quoting import LONGEST_QUOTE, shortened


@pytest.mark.parametrize(
    ("text", "longest", "found"),
    [
        ("abcdef", 6, "abcdef"),
        ("abcdefg", 6, "abc..."),
        ("", 6, ""),
        ("x" * 60, LONGEST_QUOTE, "x" * 60),
        ("x" * 61, LONGEST_QUOTE, "x" * 57 + "..."),
    ],
)
def test_texts_that_are_cut(text: str, longest: int, found: str) -> None:
    """Assert that 60 letters are quoted, and of more the first 57."""
    assert shortened(text, longest) == found
    if longest == LONGEST_QUOTE:
        assert shortened(text) == found
