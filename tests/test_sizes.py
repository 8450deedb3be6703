"""What a reader can hold: few parameters in a function."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FILES = [path for top in ("symbolic", "periodic", "reports", "tests") for path in (ROOT / top).rglob("*.py")]
MOST_PARAMETERS = 12

TOO_MANY_PARAMETERS = {"reports/app/trace/command.py trace"}
"""What is still to be divided: the list may only shrink."""


def functions() -> Iterator[tuple[str, int]]:
    """Every function, as file and name, with the number of its parameters; self and cls do not count."""
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                names = [a.arg for a in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
                yield f"{path.relative_to(ROOT).as_posix()} {node.name}", len({*names} - {"self", "cls"})


def test_functions_have_few_parameters() -> None:
    """Assert that no function takes more than a dozen arguments."""
    assert {where for where, count in functions() if count > MOST_PARAMETERS} <= TOO_MANY_PARAMETERS
