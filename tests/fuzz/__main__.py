"""Read spoilt files of every kind; the exit code says whether one was not read or refused as it should be.

    python -m fuzz [--kinds npz,mat] [--count 10000] [--first 0]

A kind is read in a process of its own, which has 1 GB more than it begins with and 10 s for each file.
"""

from __future__ import annotations

import argparse

from fuzz.kinds import KINDS
from fuzz.process import fuzzed


def main() -> int:
    """Run what is asked for and say what was found."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("python -m fuzz", description=__doc__, formatter_class=raw)
    parser.add_argument("--kinds", default=",".join(KINDS), help="which kinds of files")
    parser.add_argument("--count", type=int, default=10_000, help="how many of each kind")
    parser.add_argument("--first", type=int, default=0, help="the first file's number")
    given = parser.parse_args()
    wrong = 0
    for kind in given.kinds.split(","):
        found = fuzzed(kind, given.first, given.count)
        print(f"{kind}: {found}", flush=True)
        for number, said in found.wrong[:20]:
            print(f"  {number}: {said}", flush=True)
        wrong += len(found.wrong)
    return wrong > 0


if __name__ == "__main__":
    raise SystemExit(main())
