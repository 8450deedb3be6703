"""Mutants drawn at random: small changes of the code (cosmic-ray's) that some test should notice."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from cosmic_ray.ast import ast_nodes, get_ast_from_path
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

FOREIGN = {
    "RShift",
    "LShift",
    "BitOr",
    "BitAnd",
    "BitXor",
    "FloorDiv",
    "Mod",
    "Invert",
    "Is",
    "IsNot",
    "UAdd",
}
"""Operators that fail at once in the place of those of floating-point numbers."""

Position = tuple[int, int]
Span = tuple[Position, Position]


@dataclass(frozen=True)
class Mutant:
    """The change that an operator of cosmic-ray makes at its n-th occurrence in a file; at a position."""

    path: Path
    operator: str
    occurrence: int
    position: Position


def drawn(modules: Sequence[Path], count: int, seed: int) -> list[Mutant]:
    """Return so many mutants of the modules, the same for a seed: a long file has more of them."""
    source, sizes = random.Random(seed), [path.stat().st_size for path in modules]
    found: dict[Mutant, None] = {}
    while len(found) < count and any(sizes):
        (path,) = source.choices(modules, weights=sizes)
        left = [mutant for mutant in mutants(path) if mutant not in found]
        if not left:
            sizes[modules.index(path)] = 0
        elif is_code(mutant := source.choice(left)):
            found[mutant] = None
    return list(found)


def is_code(mutant: Mutant) -> bool:
    """Tell whether a mutant can be made and compiled: the star of a call is no product.

    Of an exception with a dotted name cosmic-ray cannot make one (AttributeError).
    """
    source, operator = mutant.path.read_text("utf-8"), get_operator(mutant.operator)()
    try:
        ast.parse(mutate_code(source, operator, mutant.occurrence))
    except (SyntaxError, AttributeError):
        return False
    return True


@cache
def mutants(path: Path) -> list[Mutant]:
    """Return every mutant of a module."""
    inert, nodes = list(_inert(ast.parse(path.read_text("utf-8")))), list(ast_nodes(get_ast_from_path(path)))
    found = []
    for name in operator_names():
        operator = get_operator(name)
        if operator.arguments() or FOREIGN & set(name.split("_")):
            continue
        places = [begin for node in nodes for begin, _ in operator().mutation_positions(node)]
        found += [Mutant(path, name, n, tuple(begin)) for n, begin in enumerate(places)]
    return [m for m in found if not any(begin <= m.position < end for begin, end in inert)]


def _inert(tree: ast.Module) -> Iterator[Span]:
    """Where code is not run or only shown: annotations, imports for the type checker, messages of errors."""
    for node in ast.walk(tree):
        match node:
            case ast.AnnAssign(annotation=found) | ast.arg(annotation=ast.expr() as found):
                yield _span(found)
            case ast.FunctionDef(returns=ast.expr() as found):
                yield _span(found)
            case ast.If(test=ast.Name(id="TYPE_CHECKING")) | ast.Raise() | ast.JoinedStr():
                yield _span(node)


def _span(node: ast.expr | ast.stmt) -> Span:
    assert node.end_lineno is not None and node.end_col_offset is not None
    return (node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset)
