"""Holds the tests against mutants of the code, and prints which of them no test notices.

    python tests/mutants/run.py [--count 100] [--seed 0] [--since COMMIT] [--limit SECONDS]

The mutants are made in a clone of the last commit. Asked first are the test files that import a mutant's
module or have its name, then the others of its folder, those of whole problems, of its package, and all, as
far as the time for a mutant goes.
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
LIMIT = 300.0
"""Seconds for the tests of one mutant."""

LATE = "time is up"


def stages(module: Path) -> list[list[str]]:
    """Return the test files that a module is held against, in the order in which they are asked."""
    package, dotted = module.parts[0], ".".join(module.with_suffix("").parts)
    every = sorted(Path("tests").rglob("test_*.py"))
    nearest = [path for path in every if path.stem == f"test_{module.stem}" and package in path.parts]
    importing = [path for path in every if f"from {dotted} import" in path.read_text("utf-8")]
    room = Path("tests", *module.parts[:-1])
    inside = [path for path in every if path.is_relative_to(room)]
    own = [path for path in every if package in path.parts]
    whole = [path for path in every if path.is_relative_to("tests/problems")]
    asked, found = set[Path](), list[list[str]]()
    for stage in ([*nearest, *importing], inside, whole, own, every):
        new = [path for path in dict.fromkeys(stage) if path not in asked]
        asked |= set(new)
        found += [[str(path) for path in new]] if new else []
    return found


def failing(tests: list[str], broken: set[str], left: float) -> str:
    """Return the first test that fails, or nothing; LATE where the seconds that are left do not suffice."""
    environment = os.environ | {"PYTHONPATH": str(CLONE), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-x",
        "-q",
        "-n0",
        "--no-header",
        "-p",
        "no:cacheprovider",
        *tests,
    ]
    command += [f"--deselect={test}" for test in broken]
    options: dict[str, Any] = {"cwd": CLONE, "env": environment, "text": True, "capture_output": True}
    try:
        ran = subprocess.run(command, timeout=max(left, 1.0), **options)
    except subprocess.TimeoutExpired:
        return LATE
    if not ran.returncode:
        return ""
    failed = [line for line in ran.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return failed[0].split(" - ")[0].split(maxsplit=1)[1] if failed else ran.stderr.strip()[-200:]


def noticed(mutant: Mutant, limit: float, broken: set[str]) -> tuple[str, str]:
    """Return what is changed, as two lines of code, and the test that notices it.

    A test that fails without the change too says nothing; it joins the broken ones and is asked no more.
    """
    ends = time.monotonic() + limit
    while True:
        with use_mutation(CLONE / mutant.path, get_operator(mutant.operator)(), mutant.occurrence) as texts:
            pairs = zip(*(text.splitlines() for text in texts), strict=False)
            change = next((f"{a.strip()}\n    -> {b.strip()}" for a, b in pairs if a != b), "a line less")
            found = (failing(stage, broken, ends - time.monotonic()) for stage in stages(mutant.path))
            test = next(filter(None, found), "")
        if "::" not in test or not failing([test], set(), limit):
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
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds for the tests of one mutant")
    asked = parser.parse_args()
    subprocess.run(["rm", "-rf", str(CLONE)], check=True)
    subprocess.run(["git", "clone", "-q", "--shared", str(ROOT), str(CLONE)], check=True)
    os.chdir(CLONE)
    mutants = drawn(modules(asked.since), asked.count, asked.seed)
    outcomes, broken = dict.fromkeys(("noticed", "survived", LATE), 0), set[str]()
    for number, mutant in enumerate(mutants):
        began = time.monotonic()
        change, test = noticed(mutant, asked.limit, broken)
        outcome = test if test == LATE else "noticed" if test else "survived"
        outcomes[outcome] += 1
        place = f"{mutant.path}:{mutant.position[0]}"
        print(
            f"{number:3} {test or 'SURVIVED'}  ({time.monotonic() - began:.0f} s)\n    {place}  {change}",
            flush=True,
        )
    print(f"of {len(mutants)} mutants: " + ", ".join(f"{n} {what}" for what, n in outcomes.items()))
    return int(outcomes["noticed"] < len(mutants))


if __name__ == "__main__":
    sys.exit(main())
