"""Trace and judge models with contact drawn at random; `--page` writes the page of the rows there are.

    python -m survey ROWS [ROWS ...] [--share 0/2] [--kinds joints,"joints down"] [--judged 8] [--page FILE]

Rows go to the first file; models that any of the files has are not run again, so that a run that was stopped
goes on where it was, and several processes, each with a file of its own and a share, divide the work.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from survey.page import page
from survey.rows import JUDGED, SEEDS, models, read, row, write


def main() -> int:
    """Run what is left; the exit code says whether anything was wrong."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("python -m survey", description=__doc__, formatter_class=raw)
    parser.add_argument("rows", type=Path, nargs="+", help="files of rows, a model a line")
    parser.add_argument("--share", default="0/1", help="which part of the models: 0/2 and 1/2 are all")
    parser.add_argument("--kinds", default=",".join(SEEDS), help="which kinds of models")
    parser.add_argument("--judged", type=int, default=JUDGED, help="points of each that are judged")
    parser.add_argument("--page", type=Path, help="where the page is written; nothing is run then")
    given = parser.parse_args()
    done = read(given.rows)
    if given.page is None:
        part, parts = map(int, given.share.split("/"))
        chosen = [m for k, m in enumerate(models()) if k % parts == part and m[0] in given.kinds.split(",")]
        for kind, seed in chosen:
            if (kind, seed) not in done:
                done[kind, seed] = found = row(kind, seed, given.judged)
                write(given.rows[0], found)
                print(
                    f"{kind} {seed}: {found.told}, {found.points} points, {found.seconds:.1f} s", flush=True
                )
                for said in (*found.wrong, *found.strays, *found.gaps):
                    print(f"    {said}", flush=True)
    else:
        rows = [done[model] for model in models() if model in done]
        given.page.write_text(page(rows), "utf-8")
    return int(any(found.wrong or found.strays for found in done.values()))


if __name__ == "__main__":
    raise SystemExit(main())
