"""One mutant on trial: what it changes, and the first test that fails with it."""

from __future__ import annotations

import os
import resource
import shutil
import signal
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import forks
import pytest
from cosmic_ray.mutating import use_mutation
from cosmic_ray.plugins import get_operator
from covering import Covering
from sample import Mutant

FIRST, GROWTH = 1.0, 4.0
"""Seconds of tests that are asked first, which notice most mutants, and how many times more next."""

PATIENCE = 5.0
"""CPU seconds more than it takes without the change, by its tenfold, after which a test does not end."""

LATE = "time is up"

COMPILED = Path("symbolic/kernels")
"""Whose mutants may make other kernels of the same text, so that none is taken from the cache."""


@dataclass(frozen=True)
class Outcome:
    """What a mutant changes, as two lines of code; the test that notices it, of how many; CPU seconds."""

    path: str
    line: int
    operator: str
    occurrence: int
    before: str
    after: str
    test: str
    asked: int
    seconds: float


@dataclass(eq=False)
class Judge:
    """A plugin of pytest that stops a test that does not end, and writes down the first that fails."""

    covering: Covering
    place: Path
    failed: str = field(default="", init=False)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Stop what takes far longer than without the change."""
        with forks.stopped_after(PATIENCE + 10 * self.covering.seconds(item.nodeid)):
            return (yield)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note the first failure."""
        if report.failed and not self.place.exists():
            self.place.write_text(report.nodeid, "utf-8")


class Trial:
    """Holds mutants in a clone against the tests that execute them, each for so many seconds of CPU time."""

    def __init__(self, clone: Path, covering: Covering, limit: float, cache: Path) -> None:
        self.clone, self.covering, self.limit, self.cache = clone, covering, limit, cache
        self.sound, self.broken = set[str](), set[str]()

    def of(self, mutant: Mutant) -> Outcome:
        """Try a mutant. A test that fails without the change too says nothing: it is asked no more."""
        tests, spent = self.covering.tests(mutant.path, mutant.position[0]), _spent()
        while True:
            asked = [test for test in tests if test not in self.broken]
            test, (before, after) = self._changed(mutant, asked, spent + self.limit)
            if "::" not in test or self._is_sound(test):
                break
        place = (str(mutant.path), mutant.position[0], mutant.operator.rpartition("/")[2], mutant.occurrence)
        return Outcome(*place, before, after, test, len(asked), round(_spent() - spent, 1))

    def _changed(self, mutant: Mutant, tests: list[str], ends: float) -> tuple[str, tuple[str, str]]:
        """Return the first test that fails with a mutant, and the lines; the file stays as old as it was."""
        file = self.clone / mutant.path
        age = file.stat()
        with (
            tempfile.TemporaryDirectory() as folder,
            use_mutation(file, get_operator(mutant.operator)(), mutant.occurrence) as texts,
        ):
            cache = Path(folder, "cache")
            if self.cache.exists() and COMPILED not in mutant.path.parents:
                shutil.copytree(self.cache, cache, copy_function=os.link)
            found = self._failing(tests, ends, Path(folder))
        os.utime(file, ns=(age.st_atime_ns, age.st_mtime_ns))
        return found, _change(*texts, mutant.position[0])

    def _is_sound(self, test: str) -> bool:
        if test not in self.sound:
            with tempfile.TemporaryDirectory() as folder:
                sound = not self._run([test], self.limit, Path(folder))
            (self.sound if sound else self.broken).add(test)
        return test in self.sound

    def _failing(self, tests: list[str], ends: float, folder: Path) -> str:
        """Ask the tests, in batches that grow."""
        first, share = 0, FIRST
        while first < len(tests):
            last, total = first, 0.0
            while last < len(tests) and total < share:
                total += self.covering.seconds(tests[last])
                last += 1
            left = ends - _spent()
            if left < 1.0:
                return LATE
            if found := self._run(tests[first:last], left, folder):
                return found
            first, share = last, GROWTH * share
        return ""

    def _run(self, tests: list[str], left: float, folder: Path) -> str:
        """Return the first test that fails, or nothing; LATE where the seconds do not suffice.

        What pytest says, without the name of a test, where it ends before it has run one: a file that is not
        collected with the mutant was collected without it.
        """
        listed, said, failed = folder / "tests", folder / "said", folder / "failed"
        listed.write_text("\n".join(tests), "utf-8")
        judge = Judge(self.covering, failed)
        code = forks.run(self.clone, ["-x", f"@{listed}"], judge, left, said, folder / "cache")
        if code == 0:
            return ""
        if failed.exists():
            return failed.read_text("utf-8")
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            return LATE
        return said.read_text("utf-8", "replace").strip()[-200:].replace("::", " ")


def _spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _change(before: str, after: str, line: int) -> tuple[str, str]:
    """The line as it was and is; nothing where it is taken out."""
    old, new = before.splitlines(), after.splitlines()
    if len(old) != len(new):
        return old[line - 1].strip(), ""
    return next((a.strip(), b.strip()) for a, b in zip(old, new, strict=True) if a != b)
