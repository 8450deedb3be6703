"""What the doctor says of a machine, and that it notices wrong numbers."""

from __future__ import annotations

import json

import pytest
from support.commands import Capture, Patch

from reports.app.cli import main
from reports.app.doctor import numbers
from symbolic.kernels import native


def test_all_is_well(capsys: Capture) -> None:
    """Assert exit code 0, versions, and errors far below what is allowed."""
    assert main(["doctor", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert {"orbitrace", "casadi", "numpy", "scipy"} <= told["packages"].keys()
    assert any(name.startswith("blas of numpy") for name in told["threads"])
    assert len(told["checks"]) == len(numbers.CHECKS)
    for check in told["checks"]:
        assert check["right"] and check["error"] < check["allowed"]


@pytest.mark.parametrize(
    ("found", "why"),
    [
        ([1.001], "error 1.0e-03, allowed 1e-07"),
        ([1.0, 1.0], "2 found, 1 known"),
        ([float("nan")], "error nan"),
    ],
)
def test_wrong_numbers(found: list[float], why: str, capsys: Capture, monkeypatch: Patch) -> None:
    """Assert exit code 3 and what is wrong, also of numbers that are missing or none."""
    monkeypatch.setattr(numbers, "CHECKS", {"one": (1e-7, lambda: (found, [1.0]))})
    assert main(["doctor"]) == 3
    said = capsys.readouterr().out
    assert "WRONG" in said and why in said


def test_failure_is_told(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that a check that cannot be made tells why, and counts as wrong."""

    def broken() -> numbers.Numbers:
        raise OSError("no library")

    monkeypatch.setattr(numbers, "CHECKS", {"one": (1e-7, broken)})
    assert main(["doctor", "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["checks"][0]["failure"] == "OSError: no library"


def test_without_a_compiler(capsys: Capture, monkeypatch: Patch) -> None:
    """Assert that a machine without a compiler is told what that means."""
    monkeypatch.setattr(native, "compiler", lambda: None)
    monkeypatch.setattr(numbers, "CHECKS", {"one": (1e-7, lambda: ([1.0], [1.0]))})
    assert main(["doctor"]) == 0
    assert "none: equations run in NumPy" in capsys.readouterr().out
