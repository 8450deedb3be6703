"""One mutant on trial: what it changes, and the first test that fails with it."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from cosmic_ray.mutating import use_mutation
from cosmic_ray.plugins import get_operator
from covering import Covering
from sample import Mutant

FIRST = 5.0
"""Seconds of tests that are asked before the others: most mutants are noticed by one of these."""

PATIENCE = 30.0
"""Seconds more than it takes without the change, by its tenfold, after which a test does not end."""

OPTIONS = ("-x", "-q", "-n0", "--no-header", "--tb=no", "-p", "no:cacheprovider")

LATE = "time is up"


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


class Trial:
    """Holds mutants in a clone against the tests that execute them, each for so many seconds of CPU time."""

    def __init__(self, clone: Path, covering: Covering, limit: float) -> None:
        self.clone, self.covering, self.limit = clone, covering, limit
        self.broken: set[str] = set()

    def of(self, mutant: Mutant) -> Outcome:
        """Try a mutant. A test that fails without the change too says nothing: it is asked no more."""
        tests, spent = self.covering.tests(mutant.path, mutant.position[0]), _spent()
        while True:
            asked = [test for test in tests if test not in self.broken]
            with use_mutation(
                self.clone / mutant.path, get_operator(mutant.operator)(), mutant.occurrence
            ) as texts:
                before, after = _change(*texts, mutant.position[0])
                test = self._failing(asked, spent + self.limit)
            if "::" not in test or not self._run([test], self.limit):
                break
            self.broken.add(test)
        place = (str(mutant.path), mutant.position[0], mutant.operator.rpartition("/")[2], mutant.occurrence)
        return Outcome(*place, before, after, test, len(asked), round(_spent() - spent, 1))

    def _failing(self, tests: list[str], ends: float) -> str:
        total, first = 0.0, 0
        while first < len(tests) and total < FIRST:
            total += self.covering.seconds(tests[first])
            first += 1
        for batch in filter(None, (tests[:first], tests[first:])):
            if ends - _spent() < 1.0:
                return LATE
            if found := self._run(batch, ends - _spent()):
                return found
        return ""

    def _run(self, tests: list[str], left: float) -> str:
        """Return the first test that fails, or nothing; LATE where the seconds do not suffice."""
        patience = PATIENCE + 10 * max(map(self.covering.seconds, tests))
        with tempfile.TemporaryDirectory() as folder:
            listed, said = Path(folder, "tests"), Path(folder, "said")
            listed.write_text("\n".join(tests), "utf-8")
            command = [sys.executable, "-m", "pytest", *OPTIONS, f"--timeout={patience}", f"@{listed}"]
            # What is compiled with a mutant is not kept.
            environment = os.environ | {"PYTHONPATH": str(self.clone), "XDG_CACHE_HOME": folder}
            with said.open("w") as out:
                process = subprocess.Popen(
                    command,
                    cwd=self.clone,
                    env=environment | {"PYTHONDONTWRITEBYTECODE": "1"},
                    stdout=out,
                    stderr=out,
                    start_new_session=True,
                    preexec_fn=lambda: resource.setrlimit(
                        resource.RLIMIT_CPU, (int(left) + 1, int(left) + 6)
                    ),
                )
                code = _end(process, 5 * left)
            return _verdict(code, said.read_text("utf-8", "replace"))


def _end(process: subprocess.Popen[bytes], seconds: float) -> int:
    """Return the exit code of the tests, which end by then with all that they have started."""
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return -signal.SIGXCPU
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _verdict(code: int, said: str) -> str:
    if code == 0:
        return ""
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return LATE
    failed = [line for line in said.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return failed[0].split(" - ")[0].split(maxsplit=1)[1] if failed else said.strip()[-200:]


def _spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _change(before: str, after: str, line: int) -> tuple[str, str]:
    """The line as it was and is; nothing where it is taken out."""
    old, new = before.splitlines(), after.splitlines()
    if len(old) != len(new):
        return old[line - 1].strip(), ""
    return next((a.strip(), b.strip()) for a, b in zip(old, new, strict=True) if a != b)
