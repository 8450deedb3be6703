"""Trace and judge machines drawn at random from catalogues; `--page` writes the page of the rows there are.

    python -m survey.machines ROWS [ROWS ...] [--share 0/2] [--seeds 20] [--page FILE]

Rows go to the first file; machines that any of the files has are not run again, so that a run that was
stopped goes on where it was, and several processes, each with a file of its own and a share, divide the work.
"""

from __future__ import annotations

import argparse
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from survey.machines.page import page
from survey.machines.rows import SEEDS, models, row
from survey.rows import Row, read, write


def main() -> int:
    """Run what is left; the exit code says whether anything was wrong."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("python -m survey.machines", description=__doc__, formatter_class=raw)
    parser.add_argument("rows", type=Path, nargs="+", help="files of rows, a machine a line")
    parser.add_argument("--share", default="0/1", help="which part of the machines: 0/2 and 1/2 are all")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="machines of a family")
    parser.add_argument("--page", type=Path, help="where the page is written; nothing is run then")
    given = parser.parse_args()
    done, wanted = read(given.rows), list(models(given.seeds))
    if given.page is None:
        part, parts = map(int, given.share.split("/"))
        for kind, seed in wanted[part::parts]:
            if (kind, seed) not in done:
                done[kind, seed] = found = _alone(kind, seed)
                write(given.rows[0], found)
                print(f"{kind} {seed}: {found.told}, {found.points} points, {found.seconds} s", flush=True)
                for said in (*found.wrong, *found.gaps):
                    print(f"    {said}", flush=True)
    else:
        given.page.write_text(page([done[model] for model in wanted if model in done]), "utf-8")
    return int(any(found.wrong for found in done.values()))


def _alone(kind: str, seed: int) -> Row:
    """A row from a process of its own, whose memory is then that of the trace."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
        return executor.submit(row, kind, seed).result()


if __name__ == "__main__":
    raise SystemExit(main())
