"""The engine that is recorded: a hash that tells code from words, commits that are counted."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from reports.studies.pages.engine import commit_of, commits_since, current, executed, sources

MODULE = '''"""What it is."""

from math import pi

TWICE = 2 * pi  # of a turn
"""In rad."""


def half(turns: float) -> str:
    """Return half of it."""
    text = """
    # no comment
    """
    return f"{turns / 2} # {pi}" + text
'''

SAID_OTHERWISE = MODULE.replace("What it is", "What it says").replace("of a turn", "a whole turn")

Git = Callable[..., str]


@pytest.fixture
def git(tmp_path: Path) -> Git:
    """Git in a repository of an engine of three files, committed."""

    def run(*arguments: str, folder: Path = tmp_path / "made") -> str:
        who = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
        return subprocess.check_output(["git", *who, *arguments], cwd=folder, text=True).strip()

    made = tmp_path / "made"
    for name, text in {
        "periodic/a.py": MODULE,
        "periodic/n/k.c": "int a;\n",
        "symbolic/s.toml": "a = 1\n",
    }.items():
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        (made / name).write_text(text, "utf-8")
    run("init", "-q")
    run("add", ".")
    run("commit", "-q", "-m", "first")
    return run


def test_what_is_executed_of_python() -> None:
    """Assert that docstrings, also of constants, and comments are left out, and texts in code kept."""
    assert executed(MODULE, ".py") == executed(SAID_OTHERWISE, ".py")
    assert executed(MODULE, ".py").splitlines() == [
        "from math import pi",
        "TWICE = 2 * pi",
        "def half(turns: float) -> str:",
        '    text = """',
        "    # no comment",
        '    """',
        '    return f"{turns / 2} # {pi}" + text',
    ]
    assert executed(MODULE.replace("/ 2", "/ 3"), ".py") != executed(MODULE, ".py")
    listed = 'NAMES = (\n    "a",\n    # of two\n    "b"\n)\n'
    assert executed(listed, ".py") == 'NAMES = (\n    "a",\n    "b"\n)'


def test_what_is_executed_of_c() -> None:
    """Assert that comments are left out, and what looks like one in a string is kept."""
    assert executed('int a; /* one\ntwo */ int b; // three\nchar *c = "/* \\" //";\n', ".c") == (
        'int a;   int b;\nchar *c = "/* \\" //";'
    )


def test_clone_has_the_same_engine(git: Git, tmp_path: Path) -> None:
    """Assert that hash and commit are those of a clone, and that outside git there is no commit."""
    made = tmp_path / "made"
    git("clone", "-q", str(made), "copy", folder=tmp_path)
    found = current(made)
    assert found == current(tmp_path / "copy")
    assert (found.commit, found.changed) == (git("log", "-1", "--abbrev=10", "--format=%h"), False)
    (made / ".git").rename(tmp_path / "elsewhere")
    assert (current(made).commit, current(made).sources) == ("", found.sources)
    assert str(current(made)) == f"engine with sources `{found.sources}`, of no commit"


def test_only_what_is_executed_changes_the_hash(git: Git, tmp_path: Path) -> None:
    """Assert that words, other files and other packages do not, and each kind of source does."""
    made = tmp_path / "made"
    before = sources(made)
    (made / "periodic" / "a.py").write_text(SAID_OTHERWISE, "utf-8")
    (made / "periodic" / "page.html").write_text("<p>", "utf-8")
    (made / "reports").mkdir()
    (made / "reports" / "a.py").write_text("a = 1\n", "utf-8")
    assert sources(made) == before
    known = {before}
    for name, text in {
        "periodic/n/k.c": "int b;\n",
        "symbolic/s.toml": "a = 2\n",
        "symbolic/b.py": "c = 1\n",
    }.items():
        (made / name).write_text(text, "utf-8")
        known.add(sources(made))
    (made / "symbolic" / "b.py").rename(made / "symbolic" / "c.py")
    assert len(known | {sources(made)}) == 5


def test_commits_are_counted(git: Git, tmp_path: Path) -> None:
    """Assert that the engine's commits alone count, merged ones too, and one of another history is none."""
    made = tmp_path / "made"
    first = current(made).commit

    def commit(name: str, text: str) -> None:
        (made / name).write_text(text, "utf-8")
        git("add", ".")
        git("commit", "-q", "-m", name)

    commit("README.md", "words")
    assert (commits_since(first, made), current(made).commit) == (0, first)
    git("checkout", "-q", "-b", "side")
    commit("periodic/a.py", "a = 1\n")
    git("checkout", "-q", "-")
    commit("symbolic/s.toml", "a = 3\n")
    git("merge", "-q", "-m", "both", "side")
    assert commits_since(first, made) == 3  # the two, and the merge that no side has alone
    assert current(made).commit == git("log", "-1", "--abbrev=10", "--format=%h")
    assert commits_since("deadbeef", made) is None and commits_since(first, tmp_path) is None
    assert commit_of(made / "periodic" / "n" / "k.c", made) == first


def test_changes_not_committed_are_said(git: Git, tmp_path: Path) -> None:
    """Assert that an engine with changes not committed says so, and has another hash."""
    made = tmp_path / "made"
    before = current(made)
    (made / "periodic" / "a.py").write_text("a = 2\n", "utf-8")
    found = current(made)
    assert found.commit == before.commit and found.changed and found.sources != before.sources
    assert str(found) == f"engine at commit `{before.commit}` with changes not committed"
