"""The same call on other people's executors, started here with two workers each: the same numbers."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from support.maps import GRID, Deadly, ends, height, process, task

import periodic as per
from periodic.workers.execution import DIED

pytestmark = pytest.mark.distributed

TESTS = Path(__file__).resolve().parents[2]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(TESTS), "OMP_NUM_THREADS": "1"}

MPI = """
import sys
import time
import periodic as per
from mpi4py.futures import MPIPoolExecutor
from support.maps import GRID, ends, height, process, task
if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        print(executor.num_workers)
        given = task(peak=height, ends=ends, process=process)
        per.design_map(given, GRID, executor, store=sys.argv[1], chunk=2)
"""


def same(found: xr.Dataset) -> None:
    """Assert that a map has the bits that this process gives, from two others."""
    here = per.design_map(task(peak=height, ends=ends), GRID, 1, store=None, chunk=2)
    for name in ("peak", "ends", "points", "newton", "status"):
        assert np.array_equal(found[name], here[name]), name
    assert len(np.unique(found["process"])) == 2 and os.getpid() not in found["process"].values


def test_dask(tmp_path: Path) -> None:
    """Assert the same numbers of a scheduler and two workers; a worker that dies costs a cell, no more."""
    distributed = pytest.importorskip("distributed")
    once = pytest.importorskip("dask").config.set({"distributed.scheduler.allowed-failures": 0})
    with warnings.catch_warnings(), once:
        warnings.simplefilter("ignore")
        with (
            distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
            client.get_executor() as executor,
        ):
            given = task(peak=height, ends=ends, process=process)
            same(per.design_map(given, GRID, executor, store=tmp_path / "map.nc", chunk=2))
            deadly = {"zeta": [0.1, 0.2, 0.3]}
            number = Deadly((0.2,), wait=0.5)  # a worker that dies while it starts is not replaced
            found = per.design_map(task(z=number), deadly, executor, store=None, chunk=3)
    assert found["reason"].values.tolist() == ["", DIED, ""]
    assert found["z"].values[[0, 2]].tolist() == [0.1, 0.3]


def dask(tmp_path: Path, *command: str) -> subprocess.Popen[bytes]:
    """A process of dask's, quiet, that meets the others by a file."""
    module = [sys.executable, "-m", f"distributed.cli.dask_{command[0]}", *command[1:], "--no-dashboard"]
    file = ["--scheduler-file", str(tmp_path / "scheduler.json")]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen([*module, *file], env=ENVIRONMENT, cwd=tmp_path, **quiet)


def test_dask_whose_scheduler_goes_away(tmp_path: Path) -> None:
    """Assert one sentence where the scheduler's process is killed, and that the call goes on elsewhere."""
    distributed, store = pytest.importorskip("distributed"), tmp_path / "map.nc"
    given, meeting = task(z=Deadly((), wait=0.2)), tmp_path / "scheduler.json"
    with dask(tmp_path, "scheduler", "--port", "0") as scheduler, dask(tmp_path, "worker") as worker:
        try:
            while not meeting.exists() and scheduler.poll() is None:
                time.sleep(0.05)
            with distributed.Client(scheduler_file=str(meeting), timeout=3) as client:
                executor = client.get_executor()
                with pytest.raises(
                    per.maps.MapStoppedError, match="^the executor went away .* the same call goes on"
                ):
                    per.design_map(
                        given, GRID, executor, store=store, chunk=1, progress=lambda _: scheduler.kill()
                    )
        finally:
            scheduler.kill()
            worker.kill()
    told: list[per.maps.Progress] = []
    found = per.design_map(given, GRID, 1, store=store, chunk=1, progress=told.append)
    assert 1 < told[0].done < 12 and (found["status"] == "done").all()


def test_mpi(tmp_path: Path) -> None:
    """Assert the same numbers of an MPI run of one process that asks and two that compute."""
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if mpiexec is None:
        pytest.skip("there is no MPI")
    script = tmp_path / "run.py"
    script.write_text(MPI)
    root = {
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "PRTE_ALLOW_RUN_AS_ROOT": "1",
        "PRTE_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    }
    command = [
        mpiexec,
        "-n",
        "3",
        sys.executable,
        "-m",
        "mpi4py.futures",
        str(script),
        str(tmp_path / "map.nc"),
    ]
    done = subprocess.run(command, env=ENVIRONMENT | root, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout.split() == ["2"], done.stderr
    same(xr.load_dataset(tmp_path / "map.nc"))
