"""Holds the tests against mutants of the code, and prints which of them no test notices.

    python tests/mutants/run.py [--count 100] [--seed 0] [--since COMMIT] [--limit SECONDS] [--page FILE]
        [--measuring SECONDS]

The mutants are made in a clone of the last commit. Each is held against the tests that execute the line that
it changes, those first that are likely to notice it for their time, as far as the CPU time for a mutant goes.
Which tests these are is measured once for each text of a test file and kept in build/covering (delete it to
measure all anew). A run that was stopped goes on where it was.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path

import forks
from covering import Covering
from measuring import PACKAGES, measure
from page import page, said
from sample import drawn
from trial import Outcome, Trial

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build"
CLONE = BUILD / "mutants"
COVERING = BUILD / "covering"
COMPILED = ".git/compiled"
"""Says which commit the clone's bytecode is of."""

LIMIT = 60.0
"""Seconds of CPU time for the tests of one mutant."""


def modules(since: str | None) -> list[Path]:
    """Return what is mutated: all modules, or those that differ from a commit."""
    command = (
        ["git", "ls-files"] if since is None else ["git", "diff", "--name-only", "--diff-filter=d", since]
    )
    listed = subprocess.check_output([*command, "--", *PACKAGES], cwd=CLONE, text=True)
    return [path for path in map(Path, listed.splitlines()) if path.suffix == ".py"]


def known(file: Path) -> list[Outcome]:
    """Return the outcomes that a file has, one a line."""
    return (
        [Outcome(**json.loads(line)) for line in file.read_text("utf-8").splitlines()]
        if file.exists()
        else []
    )


def cloned() -> str:
    """Clone the last commit, compile it to bytecode, which no mutant is, and return the commit.

    A clone of that commit that is there is kept, without what a run that was stopped has left of a mutant.
    """
    commit = subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=ROOT, text=True).strip()
    if not CLONE.exists():
        subprocess.run(["git", "clone", "-q", "--shared", str(ROOT), str(CLONE)], check=True)
    there = subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=CLONE, text=True).strip()
    if there != commit:
        subprocess.run(["git", "fetch", "-q", "origin", commit], cwd=CLONE, check=True)
    subprocess.run(["git", "reset", "-q", "--hard", commit], cwd=CLONE, check=True)
    if not (CLONE / COMPILED).exists() or (CLONE / COMPILED).read_text() != commit:
        environment = os.environ | {"PYTHONPATH": str(CLONE)}
        for command in (["compileall", "-q", *PACKAGES], ["pytest", "-q", "-n0", "--collect-only", "tests"]):
            made = [sys.executable, "-m", *command]
            subprocess.run(made, cwd=CLONE, env=environment, check=True, stdout=subprocess.DEVNULL)
        (CLONE / COMPILED).write_text(commit)
    return commit[:7]


def main() -> int:
    """Draw, try and tell; the exit code says whether all that change a result were noticed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--since", help="only files that differ from this commit")
    parser.add_argument("--limit", type=float, default=LIMIT, help="CPU seconds for one mutant")
    parser.add_argument(
        "--measuring", type=float, default=math.inf, help="seconds for test files not measured yet"
    )
    parser.add_argument("--page", type=Path, help="where the table is written")
    asked = parser.parse_args()
    commit = cloned()
    forks.load()
    measure(CLONE, COVERING, time.monotonic() + asked.measuring)
    os.chdir(CLONE)
    record = BUILD / f"mutants-{commit}-{asked.seed}.jsonl"
    outcomes = {(o.path, o.operator, o.occurrence): o for o in known(record)}
    trial = Trial(CLONE, Covering(CLONE, COVERING), asked.limit, COVERING / "cache")
    found: list[Outcome] = []
    for number, mutant in enumerate(drawn(modules(asked.since), asked.count, asked.seed)):
        place = (str(mutant.path), mutant.operator.rpartition("/")[2], mutant.occurrence)
        if place not in outcomes:
            outcomes[place] = trial.of(mutant)
            with record.open("a") as out:
                out.write(json.dumps(asdict(outcomes[place])) + "\n")
        found.append(outcomes[place])
        print(f"{number:3} {said(found[-1])}", flush=True)
    text, all_noticed = page(found, asked.seed, commit, asked.limit)
    if asked.page:
        (ROOT / asked.page).write_text(text, "utf-8")
    print(text.partition("\n## ")[0])
    return int(not all_noticed)


if __name__ == "__main__":
    sys.exit(main())
