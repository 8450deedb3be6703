"""The tests that execute a line, those first that are likely to notice a change of it for their time."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from functions import Functions
from measuring import PACKAGES, files, function, stored

PRIOR = 0.02
"""How likely a test is to notice a change of whatever it executes, beside its share of the module changed."""

STARTING = 0.02
"""Seconds that a test takes beside its own."""

UNKNOWN = 5.0
"""CPU seconds that are taken for tests that were stopped as they were measured."""

AGAIN = 0.7
"""How much less likely to notice a test's next case is than the one before, which has not noticed."""


@dataclass(frozen=True)
class Executed:
    """A test: its CPU seconds, and of each function that it executes which lines, as the bits of a number."""

    name: str
    seconds: float
    functions: dict[str, int]


class Covering:
    """The tests that execute each line, as measured in a folder for the test files of a clone."""

    def __init__(self, clone: Path, folder: Path) -> None:
        self.clone = clone
        self.digests: dict[str, set[str]] = defaultdict(set)
        self.all: dict[str, Executed] = {}
        for place in (stored(clone, folder, test) for test in files(clone)):
            if place.exists():
                self._read(json.loads(place.read_text("utf-8")))
        self.executing: dict[str, list[Executed]] = defaultdict(list)
        for test in self.all.values():
            for name in test.functions:
                self.executing[name].append(test)

    def _read(self, found: dict[str, dict[str, dict[str, object]]]) -> None:
        for name, digest in found.get("digests", {}).items():
            self.digests[name].add(str(digest))
        alike: dict[str, list[Executed]] = defaultdict(list)
        for name, note in found.get("tests", {}).items():
            own = {place: int(bits, 16) for place, bits in note["executed"].items()}  # type: ignore[attr-defined]
            if note["outcome"] in ("passed", "stopped"):
                long = UNKNOWN if note["outcome"] == "stopped" else 0.0
                test = Executed(name, max(long, float(note.get("seconds", 0))), own)  # type: ignore[arg-type]
                alike[function(name)].append(test)
                self.all[name] = test
        # Cases that were not measured are taken to execute what the last of the others does.
        for name, note in found.get("tests", {}).items():
            if note["outcome"] == "alike" and alike[function(name)]:
                last = alike[function(name)][-1]
                self.all[name] = Executed(name, last.seconds, last.functions)

    def seconds(self, test: str) -> float:
        """Return how long a test takes."""
        return self.all[test].seconds

    def tests(self, module: Path, line: int) -> list[str]:
        """Return the tests that execute a line, the most promising first.

        Of a line that is executed at import, those that execute a line which uses what it names; where there
        are none, or the function is new, those that execute anything in the module, or else its room's.
        """
        functions = Functions(self.clone / module)
        if functions.runs(line):
            executing = self._executing(module, functions, functions.lines(line))
        else:
            executing = self._using(module, functions, line)
        chosen = executing or self._beside(module)
        return self._ordered(module, chosen)

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

    def _beside(self, module: Path) -> list[Executed]:
        own = [t for t in self.all.values() if any(_module(name) == str(module) for name in t.functions)]
        room = str(Path("tests") / module.parent) + "/"
        return own or [test for test in self.all.values() if test.name.startswith(room)]

    @cached_property
    def _modules(self) -> dict[Path, Functions]:
        paths = (path for package in PACKAGES for path in (self.clone / package).rglob("*.py"))
        return {path.relative_to(self.clone): Functions(path) for path in paths}

    def _ordered(self, module: Path, tests: Sequence[Executed]) -> list[str]:
        """The most likely to notice for a second of time first: the further cases of a test later."""
        cases, scores = defaultdict[str, int](int), dict[str, float]()
        for test in sorted(tests, key=lambda test: test.seconds):
            again = AGAIN ** cases[function(test.name)]
            cases[function(test.name)] += 1
            scores[test.name] = again * _likely(module, test) / (test.seconds + STARTING)
        return sorted(scores, key=lambda name: (-scores[name], name))


def _likely(module: Path, test: Executed) -> float:
    """Return how likely a test is to notice a change of a module, up to a factor."""
    own = sum(_module(name) == str(module) for name in test.functions)
    share = own / len(test.functions) if test.functions else 0.0
    file, room = Path(test.name.partition("::")[0]), Path("tests") / module.parent
    near = 2 if file.parent == room or room in file.parents else 1
    return (PRIOR + share) * near * (2 if file.stem == f"test_{module.stem}" else 1)


def _module(name: str) -> str:
    return name.partition("::")[0]
