"""The benchmarks: records, ratios, and peers that are not there."""

from __future__ import annotations

import importlib
import json
import math
from pathlib import Path

import pytest

from reports.bench import peers
from reports.bench.__main__ import main
from reports.bench.record import RecordError, begun, compared, last, loaded
from reports.bench.suite import FOLDS, fold_error


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
    assert "AUTO-07p, ntst 50" in capsys.readouterr().err


def test_missing_peer_is_skipped_with_a_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Assert that a peer that is not installed is told of, in print and in the record."""

    def missing(name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", missing)
    assert main(["--out", str(tmp_path), "--only", "AUTO-07p, ntst 50"]) == 0
    assert "AUTO-07p, ntst 50: skipped, bifpy is not installed" in capsys.readouterr().out
    (file,) = tmp_path.glob("*.json")
    assert "AUTO-07p, ntst 50" in json.loads(file.read_text("utf-8"))["skipped"]


def test_models_of_the_peers_are_ours() -> None:
    """Assert that AUTO's right-hand side is Duffing A with its force as an oscillator on its own orbit."""
    omega, tau = 1.3, 0.7

    rates = peers._duffing([0.4, -0.2, math.sin(tau), math.cos(tau)], [omega])
    force = 0.5 * math.cos(tau)
    assert rates == pytest.approx(
        [-0.2, force + 0.02 - 0.4 - 0.064, omega * math.cos(tau), -omega * math.sin(tau)]
    )


def test_fold_error() -> None:
    """Assert that the error is the larger of two folds, and infinite where one is missed."""
    assert fold_error(FOLDS) == 0
    assert fold_error((FOLDS[0], FOLDS[1] * 1.01)) == pytest.approx(0.01)
    assert fold_error(FOLDS[:1]) == float("inf")
