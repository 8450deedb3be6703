"""What users write of symbols and Python cannot do with them: one sentence that quotes their line.

NumPy's functions are let through as far as CasADi takes them.
"""

from __future__ import annotations

import linecache
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from traceback import FrameSummary, extract_tb

import casadi as ca
import numpy as np

UNDECIDED = "Cannot compute the truth value"
NOTICE = r"\s*casadi: a numpy function was called"
"""How CasADi begins what it says of a decision in Python, and of a function of NumPy's."""

SYMBOLIC = re.compile(r"casadi|\b[SM]X\b", re.IGNORECASE)
"""In errors that are about symbols."""

LIBRARIES = tuple(str(Path(str(package.__file__)).parent) for package in (ca, np))

BETTER = {
    r"\b(max|amax|maximum)\(": "fmax",
    r"\b(min|amin|minimum)\(": "fmin",
}
"""Functions of symbolic.functions that do what a Python expression was to do; any other decision: if_else."""


@contextmanager
def explained(what: str) -> Iterator[None]:
    """Raise ValueError for what symbols cannot do in a block of a user's code; `what` is its name."""
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", NOTICE, FutureWarning)
            yield
    except (RuntimeError, NotImplementedError, TypeError) as error:
        if not SYMBOLIC.search(str(error)):
            raise
        code = _written(error)
        raise ValueError(_undecided(what, code) if UNDECIDED in str(error) else _unable(what, code)) from None


def _undecided(what: str, code: str) -> str:
    if not code:
        return (
            f"{what} decides by a symbol, as if, and, or, max and min do; "
            f"it must use if_else, fmax or fmin of symbolic.functions"
        )
    better = next((name for pattern, name in BETTER.items() if re.search(pattern, code)), "if_else")
    return f"{what} decides by a symbol in `{code}`; it must use symbolic.functions.{better}"


def _unable(what: str, code: str) -> str:
    where = f"`{code}`" if code else "something"
    return (
        f"{what} makes {where} of a symbol, which has no such operation; "
        f"it must use arithmetic and the functions of symbolic.functions"
    )


def _written(error: BaseException) -> str:
    """The expression of the user's that an error comes from, as it is written; empty if nothing tells."""
    frames = [f for f in extract_tb(error.__traceback__)[1:] if not f.filename.startswith(LIBRARIES)]
    return _segment(frames[-1]) if frames else ""


def _segment(frame: FrameSummary) -> str:
    """What stands at a frame's place, to the end of its line at most."""
    line = linecache.getline(frame.filename, frame.lineno or 0).encode()
    end = frame.end_colno if frame.end_lineno == frame.lineno else None
    return " ".join(line[frame.colno or 0 : end].decode(errors="replace").split())
