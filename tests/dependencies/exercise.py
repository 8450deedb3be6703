"""What an installation must be able to do, run by its own Python from an empty directory.

    python exercise.py README.md [--all] [--no-compiler]

README's first two blocks (the first must print what stands below it), the branch saved and read. With --all
its page and its exports, a map in two processes, another chosen and one by dask, matrices from files, and the
command line. What an extra adds is run where that extra is installed. With --no-compiler there must be none.
"""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import redirect_stdout
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

BLOCK = re.compile(r"```(python|text)\n(.*?)```", re.DOTALL)
GRID = {"F": [0.2, 0.3], "c": [0.1, 0.2]}


def readme(text: str) -> dict[str, Any]:
    """Run the first two blocks of README; return the names that they leave."""
    blocks = BLOCK.findall(text)
    assert [kind for kind, _ in blocks[:3]] == ["python", "text", "python"], "README begins otherwise"
    names: dict[str, Any] = {}
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(compile(blocks[0][1], "README.md", "exec"), names)
    assert printed.getvalue() == blocks[1][1], f"README says otherwise than\n{printed.getvalue()}"
    with redirect_stdout(io.StringIO()):
        exec(compile(blocks[2][1], "README.md", "exec"), names)
    return names


def reading(names: dict[str, Any]) -> None:
    """The branch that README's second block has saved is read as it was, and written once more."""
    import periodic as per

    branch, found = names["branch"], per.Branch.load("stop.nc")
    assert np.array_equal(found.values, branch.values) and len(branch) > 10
    for here, there in zip(found, branch, strict=True):
        assert here.label is there.label and np.array_equal(here.multipliers, there.multipliers)
        assert np.array_equal(here.orbit["x"](0.2), there.orbit["x"](0.2))
    found.save("again.nc")
    assert np.array_equal(per.Branch.load("again.nc").values, branch.values)


def exporting(names: dict[str, Any]) -> None:
    """The branch for other programs."""
    import periodic as per

    endings = [".csv", ".mat", ".h5"] + ([".uff"] if find_spec("pyuff") else [])
    for ending in endings:
        for file in per.export(names["branch"], f"stop{ending}"):
            assert file.stat().st_size > 1000, file


def drawing(names: dict[str, Any]) -> None:
    """The page of the branch, and pictures."""
    import periodic as per

    per.plot(names["branch"]).figure.savefig("stop.svg")
    per.plots.orbit(names["orbit"]).figure.savefig("orbit.png")
    if find_spec("plotly"):
        page = per.page(names["branch"], "stop.html", system=names["system"])
        assert "Plotly.newPlot" in page.read_text("utf-8")


def maps(names: dict[str, Any]) -> None:
    """A map in two processes, gone on with from its file; chosen cells; the same map by dask."""
    import periodic as per
    import symbolic as sym

    numbers = {"peak": per.maps.Highest(per.PeakToPeak("x")), "folds": per.maps.Places("LP")}
    task = per.maps.Task(sym.scene("duffing"), "Omega", (1.3, 1.9), numbers=numbers, tol=per.Accuracy.DRAFT)
    found = per.design_map(task, GRID, 2, store="map.nc", chunk=2)
    assert (found["status"] == "done").all() and float(found["peak"].min()) > 0.0
    assert per.design_map(task, GRID, 2, store="map.nc", chunk=2).identical(found)
    if find_spec("plotly"):
        per.page(found, "map.html")
    if find_spec("adaptive"):
        plan = per.maps.Adaptive({"F": (0.2, 0.3)}, "peak", 5)
        assert (per.design_map(task, plan, 1, store=None)["status"] == "done").all()
    if find_spec("distributed"):
        from distributed import Client

        with Client(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as client:
            other = per.design_map(task, GRID, client.get_executor(), store=None, chunk=2)
        np.testing.assert_allclose(other["peak"], found["peak"], rtol=1e-5)


def matrices(names: dict[str, Any]) -> None:
    """Matrices from files: SciPy's, OUTPUT4, a substructure of Abaqus."""
    import scipy.io

    import symbolic as sym

    M, K = np.eye(2), np.array([[2.0, -1.0], [-1.0, 2.0]])
    scipy.io.savemat("two.mat", {"M": M, "C": 0.1 * K, "K": K})
    assert np.array_equal(np.asarray(_dense(sym.read_matrices("two.mat").K)), K)
    if find_spec("pyyeti"):
        from pyyeti.nastran import op4

        op4.write("two.op4", {"M": M, "C": 0.1 * K, "K": K}, binary=True)
        assert np.array_equal(_dense(sym.read_matrices("two.op4").K), K)


def _dense(matrix: Any) -> Any:
    return matrix.toarray() if hasattr(matrix, "toarray") else matrix


def commands(names: dict[str, Any]) -> None:
    """The command line as it is installed."""
    page = ["--html"] if find_spec("plotly") else []
    duffing = ["duffing", "--from", "1.3", "--to", "1.9", "--accuracy", "draft"]
    _command("trace", *duffing, "--sweep", *page, "--out", "traced")
    _command("trace", *duffing, "--sweep", *page, "--out", "traced", "--resume")
    _command("map", *duffing, "--over", "F=0.1:0.3:3", "--jobs", "1", "--out", "mapped")
    _command("export", "traced", "traced.h5")
    _command("linear", "duffing", "--out", "linear")
    _command("doctor", "--json")


def _command(*arguments: str) -> None:
    program = Path(sys.executable).with_name("orbitrace")
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, (
        f"orbitrace {' '.join(arguments)} ended with {done.returncode}: {done.stderr}"
    )


def without_compiler(names: dict[str, Any]) -> None:
    """No compiler is found, and the command line's own numbers are right all the same."""
    from symbolic.kernels import native

    assert native.compiler() is None, native.compiler()
    _command("doctor")


LONG = (exporting, drawing, maps, matrices, commands)


def main(file: str, *options: str) -> int:
    """Run what is asked for; return how many failed."""
    names: dict[str, Any] = {}
    failed = 0

    def blocks(_: dict[str, Any]) -> None:
        names.update(readme(Path(file).read_text("utf-8")))

    chosen: list[Callable[[dict[str, Any]], None]] = [blocks, reading]
    chosen += LONG if "--all" in options else ()
    chosen += [without_compiler] if "--no-compiler" in options else []
    for exercise in chosen:
        begun = time.process_time()
        try:
            exercise(names)
        except Exception:
            failed += 1
            print(f"{exercise.__name__} failed\n{traceback.format_exc()}", flush=True)
        print(f"{exercise.__name__}: {time.process_time() - begun:.1f} s", flush=True)
    print(f"{sum(os.times()[:4]):.0f} s of CPU")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
