"""The functions of a module: where each stands, what its text is, and where a name is used."""

from __future__ import annotations

import ast
import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path


@dataclass(frozen=True)
class Function:
    """A function's first and last line, decorators included, and the digest of its text."""

    name: str
    first: int
    last: int
    digest: str


class Functions:
    """The functions of a module by their qualified names."""

    def __init__(self, path: Path) -> None:
        self.path, self.text = path, path.read_text("utf-8")
        self.tree = ast.parse(self.text)
        self.all = list(self._of(self.tree, ""))

    def _of(self, node: ast.AST, prefix: str) -> list[Function]:
        found, lines = [], self.text.splitlines()
        for inner in ast.iter_child_nodes(node):
            name = f"{prefix}{inner.name}" if isinstance(inner, (ast.FunctionDef, ast.ClassDef)) else ""
            if isinstance(inner, ast.FunctionDef):
                span = first(inner), inner.end_lineno or inner.lineno
                text = "\n".join(lines[span[0] - 1 : span[1]])
                found.append(Function(name, *span, hashlib.sha1(text.encode()).hexdigest()[:12]))
            found += self._of(inner, f"{name}." if name else prefix)
        return found

    @cached_property
    def _innermost(self) -> dict[int, Function]:
        by_size = sorted(self.all, key=lambda f: f.first - f.last)
        return {line: f for f in by_size for line in range(f.first, f.last + 1)}

    def at(self, line: int) -> Function | None:
        """Return the innermost function that has a line, if one has."""
        return self._innermost.get(line)

    def statement(self, line: int) -> ast.stmt | None:
        """Return the innermost statement that has a line."""
        having = (
            node
            for node in ast.walk(self.tree)
            if isinstance(node, ast.stmt) and first(node) <= line <= (node.end_lineno or node.lineno)
        )
        return max(having, key=lambda node: (first(node), -(node.end_lineno or 0)), default=None)

    def lines(self, line: int) -> set[int]:
        """Return the lines of a statement that are executed with one of them: not those of its body."""
        if (node := self.statement(line)) is None:
            return {line}
        inner = {
            k
            for part in ast.iter_child_nodes(node)
            if isinstance(part, ast.stmt)
            for k in range(first(part), (part.end_lineno or part.lineno) + 1)
        }
        return {*range(first(node), (node.end_lineno or node.lineno) + 1)} - inner | {line}

    def runs(self, line: int) -> bool:
        """Tell whether a line is executed when its function is called, not when the module is imported."""
        function, node = self.at(line), self.statement(line)
        return function is not None and not isinstance(node, ast.FunctionDef)

    def names(self, line: int) -> set[str]:
        """Return the names that a statement outside functions gives a value, a constant's or a field's."""
        match self.statement(line):
            case ast.Assign(targets=targets):
                return {
                    node.id for target in targets for node in ast.walk(target) if isinstance(node, ast.Name)
                }
            case ast.AnnAssign(target=ast.Name(id=name)):
                return {name}
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                return {name}
        return set()

    def called(self, line: int) -> set[str]:
        """Return the names by which a test may call what has a line: function, class, constant and module."""
        inside = self.at(line)
        names = {self.path.stem, *self.names(line), *(inside.name.split(".") if inside else ())}
        names |= {
            node.name
            for node in self.tree.body
            if isinstance(node, ast.ClassDef) and first(node) <= line <= (node.end_lineno or node.lineno)
        }
        return {name for name in names if not name.startswith("__")}

    def using(self, names: set[str]) -> set[int]:
        """Return the lines that use one of the names."""
        return {
            node.lineno
            for node in ast.walk(self.tree)
            if (isinstance(node, ast.Name) and node.id in names)
            or (isinstance(node, ast.Attribute) and node.attr in names)
        }


def first(node: ast.stmt) -> int:
    """Return a statement's first line, its decorators' included."""
    decorators = getattr(node, "decorator_list", [])
    return decorators[0].lineno if decorators else node.lineno
