"""The benchmarks: what a record tells, and peers that are not there."""

from __future__ import annotations

import importlib
import json
import math
import os
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import periodic as per
import symbolic as sym
from periodic.correction.newton import correct
from reports import benchmarks
from reports.benchmarks import others
from reports.benchmarks.peers.answers import folds
from reports.benchmarks.work import FOLDS, OFF_RESONANCE, chain_model, converged, fold_error, linearisations


def test_record_tells_what_is_missing(tmp_path: Path) -> None:
    """Assert that a peer that is not installed is skipped for a reason, in print and in the record."""
    # A Python that finds nothing but what the command itself puts on its path.
    bare, record = tmp_path / "python", tmp_path / "record.json"
    bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -I -S "$@"\n', "utf-8")
    bare.chmod(0o755)
    files = [f"{Path(benchmarks.__file__).parent}/bench_{name}.py" for name in ("calibration", "peers")]
    chosen = ["-k", "calibration or (bifpy and 20)", "-rs", "-p", "no:cacheprovider"]
    run = [sys.executable, "-m", "pytest", *files, *chosen, f"--benchmark-json={record}"]
    # pytest-benchmark measures nothing in a worker of pytest-xdist, or what takes itself for one.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
    environment[others.PYTHON] = str(bare)
    done = subprocess.run(run, env=environment, capture_output=True, text=True, check=True)
    assert "bifpy is not installed (pip install 'orbitrace[peers]')" in done.stdout
    told = json.loads(record.read_text("utf-8"))
    assert [b["name"] for b in told["benchmarks"]] == ["test_calibration"]
    assert told["skipped"].keys() == {"AUTO-07p by bifpy, ntst 20"}
    assert told["versions"]["bifpy"] == "not installed" and told["versions"]["numpy"][0].isdigit()
    assert told["load"] >= 0 and told["machine_info"]["cpu"]["count"] >= 1


def test_model_of_auto_is_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that AUTO's right-hand side is Duffing A with its force as an oscillator on its own orbit."""
    stand_in = types.ModuleType("bifpy")
    stand_in.auto = None  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "bifpy", stand_in)
    monkeypatch.delitem(sys.modules, "reports.benchmarks.peers.auto", raising=False)
    omega, tau = 1.3, 0.7
    model = importlib.import_module("reports.benchmarks.peers.auto")
    rates = model.duffing([0.4, -0.2, math.sin(tau), math.cos(tau)], [omega])
    force = 0.5 * math.cos(tau)
    assert rates == pytest.approx(
        [-0.2, force + 0.02 - 0.4 - 0.064, omega * math.cos(tau), -omega * math.sin(tau)]
    )


def test_folds_between_points() -> None:
    """Assert that both turns of x^3 - 3 x are found between points that miss them by up to 3e-3."""
    x = np.linspace(-1.7, 1.75, 60)
    found = folds([np.array([v, v**3 - 3 * v]) for v in x])
    assert found == pytest.approx([2.0, -2.0], abs=3e-5)


def test_iteration_is_that_of_a_converged_orbit() -> None:
    """Assert that what is timed is Newton's iteration on an orbit, as often as it linearises."""
    system = sym.compile(chain_model(2))
    orbit = converged(system, OFF_RESONANCE, 20)
    assert correct(per.Collocation().linearise, system, orbit).iterations == 1
    assert linearisations(system, orbit) == 1


def test_fold_error() -> None:
    """Assert that the error is the larger of two folds, and infinite where one is missed."""
    assert fold_error(FOLDS) == 0
    assert fold_error((FOLDS[0], FOLDS[1] * 1.01)) == pytest.approx(0.01)
    assert fold_error(FOLDS[:1]) == float("inf")
