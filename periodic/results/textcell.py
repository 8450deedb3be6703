"""Text in a cell of a CSV file, which a spreadsheet that opens the file shall not compute."""

from __future__ import annotations

import re

FORMULA = re.compile(r"(^|[;\t\r\n])(?=[=+\-@\t\r\n＝＋－＠])")
"""Where a formula would begin: at the beginning, and behind what some spreadsheets take for a separator."""


def text_cell(text: str) -> str:
    """Return a text with an apostrophe wherever a spreadsheet would begin to read a formula.

    That is before =, +, -, @ (also in full width), a tab or the end of a line, where they begin the text, or
    stand in it behind a semicolon, a tab or the end of a line. Numbers are no texts: -0.5 is left as it is.

    Parameters
    ----------
    text : str
        A name, with its unit or without, or a label.

    Returns
    -------
    str
        What the cell holds; of most texts the text itself.
    """
    return FORMULA.sub(r"\1'", text)
