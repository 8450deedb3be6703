"""AUTO-07p's own executable, its problem compiled Fortran (`fortran/chain.f90`): Duffing A, chains.

AUTO_DIR names a built AUTO-07p; `make -C src` in it makes its lib. A Fortran compiler is needed.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from reports.benchmarks.peers.answers import median, tell

DUFFING = (0.3, 1.0, 0.1, 1.0, 1.0, 0.0, 0.5, 0.0, 1e9, 1)
CHAIN = (1.6, 1.0, 0.05, 1.0, 0.1, 0.05, 0.3, 0.0, 1e9, 1e9)
LOCAL = (*CHAIN[:-1], 1)
STOPPED = (1.6, 1.0, 0.05, 1.0, 0.0, 0.05, 0.3, 1.0, 1.0, 1e9)
"""Omega where the branch begins, m, c, k, k3, link, F, stop, gap in SI, as in `reports.benchmarks.work`, and
how many oscillators have k3."""

PROBLEMS = {"duffing": DUFFING, "chain": CHAIN, "local": LOCAL, "stopped": STOPPED}

FOLD = 5
"""AUTO's type of a fold (LP) of periodic orbits."""

CONSTANTS = """IPS=2, IRS=0, ILP=1, ISP=2, ISW=1
NDIM={states}, NTST={ntst}, NCOL=4, IAD=3
ICP=[1, 11], JAC=1
NMX=5000, RL0={low}, RL1={high}, NPR=0, MXBF=0, IID=0
ITMX=9, ITNW=7, NWTN=3
EPSL=1e-8, EPSU=1e-8, EPSS=1e-6
DS={ds}, DSMIN=1e-5, DSMAX=0.05, IADS=1
UZSTOP={{1: [{end}]}}
"""
"""Folds of Duffing A to 1e-8 with NTST 20; with twice its steps one of them is lost at 4e-3."""


def built(folder: Path) -> Path:
    """Return AUTO's executable for the chain, made in a folder. Raises SystemExit."""
    where = os.environ.get("AUTO_DIR")
    objects = sorted(Path(where, "lib").glob("*.o")) if where else []
    compiler = shutil.which(os.environ.get("FC", "gfortran"))
    if not objects or compiler is None:
        raise SystemExit("AUTO_DIR names no built AUTO-07p, or there is no Fortran compiler")
    source, made = Path(__file__).with_name("fortran") / "chain.f90", folder / "chain"
    subprocess.run([compiler, "-O2", "-fopenmp", "-o", made, source, *objects], check=True, cwd=folder)
    return made


def prepare(folder: Path, problem: str, count: int, ntst: int) -> None:
    """Write problem and constants of a chain of `count` oscillators."""
    upwards = problem == "duffing"
    low, high, end, ds = (0.25, 3.0, 3.0, 0.01) if upwards else (0.5, 1.7, 0.5, -0.01)
    numbers = {"states": 2 * count + 2, "ntst": ntst, "low": low, "high": high, "end": end, "ds": ds}
    (folder / "problem").write_text(" ".join(map(str, PROBLEMS[problem])))
    (folder / "fort.2").write_text(CONSTANTS.format(**numbers))


def branch(folder: Path) -> tuple[int, list[float]]:
    """Return number of points and folds of the branch that AUTO wrote."""
    rows = [line.split() for line in (folder / "fort.7").read_text().splitlines()]
    points = [row for row in rows if row[0] != "0"]
    return len(points), [float(row[4].replace("D", "E")) for row in points if int(row[2]) == FOLD]


def main(problem: str, count: int, ntst: int) -> None:
    """Measure the branch."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        run = built(folder)
        prepare(folder, problem, count, ntst)
        seconds = median(lambda: subprocess.run([run], check=True, cwd=folder, stdout=subprocess.DEVNULL))
        tell(seconds, *branch(folder))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
