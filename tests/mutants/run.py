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


def noticed(module: Path, own: bool) -> str:
    """Return the test that fails, or nothing."""
    environment = os.environ | {"PYTHONPATH": str(CLONE), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "-p", "no:cacheprovider"]
    for stage in stages(module, own):
        try:
            ran = subprocess.run(
                [*command, *stage],
                cwd=CLONE,
                env=environment,
                text=True,
                capture_output=True,
                timeout=PATIENCE,
            )
        except subprocess.TimeoutExpired:
            return f"{stage[0]} does not end"
        if ran.returncode:
            failed = [line for line in ran.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
            return failed[0].split(" - ")[0] if failed else ran.stderr.strip()[-200:]
    return ""


def tried(mutant: Mutant, own: bool) -> tuple[str, str]:
    """Return what is changed, as two lines of code, and the test that notices it."""
    with use_mutation(CLONE / mutant.path, get_operator(mutant.operator)(), mutant.occurrence) as texts:
        before, after = (text.splitlines() for text in texts)
        change = next(
            (f"{a.strip()}\n    -> {b.strip()}" for a, b in zip(before, after, strict=False) if a != b),
            "a line less",
        )
        return change, noticed(mutant.path, own)


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
    survived = 0
    for number, mutant in enumerate(mutants):
        began = time.monotonic()
        change, test = tried(mutant, asked.own)
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
