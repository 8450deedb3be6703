"""Holds the tests against mutants of the code, and prints which of them no test notices.

    python tests/mutants/run.py [--count 100] [--seed 0] [--since COMMIT] [--own]

The mutants are made in a clone of the last commit. The tests of a mutant's own folder are asked first, then
those of its package and of whole problems; `--own` leaves it at the first two.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from cosmic_ray.mutating import use_mutation
from cosmic_ray.plugins import get_operator
from sample import Mutant, drawn

ROOT = Path(__file__).parents[2]
CLONE = ROOT / "build" / "mutants"
PACKAGES = ("symbolic", "periodic")
PATIENCE = 1800.0
"""Seconds after which a mutant is said to have stopped its tests from ending."""


def stages(module: Path, own: bool) -> list[list[str]]:
    """Return the folders of tests that a module is held against, nearest first."""
    package, room = module.parts[0], "/".join(module.parts[1:-1])
    nearest = next(
        str(folder)
        for folder in (Path("tests", package, room), *Path("tests", package, room).parents)
        if folder.is_dir()
    )
    found = [[nearest], [f"tests/{package}"], ["tests/problems", "tests/howto"]]
    kept = found[: 2 if own else 3]
    return [stage for k, stage in enumerate(kept) if stage not in kept[:k]]


def failing(tests: list[str], broken: set[str]) -> str:
    """Return the first test that fails, or nothing."""
    environment = os.environ | {"PYTHONPATH": str(CLONE), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "-p", "no:cacheprovider", *tests]
    command += [f"--deselect={test}" for test in broken]
    options: dict[str, Any] = {"cwd": CLONE, "env": environment, "text": True, "capture_output": True}
    try:
        ran = subprocess.run(command, timeout=PATIENCE, **options)
    except subprocess.TimeoutExpired:
        return f"{tests[0]} does not end"
    if not ran.returncode:
        return ""
    failed = [line for line in ran.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return failed[0].split(" - ")[0].split(maxsplit=1)[1] if failed else ran.stderr.strip()[-200:]


def noticed(mutant: Mutant, own: bool, broken: set[str]) -> tuple[str, str]:
    """Return what is changed, as two lines of code, and the test that notices it.

    A test that fails without the change too says nothing; it joins the broken ones and is asked no more.
    """
    while True:
        with use_mutation(CLONE / mutant.path, get_operator(mutant.operator)(), mutant.occurrence) as texts:
            pairs = zip(*(text.splitlines() for text in texts), strict=False)
            change = next((f"{a.strip()}\n    -> {b.strip()}" for a, b in pairs if a != b), "a line less")
            found = (failing(stage, broken) for stage in stages(mutant.path, own))
            test = next(filter(None, found), "")
        if "::" not in test or not failing([test], set()):
            return change, test
        broken.add(test)


def modules(since: str | None) -> list[Path]:
    """Return what is mutated: all modules, or those that differ from a commit."""
    command = (
        ["git", "ls-files"] if since is None else ["git", "diff", "--name-only", "--diff-filter=d", since]
    )
    listed = subprocess.check_output([*command, "--", *PACKAGES], cwd=CLONE, text=True)
    return [path for path in map(Path, listed.splitlines()) if path.suffix == ".py"]


def main() -> int:
    """Draw, try and tell; the exit code says whether all were noticed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--since", help="only files that differ from this commit")
    parser.add_argument("--own", action="store_true", help="only tests of the module's own package")
    asked = parser.parse_args()
    subprocess.run(["rm", "-rf", str(CLONE)], check=True)
    subprocess.run(["git", "clone", "-q", "--shared", str(ROOT), str(CLONE)], check=True)
    os.chdir(CLONE)
    mutants = drawn(modules(asked.since), asked.count, asked.seed)
    survived, broken = 0, set[str]()
    for number, mutant in enumerate(mutants):
        began = time.monotonic()
        change, test = noticed(mutant, asked.own, broken)
        survived += not test
        place = f"{mutant.path}:{mutant.position[0]}"
        print(
            f"{number:3} {test or 'SURVIVED'}  ({time.monotonic() - began:.0f} s)\n    {place}  {change}",
            flush=True,
        )
    print(f"{len(mutants) - survived} of {len(mutants)} mutants noticed, {survived} survived")
    return bool(survived)


if __name__ == "__main__":
    sys.exit(main())
