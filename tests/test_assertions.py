"""Every test asserts something: by the syntax of the tests, and of the helpers that they call."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
FILES = sorted(path for path in TESTS.rglob("*.py") if path.parent != TESTS / "mutants")

RAISING = {"raises", "warns", "deprecated_call", "fail"}
"""Functions of pytest that fail a test."""

Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(tree: ast.AST) -> Iterator[Function]:
    """Every function of a file, methods included."""
    return (node for node in ast.walk(tree) if isinstance(node, Function))


@cache
def called(function: Function) -> set[str]:
    """The names of functions that a function calls."""
    calls = (node.func for node in ast.walk(function) if isinstance(node, ast.Call))
    return {call.id for call in calls if isinstance(call, ast.Name)}


@cache
def asserts(function: Function) -> bool:
    """Whether a function itself asserts, or lets pytest or numpy.testing do so."""
    nodes = list(ast.walk(function))
    calls = (node.func for node in nodes if isinstance(node, ast.Call))
    names = called(function) | {call.attr for call in calls if isinstance(call, ast.Attribute)}
    own = any(isinstance(node, ast.Assert) for node in nodes)
    return own or any(name in RAISING or name.startswith("assert_") for name in names)


def silent(trees: dict[str, ast.Module]) -> list[str]:
    """The tests that assert nothing, neither themselves nor in functions of the tests that they call."""
    every = [function for tree in trees.values() for function in functions(tree)]
    helping = {function.name for function in every if asserts(function)}
    while more := {f.name for f in every if f.name not in helping and called(f) & helping}:
        helping |= more
    return [
        f"{where}::{function.name}"
        for where, tree in trees.items()
        for function in functions(tree)
        if function.name.startswith("test_") and not asserts(function) and not called(function) & helping
    ]


def test_every_test_asserts() -> None:
    """Assert that no test of the repository ends without an assertion."""
    trees = {path.relative_to(TESTS).as_posix(): ast.parse(path.read_text("utf-8")) for path in FILES}
    assert len(trees) > 200
    assert silent(trees) == []


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("assert x == 1", []),
        ("with pytest.raises(ValueError):\n        x()", []),
        ("np.testing.assert_allclose(x, 1)", []),
        ("close(x)", []),
        ("within(x)", []),
        ("x = 1", ["a.py::test_it"]),
        ("print(x)", ["a.py::test_it"]),
    ],
)
def test_tests_that_assert_nothing_are_told(body: str, found: list[str]) -> None:
    """Assert which of these tests is told, helpers of helpers included."""
    helpers = "def close(x):\n    assert x\n\n\ndef within(x):\n    close(x)\n\n\n"
    assert silent({"a.py": ast.parse(f"{helpers}def test_it(x):\n    {body}\n")}) == found
