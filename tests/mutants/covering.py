"""Which tests execute a line, and how long each takes: measured once for a commit, with coverage.py."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from os.path import commonpath
from pathlib import Path
from xml.etree import ElementTree

from coverage import CoverageData

ROOMS = ("symbolic", "periodic", "problems", "howto", "reports", ".")
LONGEST = 20
"""Seconds after which a test is stopped as it is measured; what it has executed until then counts."""


def measure(clone: Path, folder: Path) -> None:
    """Run the tests of a clone, room by room, and write what each executes; rooms that are there stay."""
    folder.mkdir(parents=True, exist_ok=True)
    for room in [room for top in ROOMS for room in _rooms(clone / "tests" / top)]:
        name = "-".join(room.relative_to(clone).parts)
        if (folder / f"{name}.xml").exists():
            continue
        options = ["-q", "-n0", "-p", "no:cacheprovider", f"--timeout={LONGEST}", "--cov-context=test"]
        options += ["--cov=symbolic", "--cov=periodic", "--cov-report=", f"--junitxml={folder}/{name}.xml"]
        environment = os.environ | {"PYTHONPATH": str(clone), "COVERAGE_FILE": f"{folder}/{name}.cov"}
        command = [sys.executable, "-m", "pytest", *options, str(room)]
        print(f"measuring {name}", flush=True)
        subprocess.run(command, cwd=clone, env=environment, capture_output=True)


def _rooms(folder: Path) -> list[Path]:
    """The test files of a folder, and its folders where it is not the outermost."""
    inner = [] if folder.name == "tests" else [path for path in folder.iterdir() if path.is_dir()]
    return sorted([*inner, *folder.glob("test_*.py")])


class Covering:
    """The tests that execute each line, as the files of a folder have them."""

    def __init__(self, folder: Path) -> None:
        self._seconds = dict(entry for file in sorted(folder.glob("*.xml")) for entry in _durations(file))
        self._data = [CoverageData(str(file)) for file in sorted(folder.glob("*.cov"))]
        for data in self._data:
            data.read()

    def seconds(self, test: str) -> float:
        """Return how long a test takes."""
        file, _, name = test.partition("::")
        return self._seconds.get((file.removesuffix(".py").replace("/", "."), name), 1.0)

    def tests(self, module: Path, line: int) -> list[str]:
        """Return the tests that execute a line, nearest folder first, there the quickest first.

        Of a line that is executed at import, those that execute its function, or anything in the module; of a
        module without functions those of its room.
        """
        found = self._executing(module)
        together = _together(ast.parse(module.read_text("utf-8")), line)
        executing = (set().union(*(found.get(k, ()) for k in lines)) for lines in together)
        chosen = next(filter(None, executing), None) or self._beside(module)
        return sorted(chosen, key=lambda test: self._rank(module, test))

    def _beside(self, module: Path) -> set[str]:
        room = Path("tests") / module.parent
        every = (f"{owner.replace('.', '/')}.py::{name}" for owner, name in self._seconds)
        return {test for test in every if Path(test.partition("::")[0]).parent == room}

    def _executing(self, module: Path) -> dict[int, set[str]]:
        found: dict[int, set[str]] = {}
        for data in self._data:
            for file in (name for name in data.measured_files() if name.endswith(f"/{module}")):
                for line, contexts in data.contexts_by_lineno(file).items():
                    found.setdefault(line, set()).update(name.rpartition("|")[0] for name in contexts if name)
        return found

    def _rank(self, module: Path, test: str) -> tuple[bool, int, float, str]:
        file, room = Path(test.partition("::")[0]), Path("tests") / module.parent
        shared = len(Path(commonpath([room, file.parent])).parts)
        return file.stem != f"test_{module.stem}", -shared, self.seconds(test), test


def _durations(file: Path) -> Iterator[tuple[tuple[str, str], float]]:
    for case in ElementTree.parse(file).iter("testcase"):
        yield (case.get("classname", ""), case.get("name", "")), float(case.get("time", 1.0))


def _together(tree: ast.Module, line: int) -> list[set[int]]:
    """Lines that are executed with a line: its statement; of what is done at import its function, or any."""
    statements = (node for node in ast.walk(tree) if isinstance(node, ast.stmt))
    inside = sorted((node for node in statements if _first(node) <= line <= _last(node)), key=_first)
    if any(isinstance(node, ast.FunctionDef) and line in _body(node) for node in inside):
        return [{*range(_first(inside[-1]), _last(inside[-1]) + 1)} - _body(inside[-1]) | {line}]
    own = [_body(node) for node in inside if isinstance(node, ast.FunctionDef)]
    return [*own, set().union(*(_body(node) for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)))]


def _body(node: ast.stmt) -> set[int]:
    return {k for inner in getattr(node, "body", []) for k in range(_first(inner), _last(inner) + 1)}


def _first(node: ast.stmt) -> int:
    decorators = getattr(node, "decorator_list", [])
    return decorators[0].lineno if decorators else node.lineno


def _last(node: ast.stmt) -> int:
    return node.end_lineno or node.lineno
