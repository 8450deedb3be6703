"""Which lines of which functions each test executes, measured with coverage.py and kept per test file.

A test file is measured anew when its text has changed. Lines are counted from the first of their function,
and a function's digest is kept: where the function has changed since, all its lines count as executed.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import forks
import pytest
from coverage import Coverage
from functions import Functions

PACKAGES = ("symbolic", "periodic")
DEFINED = "interface"
"""The folder of tests that look at what modules define, rather than run it."""

ROOMS = ("periodic", "symbolic", "problems", "howto", "fuzz/test_attacks.py", DEFINED)
"""Folders and files of tests: not those of the command line and texts, which run the packages from afar."""

LONGEST = 1.0
"""CPU seconds after which a test is stopped as it is measured; what it has executed until then counts."""

CASES = 2.0
"""CPU seconds of a test's cases: those that are left then are taken to execute what the others do."""

WHOLE = 10.0
"""CPU seconds of a file's tests: of those that are left then, but of further cases, nothing is known."""


def files(clone: Path) -> list[Path]:
    """Return the test files of a clone, relative to it, the rooms of the packages first."""
    rooms = (clone / "tests" / room for room in ROOMS)
    each = (sorted(room.rglob("test_*.py")) if room.is_dir() else [room] for room in rooms if room.exists())
    return [path.relative_to(clone) for found in each for path in found]


def stored(clone: Path, folder: Path, test: Path) -> Path:
    """Return where the measurement of a test file is kept, by the file's text."""
    digest = hashlib.sha1((clone / test).read_bytes()).hexdigest()[:12]
    return folder / f"{'-'.join(test.with_suffix('').parts)}-{digest}.json"


def measure(clone: Path, folder: Path, ends: float = float("inf")) -> None:
    """Measure the test files whose text is not known yet, until so much time is on the clock."""
    folder.mkdir(parents=True, exist_ok=True)
    for test in files(clone):
        place = stored(clone, folder, test)
        if place.exists() or time.monotonic() > ends:
            continue
        spent = time.monotonic()
        with tempfile.TemporaryDirectory() as scratch:
            meter = Meter(clone, place)
            code = forks.run(clone, [str(test)], meter, 600.0, Path(scratch, "said"), folder / "cache")
            told = Path(scratch, "said").read_text("utf-8", "replace")
        if not place.exists():
            # Killed, or not collected: its tests are asked of no mutant.
            place.write_text(json.dumps({"said": f"{code} {told[-300:]}"}), "utf-8")
        print(f"measured {test} ({time.monotonic() - spent:.0f} s)", flush=True)


@dataclass(eq=False)
class Meter:
    """A plugin of pytest that notes each test's outcome, CPU seconds and executed lines."""

    clone: Path
    place: Path
    found: dict[str, dict[str, Any]] = field(default_factory=dict)
    used: dict[str, float] = field(default_factory=lambda: defaultdict(float))

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionstart(self) -> None:
        """Begin before the packages are imported."""
        include = [f"{self.clone}/{package}/*" for package in PACKAGES]
        self.coverage = Coverage(data_file=None, include=include, config_file=False)
        self.coverage.start()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> bool | None:
        """Leave out what is known well enough."""
        if self.used[function(item.nodeid)] < CASES and sum(self.used.values()) < WHOLE:
            return None
        self.found[item.nodeid] = {"outcome": "alike"}
        return True

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Stop what takes long."""
        with forks.stopped_after(LONGEST):
            return (yield)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        """Begin to count, with nothing kept from tests before; fixtures may take longer."""
        forget()
        self.coverage.switch_context(item.nodeid)
        self.began = time.process_time()
        with forks.stopped_after(3 * LONGEST):
            return (yield)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note how a test went, the worst of its phases."""
        note = self.found.setdefault(report.nodeid, {"outcome": "passed"})
        if report.outcome != "passed":
            text = str(report.longrepr)
            note["outcome"] = "stopped" if "s of the processor" in text else report.outcome
        if report.when == "call" or report.failed:
            note["seconds"] = round(time.process_time() - self.began, 4)
            self.used[function(report.nodeid)] += time.process_time() - self.began

    def pytest_sessionfinish(self) -> None:
        """Write all."""
        self.coverage.stop()
        digests: dict[str, str] = {}
        executed: dict[str, dict[str, int]] = defaultdict(lambda: defaultdict(int))
        data = self.coverage.get_data()
        for name in data.measured_files():
            module = str(Path(name).relative_to(self.clone))
            for line, contexts in data.contexts_by_lineno(name).items():
                if (inside := functions_of(name).at(line)) is not None:
                    place = f"{module}::{inside.name}"
                    digests[place] = inside.digest
                    for test in contexts:
                        executed[test][place] |= 1 << (line - inside.first)
        for test, note in self.found.items():
            note["executed"] = {place: f"{bits:x}" for place, bits in executed[test].items()}
        text = json.dumps({"digests": digests, "tests": self.found}, separators=(",", ":"))
        part = self.place.with_suffix(".part")
        part.write_text(text, "utf-8")
        part.rename(self.place)


def forget() -> None:
    """Clear what functions of the packages keep, so that each test executes all that it asks for."""
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] in PACKAGES:
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear"):
                    value.cache_clear()


@cache
def functions_of(name: str) -> Functions:
    """Return the functions of a file."""
    return Functions(Path(name))


def function(test: str) -> str:
    """Return a test's name without its case."""
    return test.partition("[")[0]
