"""The benchmarks: records, ratios, and peers that are not there."""

from __future__ import annotations

import importlib
import json
import math
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import symbolic as sym
from periodic.newton import correct
from reports.bench import others
from reports.bench.__main__ import main
from reports.bench.peers.told import folds
from reports.bench.record import RecordError, begun, compared, last, loaded
from reports.bench.suite import FOLDS, OFF_RESONANCE, converged, fold_error, iteration
from reports.trade.problems import chain_model


def test_ratios_to_the_last_record_that_has_them(tmp_path: Path) -> None:
    """Assert that results are compared with the latest of each benchmark, and new ones with nothing."""
    for date, value in (("2026-01-01T000000", 4.0), ("2026-01-02T000000", 2.0)):
        record = begun({"a": {"s": value}}, {}, 0.0)
        (tmp_path / f"{date}.json").write_text(record.save(tmp_path / "one").read_text("utf-8"), "utf-8")
    (tmp_path / "2026-01-03T000000.json").write_text(
        begun({"b": {"s": 1.0}}, {"c": "not here"}, 0.5).save(tmp_path / "one").read_text("utf-8"), "utf-8"
    )
    assert last(tmp_path) == {"a": {"s": 2.0}, "b": {"s": 1.0}}
    lines = compared({"a": {"s": 3.0, "points": 7.0}, "d": {"s": 1.0}}, last(tmp_path))
    assert lines == [("a: s", 3.0, 1.5), ("a: points", 7.0, None), ("d: s", 1.0, None)]


def test_record_tells_machine_versions_and_date(tmp_path: Path) -> None:
    """Assert that a record comes back as it was, with all that its numbers depend on."""
    record = begun({"a": {"s": 4.0}}, {"b": "not installed"}, 1.5)
    assert loaded(record.save(tmp_path)) == record
    assert {"system", "processor", "cores", "python"} == set(record.machine)
    assert record.versions["numpy"][0].isdigit() and record.date.startswith("20")


@pytest.mark.parametrize("text", ["{", "[]", '{"date": 1}'])
def test_damaged_record_is_refused(tmp_path: Path, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that a file that is no record is named in one sentence, before anything is measured."""
    file = tmp_path / "2026.json"
    file.write_text(text, "utf-8")
    with pytest.raises(RecordError, match=r"2026\.json is no record of benchmarks"):
        loaded(file)
    assert main(["--out", str(tmp_path), "--only", "start"]) == 2
    assert "is no record" in capsys.readouterr().err


def test_unknown_benchmark(capsys: pytest.CaptureFixture[str]) -> None:
    """Assert that a name that none has is refused with those that there are."""
    assert main(["--only", "marathon"]) == 2
    assert "AUTO-07p by bifpy, ntst 50" in capsys.readouterr().err


def test_missing_peers_are_skipped_with_a_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a peer that is not installed is told of, in print and in the record."""
    # A Python that finds nothing but what the command itself puts on its path.
    bare = tmp_path / "python"
    bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -I -S "$@"\n', "utf-8")
    bare.chmod(0o755)
    monkeypatch.setenv(others.PYTHON, str(bare))
    others.version.cache_clear()
    assert main(["--out", str(tmp_path), "--only", "AUTO-07p by bifpy, ntst 50"]) == 0
    others.version.cache_clear()
    assert "AUTO-07p by bifpy, ntst 50: skipped, bifpy is not installed" in capsys.readouterr().out
    (file,) = tmp_path.glob("*.json")
    record = json.loads(file.read_text("utf-8"))
    assert (
        "AUTO-07p by bifpy, ntst 50" in record["skipped"] and record["versions"]["bifpy"] == "not installed"
    )


def test_model_of_auto_is_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assert that AUTO's right-hand side is Duffing A with its force as an oscillator on its own orbit."""
    stand_in = types.ModuleType("bifpy")
    stand_in.auto = None  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "bifpy", stand_in)
    monkeypatch.delitem(sys.modules, "reports.bench.peers.auto", raising=False)
    omega, tau = 1.3, 0.7
    model = importlib.import_module("reports.bench.peers.auto")
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
    assert correct(system, orbit).iterations == 1
    assert iteration(system, OFF_RESONANCE, 20) > 0.01


def test_fold_error() -> None:
    """Assert that the error is the larger of two folds, and infinite where one is missed."""
    assert fold_error(FOLDS) == 0
    assert fold_error((FOLDS[0], FOLDS[1] * 1.01)) == pytest.approx(0.01)
    assert fold_error(FOLDS[:1]) == float("inf")
