"""Files read in processes with bounds; what ends one is a finding like what is raised."""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

MEMORY = 10**9
"""Bytes that reading may take beyond what a process has when it has read one sound file."""

SECONDS = 10
"""Seconds of each file."""

LONGEST = 700
"""Characters of the longest sentence, the path of the file included."""

TESTS = Path(__file__).resolve().parents[1]


@dataclass
class Found:
    """How many files were read and refused, the longest that one took (s), and what went wrong, by number."""

    read: int = 0
    refused: int = 0
    longest: float = 0.0
    wrong: list[tuple[int, str]] = field(default_factory=list)

    def __str__(self) -> str:
        total = self.read + self.refused + len(self.wrong)
        wrong = f"{len(self.wrong)} wrong, longest {self.longest:.2f} s"
        return f"{total} files, {self.read} read, {self.refused} refused, {wrong}"


def fuzzed(kind: str, first: int, count: int) -> Found:
    """Return what became of so many files of a kind; after one that ends the process another goes on."""
    found, last = Found(), first + count
    while first < last:
        code = f"from fuzz.process import work; work({kind!r}, {first}, {last})"
        given = [sys.executable, "-W", "error", "-c", code]
        done = subprocess.run(given, capture_output=True, text=True, cwd=TESTS)
        at = None
        for line in done.stdout.splitlines():
            what, number, said = line.split(" ", 2)
            if what == "begin":
                at = int(number)
                continue
            at = None
            found.longest = max(found.longest, float(said.split(" ")[0]))
            if what == "wrong":
                found.wrong.append((int(number), said))
            else:
                found.read += what == "read"
                found.refused += what == "refused"
            first = int(number) + 1
        if done.returncode == 0:
            break
        if at is None:
            raise RuntimeError(f"no file was read: {done.stderr[-2000:]}")
        found.wrong.append((at, f"the process ended ({done.returncode}): {done.stderr[-300:]}"))
        first = at + 1
    return found


def work(name: str, first: int, last: int) -> None:
    """Read files, one line before and one after each."""
    from fuzz.kinds import KINDS, seed_of

    kind = KINDS[name]
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    with tempfile.TemporaryDirectory() as folder:
        path, sound = Path(folder, f"a.{kind.ending}"), kind.sound(Path(folder))
        for held in sound:
            path.write_bytes(held)
            try:
                kind.read(path)
            except kind.refusal as error:  # one matrix alone is no structure
                assert "has no matrix" in str(error), error
        _bounded()
        for number in range(first, last):
            random = np.random.default_rng(seed_of(name, number))
            path.write_bytes(kind.spoil(sound[int(random.integers(len(sound)))], random))
            print(f"begin {number} -", flush=True)
            signal.alarm(SECONDS)
            begun = time.perf_counter()
            what, said = _outcome(kind, path)
            signal.alarm(0)
            print(what, number, f"{time.perf_counter() - begun:.3f}", said, flush=True)


def _bounded() -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


def _outcome(kind: Any, path: Path) -> tuple[str, str]:
    """What becomes of a file: read, refused or wrong, and what was said."""
    import traceback

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            kind.read(path)
        return "read", ""
    except BaseException as error:  # whatever comes is what is looked for
        said = str(error)
        wanted = kind.refusal
        own = type(error) is wanted or (wanted is not ValueError and isinstance(error, wanted))
        if own and fit(said, kind.tells):
            return "refused", ""
        where = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(where.filename).name}:{where.lineno}"
        return "wrong", f"{type(error).__name__} at {place}: {ascii(said[:300])}"


def fit(said: str, tells: bool) -> bool:
    """Whether a refusal is one sentence of a reasonable length that quotes nothing."""
    from fuzz.spoil import SECRET

    return said.isprintable() and 0 < len(said) < LONGEST and (tells or SECRET.decode() not in said)
