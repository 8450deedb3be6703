"""The engine that computes a section: the last commit that changed it, a hash of what of it is executed."""

from __future__ import annotations

import io
import re
import subprocess
import tokenize
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import periodic

ROOT = Path(periodic.__file__).resolve().parents[1]
"""Where the engine lies that is imported: the folder of a checkout."""

PACKAGES = ("periodic", "symbolic")

EXECUTED = (".py", ".c", ".toml")
"""Endings of the files that results depend on: code, kernels, scenes."""

DIGITS = 10
"""Of a commit and of a hash, as they are told."""

_LEADING = (tokenize.ENCODING, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
"""Tokens behind which a statement begins."""


@dataclass(frozen=True, kw_only=True)
class Engine:
    """Which engine computed something.

    sources: hash of periodic/ and symbolic/ without comments and docstrings, the same in every clone and
    with every Python. commit: the last one that changed either package, empty outside a git repository.
    changed: whether the packages had changes besides, not committed.
    """

    sources: str
    commit: str = ""
    changed: bool = False

    def __str__(self) -> str:
        if not self.commit:
            return f"engine with sources `{self.sources}`, of no commit"
        return f"engine at commit `{self.commit}`" + (" with changes not committed" if self.changed else "")


def current(root: Path = ROOT) -> Engine:
    """Return the engine that is in a folder."""
    commit = _git(root, "log", "-1", f"--abbrev={DIGITS}", "--format=%h", "--", *PACKAGES)
    changed = _git(root, "status", "--porcelain", "--", *PACKAGES)
    return Engine(sources=sources(root), commit=commit or "", changed=bool(changed))


def sources(root: Path = ROOT) -> str:
    """Return the hash of an engine's sources: of names and texts, without what is not executed."""
    found = sha256()
    files = [file for name in PACKAGES for file in (root / name).rglob("*") if file.suffix in EXECUTED]
    for name, file in sorted((file.relative_to(root).as_posix(), file) for file in files):
        text = executed(file.read_text("utf-8"), file.suffix)
        found.update(f"{name}\0{len(text)}\0{text}\0".encode())
    return found.hexdigest()[:DIGITS]


def commits_since(commit: str, root: Path = ROOT) -> int | None:
    """Return how many commits have changed the engine since one, None where the history has it not."""
    if _git(root, "merge-base", "--is-ancestor", commit, "HEAD") is None:
        return None
    count = _git(root, "rev-list", "--count", f"{commit}..HEAD", "--", *PACKAGES)
    return None if count is None else int(count)


def commit_of(file: Path, root: Path = ROOT) -> str:
    """Return the last commit that changed a file, empty where there is none."""
    return _git(root, "log", "-1", f"--abbrev={DIGITS}", "--format=%h", "--", str(file)) or ""


def executed(text: str, suffix: str) -> str:
    """Return a source without comments, docstrings and empty lines."""
    bare = {".py": _python, ".c": _c}.get(suffix, str)(text)
    return "\n".join(line.rstrip() for line in bare.splitlines() if line.strip())


def _python(text: str) -> str:
    lines, before = text.splitlines(keepends=True), tokenize.ENCODING
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    # Places of tokens, and not the tokens: how these divide an f-string depends on the Python.
    for token, after in zip(tokens, tokens[1:], strict=False):
        alone = token.type == tokenize.STRING and before in _LEADING and after.type == tokenize.NEWLINE
        if alone or token.type == tokenize.COMMENT:
            _blank(lines, token.start, token.end)
        if token.type not in (tokenize.NL, tokenize.COMMENT):
            before = token.type
    return "".join(lines)


def _blank(lines: list[str], start: tuple[int, int], end: tuple[int, int]) -> None:
    """Put spaces where a token is, which keeps the places of those after it."""
    for row in range(start[0], end[0] + 1):
        line = lines[row - 1]
        left = start[1] if row == start[0] else 0
        right = end[1] if row == end[0] else len(line.rstrip("\n"))
        lines[row - 1] = line[:left] + " " * (right - left) + line[right:]


def _c(text: str) -> str:
    """C without comments; a string may hold what looks like one."""
    token = re.compile(r'("(?:\\.|[^"\\])*")|/\*.*?\*/|//[^\n]*', re.DOTALL)
    return token.sub(lambda match: match[1] or " ", text)


def _git(root: Path, *arguments: str) -> str | None:
    """Return what git says of a repository, None where there is none, or it says no."""
    try:
        said = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return said.stdout.strip() if said.returncode == 0 else None
