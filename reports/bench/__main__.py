"""Run the benchmarks: `python -m reports.bench [--out DIR] [--only TEXT]`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from threadpoolctl import threadpool_limits

from reports.bench.others import PEERS, MissingError
from reports.bench.record import RecordError, begun, compared, last
from reports.bench.suite import OWN, Numbers

FOLDER = Path("benchmarks")


def main(arguments: list[str] | None = None) -> int:
    """Measure, print ratios against the last record, and keep a new one."""
    parser = argparse.ArgumentParser(prog="python -m reports.bench", description=__doc__)
    parser.add_argument("--out", type=Path, default=FOLDER, help="where records are [benchmarks]")
    parser.add_argument("--only", default="", help="run the benchmarks whose name contains this")
    asked = parser.parse_args(arguments)
    chosen = [b for b in (*OWN, *PEERS) if asked.only.lower() in b.name.lower()]
    if not chosen:
        names = ", ".join(b.name for b in (*OWN, *PEERS))
        print(f"--only is {asked.only!r}; it must be part of one of: {names}", file=sys.stderr)
        return 2
    try:
        before = last(asked.out)
    except RecordError as error:
        print(error, file=sys.stderr)
        return 2
    asked.out.mkdir(parents=True, exist_ok=True)
    load, results, skipped = os.getloadavg()[0], dict[str, Numbers](), dict[str, str]()
    with threadpool_limits(limits=1, user_api="blas"):
        for benchmark in chosen:
            print(f"{benchmark.name} ...", file=sys.stderr, flush=True)
            try:
                results[benchmark.name] = benchmark.run()
            except MissingError as error:
                skipped[benchmark.name] = str(error)
    record, lines = begun(results, skipped, load), compared(results, before)
    width = max((len(name) for name, _, _ in lines), default=0)
    for name, value, ratio in lines:
        print(f"{name:{width}}  {value:10.4g}" + ("" if ratio is None else f"  x {ratio:.2f}"))
    for name, reason in skipped.items():
        print(f"{name}: skipped, {reason}")
    print("x: ratio to the last record that has it" if before else "there is no earlier record")
    print(f"written: {record.save(asked.out)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
