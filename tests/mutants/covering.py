"""The tests that execute a line, those first that are likely to notice a change of it for their time."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from functions import Functions
from measuring import DEFINED, PACKAGES, files, function, stored

PRIOR = 0.02
"""How likely a test is to notice a change of whatever it executes, beside its share of the module changed."""

STARTING = 0.02
"""Seconds that a test takes beside its own."""

UNKNOWN = 5.0
"""CPU seconds that are taken for tests that were stopped as they were measured."""

DOUBT = 0.3
"""How likely a test is to execute a line that is not known to, but may."""

NAMED = 8.0
"""How much more likely a test file is to execute a function whose name is in its text."""

LOOKED = 1.0
"""How likely a test that looks at what modules define is to notice a change of a definition."""

AGAIN = 0.7
"""How much less likely to notice a test's next case is than the one before, which has not noticed."""

WORD = re.compile(r"\w+")


@dataclass(frozen=True)
class Executed:
    """A test: its CPU seconds, and of each function that it executes which lines, as the bits of a number."""

    name: str
    seconds: float
    functions: dict[str, int]


class Covering:
    """The tests that execute each line, as measured in a folder for the test files of a clone.

    A test file that is not measured yet, or could not be, stands for one test of which nothing is known.
    """

    def __init__(self, clone: Path, folder: Path) -> None:
        self.clone = clone
        self.digests: dict[str, set[str]] = defaultdict(set)
        self.all: dict[str, Executed] = {}
        self.unknown: dict[str, set[str]] = {}
        for test in files(clone):
            place = stored(clone, folder, test)
            if place.exists():
                self._read(json.loads(place.read_text("utf-8")))
            else:
                self.all[str(test)] = Executed(str(test), UNKNOWN, {})
                self.unknown[str(test)] = set(WORD.findall((clone / test).read_text("utf-8")))
        self.executing: dict[str, list[Executed]] = defaultdict(list)
        for known in self.all.values():
            for name in known.functions:
                self.executing[name].append(known)

    def _read(self, found: dict[str, Any]) -> None:
        for name, digest in found.get("digests", {}).items():
            self.digests[name].add(digest)
        notes, last = found.get("tests", {}), dict[str, Executed]()
        for name, note in notes.items():
            if note["outcome"] in ("passed", "stopped"):
                own = {place: int(bits, 16) for place, bits in note["executed"].items()}
                seconds = max(note.get("seconds", 0.0), UNKNOWN if note["outcome"] == "stopped" else 0.0)
                self.all[name] = last[function(name)] = Executed(name, seconds, own)
        for name, note in notes.items():
            if note["outcome"] == "alike":
                like = last.get(function(name), Executed(name, UNKNOWN, {}))
                self.all[name] = replace(like, name=name)

    def seconds(self, test: str) -> float:
        """Return how long a test takes, or is taken to take."""
        return self.all[test].seconds if test in self.all else UNKNOWN

    def tests(self, module: Path, line: int) -> list[str]:
        """Return the tests that execute a line, the most promising first, then those that may.

        Of a line that is executed at import, those that look at what modules define and those that execute a
        line which uses what it names. Tests that may are those of the module's room of which not all is
        known, and those that execute anything in the module where none is known to execute the line.
        """
        functions = Functions(self.clone / module)
        if functions.runs(line):
            sure = self._executing(module, functions, functions.lines(line))
        else:
            sure = self._using(module, functions, line)
        found = {test.name: _likely(module, test) for test in sure}
        found |= {} if functions.runs(line) else dict.fromkeys(self._looking(), LOOKED)
        names = functions.called(line)
        for test in self._beside(module, not sure, names):
            more = NAMED if self._mentions(test.name, names) else 1.0
            found.setdefault(test.name, DOUBT * more * _likely(module, test))
        return self._ordered(found)

    def _executing(self, module: Path, functions: Functions, lines: Iterable[int]) -> list[Executed]:
        found: dict[str, Executed] = {}
        for line in lines:
            if (inside := functions.at(line)) is None:
                continue
            name = f"{module}::{inside.name}"
            known, bit = self.digests[name] == {inside.digest}, 1 << (line - inside.first)
            found |= {t.name: t for t in self.executing[name] if not known or t.functions[name] & bit}
        return list(found.values())

    def _using(self, module: Path, functions: Functions, line: int) -> list[Executed]:
        if inside := functions.at(line):
            return self._executing(module, functions, range(inside.first, inside.last + 1))
        names, found = functions.names(line), dict[str, Executed]()
        for path, other in self._modules.items():
            if path == module or any(name in other.text for name in names):
                using = self._executing(path, other, other.using(names))
                found |= {test.name: test for test in using}
        return list(found.values())

    def _looking(self) -> list[str]:
        return [name for name in self.all if Path("tests", DEFINED) in Path(name.partition("::")[0]).parents]

    def _beside(self, module: Path, none: bool, names: set[str]) -> Iterator[Executed]:
        """Yield the tests that may execute a line; none: whether none is known to."""
        room = Path("tests") / module.parent
        for test in self.all.values():
            near = room in Path(test.name.partition("::")[0]).parents
            partly = test.seconds >= UNKNOWN
            own = none and any(_module(name) == str(module) for name in test.functions)
            if (near and (partly or none)) or own or self._mentions(test.name, names):
                yield test

    def _mentions(self, name: str, names: set[str]) -> bool:
        """Whether a test file of which nothing is known has one of some names in its text."""
        return bool(self.unknown.get(name, set()) & names)

    @cached_property
    def _modules(self) -> dict[Path, Functions]:
        paths = (path for package in PACKAGES for path in (self.clone / package).rglob("*.py"))
        return {path.relative_to(self.clone): Functions(path) for path in paths}

    def _ordered(self, likely: dict[str, float]) -> list[str]:
        """The most likely to notice for a second of time first: the further cases of a test later."""
        cases, scores = defaultdict[str, int](int), dict[str, float]()
        for name in sorted(likely, key=lambda name: (self.seconds(name), name)):
            again = AGAIN ** cases[function(name)]
            cases[function(name)] += 1
            scores[name] = again * likely[name] / (self.seconds(name) + STARTING)
        return sorted(scores, key=lambda name: (-scores[name], name))


def _likely(module: Path, test: Executed) -> float:
    """Return how likely a test is to notice a change of a module, up to a factor."""
    own = sum(_module(name) == str(module) for name in test.functions)
    file, room = Path(test.name.partition("::")[0]), Path("tests") / module.parent
    alone = float(file.stem == f"test_{module.stem}")
    share = own / len(test.functions) if test.functions else alone
    near = 2 if file.parent == room or room in file.parents else 1
    return (PRIOR + share) * near * (2 if file.stem == f"test_{module.stem}" else 1)


def _module(name: str) -> str:
    return name.partition("::")[0]
